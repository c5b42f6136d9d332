"""What may go with an error: what the rudder did in a window, how fast the ship was, what was around her."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..measures import references
from ..trial import Trial, measured_wind
from ..units import DEG

MOVED = 2.0 * DEG
"""Range of the rudder angle over a window [rad] from which the rudder counts as moving; less is noise or an autopilot
that holds a course."""

RUDDER_EDGES = tuple(angle * DEG for angle in (1.0, 3.0, 7.0, 13.0, 20.0, 30.0))
"""Rudder angles [rad] between bins: 10 deg, where the paper found the largest errors, is in the middle of one."""

QUANTILES = 5
"""Bins of as many windows each, for what has no edges of its own."""


@dataclass(frozen=True)
class Feature:
    """Something known of each window.

    unit   SI
    edges  between its bins, in SI; empty for bins of as many windows each
    names  of its bins, where they have some
    """

    name: str
    words: str
    unit: str
    edges: tuple[float, ...] = ()
    names: tuple[str, ...] = ()


FEATURES = (
    Feature("rudder", "mean rudder angle to either side", "rad", RUDDER_EDGES),
    Feature("rudder_largest", "largest rudder angle to either side", "rad", RUDDER_EDGES),
    Feature("rudder_range", "range of the rudder angle", "rad", (MOVED,), ("steady", "moving")),
    Feature("rudder_rate", "largest rate of the rudder", "rad/s"),
    Feature("speed", "mean speed", "m/s"),
    Feature("drift", "mean drift angle to either side", "rad"),
    Feature("yaw_rate", "mean yaw rate to either side", "rad/s"),
    Feature("depth", "mean depth", "m"),
    Feature("wind", "mean wind speed", "m/s"),
    Feature("sea", "mean significant wave height", "m"),
    Feature("current", "mean current speed", "m/s"),
)
"""All of them; those nobody logged are NaN throughout."""

_COLUMNS = {"depth": "depth", "wind": "wind_speed", "sea": "wave_height", "current": "current_speed"}


def features_of(trials: Sequence[Trial], motion: FloatArray, t: FloatArray) -> dict[str, FloatArray]:
    """Every feature of windows, their path length [m] and their largest yaw rate [rad/s], (n_windows,) each.

    motion  (n_windows, T, 6) measured, NaN in gaps and behind the end
    t       (n_windows, T) time [s], NaN behind the end
    """
    delta = padded([trial.delta for trial in trials], t.shape[1])
    steps = np.diff(t, axis=1)
    rate = np.abs(np.divide(np.diff(delta, axis=1), steps, out=np.full_like(steps, np.nan), where=steps > 0.0))
    u, v, r = motion[:, :, 3], motion[:, :, 4], motion[:, :, 5]
    length, speed = references(motion)
    found = {
        "path": length,
        "rudder": _mean(np.abs(delta)),
        "rudder_largest": np.nanmax(np.abs(delta), axis=1),
        "rudder_range": np.nanmax(delta, axis=1) - np.nanmin(delta, axis=1),
        "rudder_rate": np.nanmax(rate, axis=1),
        "speed": speed,
        "drift": _mean(np.abs(np.arctan2(-v, u))),
        "yaw_rate": _mean(np.abs(r)),
        "yaw_rate_largest": np.nanmax(np.abs(r), axis=1),
    }
    for name, column in _COLUMNS.items():
        logged = [trial.extra.get(column) for trial in trials]
        if name == "wind":
            logged = [_wind(trial) if one is None else one for trial, one in zip(trials, logged, strict=True)]
        there = [one for one in logged if one is not None]
        found[name] = _mean(padded(there, t.shape[1])) if len(there) == len(trials) else np.full(len(trials), np.nan)
    return found


def padded(columns: Sequence[FloatArray], length: int) -> FloatArray:
    """(n, length, ...) columns of different length below each other, NaN behind the end of each."""
    whole = np.full((len(columns), length, *columns[0].shape[1:]), np.nan)
    for into, values in zip(whole, columns, strict=True):
        into[: len(values)] = values
    return whole


def _wind(trial: Trial) -> FloatArray | None:
    """True wind speed from what was felt on board; None where nothing was."""
    if "wind_speed_app" not in trial.extra:
        return None
    wind = measured_wind(trial)
    return np.where(wind[:, 2] > 0.0, np.hypot(wind[:, 0], wind[:, 1]), np.nan)


def _mean(values: FloatArray) -> FloatArray:
    """(n,) means of rows over samples that are there; NaN where none is."""
    there = np.isfinite(values)
    count = there.sum(axis=1)
    total = np.sum(np.where(there, values, 0.0), axis=1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
