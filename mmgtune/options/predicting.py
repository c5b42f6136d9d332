"""What a user can choose about a prediction with bands."""

from __future__ import annotations

from dataclasses import dataclass

from .choice import again, choice
from .orders import SimulateOptions
from .particles import BAND, ParticleOptions
from .scoring import ValidateOptions
from .tuning import LeaveOutOptions

OF_TRIALS = ("restart", "sigma_from")
"""Fields that mean something for trials only."""


@dataclass(frozen=True)
class PredictOptions(SimulateOptions, ParticleOptions):
    """All choices of a prediction: manoeuvres by orders, or how trials are predicted, and how bands are made."""

    restart: float | None = again(LeaveOutOptions, "restart", but="Scores are of these.")
    sigma_from: str | None = again(ValidateOptions, "sigma_from")
    level: float = choice(90.0, "Percent of what may happen that a band holds.", unit="%", least=1, most=99, panel=BAND)
