"""Bounded nonlinear least squares: projected Levenberg-Marquardt from many starts at once.

J is a sum of squares, so its second derivatives are nearly known from the first; the Jacobians of all starts run as
lanes.  An interior method stalls beside bounds, where the optima of narrow boxes lie; here a bound is reached exactly
and left again when the gradient says so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .problem import FitProblem

FloatArray = npt.NDArray[np.float64]

DAMPINGS = 10.0 ** np.array([-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0])
"""Multiples of the last damping tried side by side; as many as there are lanes in a block."""


@dataclass(frozen=True, eq=False)
class LeastSquaresResult:
    """Where one start ended: unit (n_targets,), J, iterations, and whether it stopped by itself."""

    unit: FloatArray
    J: float
    iterations: int
    converged: bool


def solve(
    problem: FitProblem,
    starts: FloatArray,
    max_iterations: int = 80,
    ridge: float = 0.0,
    anchor: FloatArray | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> list[LeastSquaresResult]:
    """Minimise J within the unit cube from every column of ``starts`` (n_targets, n_starts).

    ridge, anchor   adds ridge * |unit - anchor|^2 to what is minimised (not to the J reported): picks, among
                    coefficient sets that fit equally well, the one nearest to ``anchor``
    stop            asked before every iteration; True ends all starts where they are
    Returns a result per start, never above the J it began with.
    """
    n_starts = starts.shape[1]
    z = np.clip(starts, 0.0, 1.0).astype(float)
    centre = np.zeros(len(z)) if anchor is None else anchor
    J = problem.costs(z)
    value = J + ridge * np.sum((z - centre[:, None]) ** 2, axis=0)
    damping = np.full(n_starts, 1e-3)
    iterations = np.zeros(n_starts, dtype=int)
    quiet = np.zeros(n_starts, dtype=int)
    converged = np.zeros(n_starts, dtype=bool)
    running = np.isfinite(J)
    for _ in range(max_iterations):
        rows = np.flatnonzero(running)
        if len(rows) == 0 or stop():
            break
        residuals, jacobians = problem.jacobians(z[:, rows])
        tried = np.empty((len(z), len(rows), len(DAMPINGS)))
        for i, row in enumerate(rows):
            jacobian = np.where(np.isfinite(jacobians[i]), jacobians[i], 0.0)
            hessian = jacobian.T @ jacobian + ridge * np.eye(len(z))
            gradient = jacobian.T @ residuals[i] + ridge * (z[:, row] - centre)
            scale = np.maximum(np.diag(hessian), 1e-12 * np.diag(hessian).max() + 1e-300)
            for k, factor in enumerate(DAMPINGS):
                tried[:, i, k] = bounded_step(hessian + np.diag(damping[row] * factor * scale), gradient, z[:, row])
        costs = problem.costs(tried.reshape(len(z), -1)).reshape(len(rows), -1)
        values = costs + ridge * np.sum((tried - centre[:, None, None]) ** 2, axis=0)
        for i, row in enumerate(rows):
            iterations[row] += 1
            best = int(np.argmin(values[i]))
            gain = value[row] - values[i, best]
            if gain > 0.0:
                z[:, row], J[row], value[row] = tried[:, i, best], costs[i, best], values[i, best]
                damping[row] = min(max(damping[row] * DAMPINGS[best], 1e-12), 1e6)
            else:
                damping[row] *= 1e3
            small = 0.0 < gain <= 1e-12 * value[row]
            quiet[row] = quiet[row] + 1 if small else 0
            if quiet[row] >= 2 or damping[row] > 1e8 or value[row] < 1e-24:
                converged[row], running[row] = True, False
    return [LeastSquaresResult(z[:, k].copy(), float(J[k]), int(iterations[k]), bool(converged[k])) for k in range(n_starts)]


def bounded_step(hessian: FloatArray, gradient: FloatArray, z: FloatArray) -> FloatArray:
    """The point of the unit cube that minimises the quadratic model around z, by adding bounds until none is crossed."""
    n = len(z)
    held = ((z <= 0.0) & (gradient > 0.0)) | ((z >= 1.0) & (gradient < 0.0))
    step = np.zeros(n)
    for _ in range(n):
        free = ~held
        if not free.any():
            break
        right = -(gradient[free] + hessian[np.ix_(free, held)] @ step[held])
        try:
            step[free] = np.linalg.solve(hessian[np.ix_(free, free)], right)
        except np.linalg.LinAlgError:
            step[free] = np.linalg.lstsq(hessian[np.ix_(free, free)], right, rcond=None)[0]
        beyond = free & ((z + step < 0.0) | (z + step > 1.0))
        if not beyond.any():
            break
        step[beyond] = np.where(z[beyond] + step[beyond] < 0.0, -z[beyond], 1.0 - z[beyond])
        held = held | beyond
    return np.clip(z + step, 0.0, 1.0)
