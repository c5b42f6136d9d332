"""The heading from the yaw rate, where it is printed with too few digits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ..errors import LogError, Problem
from .mapping import LogMap
from .record import Record, Series

MISS = 3.0
"""How many times as far as by rounding alone the integral may miss the printed heading."""


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
    t = heading.t
    known = np.isfinite(logged.values)
    inside = np.diff(logged.t[known])
    if known.sum() < 2 or inside.max() > log_map.gap * logged.step * (1.0 + 1e-6):
        note = "psi was not recovered from r, which has a hole: both are as printed"
        return replace(record, notes=[*record.notes, note])
    rate = np.interp(t, logged.t[known], logged.values[known])
    turned = cumulative_trapezoid(rate, t, initial=0.0)
    # Just beside zero the print steps are finer than a gyro is true.
    step = np.maximum(heading.coarse, 0.01 * np.nanmax(heading.coarse))
    used = np.isfinite(heading.values) & np.isfinite(step)
    basis = np.column_stack([np.ones_like(t), t - t[0], rate - rate[0]])
    (constant, bias, lag), *_ = np.linalg.lstsq(
        basis[used] / step[used, None], ((heading.values - turned) / step)[used], rcond=None
    )
    found = turned + basis @ np.array([constant, bias, lag])
    missed = float(np.sqrt(np.mean((heading.values - found)[used] ** 2)))
    rounding = float(np.sqrt(np.mean(step[used] ** 2) / 12.0))
    degrees = 180.0 / np.pi
    said = f"{degrees * missed:.3g} deg rms, rounding alone would make {degrees * rounding:.3g}"
    if missed > MISS * rounding:
        fix = "check unit and sign of r, or leave out recover"
        what = "the heading cannot be recovered from the yaw rate"
        raise LogError(Problem(what, str(record.path), f"its integral misses the printed heading by {said}", fix))
    notes = [
        *record.notes,
        f"psi was recovered: r less a bias of {-degrees * bias:.2g} deg/s, {lag:.2g} s earlier, integrated",
        f"that misses the printed heading by {said}; r is its slope",
    ]
    slope = np.where(known, np.interp(logged.t, t, np.gradient(found, t)), np.nan)
    series = {
        **record.series,
        "psi": replace(heading, values=np.where(np.isfinite(heading.values), found, np.nan)),
        "r": Series(logged.t, slope),
    }
    return replace(record, series=series, notes=notes)
