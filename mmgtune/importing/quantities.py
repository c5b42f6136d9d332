"""What a log can hold: quantities by name, their unit inside the program and the ways people count them."""

from __future__ import annotations

from dataclasses import dataclass

from ..inputs import INPUTS, Role
from ..trial.schema import COLUMNS, MOTION, SURROUNDINGS, Column

AGAINST = ("south", "west", "port", "counterclockwise", "aft", "astern")
"""Words for a positive direction that is the opposite of the trial format's."""


@dataclass(frozen=True)
class Quantity:
    """One quantity of a log.

    unit      what it is converted to (``mmgtune.units``)
    positive  directions a map may call positive, the trial format's first; () where the sign is no question
    angle     whether it comes back to itself after a full turn
    origin    whether a map may say which way its zero points
    wind      whether a map must say if it is a direction something comes from or goes to
    """

    unit: str
    positive: tuple[str, ...] = ()
    angle: bool = False
    origin: bool = False
    wind: bool = False


_SIDES = ("starboard", "port")
_TURNS = ("clockwise", "counterclockwise")

POSITIVE: dict[Role, tuple[str, ...]] = {"propeller": ("ahead", "astern"), "rudder": _SIDES, "thruster": _SIDES}
"""Directions a map may call positive, by role of the input."""


def _around(column: Column) -> Quantity:
    """A quantity measured around the ship: a direction, which something comes from or goes to, or a size."""
    if not column.counted_from:
        return Quantity(column.unit)
    return Quantity(column.unit, _TURNS, angle=True, origin=column.counted_from == "north", wind=True)


QUANTITIES: dict[str, Quantity] = {
    "x": Quantity("m", ("north", "south")),
    "y": Quantity("m", ("east", "west", "starboard", "port")),
    "latitude": Quantity("deg", ("north", "south")),
    "longitude": Quantity("deg", ("east", "west"), angle=True),
    "psi": Quantity("rad", _TURNS, angle=True, origin=True),
    "u": Quantity("m/s", ("forward", "aft", "north", "south")),
    "v": Quantity("m/s", (*_SIDES, "east", "west")),
    "sog": Quantity("m/s"),
    "cog": Quantity("rad", _TURNS, angle=True, origin=True),
    "r": Quantity("rad/s", (*_SIDES, *_TURNS)),
    **{name: Quantity(one.unit, POSITIVE[one.role]) for name, one in INPUTS.items()},
    **{name: _around(column) for name, column in SURROUNDINGS.items()},
}

MEASURED = tuple(MOTION)
"""Motion channels of a trial, of which u, v and r can be derived."""

MEANING = {name: column.meaning for name, column in COLUMNS.items()} | {
    "latitude": "geographic latitude",
    "longitude": "geographic longitude",
    "sog": "speed over ground",
    "cog": "course over ground",
}
"""What each quantity is, in words."""
