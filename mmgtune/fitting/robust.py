"""Robust fit: least squares repeated with weights for outliers from its own residuals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray, robust_deviation
from ..backends import Cases
from .least_squares import LeastSquaresResult, solve
from .problem import FitProblem

MOST_ROUNDS = 6
"""Rounds of weighting outliers."""

USUAL_DEVIATIONS = 3.0
"""Robust standard deviations within which a residual counts by its square, beyond which by its size."""

LEAST_MOVE = 1e-4
"""Move within the unit cube that counts as none."""


def huber_weights(cases: Cases, residuals: FloatArray) -> FloatArray:
    """Factors (n_cases, T, 6) on the weights of squares, 1 but for outliers of their channel.

    residuals  (n_residuals,) as the cases weigh them without such factors
    """
    counted = cases.rows >= 0
    size = np.zeros(cases.rows.shape)
    size[counted] = np.abs(residuals[cases.rows[counted]])
    factors = np.ones(cases.rows.shape)
    for channel in range(counted.shape[2]):
        here = counted[:, :, channel]
        if not here.any():
            continue
        usual = USUAL_DEVIATIONS * robust_deviation(size[:, :, channel][here])
        if usual > 0.0:
            factors[:, :, channel] = np.minimum(1.0, usual / np.maximum(size[:, :, channel], usual))
    return factors


def weigh_down(
    problem: FitProblem, best: LeastSquaresResult, ridge: float, anchor: FloatArray
) -> tuple[FitProblem, LeastSquaresResult]:
    """The problem with outliers down-weighted, and its solution, starting from ``best``, the solution of the plain
    problem.

    Iteratively reweighted least squares with Huber's weights; ridge and anchor as for ``solve``.
    """
    plain = problem
    for _ in range(MOST_ROUNDS):
        weights = huber_weights(plain.cases, plain.with_offsets(best.offsets).residuals(best.unit[:, None])[0])
        problem = plain.with_cases(replace(plain.cases, weight=plain.cases.weight * weights))
        problem = problem.with_offsets(best.offsets)
        better = solve(problem, best.unit[:, None], ridge=ridge, anchor=anchor)[0]
        moved = float(np.max(np.abs(better.unit - best.unit)))
        best = better
        if moved < LEAST_MOVE:
            break
    return problem.with_offsets(best.offsets), best
