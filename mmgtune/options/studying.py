"""What a user can choose about studies of controllers in simulation."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..errors import Problem
from .choice import INPUT, again, choice
from .particles import ParticleOptions


@dataclass(frozen=True)
class HeadingOptions(ParticleOptions):
    """All choices of ``study heading-keeping``; defaults are those of Wakita, Akimoto and Maki, section 5.4."""

    speed: float = choice(0.5, "Speed ahead at the start.", unit="m/s", above=0.0, most=50.0, panel=INPUT)
    turn: float = choice(90.0, "Change of heading that is ordered.", unit="deg", least=-180.0, most=180.0, panel=INPUT)
    duration: float = choice(100.0, "Time simulated.", unit="s", above=0.0, most=100_000.0, panel=INPUT)
    gain_step: float = choice(
        5.0, "Least gain and distance between gains, in deg of rudder per rad and per rad/s.", above=0.0, panel=INPUT
    )
    gain_most: float = choice(100.0, "Largest gain.", above=0.0, most=100_000.0, panel=INPUT)
    step: float = choice(
        0.1, "Time between orders where a model has no step of its own.", unit="s", least=1e-3, panel=INPUT
    )
    particles: int = again(
        ParticleOptions, "particles", but="Members of an ensemble are taken as they are where each keeps its path."
    )

    def problems(self) -> list[Problem]:
        """A grid of gains has at least one, and not too many."""
        found = super().problems()
        if found:  # they may be no numbers to divide by
            return found
        n = self.gain_most / self.gain_step + 1e-9
        if not 1.0 <= n < MOST_GAINS + 1.0:
            what = f"{math.floor(n) if n < math.inf else n:g} gains from {self.gain_step:g} to {self.gain_most:g}"
            found.append(Problem(what, "gain_step", fix=f"let there be between 1 and {MOST_GAINS}"))
        return found


MOST_GAINS = 100
"""Gains on either side of a grid."""
