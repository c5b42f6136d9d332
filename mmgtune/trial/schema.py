"""Columns of a trial file: names, units, meaning.  SI units, angles in radians."""

from __future__ import annotations

from dataclasses import dataclass

from ..inputs import INPUTS
from ..physics.quantities import STATES

SCHEMA = 1
METADATA_KEY = b"mmgtune"


@dataclass(frozen=True)
class Column:
    """One column: its unit and what it means."""

    unit: str
    meaning: str


MOTION = {
    "x": Column("m", "midship position over ground, north of a local origin"),
    "y": Column("m", "midship position over ground, east of a local origin"),
    "psi": Column("rad", "heading, clockwise from north, unwrapped"),
    "u": Column("m/s", "velocity over ground in ship axes, forward"),
    "v": Column("m/s", "velocity over ground in ship axes at midship, to starboard"),
    "r": Column("rad/s", "yaw rate, to starboard"),
}
LOGGED = {name: Column(one.unit, one.words) for name, one in INPUTS.items()}
MAIN_INPUTS = ("n", "delta")
"""Revolutions and rudder angle that every trial has: manoeuvres are recognised by them."""

REQUIRED = {
    "t": Column("s", "time from the trial's start, strictly increasing"),
    **MOTION,
    **{name: LOGGED[name] for name in MAIN_INPUTS},
}
OPTIONAL = {
    **{name: column for name, column in LOGGED.items() if name not in MAIN_INPUTS},
    "wind_speed": Column("m/s", "true wind speed"),
    "wind_dir": Column("rad", "direction the true wind comes from, clockwise from north"),
    "wind_speed_app": Column("m/s", "apparent wind speed at the ship"),
    "wind_dir_app": Column("rad", "direction the apparent wind comes from, clockwise from the bow"),
    "depth": Column("m", "water depth"),
    "wave_height": Column("m", "significant wave height"),
    "wave_dir": Column("rad", "direction waves come from, clockwise from north"),
}
COLUMNS = {**REQUIRED, **OPTIONAL}
METADATA = ("schema", "ship", "id", "manoeuvre", "source", "noise", "note", "cut_from")
SOURCES = ("measured", "generated")

ATTRIBUTES = {name: "v_m" if name == "v" else name for name in REQUIRED}
"""Attribute of a ``Trial`` that holds each required column: sway is ``v`` in the file, ``v_m`` in the program."""

CHANNELS = STATES
"""Motion channels in the order of ``Trial.motion``."""

RUDDERS = tuple(name for name, one in INPUTS.items() if one.role == "rudder")
DIRECTIONS = ("wind_dir", "wind_dir_app", "wave_dir")

LARGEST_RUDDER = 1.6
"""Rudder angle [rad] beyond which a column must be in degrees."""

LARGEST_YAW_RATE = 0.5
"""Yaw rate [rad/s] that no ship and no model longer than a few metres reaches."""
