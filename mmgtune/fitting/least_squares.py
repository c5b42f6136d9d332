"""Bounded nonlinear least squares: projected Levenberg-Marquardt from many starts at once.

J is a sum of squares, so its second derivatives are nearly known from the first; the Jacobians of all starts run as
lanes.  An interior method stalls beside bounds, where the optima of narrow boxes lie; here a bound is reached exactly
and left again when the gradient says so.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..arrays import BoolArray, FloatArray
from ..displayed import Brief
from .initial import LARGEST
from .journal import remembered
from .problem import FitProblem

QUIET = 1e-9
"""Relative fall of what is minimised that counts as none; two such iterations in a row end a start."""

DAMPINGS = 10.0 ** np.array([-3.0, -1.0, 0.5, 2.0])
"""Multiples of the last damping tried side by side, as lanes of one call."""

FIRM = 10.0
"""Damping from which steps of initial states are damped too: far from any fit these alone would leave their range."""

HARDLY = 1e-9
"""Damping of the step whose promise is asked for, as a share of the curvature."""

MOST_CHANGES = 12
"""Rounds in which small problems choose anew what is held at a bound, before they are solved one by one."""

FORETOLD = 0.3
"""Share of a promised fall by which it may differ for the derivatives to be used once more."""

SETTLED = 4
"""Iterations from which on that is done: before, parameters that move later than others still find their way."""

FIRST_STEPS = 1
"""Steps before a start is given up for what the linear problem promises: far from its end that says little."""

AHEAD = 0.1
"""Share of a step at which its second derivative is taken."""


@dataclass(frozen=True, eq=False, repr=False)
class LeastSquaresResult(Brief):
    """Where one start ended.

    unit        (n_targets,) position in the unit cube
    offsets     (n_cases, 6) of the initial states; zero where these are held
    J           what ``FitProblem.costs`` gives there: J and the terms beside it, without the prior of the offsets
    converged   whether it stopped by itself
    promised    what is minimised would fall by so much further, by the linear problem of the last step; 0 where that
                was not asked
    """

    unit: FloatArray
    offsets: FloatArray
    J: float
    iterations: int
    converged: bool
    promised: float = 0.0


def _asked(problem: FitProblem, starts: FloatArray, *given: Any, **named: Any) -> list[Any]:
    """What tells one solve from another."""
    named = {name: "a function" if callable(value) else value for name, value in named.items()}
    anchor = named.pop("anchor", None)
    beliefs = named.pop("beliefs", None)
    plain = [value for value in given if not callable(value)]
    return ["solve", *problem.asked(), starts, anchor, repr(plain), repr(sorted(named.items())), *(beliefs or ())]


def _noted(ends: list[LeastSquaresResult]) -> list[Any]:
    return [
        [end.unit.tolist(), end.offsets.tolist(), float(end.J), end.iterations, end.converged, end.promised]
        for end in ends
    ]


def _recalled(noted: list[Any]) -> list[LeastSquaresResult]:
    return [
        LeastSquaresResult(np.array(unit), np.array(offsets).reshape(-1, 6), *numbers)
        for unit, offsets, *numbers in noted
    ]


@remembered(_asked, _noted, _recalled, lambda problem, *_given, **_named: problem.counter)
def solve(
    problem: FitProblem,
    starts: FloatArray,
    max_iterations: int = 80,
    ridge: float = 0.0,
    anchor: FloatArray | None = None,
    stop: Callable[[], bool] = lambda: False,
    whiten: Callable[[FloatArray], FloatArray] | None = None,
    tolerance: float = 0.0,
    beliefs: tuple[FloatArray, FloatArray] | None = None,
    trusting: bool = False,
    hopeless: float = math.inf,
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
    beliefs         (k, n_targets) matrix A and (n_targets,) centre: adds |A (unit - centre)|^2 to what is minimised
                    (not to the J reported)
    trusting        a start also ends after the step from which the linear problem promises no more than the tolerance,
                    or that brought what was promised to within it, instead of two steps in a row that bring no more,
                    and two again; and initial states that would leave their range are held at its end in the linear
                    problem, and held back by large damping (elsewhere they find the way round a bound by steps of
                    their own)
    hopeless        a trusting start also ends, after its first steps, where all that the linear problem promises would
                    leave more of what is minimised than this
    Returns a result per start, never above what it began with.
    """
    n_starts = starts.shape[1]
    z = np.clip(starts, 0.0, 1.0).astype(float)
    d = np.repeat(problem.offsets[:, None], n_starts, axis=1)
    centre = np.zeros(len(z)) if anchor is None else anchor
    prior = problem.prior
    believed = np.zeros((len(z), len(z))) if beliefs is None else beliefs[0].T @ beliefs[0]
    likely = centre if beliefs is None else beliefs[1]

    def penalty(unit: FloatArray, offsets: FloatArray) -> FloatArray:
        away = np.sum((unit - centre[:, None]) ** 2, axis=0)
        own = ridge * away + np.einsum("cps,cs->p", offsets**2, prior)
        if beliefs is not None:
            own = own + np.sum((beliefs[0] @ (unit - likely[:, None])) ** 2, axis=0)
        return np.asarray(own)

    def of_all(linear: _Linear, at: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Halves of second and first derivatives of all that is minimised."""
        hessian = linear.hessian + ridge * np.eye(len(at)) + believed
        return hessian, linear.gradient + ridge * (at - centre) + believed @ (at - likely)

    def towards(
        linear: _Linear, at: FloatArray, damping: FloatArray, nearby: FloatArray | None = None
    ) -> tuple[FloatArray, _Linear]:
        """Where the quadratic model leads under damping (n_targets,), and the model with offsets held as there."""
        hessian, gradient = of_all(linear, at)
        step = bounded_step(hessian + np.diag(damping), gradient, at, nearby)
        there = linear.about(step - at)
        if there is not linear:
            hessian, gradient = of_all(there, at)
            step = bounded_step(hessian + np.diag(damping), gradient, at, step)
        return step, there

    def scale_of(linear: _Linear, at: FloatArray) -> FloatArray:
        """(n_targets,) what damping is a multiple of."""
        curvature = np.diag(of_all(linear, at)[0])
        return np.asarray(np.maximum(curvature, 1e-12 * curvature.max() + 1e-300))

    def promised_by(linear: _Linear, at: FloatArray, scale: FloatArray) -> float:
        """Fall of what is minimised by a step that is hardly damped."""
        step, there = towards(linear, at, HARDLY * scale)
        hessian, gradient = of_all(there, at)
        step = step - at
        return there.settling - 2.0 * float(gradient @ step) - float(step @ hessian @ step)

    def residuals_of(unit: FloatArray, offsets: FloatArray) -> FloatArray:
        found = problem.residuals(unit, offsets).T
        return found if whiten is None else whiten(found)

    def cost(unit: FloatArray, offsets: FloatArray) -> FloatArray:
        return problem.costs(unit, offsets) if whiten is None else _squares(residuals_of(unit, offsets))

    def around(rows: npt.NDArray[np.intp]) -> list[_Linear]:
        """The quadratic models at the running starts: of derivatives taken there, or of the last ones where those
        foretold what came."""
        anew = [row for row in rows if not told[row]]
        if anew:
            made = zip(*_jacobians(problem, z, d, np.array(anew), whiten), strict=True)
            for row, (at, off, slopes, by_offset) in zip(anew, made, strict=True):
                models[row] = _Linear(problem, at, off, slopes, by_offset, holding=trusting)
        again = [row for row in rows if told[row]]
        if again:
            offsets = d[:, again]
            residuals = residuals_of(z[:, again], offsets)
            for k, row in enumerate(again):
                models[row] = models[row].with_residuals(offsets[:, k], residuals[:, k])
        return [models[row] for row in rows]

    models: dict[int, _Linear] = {}
    told = np.zeros(n_starts, dtype=bool)
    J = cost(z, d)
    value = J + penalty(z, d)
    damping = np.full(n_starts, 1e-3)
    iterations = np.zeros(n_starts, dtype=int)
    quiet = np.zeros(n_starts, dtype=int)
    last_stop = np.full(n_starts, np.inf)
    converged = np.zeros(n_starts, dtype=bool)
    further = np.zeros(n_starts)
    running = np.isfinite(J)
    for _ in range(max_iterations):
        rows = np.flatnonzero(running)
        if len(rows) == 0 or stop():
            break
        linear = around(rows)
        scales = [scale_of(at, z[:, row]) for at, row in zip(linear, rows, strict=True)]
        promised = np.full(len(rows), np.inf)
        if trusting:
            promised[:] = [promised_by(at, z[:, row], own) for at, row, own in zip(linear, rows, scales, strict=True)]
            further[rows] = promised
        going = (iterations[rows] < FIRST_STEPS) | (value[rows] - promised <= hopeless)
        running[rows[~going]] = False
        if not going.any():
            break
        kept = np.flatnonzero(going)
        rows, promised = rows[kept], promised[kept]
        linear, scales = [linear[k] for k in kept], [scales[k] for k in kept]
        last = promised <= tolerance
        tried = np.empty((len(z), len(rows), 2, len(DAMPINGS)))
        moved = np.empty((len(problem.cases), len(rows), 2, len(DAMPINGS), 6))
        for i, row in enumerate(rows):
            if last[i]:
                damping[row] = min(damping[row], 1e-3)
            for k, factor in enumerate(DAMPINGS):
                at = linear[i]
                if trusting and damping[row] * factor > FIRM:
                    at = at.damped(damping[row] * factor)
                nearby = tried[:, i, 0, k - 1] if k else None
                tried[:, i, 0, k], at = towards(at, z[:, row], damping[row] * factor * scales[i], nearby)
                moved[:, i, 0, k] = at.offsets(tried[:, i, 0, k] - z[:, row])
        if last.all():
            tried, moved = tried[:, :, :1], moved[:, :, :1]
        else:
            _accelerate(residuals_of, linear, z[:, rows], d[:, rows], damping[rows], tried, moved)
        unit = tried.reshape(len(z), -1)
        offsets = moved.reshape(len(problem.cases), unit.shape[1], 6)
        costs = cost(unit, offsets)
        values = (costs + penalty(unit, offsets)).reshape(len(rows), -1)
        costs = costs.reshape(len(rows), -1)
        for i, row in enumerate(rows):
            iterations[row] += 1
            best = int(np.argmin(values[i]))
            gain = value[row] - values[i, best]
            if gain > 0.0:
                further[row] = max(further[row] - gain, 0.0)
                bent, k = divmod(best, len(DAMPINGS))
                z[:, row], d[:, row] = tried[:, i, bent, k], moved[:, i, bent, k]
                J[row], value[row] = costs[i, best], values[i, best]
                damping[row] = min(max(damping[row] * DAMPINGS[k], 1e-12), 1e6)
            else:
                damping[row] *= 1e3
            foretold = gain > 0.0 and abs(gain - promised[i]) <= FORETOLD * promised[i]
            told[row] = trusting and foretold and iterations[row] >= SETTLED
            small = 0.0 < gain <= max(QUIET * value[row], tolerance)
            quiet[row] = quiet[row] + 1 if small else 0
            if last[i] or abs(gain - promised[i]) <= tolerance:
                converged[row], running[row] = True, False
                continue
            if quiet[row] >= 2 or damping[row] > 1e8 or value[row] < 1e-24:
                if value[row] < last_stop[row] - max(QUIET * value[row], tolerance):
                    # It may have been slow only because its damping was high: once more with a low one.
                    last_stop[row], damping[row], quiet[row] = value[row], 1e-3, 0
                else:
                    converged[row], running[row] = True, False
    return [
        LeastSquaresResult(
            z[:, k].copy(), d[:, k].copy(), float(J[k]), int(iterations[k]), bool(converged[k]), float(further[k])
        )
        for k in range(n_starts)
    ]


def fit_offsets(problem: FitProblem, unit: FloatArray, max_iterations: int = 12) -> FloatArray:
    """Offsets (n_cases, 6) of the initial states that fit best with the targets held at ``unit`` (n_targets,).

    A case keeps the best offsets met, beginning with none, so J and prior together never rise; one that diverges keeps
    none.
    """
    point = unit[:, None]
    best = np.zeros((len(problem.cases), 6))
    value = problem.costs_by_case(point, best[:, None])[:, 0]
    for _ in range(max_iterations):
        residuals, slopes = problem.offset_slopes(unit, best)
        residuals, slopes = flat_where_lost(residuals), flat_where_lost(slopes)
        linear = _Linear(problem, best, residuals, np.empty((len(residuals), 0)), slopes)
        tried = linear.offsets(np.empty(0))
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


def _accelerate(
    residuals_of: Callable[[FloatArray, FloatArray], FloatArray],
    linear: list[_Linear],
    z: FloatArray,
    d: FloatArray,
    damping: FloatArray,
    tried: FloatArray,
    moved: FloatArray,
) -> None:
    """Bend each straight step tried[:, :, 0], moved[:, :, 0] along the valley it starts in, into [:, :, 1].

    Coefficients that nearly trade against each other make valleys long, narrow and curved.  The second derivative of
    the residuals along a step, from one more run at a tenth of it, gives the bend (geodesic acceleration: Transtrum &
    Sethna 2012, arXiv:1201.5885).  A bend that is no smaller than the step is not to be trusted and left out.
    """
    step, shift = tried[:, :, 0] - z[:, :, None], moved[:, :, 0] - d[:, :, None]
    near = (z[:, :, None] + AHEAD * step).reshape(len(z), -1)
    runs = residuals_of(near, (d[:, :, None] + AHEAD * shift).reshape(len(d), near.shape[1], 6))
    runs = runs.reshape(len(runs), *step.shape[1:])
    tried[:, :, 1], moved[:, :, 1] = tried[:, :, 0], moved[:, :, 0]
    for i, at in enumerate(linear):
        with np.errstate(invalid="ignore"):
            ahead = (runs[:, i] - at.residuals[:, None]) / AHEAD
            curved = (2.0 / AHEAD) * (ahead - at.slope(step[:, i], shift[:, i]))
        for k, factor in enumerate(DAMPINGS):
            if not np.isfinite(runs[:, i, k]).all():
                continue
            bend, bend_shift = at.bend(curved[:, k], damping[i] * factor, step[:, i, k] != 0.0)
            if np.linalg.norm(bend * at.scale) <= np.linalg.norm(2.0 * step[:, i, k] * at.scale):
                tried[:, i, 1, k] = np.clip(tried[:, i, 0, k] + 0.5 * bend, 0.0, 1.0)
                moved[:, i, 1, k] = at.limited(moved[:, i, 0, k] + 0.5 * bend_shift)


class _Cases(NamedTuple):
    """What the quadratic model of the cases is made of, wherever their offsets may go: halves of derivatives.

    at         (n_cases, 6) the offsets where it was made
    curvature  (n_cases, 6, 6) of what is minimised by these, the prior among them
    cross      (n_cases, 6, n_targets) the same by these and the targets
    slope      (n_cases, 6) its first derivatives by the offsets
    """

    at: FloatArray
    curvature: FloatArray
    cross: FloatArray
    slope: FloatArray


@dataclass(frozen=True, eq=False)
class _Offsets:
    """The offsets of initial states in the quadratic model, those that would leave their range held at its end.

    What is of a held one is zero, but for 1 on the diagonal of the curvature.

    free       (n_cases, 6) which are not held
    to_end     (n_cases, 6) how far those that are held move
    curvature  (n_cases, 6, 6) halves of second derivatives
    cross      (6 n_cases, n_targets) the same by these and the targets
    by_held    (n_targets,) half of what the held ones add to the derivatives by the targets
    alone      (6 n_cases,) best step against their slopes where the targets stand
    by_target  (6 n_cases, n_targets) the same for a unit step of each target
    promised   fall of what is minimised by the offsets alone
    """

    free: BoolArray
    to_end: FloatArray
    curvature: FloatArray
    cross: FloatArray
    by_held: FloatArray
    alone: FloatArray
    by_target: FloatArray
    promised: float

    @classmethod
    def of(cls, cases: _Cases, limit: FloatArray | None, damping: float, step: FloatArray | None) -> _Offsets:
        """How they move with the targets.

        limit  (n_cases, 6) the ends of their ranges, None where none is held
        step   (n_targets,) of the targets that says which would leave it; None for none
        """
        at, whole, cross, slope = cases
        if damping:
            whole = whole + damping * whole * np.eye(6)
        there = slope if step is None else slope + cross @ step
        free, to_end = np.ones(at.shape, dtype=bool), np.zeros(at.shape)
        curvature, pull = whole, slope
        solved = np.linalg.solve(whole, np.concatenate([slope[..., None], cross], axis=2))
        if limit is not None:
            end = at - solved[..., 0] - (0.0 if step is None else solved[..., 1:] @ step)
            leaving = np.flatnonzero(np.any(np.abs(end) > limit, axis=1))
            if len(leaving):
                width = 2.0 * limit[leaving]
                unit = bounded_steps(
                    whole[leaving] * width[:, :, None] * width[:, None],
                    there[leaving] * width,
                    np.clip(at[leaving] / width + 0.5, 0.0, 1.0),
                )
                free[leaving] = (unit > 0.0) & (unit < 1.0)
                to_end[leaving] = np.where(free[leaving], 0.0, (unit - 0.5) * width - at[leaving])
                curvature = np.where(free[:, :, None] & free[:, None], whole, np.eye(6) * ~free[:, None])
                pull = np.where(free, slope + (whole @ to_end[..., None])[..., 0], 0.0)
                cross = np.where(free[..., None], cross, 0.0)
                solved = np.linalg.solve(curvature, np.concatenate([pull[..., None], cross], axis=2))
        moved = to_end - solved[..., 0]
        shape = (6 * len(at), cross.shape[2])
        return cls(
            free,
            to_end,
            curvature,
            cross.reshape(shape),
            to_end.reshape(-1) @ cases.cross.reshape(shape),
            solved[..., 0].reshape(-1),
            solved[..., 1:].reshape(shape),
            -float(np.sum(moved * (2.0 * slope + (whole @ moved[..., None])[..., 0]))),
        )

    def move(self, step: FloatArray) -> FloatArray:
        """(n_cases, 6) how far the offsets move beside a step (n_targets,) of the targets."""
        return self.to_end - (self.alone + self.by_target @ step).reshape(-1, 6)


class _Plain(NamedTuple):
    """What a quadratic model is made of, whatever of it is held: halves of derivatives by targets, and of the cases."""

    hessian: FloatArray
    gradient: FloatArray
    cases: _Cases | None


class _Linear:
    """The quadratic model of what is minimised around one point, with the offsets of initial states eliminated.

    hessian, gradient  by target, halves of the second and first derivatives
    settling           fall of what is minimised that offsets alone promise
    """

    def __init__(
        self,
        problem: FitProblem,
        d: FloatArray,
        residuals: FloatArray,
        jacobian: FloatArray,
        by_offset: FloatArray,
        holding: bool = False,
        damping: float = 0.0,
        step: FloatArray | None = None,
        plain: _Plain | None = None,
    ):
        self.residuals, self._d = residuals, d
        self._problem, self._jacobian, self._by_offset = problem, jacobian, by_offset
        self._rows = problem.rows_of_cases
        self._limit = None if problem.sigma is None else LARGEST * problem.sigma
        self._holding, self._damping = holding, damping
        self._plain = plain or _Plain(jacobian.T @ jacobian, jacobian.T @ residuals, self._cases())
        self.hessian, self.gradient, self.settling = self._plain.hessian, self._plain.gradient, 0.0
        self._own: _Offsets | None = None
        if self._plain.cases is not None:
            own = self._own = _Offsets.of(self._plain.cases, self._limit if holding else None, damping, step)
            self.hessian = self.hessian - own.cross.T @ own.by_target
            self.gradient = self.gradient + own.by_held - own.alone @ own.cross
            self.settling = own.promised

    def _cases(self) -> _Cases | None:
        """Those whose offsets are free."""
        if self._limit is None:
            return None
        of_cases = [(self._by_offset[rows].T, rows) for rows in self._rows]
        return _Cases(
            self._d,
            np.array([by_row @ by_row.T for by_row, _ in of_cases]) + self._problem.prior[:, None] * np.eye(6),
            np.array([by_row @ self._jacobian[rows] for by_row, rows in of_cases]),
            self._slope(self._d, self.residuals),
        )

    def _slope(self, d: FloatArray, residuals: FloatArray) -> FloatArray:
        """(n_cases, 6) halves of the first derivatives by the offsets d, of which the residuals are."""
        return np.array([self._by_offset[rows].T @ residuals[rows] for rows in self._rows]) + self._problem.prior * d

    def with_residuals(self, d: FloatArray, residuals: FloatArray) -> _Linear:
        """The same derivatives around a point nearby."""
        cases = self._plain.cases
        if cases is not None:
            cases = cases._replace(at=d, slope=self._slope(d, residuals))
        plain = _Plain(self._plain.hessian, self._jacobian.T @ residuals, cases)
        return _Linear(self._problem, d, residuals, self._jacobian, self._by_offset, self._holding, plain=plain)

    def damped(self, damping: float) -> _Linear:
        """The same with steps of the offsets damped."""
        return self if self._own is None else self._again(damping, None)

    def about(self, step: FloatArray) -> _Linear:
        """The same with those offsets held that would leave their range beside a step (n_targets,) of the targets."""
        if not self._holding or self._own is None or self._limit is None:
            return self
        leave = not self._own.free.all() or bool(np.any(np.abs(self._d + self._own.move(step)) > self._limit))
        return self._again(self._damping, step) if leave else self

    def _again(self, damping: float, step: FloatArray | None) -> _Linear:
        given = (self._problem, self._d, self.residuals, self._jacobian, self._by_offset)
        return _Linear(*given, self._holding, damping, step, self._plain)

    def offsets(self, step: FloatArray) -> FloatArray:
        """(n_cases, 6) best offsets after a step (n_targets,) of the targets, kept within their limit."""
        return self._d if self._own is None else self.limited(self._d + self._own.move(step))

    def limited(self, offsets: FloatArray) -> FloatArray:
        """Offsets kept within their limit."""
        return offsets if self._limit is None else np.clip(offsets, -self._limit, self._limit)

    @property
    def scale(self) -> FloatArray:
        """(n_targets,) what steps are measured in: the residual each target changes."""
        return np.sqrt(np.maximum(np.diag(self.hessian), 0.0))

    def slope(self, steps: FloatArray, shifts: FloatArray) -> FloatArray:
        """First-order change of the residuals by steps (n_targets, k) and shifts of the offsets (n_cases, k, 6)."""
        change = self._jacobian @ steps
        if self._own is not None:
            for rows, own in zip(self._rows, shifts, strict=True):
                change[rows] += self._by_offset[rows] @ own.T
        return change

    def bend(self, curved: FloatArray, damping: float, free: BoolArray) -> tuple[FloatArray, FloatArray]:
        """Step and shift that undo a second derivative of the residuals, by least squares over the free targets."""
        own, gradient = self._own, self._jacobian.T @ curved
        pull = np.zeros((0, 6))
        if own is not None:
            pull = np.array([self._by_offset[rows].T @ curved[rows] for rows in self._rows]) * own.free
            gradient = gradient - pull.reshape(-1) @ own.by_target
        hessian = self.hessian[np.ix_(free, free)]
        damped = hessian + damping * np.diag(np.maximum(np.diag(hessian), 1e-300))
        step = np.zeros(len(gradient))
        step[free] = -np.linalg.lstsq(damped, gradient[free], rcond=1e-14)[0]
        if own is None:
            return step, np.zeros_like(self._d)
        pulled = np.linalg.solve(own.curvature, pull[..., None])[..., 0]
        return step, -(pulled + (own.by_target @ step).reshape(-1, 6))


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


def bounded_steps(hessian: FloatArray, gradient: FloatArray, z: FloatArray) -> FloatArray:
    """``bounded_step`` of k small problems at once, hessian (k, n, n), gradient and z (k, n) -> (k, n).

    What leaves the cube is held at its end, what is held and pulled inwards is let go, all at once, until nothing
    changes (Hintermueller, Ito & Kunisch 2003, a primal-dual active set); the few that cycle go one by one.
    """
    own = np.eye(z.shape[1])
    side = np.zeros(z.shape, dtype=int)
    for _ in range(MOST_CHANGES):
        held = side != 0
        to_end = np.where(held, (side > 0) - z, 0.0)
        pull = gradient + (hessian @ to_end[..., None])[..., 0]
        within = np.where(held[:, :, None] | held[:, None], own * held[:, None], hessian)
        step = to_end - np.linalg.solve(within, np.where(held, 0.0, pull)[..., None])[..., 0]
        slope = gradient + (hessian @ step[..., None])[..., 0]
        leaving = (z + step > 1.0).astype(int) - (z + step < 0.0)
        new = np.where(held, np.where(side * slope < 0.0, side, 0), leaving)
        changed = np.any(new != side, axis=1)
        side = new
        if not changed.any():
            return np.clip(np.where(held, side > 0, z + step), 0.0, 1.0)
    found = np.where(side != 0, side > 0, z + step).astype(float)
    for k in np.flatnonzero(changed):
        found[k] = bounded_step(hessian[k], gradient[k], z[k])
    return np.asarray(np.clip(found, 0.0, 1.0))
