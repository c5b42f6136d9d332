"""What a user can choose about standard manoeuvres given as orders."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Problem
from .choice import choice
from .simulation import SimulationOptions

MANOEUVRE = "Manoeuvre"

ORDERS = ("turn", "zigzag", "stop", "astern", "speed", "rpm")
"""Fields that order manoeuvres."""


@dataclass(frozen=True)
class SimulateOptions(SimulationOptions):
    """All choices of a simulation: manoeuvres by orders, or how trials are simulated.

    Angles, speed and revolutions are texts with a unit, as a profile has them; a plain number is in the unit named, and
    for ``turn``, ``astern`` and ``rpm`` needs no quotes.
    """

    turn: tuple[str, ...] = choice(
        (),
        'Turning circle at this rudder angle, starboard positive: 35 (deg) or "0.61 rad"; repeatable.',
        panel=MANOEUVRE,
        bare=True,
    )
    zigzag: tuple[str, ...] = choice(
        (), "Zigzag RUDDER/HEADING (deg), such as 20/20 or -10/10; repeatable.", panel=MANOEUVRE, example="20/20"
    )
    stop: bool = choice(False, "Crash stop: the propeller ordered full astern.", panel=MANOEUVRE)
    astern: str | None = choice(
        None,
        "Revolutions astern of the stop: 60 (1/min) or '1 1/s'. Default: as many as ahead.",
        panel=MANOEUVRE,
        bare=True,
    )
    speed: str | None = choice(
        None, 'Approach speed, such as "12 kn". Default: the profile\'s.', unit="m/s", panel=MANOEUVRE
    )
    rpm: str | None = choice(
        None, 'Propeller revolutions: 106 (1/min) or "1.77 1/s". Default: the profile\'s.', panel=MANOEUVRE, bare=True
    )

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
