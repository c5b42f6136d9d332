"""Digits that were not printed, made up for."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_smoothing_spline

from ..arrays import FloatArray


def print_step(values: FloatArray) -> tuple[FloatArray, int]:
    """The step (n_samples,) of the last digit that numbers are printed with, in their unit, and how many digits.

    The digits are 0 where more than 6 are printed, or there are fewer than 10 values; the step is NaN then, as it is
    where values are.

    values  (n_samples,) as printed, in any unit
    """
    out = np.full(len(values), np.nan)
    known = np.isfinite(values)
    printed = values[known]
    digits = next((d for d in range(1, 7) if np.allclose(_rounded(printed, d), printed, rtol=1e-9, atol=0.0)), 0)
    if not digits or known.sum() < 10:
        return out, 0
    size = np.where(printed == 0.0, np.min(np.abs(printed[printed != 0.0]), initial=1.0), np.abs(printed))
    step = 10.0 ** (np.floor(np.log10(size)) + 1 - digits)
    # Just below a power of ten steps are finer than above it; near zero they are far finer than matters.
    out[known] = np.maximum(step, 1e-3 * step.max())
    return out, digits


def within_digits(t: FloatArray, values: FloatArray) -> tuple[FloatArray, int, FloatArray]:
    """The smoothest curve (n_samples,) that rounds to what was printed, the digits printed, and their steps.

    One sample in 200 may lie beyond half a step: holding it there would bend the curve.

    t       (n_samples,) time [s], strictly increasing
    values  (n_samples,) as printed, in any unit

    The digits are 0, and the values returned as they are, where more than 6 are printed.
    """
    known = np.isfinite(values)
    steps, digits = print_step(values)
    if not digits:
        return values, 0, steps
    step = steps[known]
    low, high = -6.0, 12.0
    best = values[known]
    for _ in range(24):
        middle = 0.5 * (low + high)
        curve = make_smoothing_spline(t[known], values[known], w=(step.max() / step) ** 2, lam=10.0**middle)(t[known])
        if np.mean(np.abs(curve - values[known]) <= 0.5 * step * (1.0 + 1e-9)) > 0.995:
            low, best = middle, curve
        else:
            high = middle
    out = np.array(values)
    out[known] = best
    return out, digits, steps


def _rounded(values: FloatArray, digits: int) -> FloatArray:
    size = np.where(values == 0.0, 1.0, np.abs(values))
    unit = 10.0 ** (np.floor(np.log10(size)) + 1 - digits)
    return np.asarray(np.round(values / unit) * unit)
