"""What a log can hold: quantities by name, their unit inside the program and the ways people count them."""

from __future__ import annotations

from dataclasses import dataclass

from ..trial.schema import COLUMNS, MAIN_INPUTS, MOTION

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
    "n": Quantity("1/s", ("ahead", "astern")),
    "delta": Quantity("rad", _SIDES),
    "delta_port": Quantity("rad", _SIDES),
    "delta_stbd": Quantity("rad", _SIDES),
    "n_bow": Quantity("1/s", _SIDES),
    "n_stern": Quantity("1/s", _SIDES),
    "wind_speed": Quantity("m/s"),
    "wind_dir": Quantity("rad", _TURNS, angle=True, origin=True, wind=True),
    "wind_speed_app": Quantity("m/s"),
    "wind_dir_app": Quantity("rad", _TURNS, angle=True, wind=True),
    "depth": Quantity("m"),
    "wave_height": Quantity("m"),
    "wave_dir": Quantity("rad", _TURNS, angle=True, origin=True, wind=True),
}

MEASURED = tuple(MOTION)
"""Motion channels of a trial, of which u, v and r can be derived."""

CONTROLS = MAIN_INPUTS
"""Channels a trial must have at every sample."""

MEANING = {name: column.meaning for name, column in COLUMNS.items()} | {
    "latitude": "geographic latitude",
    "longitude": "geographic longitude",
    "sog": "speed over ground",
    "cog": "course over ground",
}
"""What each quantity is, in words."""
