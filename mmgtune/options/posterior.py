"""What a user can choose about particles of a physical model."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Problem
from .choice import REPRODUCE, choice, effects, unknown_effects
from .simulation import SimulationOptions


@dataclass(frozen=True)
class PosteriorOptions(SimulationOptions):
    """All choices of ``posterior``."""

    particles: int = choice(400, "How many particles are drawn.", least=10, most=100_000)
    room: float = choice(
        1.0, "How far the form of the model may be wrong, over what generated ships called for.", above=0, most=10
    )
    without: tuple[str, ...] = choice((), "Effects to leave no room for, such as current.", names=effects)
    leave_out: bool = choice(
        True, "Leave kinds and sides out in turn, to find how much the trials are to be believed.", flag="--leave-out"
    )
    seed: int = choice(1, "Seed of every random number, 1 or more.", panel=REPRODUCE, least=1, most=2**63 - 1)

    def problems(self) -> list[Problem]:
        """What makes no sense, effects that do not exist among it."""
        return super().problems() + unknown_effects("without", self.without)
