"""What a user can choose about trials that are made of a model."""

from __future__ import annotations

from dataclasses import dataclass

from .choice import INPUT, Options, again, choice
from .tuning import FitOptions

SETS = ("train-b", "test-b", "test-zt", "test-r")
SCALES = ("model", "full")
WINDS = ("paper", "all", "none")


@dataclass(frozen=True)
class MakeOptions(Options):
    """Which sets are made, how large the ship is, in what wind, from which seed."""

    sets: tuple[str, ...] = choice(
        (),
        "Sets to make: train-b and test-b berthing, test-zt zigzags and turning circles, test-r orders at random. "
        "Default: all.",
        values=SETS,
        called="set",
        panel=INPUT,
    )
    scale: str = choice(
        "model", "model: the 3 m model. full: a ship of 150 m by Froude's law.", values=SCALES, panel=INPUT
    )
    wind: str = choice(
        "paper",
        "paper: berthing and orders at random in wind, zigzags and turning circles in calm. all: everything in wind. "
        "none: nothing.",
        values=WINDS,
        panel=INPUT,
    )
    sample: float = choice(
        1.0,
        "Time between samples. At 0.1 the inputs of the model are logged at every step.",
        unit="s",
        least=0.1,
        most=10.0,
    )
    seed: int = again(FitOptions, "seed")
