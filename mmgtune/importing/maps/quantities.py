"""What a log can hold: quantities by name, their unit inside the program and the ways people count them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...inputs import INPUTS, Role
from ...trial.schema import MOTION, SURROUNDINGS, Column, impossible, known_column, surrounding

AGAINST = ("south", "west", "port", "counterclockwise", "aft", "astern")
"""Words for a positive direction that is the opposite of the trial format's."""


@dataclass(frozen=True)
class Quantity:
    """One quantity of a log.

    unit      what it is converted to (``mmgtune.units``)
    positive  directions a map may call positive, the trial format's first; () where the sign is no question
    angle     whether it comes back to itself after a full turn
    origin    whether a map may say which way its zero points
    points    "from" or "to" as the trial format counts a direction something comes from or goes to, where a map must
              say which; "" for anything else
    most      size [unit] beyond which a number is damage
    """

    unit: str
    positive: tuple[str, ...] = ()
    angle: bool = False
    origin: bool = False
    points: str = ""
    most: float = math.inf

    def beyond(self, values: FloatArray) -> BoolArray:
        """Which numbers (n_samples,) nothing about a ship can be."""
        return impossible(values, self.unit) | (np.abs(values) > self.most)


FASTEST = 100.0
"""Speed of a ship [m/s] beyond which a number in a log is none, but a mark for no value or damage."""

_SIDES = ("starboard", "port")
_TURNS = ("clockwise", "counterclockwise")

POSITIVE: dict[Role, tuple[str, ...]] = {"propeller": ("ahead", "astern"), "rudder": _SIDES, "thruster": _SIDES}
"""Directions a map may call positive, by role of the input."""


def _around(column: Column) -> Quantity:
    """A quantity measured around the ship: a direction, which something comes from or goes to, or a size."""
    if not column.counted_from:
        return Quantity(column.unit)
    return Quantity(column.unit, _TURNS, angle=True, origin=column.counted_from == "north", points=column.points)


PAIRS = (("latitude", "longitude"), ("x", "y"), ("u", "v"))
"""Quantities that are read together."""

QUANTITIES: dict[str, Quantity] = {
    "x": Quantity("m", ("north", "south")),
    "y": Quantity("m", ("east", "west", "starboard", "port")),
    "latitude": Quantity("deg", ("north", "south")),
    "longitude": Quantity("deg", ("east", "west"), angle=True),
    "psi": Quantity("rad", _TURNS, angle=True, origin=True),
    "u": Quantity("m/s", ("forward", "aft", "north", "south"), most=FASTEST),
    "v": Quantity("m/s", (*_SIDES, "east", "west"), most=FASTEST),
    "sog": Quantity("m/s", most=FASTEST),
    "cog": Quantity("rad", _TURNS, angle=True, origin=True),
    "r": Quantity("rad/s", (*_SIDES, *_TURNS)),
    **{name: Quantity(one.unit, POSITIVE[one.role]) for name, one in INPUTS.items()},
    **{name: _around(column) for name, column in SURROUNDINGS.items()},
}

MEASURED = tuple(MOTION)
"""Motion channels of a trial, of which u, v and r can be derived."""

GEOGRAPHIC = {
    "latitude": "geographic latitude",
    "longitude": "geographic longitude",
    "sog": "speed over ground",
    "cog": "course over ground",
}
"""What trials do not have, in words."""


def quantity_of(name: str) -> Quantity | None:
    """A quantity by name, one of a layer of the water too; None where there is none of that name."""
    column = surrounding(name)
    return QUANTITIES.get(name) or (_around(column) if column else None)


def known_quantity(name: str) -> Quantity:
    """A quantity by a name that is known to be one, one of a layer of the water too."""
    found = quantity_of(name)
    assert found is not None
    return found


def meaning(name: str) -> str:
    """What a quantity is, in words; "" where there is none of that name."""
    column = known_column(name)
    return column.meaning if column else GEOGRAPHIC.get(name, "")
