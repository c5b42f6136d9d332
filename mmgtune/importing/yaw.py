"""The heading from the yaw rate, where it is printed with too few digits."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ..arrays import FloatArray
from ..errors import LogError, Problem
from ..trial.kinematics import rounding_noise, white_noise
from ..units import DEG
from .maps.mapping import LogMap
from .record import Record, Series

MISS = 3.0
"""How many times as far as by rounding alone the integral may miss the printed heading."""

WANDERS = 0.1
"""Share of what rounding makes up to which the integral may wander: what the noise of a rate adds up to is slow, like
motion, and rounding is noise like any other."""


class NotFollowed(Problem):
    """The integral of a yaw rate does not follow the heading that was to be recovered from it."""


@dataclass(frozen=True, eq=False)
class Integral:
    """The integral of the yaw rate, fitted on the printed heading by a constant, a bias and a lag of the rate.

    heading  (n_samples,) [rad], at the samples of the printed one
    bias     of the rate [rad/s]; lag of the rate behind the heading [s]
    missed   rms by which it misses the printed heading, and rounding: what rounding alone would make of that [rad]
    wander   rms of what the noise of the rate adds up to [rad]
    """

    heading: FloatArray
    bias: float
    lag: float
    missed: float
    rounding: float
    wander: float

    @property
    def wanders(self) -> bool:
        """Whether that is too much for it to take the place of what is printed."""
        return self.wander > WANDERS * self.rounding


def integral_of(heading: Series, rate: Series, step: FloatArray, gap: float) -> Integral | None:
    """The integral of a yaw rate fitted on a heading; None where the rate has too few samples, or a hole.

    step  (n_samples,) that the heading is printed in [rad], which its samples are weighted by
    gap   holes of the rate that are bridged, in its own time steps
    """
    t = heading.t
    known = np.isfinite(rate.values)
    inside = np.diff(rate.t[known])
    if known.sum() < 2 or inside.max() > gap * rate.step * (1.0 + 1e-6):
        return None
    turning = np.interp(t, rate.t[known], rate.values[known])
    turned = cumulative_trapezoid(turning, t, initial=0.0)
    # Just beside zero the print steps are finer than a gyro is true.
    step = np.maximum(step, 0.01 * np.nanmax(step))
    used = np.isfinite(heading.values) & np.isfinite(step)
    basis = np.column_stack([np.ones_like(t), t - t[0], turning - turning[0]])
    (constant, bias, lag), *_ = np.linalg.lstsq(
        basis[used] / step[used, None], ((heading.values - turned) / step)[used], rcond=None
    )
    found = turned + basis @ np.array([constant, bias, lag])
    missed = float(np.sqrt(np.mean((heading.values - found)[used] ** 2)))
    rounding = float(np.sqrt(np.mean(step[used] ** 2) / 12.0))
    logged = rate.values[known]
    noise = max(white_noise(logged), rounding_noise(logged))
    # Of the variance that a random walk ends with, a straight line through it leaves a fifteenth.
    wander = noise * float(np.sqrt(rate.step * (rate.t[known][-1] - rate.t[known][0]) / 15.0))
    return Integral(found, -float(bias), float(lag), missed, rounding, wander)


def heading_recovered(record: Record, log_map: LogMap) -> Record:
    """The record with the integral of r in place of a heading printed with few digits, where the map asks for it.

    A constant, a bias and a lag of r are fitted on the printed heading, weighted by its print step; r becomes the slope
    of the heading found.  Where r has a hole that is not bridged, nothing is done, and the notes say so.

    Raises LogError where the integral of r does not follow the heading.
    """
    source, heading = log_map.sources.get("psi"), record.series.get("psi")
    if source is None or source.recover != "yaw-rate" or heading is None or heading.coarse is None:
        return record
    logged = record.series["r"]
    found = integral_of(heading, logged, heading.coarse, log_map.gap)
    if found is None:
        note = "psi was not recovered from r, which has a hole: both are as printed"
        return replace(record, notes=[*record.notes, note])
    said = f"{found.missed / DEG:.3g} deg rms, rounding alone would make {found.rounding / DEG:.3g}"
    if found.missed > MISS * found.rounding:
        fix = "check unit and sign of r, or leave out recover"
        what = "the heading cannot be recovered from the yaw rate"
        raise LogError(NotFollowed(what, str(record.path), f"its integral misses the printed heading by {said}", fix))
    notes = [
        *record.notes,
        f"psi was recovered: r less a bias of {found.bias / DEG:.2g} deg/s, {found.lag:.2g} s earlier, integrated",
        f"that misses the printed heading by {said}; r is its slope",
    ]
    known = np.isfinite(logged.values)
    slope = np.where(known, np.interp(logged.t, heading.t, np.gradient(found.heading, heading.t)), np.nan)
    series = {
        **record.series,
        "psi": replace(heading, values=np.where(np.isfinite(heading.values), found.heading, np.nan)),
        "r": Series(logged.t, slope),
    }
    return replace(record, series=series, notes=notes, recovered=(found.missed, found.rounding, found.wander))
