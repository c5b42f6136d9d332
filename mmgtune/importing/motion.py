"""Motion of the midship point in ship axes, from what was measured."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..phrases import aboard
from ..physics.frame import to_earth, to_ship
from ..trial.kinematics import white_noise
from ..trial.smoothing import FEWEST, smoothed, time_scale
from .maps.mapping import LogMap

LONGEST = 5000
"""Samples the time scale of a smoothing is chosen on."""


def at_midship(columns: dict[str, FloatArray], log_map: LogMap) -> list[str]:
    """Move positions from the antenna to midship, in place; what was done, in sentences.

    columns  x, y [m] and psi [rad], (n_samples,)
    """
    if log_map.antenna is None:
        return []
    ahead, abeam = log_map.antenna
    north, east = to_earth(columns["psi"], ahead, abeam)
    columns["x"] = columns["x"] - north
    columns["y"] = columns["y"] - east
    return [f"positions moved from the antenna, {aboard(ahead, abeam, 6)} of midship"]


def with_yaw_rate(t: FloatArray, columns: dict[str, FloatArray]) -> list[str]:
    """Add r where it was not measured, from the heading; what was done, in sentences."""
    if "r" in columns:
        return []
    (rate,), tau = _rates(t, [columns["psi"]])
    columns["r"] = np.where(np.isfinite(columns["psi"]), rate, np.nan)
    return [f"r was not measured: it is the slope of the heading, smoothed with a time scale of {tau:.3g} s"]


def with_course(t: FloatArray, columns: dict[str, FloatArray]) -> list[str]:
    """Add the course over ground [rad], which was not measured, from the positions; what was done, in sentences."""
    (north, east), tau = _rates(t, [columns["x"], columns["y"]])
    columns["cog"] = np.arctan2(east, north)
    return [f"the course over ground is the direction of the track, smoothed with a time scale of {tau:.3g} s"]


def over_ground(columns: dict[str, FloatArray], log_map: LogMap) -> list[str]:
    """Turn velocity over ground, ``north`` and ``east``, into u and v of midship, in place.

    They are of the antenna where the map says where that is, unless it says otherwise.
    """
    if not {"north", "east"} <= set(columns):
        return []
    north, east = columns.pop("north"), columns.pop("east")
    if "u" in columns and "v" in columns:
        return []
    columns["u"], columns["v"] = to_ship(columns["psi"], north, east)
    said = ["u and v are speed over ground along the course, turned by the heading"]
    return said + moved(columns, log_map, log_map.point or "antenna")


def moved(columns: dict[str, FloatArray], log_map: LogMap, point: str) -> list[str]:
    """Move velocities u and v [m/s] from the point they are of to midship, in place; what was done, in sentences.

    Where they were moved already, but with the lever's velocity taken off along earth axes, that is put back first.
    """
    lever = log_map.lever(point)
    if lever is None:
        return []
    ahead, abeam = lever
    said = []
    if log_map.shifted:
        back = to_ship(columns["psi"], -abeam * columns["r"], ahead * columns["r"])
        columns["u"], columns["v"] = columns["u"] + back[0], columns["v"] + back[1]
        said.append("velocities had been moved to midship along earth axes instead of the ship's: that was undone")
    columns["u"] = columns["u"] + abeam * columns["r"]
    columns["v"] = columns["v"] - ahead * columns["r"]
    where = "the antenna" if point == "antenna" else f"{aboard(ahead, abeam, 6)} of it"
    return [*said, f"velocities moved to midship from {where}"]


def with_velocities(t: FloatArray, columns: dict[str, FloatArray]) -> list[str]:
    """Add u and v where they were not measured, from positions and heading; what was done, in sentences."""
    missing = [name for name in ("u", "v") if name not in columns]
    if not missing:
        return []
    (north, east), tau = _rates(t, [columns["x"], columns["y"]])
    known = np.isfinite(columns["x"]) & np.isfinite(columns["y"])
    found = dict(zip(("u", "v"), to_ship(columns["psi"], north, east), strict=True))
    for name in missing:
        columns[name] = np.where(known, found[name], np.nan)
    verb = "was" if len(missing) == 1 else "were"
    return [
        (
            f"{' and '.join(missing)} {verb} not measured: from the slope of the positions, smoothed with a time scale "
            f"of {tau:.3g} s, and the heading"
        )
    ]


def _rates(t: FloatArray, channels: list[FloatArray]) -> tuple[list[FloatArray], float]:
    """Time derivatives of channels (n_samples,) that share one time scale, and that scale [s]."""
    stacked = np.column_stack(channels)
    whole = np.flatnonzero(np.isfinite(stacked).all(axis=1))
    dt = float(np.median(np.diff(t)))
    if len(whole) < FEWEST:
        return [np.full(len(t), np.nan) for _ in channels], dt
    middle = whole[max(0, (len(whole) - LONGEST) // 2) :][:LONGEST]
    noise = np.array([white_noise(channel[middle]) for channel in channels])
    tau = time_scale(t[middle], stacked[middle], noise, dt)
    return list(smoothed(t, stacked, tau, dt, derivative=1).T), tau
