"""What a user can choose about a prediction with bands."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Problem
from .choice import again, choice
from .orders import MANOEUVRE, SimulateOptions
from .particles import BAND, ParticleOptions
from .scoring import ValidateOptions
from .tuning import LeaveOutOptions

ORDERS = ("turn", "zigzag", "stop", "astern", "speed", "rpm")
"""Fields that order manoeuvres."""

OF_TRIALS = ("restart", "sigma_from")
"""Fields that mean something for trials only."""


@dataclass(frozen=True)
class PredictOptions(SimulateOptions, ParticleOptions):
    """All choices of a prediction: manoeuvres by orders, or how trials are predicted, and how bands are made."""

    stop: bool = choice(False, "Crash stop: the propeller ordered full astern.", panel=MANOEUVRE)
    astern: str | None = choice(
        None, "Revolutions astern of the stop: 60 (1/min) or '1 1/s'. Default: as many as ahead.", panel=MANOEUVRE
    )
    restart: float | None = again(LeaveOutOptions, "restart", but="Scores are of these.")
    sigma_from: str | None = again(ValidateOptions, "sigma_from")
    level: float = choice(90.0, "Percent of what may happen that a band holds.", unit="%", least=1, most=99, panel=BAND)

    def problems(self) -> list[Problem]:
        """Revolutions astern are those of a stop."""
        found = super().problems()
        if self.astern is not None and not self.stop:
            what = "revolutions astern are ordered in a crash stop"
            found.append(Problem(what, "astern", "no stop is asked for", "add stop=True, or leave it out"))
        return found

    def given(self, names: tuple[str, ...]) -> list[str]:
        """Those of these fields that somebody has filled in."""
        return [name for name in names if getattr(self, name) not in ((), None, False)]
