"""Columns of a trial file: names, units, meaning.  SI units, angles in radians."""

from __future__ import annotations

from dataclasses import dataclass

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
INPUTS = {
    "n": Column("1/s", "propeller revolutions"),
    "delta": Column("rad", "rudder angle, to starboard: a positive angle turns the ship to starboard"),
}
REQUIRED = {"t": Column("s", "time from the trial's start, strictly increasing"), **MOTION, **INPUTS}
OPTIONAL = {
    "delta_port": Column("rad", "port rudder angle"),
    "delta_stbd": Column("rad", "starboard rudder angle"),
    "n_bow": Column("1/s", "bow thruster revolutions"),
    "n_stern": Column("1/s", "stern thruster revolutions"),
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

CHANNELS = tuple(ATTRIBUTES[name] for name in MOTION)
"""Motion channels in the order of ``Trial.motion``: x, y, psi, u, v_m, r."""

CHANNEL_UNITS = tuple(column.unit for column in MOTION.values())
"""Units of CHANNELS, in the same order."""

RUDDERS = ("delta", "delta_port", "delta_stbd")
DIRECTIONS = ("wind_dir", "wind_dir_app", "wave_dir")

LARGEST_RUDDER = 1.6
"""Rudder angle [rad] beyond which a column must be in degrees."""

LARGEST_YAW_RATE = 0.5
"""Yaw rate [rad/s] that no ship and no model longer than a few metres reaches."""
