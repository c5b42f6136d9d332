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

from .initial import LARGEST
from .problem import FitProblem

FloatArray = npt.NDArray[np.float64]

QUIET = 1e-9
"""Relative fall of what is minimised that counts as none; two such iterations in a row end a start."""

DAMPINGS = 10.0 ** np.array([-3.0, -1.0, 0.5, 2.0])
"""Multiples of the last damping tried side by side, as lanes of one call."""


@dataclass(frozen=True, eq=False)
class LeastSquaresResult:
    """Where one start ended.

    unit        (n_targets,) position in the unit cube
    offsets     (n_cases, 6) of the initial states; zero where these are held
    J           sum of squares there, without the prior of the offsets
    converged   whether it stopped by itself
    """

    unit: FloatArray
    offsets: FloatArray
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
    whiten: Callable[[FloatArray], FloatArray] | None = None,
    tolerance: float = 0.0,
) -> list[LeastSquaresResult]:
    """Minimise J within the unit cube from every column of ``starts`` (n_targets, n_starts).

    Where the problem estimates initial states, their offsets are eliminated from each step exactly: a case's six
    touch its own residuals only.  What is minimised then is J plus the prior of the offsets.

    ridge, anchor   adds ridge * |unit - anchor|^2 to what is minimised (not to the J reported): picks, among
                    coefficient sets that fit equally well, the one nearest to ``anchor``
    stop            asked before every iteration; True ends all starts where they are
    whiten          linear map of residuals (n_residuals, ...) within each case, such as ``Whitening.apply``; J is then
                    the sum of squares of what it makes of them
    tolerance       fall of what is minimised that counts as none, if larger than a share of QUIET
    Returns a result per start, never above what it began with.
    """
    n_starts = starts.shape[1]
    z = np.clip(starts, 0.0, 1.0).astype(float)
    d = np.repeat(problem.offsets[:, None], n_starts, axis=1)
    centre = np.zeros(len(z)) if anchor is None else anchor
    prior = problem.prior

    def penalty(unit: FloatArray, offsets: FloatArray) -> FloatArray:
        away = np.sum((unit - centre[:, None]) ** 2, axis=0)
        return np.asarray(ridge * away + np.einsum("cps,cs->p", offsets**2, prior))

    def cost(unit: FloatArray, offsets: FloatArray) -> FloatArray:
        if whiten is None:
            return problem.costs(unit, offsets)
        return _squares(whiten(problem.residuals(unit, offsets).T))

    J = cost(z, d)
    value = J + penalty(z, d)
    damping = np.full(n_starts, 1e-3)
    iterations = np.zeros(n_starts, dtype=int)
    quiet = np.zeros(n_starts, dtype=int)
    converged = np.zeros(n_starts, dtype=bool)
    running = np.isfinite(J)
    for _ in range(max_iterations):
        rows = np.flatnonzero(running)
        if len(rows) == 0 or stop():
            break
        linear = [_Linear(problem, *parts) for parts in zip(*_jacobians(problem, z, d, rows, whiten), strict=True)]
        tried = np.empty((len(z), len(rows), len(DAMPINGS)))
        moved = np.empty((len(problem.cases), len(rows), len(DAMPINGS), 6))
        for i, row in enumerate(rows):
            hessian = linear[i].hessian + ridge * np.eye(len(z))
            gradient = linear[i].gradient + ridge * (z[:, row] - centre)
            scale = np.maximum(np.diag(hessian), 1e-12 * np.diag(hessian).max() + 1e-300)
            for k, factor in enumerate(DAMPINGS):
                damped = hessian + np.diag(damping[row] * factor * scale)
                nearby = tried[:, i, k - 1] if k else None
                tried[:, i, k] = bounded_step(damped, gradient, z[:, row], nearby)
                moved[:, i, k] = linear[i].offsets(tried[:, i, k] - z[:, row])
        unit, offsets = tried.reshape(len(z), -1), moved.reshape(len(problem.cases), -1, 6)
        costs = cost(unit, offsets)
        values = (costs + penalty(unit, offsets)).reshape(len(rows), -1)
        costs = costs.reshape(len(rows), -1)
        for i, row in enumerate(rows):
            iterations[row] += 1
            best = int(np.argmin(values[i]))
            gain = value[row] - values[i, best]
            if gain > 0.0:
                z[:, row], d[:, row] = tried[:, i, best], moved[:, i, best]
                J[row], value[row] = costs[i, best], values[i, best]
                damping[row] = min(max(damping[row] * DAMPINGS[best], 1e-12), 1e6)
            else:
                damping[row] *= 1e3
            small = 0.0 < gain <= max(QUIET * value[row], tolerance)
            quiet[row] = quiet[row] + 1 if small else 0
            if quiet[row] >= 2 or damping[row] > 1e8 or value[row] < 1e-24:
                converged[row], running[row] = True, False
    return [
        LeastSquaresResult(z[:, k].copy(), d[:, k].copy(), float(J[k]), int(iterations[k]), bool(converged[k]))
        for k in range(n_starts)
    ]


