"""Columns of a trial file: names, units, meaning.  SI units, angles in radians."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..inputs import INPUTS
from ..physics.quantities import STATES

SCHEMA = 1
METADATA_KEY = b"mmgtune"


@dataclass(frozen=True)
class Column:
    """One column: its unit and what it means.

    counted_from  "north" or "bow" for a direction, "" for anything else
    gusty         whether it jumps by nature, so that a single sample far off its neighbours is none the worse for it
    """

    unit: str
    meaning: str
    counted_from: str = ""
    gusty: bool = False


MOTION = {
    "x": Column("m", "midship position over ground, north of a local origin"),
    "y": Column("m", "midship position over ground, east of a local origin"),
    "psi": Column("rad", "heading, clockwise from north, unwrapped"),
    "u": Column("m/s", "velocity over ground in ship axes, forward"),
    "v": Column("m/s", "velocity over ground in ship axes at midship, to starboard"),
    "r": Column("rad/s", "yaw rate, to starboard"),
}
LOGGED = {name: Column(one.unit, one.meaning) for name, one in INPUTS.items()}
MAIN_INPUTS = ("n", "delta")
"""Revolutions and rudder angle that every trial has: manoeuvres are recognised by them."""

REQUIRED = {
    "t": Column("s", "time from the trial's start, strictly increasing"),
    **MOTION,
    **{name: LOGGED[name] for name in MAIN_INPUTS},
}
SURROUNDINGS = {
    "wind_speed": Column("m/s", "true wind speed", gusty=True),
    "wind_dir": Column("rad", "direction the true wind comes from, clockwise from north", "north", gusty=True),
    "wind_speed_app": Column("m/s", "apparent wind speed at the ship", gusty=True),
    "wind_dir_app": Column("rad", "direction the apparent wind comes from, clockwise from the bow", "bow", gusty=True),
    "depth": Column("m", "water depth"),
    "wave_height": Column("m", "significant wave height", gusty=True),
    "wave_dir": Column("rad", "direction waves come from, clockwise from north", "north", gusty=True),
}
"""What may have been measured around the ship."""

OPTIONAL = {**{name: column for name, column in LOGGED.items() if name not in MAIN_INPUTS}, **SURROUNDINGS}
COLUMNS = {**REQUIRED, **OPTIONAL}
METADATA = ("schema", "ship", "id", "manoeuvre", "source", "noise", "note", "cut_from")
SOURCES = ("measured", "generated")

ATTRIBUTES = {name: "v_m" if name == "v" else name for name in REQUIRED}
"""Attribute of a ``Trial`` that holds each required column: sway is ``v`` in the file, ``v_m`` in the program."""

CHANNELS = STATES
"""Motion channels in the order of ``Trial.motion``."""

RUDDERS = tuple(name for name, one in INPUTS.items() if one.role == "rudder")
DIRECTIONS = tuple(name for name, column in SURROUNDINGS.items() if column.counted_from)

LARGEST = {"s": 1e11, "m": 1e9, "rad": 1e6, "deg": 1e6, "m/s": 1e4, "rad/s": 1e4, "1/s": 1e5}
"""Sizes by unit that nothing about a ship has, not even written in another unit: such numbers are damage."""


def impossible(values: FloatArray, unit: str) -> BoolArray:
    """Which values (n,) are beyond what anything about a ship can be; NaN is not."""
    return np.asarray(np.abs(values) > LARGEST.get(unit, np.inf))


LARGEST_RUDDER = 1.6
"""Rudder angle [rad] beyond which a column must be in degrees."""

LARGEST_YAW_RATE = 0.5
"""Yaw rate [rad/s] that no ship and no model longer than a few metres reaches."""
