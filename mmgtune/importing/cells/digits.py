"""Digits that were not printed, made up for."""

from __future__ import annotations

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from ...arrays import FloatArray


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
    # Just below a power of ten steps are finer than above it, unless all numbers have as many decimals; near zero they
    # are far finer than matters.
    out[known] = np.maximum(step, max(1e-3 * step.max(), _same_decimals(printed, step.max())))
    return out, digits


def _same_decimals(printed: FloatArray, coarsest: float) -> float:
    """The largest power of ten, up to ``coarsest``, that all numbers are whole multiples of; 0 where there is none down
    to a millionth of it."""
    for finer in range(7):
        step = coarsest / 10.0**finer
        if np.allclose(np.round(printed / step) * step, printed, rtol=1e-9, atol=1e-6 * step):
            return float(step)
    return 0.0


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
    smoothed = _Smoothing(t[known] / np.median(np.diff(t[known])), values[known], (step / step.max()) ** 2)
    low, high = -6.0, 12.0  # from hardly any smoothing to that over a thousand samples
    best = values[known]
    for _ in range(24):
        middle = 0.5 * (low + high)
        try:
            curve = smoothed(10.0**middle)
        except (LinAlgError, ValueError):  # samples that all but coincide: double precision tells no curve so smooth
            high = middle
            continue
        if np.mean(np.abs(curve - values[known]) <= 0.5 * step * (1.0 + 1e-9)) > 0.995:
            low, best = middle, curve
        else:
            high = middle
    out = np.array(values)
    out[known] = best
    return out, digits, steps


class _Smoothing:
    """Cubic smoothing splines of values at their own times: of the curves with these squares of differences, each over
    its variance, plus ``lam`` times the integral of the squared curvature, the one for which the sum is least.

    By Reinsch's algorithm (Green & Silverman 1994, section 2.3), a banded solve for each ``lam``; SciPy's
    ``make_smoothing_spline`` finds the same curves a hundred times slower.

    t, values, variance  (n_samples,)
    """

    @np.errstate(over="ignore", invalid="ignore")
    def __init__(self, t: FloatArray, values: FloatArray, variance: FloatArray):
        gap = np.diff(t)
        self._values, self._variance = values, variance
        self._second = np.array([1.0 / gap[:-1], -1.0 / gap[:-1] - 1.0 / gap[1:], 1.0 / gap[1:]])
        before, at, after = self._second
        one, two, three = variance[:-2], variance[1:-1], variance[2:]
        self._rough = np.zeros((3, len(gap) - 1))  # bands of a symmetric matrix, the diagonal first
        self._rough[0] = before**2 * one + at**2 * two + after**2 * three
        self._rough[1, :-1] = at[:-1] * before[1:] * two[:-1] + after[:-1] * at[1:] * three[:-1]
        self._rough[2, :-2] = after[:-2] * before[2:] * three[:-2]
        self._smooth = np.zeros_like(self._rough)
        self._smooth[0] = (gap[:-1] + gap[1:]) / 3.0
        self._smooth[1, :-1] = gap[1:-1] / 6.0
        self._bent = before * values[:-2] + at * values[1:-1] + after * values[2:]

    def __call__(self, lam: float) -> FloatArray:
        """The curve (n_samples,) at the times.  Raises LinAlgError or ValueError where these lie too close for one."""
        curvature = solveh_banded(self._rough + self._smooth / lam, self._bent, lower=True)
        before, at, after = self._second * curvature
        pull = np.zeros_like(self._values)
        pull[:-2] += before
        pull[1:-1] += at
        pull[2:] += after
        return np.asarray(self._values - self._variance * pull)


def _rounded(values: FloatArray, digits: int) -> FloatArray:
    size = np.where(values == 0.0, 1.0, np.abs(values))
    unit = 10.0 ** (np.floor(np.log10(size)) + 1 - digits)
    return np.asarray(np.round(values / unit) * unit)
