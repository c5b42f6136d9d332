"""Columns of a trial file: names, units, meaning.  SI units, angles in radians."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

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
    points        "from" for a direction something comes from, "to" for one it goes to, "" for anything else
    gusty         whether it jumps by nature, so that a single sample far off its neighbours is none the worse for it
    low, high     beyond these it is doubted
    """

    unit: str
    meaning: str
    counted_from: str = ""
    points: str = ""
    gusty: bool = False
    low: float = -np.inf
    high: float = np.inf


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


def _speed(meaning: str, most: float, gusty: bool = False) -> Column:
    return Column("m/s", meaning, gusty=gusty, low=0.0, high=most)


def _direction(meaning: str, points: str, counted_from: str = "north", gusty: bool = False) -> Column:
    return Column(
        "rad",
        f"{meaning}, clockwise from {'the bow' if counted_from == 'bow' else 'north'}",
        counted_from,
        points,
        gusty,
    )


SURROUNDINGS = {
    "wind_speed": _speed("true wind speed", 120.0, gusty=True),
    "wind_dir": _direction("direction the true wind comes from", "from", gusty=True),
    "wind_speed_app": _speed("apparent wind speed at the ship", 150.0, gusty=True),
    "wind_dir_app": _direction("direction the apparent wind comes from", "from", "bow", gusty=True),
    "current_speed": _speed("speed of the current over ground", 15.0),
    "current_dir": _direction("direction the current sets towards", "to"),
    "depth": Column("m", "water depth", low=0.0, high=12e3),
    "wave_height": Column("m", "significant wave height", gusty=True, low=0.0, high=30.0),
    "wave_dir": _direction("direction waves come from", "from", gusty=True),
}
"""What may have been measured around the ship."""

LAYER = re.compile(r"(current_speed|current_dir)_at_(\d+(?:\.\d+)?)m")
"""Columns of the current in a layer of the water: what is measured, and how far below the surface [m]."""


def surrounding(name: str) -> Column | None:
    """What a column says of the surroundings, one of a layer of the water too; None where it says nothing of them."""
    layer = LAYER.fullmatch(name)
    if layer is None:
        return SURROUNDINGS.get(name)
    whole = SURROUNDINGS[layer[1]]
    return replace(whole, meaning=f"{whole.meaning}, {float(layer[2]):g} m below the surface")


OPTIONAL = {**{name: column for name, column in LOGGED.items() if name not in MAIN_INPUTS}, **SURROUNDINGS}
COLUMNS = {**REQUIRED, **OPTIONAL}


def known_column(name: str) -> Column | None:
    """What is known of a column; None for one that the program does not know."""
    return COLUMNS.get(name) or surrounding(name)


def directions(columns: Mapping[str, Any]) -> list[str]:
    """Those of some columns that are directions of what is around the ship."""
    return [name for name in columns if (found := surrounding(name)) is not None and found.counted_from]


METADATA = ("schema", "ship", "id", "manoeuvre", "source", "noise", "note", "cut_from", "group", "derived", "antenna")
SOURCES = ("measured", "generated")

ATTRIBUTES = {name: "v_m" if name == "v" else name for name in REQUIRED}
"""Attribute of a ``Trial`` that holds each required column: sway is ``v`` in the file, ``v_m`` in the program."""

CHANNELS = STATES
"""Motion channels in the order of ``Trial.motion``."""

FILE_CHANNELS = tuple(name for state in CHANNELS for name, of in ATTRIBUTES.items() if of == state)
"""The same as files and people name them: sway is ``v``."""

RUDDERS = tuple(name for name, one in INPUTS.items() if one.role == "rudder")

LARGEST = {"s": 1e11, "m": 1e9, "rad": 1e6, "deg": 1e6, "m/s": 1e4, "rad/s": 1e4, "1/s": 1e5}
"""Sizes by unit that nothing about a ship has, not even written in another unit: such numbers are damage."""


def impossible(values: FloatArray, unit: str) -> BoolArray:
    """Which values (n,) are beyond what anything about a ship can be; NaN is not."""
    return np.asarray(np.abs(values) > LARGEST.get(unit, np.inf))


FEWEST_SAMPLES = 3
"""Samples without which there is no motion: of two there is one step, and no index, rate or turn to be read."""

SHORTEST_STEP = 1e-7
"""Time [s] between samples below which stamps cannot be seconds."""

LARGEST_RUDDER = 2.0
"""Rudder angle [rad] beyond which a column must be in degrees."""

LARGEST_YAW_RATE = 0.5
"""Yaw rate [rad/s] that no ship and no model longer than a few metres reaches."""
