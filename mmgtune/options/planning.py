"""What a user can choose about the trial to sail next."""

from __future__ import annotations

from dataclasses import dataclass

from .choice import REPRODUCE, choice
from .orders import MANOEUVRE
from .particles import BAND
from .simulation import SimulationOptions

KINDS = ("turn", "zigzag", "spiral", "stop", "straight", "weave")
"""Kinds of trials that could be sailed."""


@dataclass(frozen=True)
class PlanOptions(SimulationOptions):
    """All choices of ``plan``."""

    kind: tuple[str, ...] = choice(
        (),
        "Kinds of trials that could be sailed: turn, zigzag, spiral, stop, straight, weave; repeatable. Default: all "
        "that the model's equations reach.",
        values=KINDS,
        called="kind of trial",
        panel=MANOEUVRE,
    )
    half_speed: bool = choice(True, "Also turns and zigzags at half the approach speed.", panel=MANOEUVRE)
    speed: str | None = choice(
        None, 'Approach speed, such as "12 kn". Default: the profile\'s.', unit="m/s", panel=MANOEUVRE
    )
    rpm: str | None = choice(
        None, 'Propeller revolutions: 106 (1/min) or "1.77 1/s". Default: the profile\'s.', panel=MANOEUVRE, bare=True
    )
    particles: int = choice(400, "Particles that answer the question.", least=20, most=2000, panel=BAND)
    level: float = choice(90.0, "Percent of what may happen that a band holds.", unit="%", least=1, most=99, panel=BAND)
    seed: int = choice(1, "Seed of the particles.", least=1, most=2**62, panel=REPRODUCE)
