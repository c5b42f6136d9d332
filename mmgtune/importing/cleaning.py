"""Spikes taken out, and digits that were not printed made up for."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_smoothing_spline

from ..trial.model import FloatArray
from ..trial.motion_checks import spikes
from .mapping import LogMap
from .quantities import CONTROLS
from .record import Record, Series


def without_spikes(record: Record) -> Record:
    """The record with single samples far off their neighbours taken out (NaN), and their number by quantity."""
    series, counts = {}, dict(record.spikes)
    for name, one in record.series.items():
        values = np.array(one.values)
        controls = name in CONTROLS or name.startswith(("delta", "n_"))
        # Wind is gusty and speeds near rest are noise: only what a trial is simulated or compared with is cleaned.
        if not name.startswith(("wind", "wave")):
            rows = spikes(values, share=0.2 if controls else 0.02)
            values[rows] = np.nan
            if len(rows):
                counts[name] = counts.get(name, 0) + len(rows)
        series[name] = Series(one.t, values)
    return Record(record.path, series, counts, record.notes)


def with_printed_digits(record: Record, log_map: LogMap) -> Record:
    """The record with positions smoothed within the digits they are printed with, where the map asks for it."""
    series, notes = dict(record.series), list(record.notes)
    for name in ("x", "y"):
        source = log_map.sources.get(name)
        if source is None or source.recover is None or name not in series:
            continue
        one = series[name]
        back = log_map.sources[name].scale
        smooth, digits, coarsest = within_digits(one.t, one.values, back)
        if digits:
            series[name] = Series(one.t, smooth)
            notes.append(
                f"{name} is printed with {digits} significant digits, in steps of up to {coarsest:.3g} m; "
                "it was smoothed within half a step"
            )
        else:
            notes.append(f"{name} is printed with more than 6 digits: nothing to recover")
    return Record(record.path, series, record.spikes, notes)


def within_digits(t: FloatArray, values: FloatArray, scale: float = 1.0) -> tuple[FloatArray, int, float]:
    """The smoothest curve (n_samples,) that rounds to what was printed, the digits printed, and the coarsest step.

    The digits are 0, and the values returned as they are, where more than 6 are printed.
    scale  factor between the printed numbers and ``values``
    """
    known = np.isfinite(values)
    printed = values[known] / scale
    digits = next((d for d in range(1, 7) if np.allclose(_rounded(printed, d), printed, rtol=1e-9, atol=0.0)), 0)
    if not digits or known.sum() < 10:
        return values, 0, 0.0
    size = np.where(printed == 0.0, np.min(np.abs(printed[printed != 0.0]), initial=1.0), np.abs(printed))
    step = abs(scale) * 10.0 ** (np.floor(np.log10(size)) + 1 - digits)
    # Just below a power of ten steps are finer than above it; near zero they are far finer than matters.
    step = np.maximum(step, 1e-3 * step.max())
    low, high = -6.0, 12.0
    best = values[known]
    for _ in range(24):
        middle = 0.5 * (low + high)
        curve = make_smoothing_spline(t[known], values[known], w=(step.max() / step) ** 2, lam=10.0**middle)(t[known])
        if np.mean(np.abs(curve - values[known]) <= 0.5 * step * (1.0 + 1e-9)) > 0.995:
            low, best = middle, curve
        else:
            high = middle
    # The few that are left over are held to what was printed.
    best = np.clip(best, values[known] - 0.5 * step, values[known] + 0.5 * step)
    out = np.array(values)
    out[known] = best
    return out, digits, float(step.max())


def _rounded(values: FloatArray, digits: int) -> FloatArray:
    size = np.where(values == 0.0, 1.0, np.abs(values))
    unit = 10.0 ** (np.floor(np.log10(size)) + 1 - digits)
    return np.asarray(np.round(values / unit) * unit)
