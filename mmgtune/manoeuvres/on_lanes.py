"""Indices of simulated manoeuvres whose order is known, many lanes at once: what ``turning``, ``zigzag`` and
``stopping`` read from a record.

Definitions are theirs.  Records here have no noise and their orders need not be found, which makes it quick, and every
index varies continuously with the motion: crossings are interpolated, peaks are those of parabolas.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..physics.frame import to_ship
from ..units import DEG

Values = dict[str, FloatArray]
"""(n_lanes,) of each index in SI units, NaN where a lane does not reach it."""


@dataclass(frozen=True, eq=False)
class LaneRecord:
    """Lanes that begin straight ahead and get their first order at sample ``order``.

    h       (n_lanes,) time between samples [s]
    states  (n_samples, 6, n_lanes) x, y, psi, u, v_m, r
    end     (n_lanes,) last sample of each
    orders  (n_orders, n_lanes) fractional samples of rudder orders, NaN where none was given
    side    (n_lanes,) +1 where the first order is to starboard, -1 to port
    """

    h: FloatArray
    states: FloatArray
    end: IntArray
    orders: FloatArray
    order: int
    side: FloatArray

    @property
    def speed(self) -> FloatArray:
        """(n_samples, n_lanes) [m/s]."""
        return np.hypot(self.states[:, 3], self.states[:, 4])

    def crossing(self, values: FloatArray, level: float | FloatArray, begin: FloatArray | None = None) -> FloatArray:
        """(n_lanes,) fractional sample at which ``values`` (n_samples, n_lanes) first reach a level from ``begin``."""
        samples = np.arange(len(values))[:, None]
        start = np.full(len(self.h), float(self.order)) if begin is None else begin
        with np.errstate(invalid="ignore"):
            there = (values >= level) & (samples >= start) & (samples <= self.end)
        i = np.argmax(there, axis=0)
        lanes = np.arange(len(i))
        at, before = values[i, lanes], values[np.maximum(i - 1, 0), lanes]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.clip((level - before) / (at - before), 0.0, 1.0)
        found = np.where(i > start, i - 1 + share, i)
        return np.where(there.any(axis=0), found, np.nan)

    def at(self, values: FloatArray, position: FloatArray) -> FloatArray:
        """``values`` (n_samples, n_lanes) at fractional samples (n_lanes,), linearly interpolated; NaN at NaN."""
        whole = np.nan_to_num(position, nan=0.0)
        i = np.minimum(whole.astype(np.int64), len(values) - 2)
        lanes = np.arange(len(i))
        share = whole - i
        found = (1.0 - share) * values[i, lanes] + share * values[i + 1, lanes]
        return np.where(np.isnan(position), np.nan, found)

    def integral(self, values: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray:
        """Integral over time of ``values`` between fractional samples (n_lanes,), trapezoidal."""
        steps = 0.5 * (values[1:] + values[:-1])
        total = np.vstack([np.zeros(len(self.h)), np.cumsum(steps, axis=0)])

        def up_to(position: FloatArray) -> FloatArray:
            floor = np.floor(position)
            part = position - floor
            return self.at(total, floor) + 0.5 * part * (self.at(values, floor) + self.at(values, position))

        return self.h * (up_to(end) - up_to(begin))

    def since(self, position: FloatArray) -> FloatArray:
        """Time from the first order to a fractional sample [s]."""
        return self.h * (position - self.order)


def turning(record: LaneRecord) -> Values:
    """Indices of turning circles; see ``TurningIndices``.  Their approach is taken for straight and steady."""
    e, states, side = record.order, record.states, record.side
    phi = side * (states[:, 2] - states[e, 2])
    along, across = to_ship(states[e, 2], states[:, 0] - states[e, 0], states[:, 1] - states[e, 1])
    across = side * across
    speed = record.speed
    begun = np.full(len(side), float(e))
    at = {degrees: record.crossing(phi, degrees * DEG) for degrees in (10, 90, 180, 270, 360)}
    approach = record.integral(speed, np.zeros(len(side)), begun) / record.since(2.0 * begun)
    found = {
        "advance": record.at(along, at[90]),
        "transfer": record.at(across, at[90]),
        "tactical_diameter": record.at(across, at[180]),
        "initial_turning_distance": record.integral(speed, begun, at[10]),
        **{f"time_{degrees}": record.since(at[degrees]) for degrees in (90, 180, 270, 360)},
        **{f"speed_ratio_{degrees}": record.at(speed, at[degrees]) / approach for degrees in (90, 180, 360)},
    }
    samples = np.arange(len(phi))[:, None]
    total = np.max(np.where((samples >= e) & (samples <= record.end), phi, -np.inf), axis=0)
    last = record.crossing(phi, total)
    first = record.crossing(phi, np.maximum(180.0 * DEG, total - 360.0 * DEG))
    first = np.where(total > 360.0 * DEG, first, np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):
        duration = record.h * (last - first)
        U = record.integral(speed, first, last) / duration
        r = (record.at(phi, last) - record.at(phi, first)) / duration
        drift = record.integral(side * np.arctan2(-states[:, 4], states[:, 3]), first, last) / duration
        found |= {"steady_speed": U, "steady_yaw_rate": r, "steady_diameter": 2.0 * U / r, "steady_drift_angle": drift}
    return found


def zigzag(record: LaneRecord, check: FloatArray) -> Values:
    """Indices of zigzags with check angles (n_lanes,) [rad]; see ``ZigzagIndices``."""
    e, side = record.order, record.side
    before = record.states[: e + 1, 2]
    course = np.sum(0.5 * (before[1:] + before[:-1]), axis=0) / e
    heading = side * (record.states[:, 2] - course)
    turned = record.crossing(heading, check)
    found = {
        "initial_turning_time": record.since(turned),
        "initial_turning_distance": record.integral(record.speed, np.full(len(side), float(e)), turned),
    }
    last = record.end.astype(float)
    for k in range(1, len(record.orders)):
        begin = record.orders[k]
        then = record.orders[k + 1] if k + 1 < len(record.orders) else np.full(len(side), np.nan)
        sign = (-1.0) ** (k - 1)
        found[f"overshoot_{k}"] = _peak(record, sign * heading, begin, then, last) - check
        if k <= 2:
            back = record.crossing(-sign * heading, 0.0, np.ceil(np.nan_to_num(begin, nan=np.inf)))
            found[("reach", "period")[k - 1]] = record.since(back)
    return found


def _peak(record: LaneRecord, heading: FloatArray, begin: FloatArray, then: FloatArray, last: FloatArray) -> FloatArray:
    """(n_lanes,) height of the peak between two orders, of a parabola through the three samples about the highest."""
    samples = np.arange(len(heading))[:, None]
    end = np.where(np.isnan(then), last, then)
    with np.errstate(invalid="ignore"):
        inside = (samples >= np.floor(begin)) & (samples <= end)
    part = np.where(inside, heading, -np.inf)
    top = np.clip(np.argmax(part, axis=0), 1, len(heading) - 2)
    lanes = np.arange(len(top))
    a, b, c = heading[top - 1, lanes], heading[top, lanes], heading[top + 1, lanes]
    bend = a - 2.0 * b + c
    with np.errstate(invalid="ignore", divide="ignore"):
        height = b - 0.125 * (c - a) ** 2 / np.where(bend < 0.0, bend, -np.inf)
    come_down = inside.any(axis=0) & (top < np.floor(end))
    return np.where(come_down & ~np.isnan(begin), height, np.nan)


def stopping(record: LaneRecord) -> Values:
    """Indices of stops; see ``StoppingIndices``."""
    e, states = record.order, record.states
    end = record.crossing(-states[:, 3], 0.0)
    along, across = to_ship(states[e, 2], states[:, 0] - states[e, 0], states[:, 1] - states[e, 1])
    return {
        "track_reach": record.integral(record.speed, np.full(len(end), float(e)), end),
        "head_reach": record.at(along, end),
        "lateral_deviation": record.at(across, end),
        "stopping_time": record.since(end),
    }