def fit_offsets(problem: FitProblem, unit: FloatArray, max_iterations: int = 12) -> FloatArray:
    """Offsets (n_cases, 6) of the initial states that fit best with the targets held at ``unit`` (n_targets,).

    A case keeps the best offsets met, beginning with none, so J and prior together never rise.
    """
    point = unit[:, None]
    best = np.zeros((len(problem.cases), 6))
    value = problem.costs_by_case(point, best[:, None])[:, 0]
    for _ in range(max_iterations):
        parts = _jacobians(problem, point, best[:, None], np.array([0]))
        linear = _Linear(problem, *(part[0] for part in parts))
        tried = linear.offsets(np.zeros(len(unit)))
        found = problem.costs_by_case(point, tried[:, None])[:, 0] + np.sum(problem.prior * tried**2, axis=1)
        better = found < value * (1.0 - 1e-9)
        best[better], value[better] = tried[better], found[better]
        if not better.any():
            break
    return best


def _jacobians(
    problem: FitProblem,
    z: FloatArray,
    d: FloatArray,
    rows: npt.NDArray[np.intp],
    whiten: Callable[[FloatArray], FloatArray] | None = None,
) -> tuple[FloatArray, ...]:
    """Offsets, residuals and derivatives of the running starts, first axis the start.

    Where a neighbour diverged the derivative counts as flat.
    """
    residuals, jacobians, by_offset = problem.jacobians(z[:, rows], d[:, rows])
    jacobians, by_offset = flat_where_lost(jacobians), flat_where_lost(by_offset)
    if whiten is not None:
        residuals, jacobians, by_offset = (
            np.moveaxis(whiten(np.moveaxis(values, 1, 0)), 0, 1) for values in (residuals, jacobians, by_offset)
        )
    return d[:, rows].transpose(1, 0, 2), residuals, jacobians, by_offset


def _squares(residuals: FloatArray) -> FloatArray:
    """Sums over the first axis; inf where a run diverged."""
    with np.errstate(invalid="ignore", over="ignore"):
        found = np.einsum("ij,ij->j", residuals, residuals)
    return np.where(np.isfinite(found), found, np.inf)


def flat_where_lost(derivatives: FloatArray) -> FloatArray:
    """Derivatives with 0 for those that are not finite; the usual case costs one pass and no copy."""
    with np.errstate(invalid="ignore", over="ignore"):
        whole = bool(np.isfinite(derivatives.sum()))
    if whole:
        return derivatives
    return np.where(np.isfinite(derivatives), derivatives, 0.0)


class _Linear:
    """The quadratic model of what is minimised around one point, with the offsets of initial states eliminated.

    hessian, gradient  by target, halves of the second and first derivatives
    """

    def __init__(
        self, problem: FitProblem, d: FloatArray, residuals: FloatArray, jacobian: FloatArray, by_offset: FloatArray
    ):
        self.hessian = jacobian.T @ jacobian
        self.gradient = jacobian.T @ residuals
        self._d = d
        self._limit = None if problem.sigma is None else LARGEST * problem.sigma
        self._from_step: list[tuple[FloatArray, FloatArray]] = []
        if problem.sigma is None:
            return
        for case, rows in enumerate(problem.rows_of_cases):
            S, J = by_offset[rows], jacobian[rows]
            prior = problem.prior[case]
            own = S.T @ S + np.diag(prior)
            cross = S.T @ J
            slope = S.T @ residuals[rows] + prior * d[case]
            solved = np.linalg.solve(own, np.column_stack([slope, cross]))
            self.hessian -= cross.T @ solved[:, 1:]
            self.gradient -= cross.T @ solved[:, 0]
            self._from_step.append((solved[:, 0], solved[:, 1:]))

    def offsets(self, step: FloatArray) -> FloatArray:
        """(n_cases, 6) best offsets after a step (n_targets,) of the targets, kept within their limit."""
        if self._limit is None:
            return self._d
        moved = np.array([d - own - cross @ step for d, (own, cross) in zip(self._d, self._from_step, strict=True)])
        return np.asarray(np.clip(moved, -self._limit, self._limit))


def bounded_step(
    hessian: FloatArray, gradient: FloatArray, z: FloatArray, start: FloatArray | None = None
) -> FloatArray:
    """The point of the unit cube that minimises a convex quadratic around z, by an active-set method.

    Moves towards the minimum over the free coordinates up to the first bound, holds what met it, and releases a held
    coordinate once its slope points inwards.

    start  a point of the cube to begin at, such as the solution for another damping: most bounds are then known
    """
    n = len(z)
    point = z.copy() if start is None else start.copy()
    slope = gradient + hessian @ (point - z)
    held = ((point <= 0.0) & (slope > 0.0)) | ((point >= 1.0) & (slope < 0.0))
    for _ in range(3 * n):
        free = np.flatnonzero(~held)
        slope = gradient + hessian @ (point - z)
        if len(free):
            try:
                step = -np.linalg.solve(hessian[np.ix_(free, free)], slope[free])
            except np.linalg.LinAlgError:
                step = -np.linalg.lstsq(hessian[np.ix_(free, free)], slope[free], rcond=None)[0]
            room = np.where(step > 0.0, 1.0 - point[free], point[free])
            share = float(np.min(room / np.maximum(np.abs(step), 1e-300)))
            if share < 1.0:
                point[free] += share * step
                met = free[room <= share * np.abs(step) * (1.0 + 1e-12)]
                point[met] = np.where(point[met] > 0.5, 1.0, 0.0)
                held[met] = True
                continue
            point[free] += step
            slope = gradient + hessian @ (point - z)
        inwards = np.where(held & (point <= 0.0), -slope, np.where(held, slope, 0.0))
        if inwards.max() <= 1e-14 * np.abs(gradient).max():
            break
        held[int(np.argmax(inwards))] = False
    return np.clip(point, 0.0, 1.0)
