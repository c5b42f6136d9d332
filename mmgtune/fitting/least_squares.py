"""Bounded nonlinear least squares: projected Levenberg-Marquardt from many starts at once.

J is a sum of squares, so its second derivatives are nearly known from the first; the Jacobians of all starts run as
lanes.  An interior method stalls beside bounds, where the optima of narrow boxes lie; here a bound is reached exactly
and left again when the gradient says so.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..backends import Integrator
from ..displayed import Brief
from ..first_states import LITTLE, ROUNDS
from .bounded import bounded_step
from .journal import remembered
from .problem import FitProblem
from .quadratic import Quadratic, flat_where_lost

MOST_ITERATIONS = 80
"""Iterations of a solve at most."""

LEAST_FALL = 1e-9
"""Relative fall of the objective that counts as none; two such iterations in a row end a start."""

DAMPINGS = 10.0 ** np.array([-2.0, -0.7, 0.3, 2.0])
"""Multiples of the last damping tried side by side, as lanes of one call."""

FIRM_DAMPING = 10.0
"""Damping from which steps of initial states are damped too: far from any fit these alone would leave their range."""

PROMISE_DAMPING = 1e-9
"""Damping of the step whose promise is asked for, as a share of the curvature."""

PROMISE_TOLERANCE = 0.3
"""Share of a promised fall by which it may differ for the derivatives to be used once more."""

ITERATIONS_BEFORE_REUSE = 4
"""Iterations before derivatives may be reused: at first, parameters that move later than others still find their
way."""

FIRST_STEPS = 1
"""Steps before a start is given up for what the linear problem promises: far from its end that says little."""

SHARE_AHEAD = 0.1
"""Share of a step at which its second derivative is taken."""


@dataclass(frozen=True, eq=False, repr=False)
class LeastSquaresResult(Brief):
    """Where one start ended.

    unit        (n_targets,) position in the unit cube
    offsets     (n_cases, 6) of the initial states; zero where these are held
    J           objective by ``FitProblem.costs``: J and the weighted terms, without the prior of the offsets
    converged   whether it stopped by itself
    promised    predicted further fall of the objective, by the linear problem of the last step; 0 where that was not
                asked
    """

    unit: FloatArray
    offsets: FloatArray
    J: float
    iterations: int
    converged: bool
    promised: float = 0.0


def _asked(
    problem: FitProblem,
    starts: FloatArray,
    stop: Callable[[], bool],
    whiten: Callable[[FloatArray], FloatArray] | None,
    beliefs: tuple[FloatArray, FloatArray] | None,
    **numbers: Any,
) -> list[Any]:
    """Numbers and texts that identify a solve in a journal: its arguments, but for what stops it.

    Of a whitening it is said that there is one: which follows from what the run has done before.
    """
    anchor = numbers.pop("anchor")
    how = [*sorted(numbers.items()), "whitened" if whiten else ""]
    return ["solve", *problem.asked(), starts, anchor, *how, *(beliefs or ())]


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


@remembered(_asked, _noted, _recalled, lambda problem, **_: problem.counter)
def solve(
    problem: FitProblem,
    starts: FloatArray,
    max_iterations: int = MOST_ITERATIONS,
    ridge: float = 0.0,
    anchor: FloatArray | None = None,
    stop: Callable[[], bool] = lambda: False,
    whiten: Callable[[FloatArray], FloatArray] | None = None,
    tolerance: float = 0.0,
    beliefs: tuple[FloatArray, FloatArray] | None = None,
    trusting: bool = False,
    hopeless: float = math.inf,
    slopes: Integrator | None = None,
) -> list[LeastSquaresResult]:
    """Minimise J within the unit cube from every column of ``starts`` (n_targets, n_starts).

    Where the problem estimates initial states, their offsets are eliminated from each step exactly: a case's six
    touch its own residuals only.  The objective is then J plus the prior of the offsets.

    ridge, anchor   adds ridge * |unit - anchor|^2 to the objective (not to the J reported): picks, among
                    coefficient sets that fit equally well, the one nearest to ``anchor``
    stop            asked before every iteration; True ends all starts where they are
    whiten          linear map of residuals (n_residuals, ...) within each case, such as ``Whitening.apply``; J is then
                    the sum of squares of the whitened residuals
    tolerance       fall of the objective that counts as none, if larger than a share of LEAST_FALL
    beliefs         (k, n_targets) matrix A and (n_targets,) centre: adds |A (unit - centre)|^2 to the objective (not to
                    the J reported)
    trusting        a start also ends after the step from which the linear problem promises no more than the tolerance,
                    or that brought what was promised to within it, instead of two steps in a row that bring no more,
                    and two again; and initial states that would leave their range are held at its end in the linear
                    problem, and held back by large damping (elsewhere they find the way round a bound by steps of
                    their own)
    hopeless        a trusting start also ends, after its first steps, where all that the linear problem promises would
                    leave a larger objective than this
    slopes          integrator of the derivatives, until a step by them gains nothing; the problem's own where None
    Returns a result per start, never above what it began with.
    """
    aim = _Minimised(problem, len(starts), ridge, anchor, beliefs, whiten, slopes)
    under_way = _Starts(aim, starts, tolerance, trusting, hopeless)
    for _ in range(max_iterations):
        if stop() or not under_way.advance():
            break
    return under_way.results()


def fit_offsets(
    problem: FitProblem,
    unit: FloatArray,
    whiten: Callable[[FloatArray], FloatArray] | None = None,
) -> FloatArray:
    """Offsets (n_cases, 6) of the initial states that fit best with the targets held at ``unit`` (n_targets,).

    A case keeps the best offsets met, beginning with none, so J and prior together never rise; one that diverges keeps
    none.

    whiten  linear map of residuals (n_residuals, ...) within each case, the squares of which stand for J then
    """
    best = np.zeros((len(problem.cases), 6))
    value = squares_by_case(problem, unit, best, whiten)
    for _ in range(ROUNDS):
        residuals, slopes = problem.offset_slopes(unit, best)
        residuals, slopes = flat_where_lost(residuals), flat_where_lost(slopes)
        if whiten is not None:
            residuals, slopes = whiten(residuals), whiten(slopes)
        linear = Quadratic(problem, best, residuals, np.empty((len(residuals), 0)), slopes)
        tried = linear.offsets(np.empty(0))
        found = squares_by_case(problem, unit, tried, whiten) + np.sum(problem.prior * tried**2, axis=1)
        better = found < value * (1.0 - LITTLE)
        best[better], value[better] = tried[better], found[better]
        if not better.any():
            break
    return best


def squares_by_case(
    problem: FitProblem, unit: FloatArray, offsets: FloatArray, whiten: Callable[[FloatArray], FloatArray] | None
) -> FloatArray:
    """(n_cases,) J, or the sums of squares of what ``whiten`` makes of the residuals, at a point with offsets
    (n_cases, 6); inf where a run diverged."""
    if whiten is None:
        return problem.costs_by_case(unit[:, None], offsets[:, None])[:, 0]
    left = whiten(problem.residuals(unit[:, None], offsets[:, None]).T)
    return np.array([_squares(left[rows])[0] for rows in problem.rows_of_cases])


class _Minimised:
    """The objective: J or the sum of squares of whitened residuals, plus ridge, beliefs and prior of the offsets; see
    ``solve``."""

    def __init__(
        self,
        problem: FitProblem,
        n_targets: int,
        ridge: float,
        anchor: FloatArray | None,
        beliefs: tuple[FloatArray, FloatArray] | None,
        whiten: Callable[[FloatArray], FloatArray] | None,
        slopes: Integrator | None,
    ):
        self.problem, self._ridge, self._whiten = problem, ridge, whiten
        self.slopes = None if slopes == problem.integrator else slopes
        self._centre = np.zeros(n_targets) if anchor is None else anchor
        self._beliefs = beliefs
        self._believed = np.zeros((n_targets, n_targets)) if beliefs is None else beliefs[0].T @ beliefs[0]
        self._likely = self._centre if beliefs is None else beliefs[1]

    def residuals(self, unit: FloatArray, offsets: FloatArray, closely: bool = True) -> FloatArray:
        """(n_residuals, n_points), whitened where that was asked for.

        closely  of the problem's own integrator, not of that of the derivatives
        """
        problem = self.problem if closely or self.slopes is None else self.problem.with_integrator(self.slopes)
        found = problem.residuals(unit, offsets).T
        return found if self._whiten is None else self._whiten(found)

    def cost(self, unit: FloatArray, offsets: FloatArray) -> FloatArray:
        """(n_points,) J, or the sum of squares of whitened residuals."""
        return self.problem.costs(unit, offsets) if self._whiten is None else _squares(self.residuals(unit, offsets))

    def penalty(self, unit: FloatArray, offsets: FloatArray) -> FloatArray:
        """(n_points,) ridge, beliefs and prior of the offsets."""
        away = np.sum((unit - self._centre[:, None]) ** 2, axis=0)
        own = self._ridge * away + np.einsum("cps,cs->p", offsets**2, self.problem.prior)
        if self._beliefs is not None:
            own = own + np.sum((self._beliefs[0] @ (unit - self._likely[:, None])) ** 2, axis=0)
        return np.asarray(own)

    def models(self, z: FloatArray, d: FloatArray, holding: bool, closely: bool) -> list[Quadratic]:
        """The quadratic models around points z (n_targets, n_points), d (n_cases, n_points, 6).

        Where a neighbour diverged the derivative counts as flat.

        closely  by derivatives of the problem's own integrator, whatever others are allowed
        """
        residuals, jacobians, by_offset = self.problem.jacobians(z, d, None if closely else self.slopes)
        jacobians, by_offset = flat_where_lost(jacobians), flat_where_lost(by_offset)
        if self._whiten is not None:
            residuals, jacobians, by_offset = (
                np.moveaxis(self._whiten(np.moveaxis(values, 1, 0)), 0, 1)
                for values in (residuals, jacobians, by_offset)
            )
        made = zip(d.transpose(1, 0, 2), residuals, jacobians, by_offset, strict=True)
        return [Quadratic(self.problem, *one, holding=holding) for one in made]

    def derivatives(self, model: Quadratic, at: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Halves of second and first derivatives of all that is minimised."""
        hessian = model.hessian + self._ridge * np.eye(len(at)) + self._believed
        return hessian, model.gradient + self._ridge * (at - self._centre) + self._believed @ (at - self._likely)

    def scale(self, model: Quadratic, at: FloatArray) -> FloatArray:
        """(n_targets,) scale of the damping."""
        curvature = np.diag(self.derivatives(model, at)[0])
        return np.asarray(np.maximum(curvature, 1e-12 * curvature.max() + 1e-300))

    def towards(
        self, model: Quadratic, at: FloatArray, damping: FloatArray, nearby: FloatArray | None = None
    ) -> tuple[FloatArray, Quadratic]:
        """Where a model leads under damping (n_targets,), and the model with offsets held as there."""
        hessian, gradient = self.derivatives(model, at)
        step = bounded_step(hessian + np.diag(damping), gradient, at, nearby)
        there = model.about(step - at)
        if there is not model:
            hessian, gradient = self.derivatives(there, at)
            step = bounded_step(hessian + np.diag(damping), gradient, at, step)
        return step, there

    def promised(self, model: Quadratic, at: FloatArray, scale: FloatArray) -> float:
        """Predicted fall of the objective by a step that is hardly damped."""
        step, there = self.towards(model, at, PROMISE_DAMPING * scale)
        hessian, gradient = self.derivatives(there, at)
        step = step - at
        return there.settling - 2.0 * float(gradient @ step) - float(step @ hessian @ step)


class _Tried(NamedTuple):
    """Points to try from each of some starts: straight steps, and these bent, of each damping.

    unit     (n_targets, n_starts, 1 or 2, n_dampings)
    offsets  (n_cases, n_starts, 1 or 2, n_dampings, 6)
    """

    unit: FloatArray
    offsets: FloatArray


class _Starts:
    """State of all starts; those still running are advanced side by side."""

    def __init__(self, aim: _Minimised, starts: FloatArray, tolerance: float, trusting: bool, hopeless: float):
        n = starts.shape[1]
        self._aim, self._tolerance, self._trusting, self._hopeless = aim, tolerance, trusting, hopeless
        self._z = np.clip(starts, 0.0, 1.0).astype(float)
        self._d = np.repeat(aim.problem.offsets[:, None], n, axis=1)
        self._J = aim.cost(self._z, self._d)
        self._value = self._J + aim.penalty(self._z, self._d)
        self._models: dict[int, Quadratic] = {}
        self._told = np.zeros(n, dtype=bool)  # whether the last derivatives foretold what came
        self._closely = np.full(n, aim.slopes is None)  # whether derivatives are of the problem's own integrator
        self._damping = np.full(n, 1e-3)
        self._iterations = np.zeros(n, dtype=int)
        self._quiet = np.zeros(n, dtype=int)
        self._last_stop = np.full(n, np.inf)
        self._converged = np.zeros(n, dtype=bool)
        self._further = np.zeros(n)
        self._running = np.isfinite(self._J)

    def results(self) -> list[LeastSquaresResult]:
        """Where each ended."""
        ends = zip(self._J, self._iterations, self._converged, self._further, strict=True)
        return [
            LeastSquaresResult(
                self._z[:, k].copy(), self._d[:, k].copy(), float(J), int(iterations), bool(converged), float(further)
            )
            for k, (J, iterations, converged, further) in enumerate(ends)
        ]

    def advance(self) -> bool:
        """One iteration of those that run; False where none does."""
        rows = np.flatnonzero(self._running)
        if len(rows) == 0:
            return False
        models = self._around(rows)
        scales = [self._aim.scale(model, self._z[:, row]) for model, row in zip(models, rows, strict=True)]
        promised = np.full(len(rows), np.inf)
        if self._trusting:
            of_rows = zip(models, rows, scales, strict=True)
            promised[:] = [self._aim.promised(model, self._z[:, row], own) for model, row, own in of_rows]
            self._further[rows] = promised
        going = (self._iterations[rows] < FIRST_STEPS) | (self._value[rows] - promised <= self._hopeless)
        self._running[rows[~going]] = False
        kept = np.flatnonzero(going)
        if not len(kept):
            return False
        rows, promised = rows[kept], promised[kept]
        last = promised <= self._tolerance
        tried = self._tried(rows, [models[k] for k in kept], [scales[k] for k in kept], last)
        unit = tried.unit.reshape(len(self._z), -1)
        offsets = tried.offsets.reshape(len(self._d), unit.shape[1], 6)
        costs = self._aim.cost(unit, offsets)
        values = (costs + self._aim.penalty(unit, offsets)).reshape(len(rows), -1)
        costs = costs.reshape(len(rows), -1)
        for i, row in enumerate(rows.tolist()):
            gain = self._taken(i, row, tried, costs[i], values[i])
            self._judged(row, gain, promised[i], last[i])
        return True

    def _around(self, rows: IntArray) -> list[Quadratic]:
        """The quadratic models: of derivatives taken here, or of the last ones where these predicted the step well."""
        for closely in (False, True):
            anew = rows[~self._told[rows] & (self._closely[rows] == closely)]
            if len(anew):
                made = self._aim.models(self._z[:, anew], self._d[:, anew], self._trusting, closely)
                self._models.update(zip(anew.tolist(), made, strict=True))
        again = rows[self._told[rows]]
        if len(again):
            offsets = self._d[:, again]
            residuals = self._aim.residuals(self._z[:, again], offsets)
            for k, row in enumerate(again.tolist()):
                self._models[row] = self._models[row].with_residuals(offsets[:, k], residuals[:, k])
        return [self._models[row] for row in rows.tolist()]

    def _tried(self, rows: IntArray, models: list[Quadratic], scales: list[FloatArray], last: BoolArray) -> _Tried:
        """Steps under some dampings from each of the starts ``rows``, bent ones too unless for all it is the last."""
        unit = np.empty((len(self._z), len(rows), 2, len(DAMPINGS)))
        offsets = np.empty((len(self._d), len(rows), 2, len(DAMPINGS), 6))
        for i, row in enumerate(rows):
            if last[i]:
                self._damping[row] = min(self._damping[row], 1e-3)
            for k, factor in enumerate(DAMPINGS):
                at, damping = models[i], self._damping[row] * factor
                if self._trusting and damping > FIRM_DAMPING:
                    at = at.damped(damping)
                nearby = unit[:, i, 0, k - 1] if k else None
                unit[:, i, 0, k], at = self._aim.towards(at, self._z[:, row], damping * scales[i], nearby)
                offsets[:, i, 0, k] = at.offsets(unit[:, i, 0, k] - self._z[:, row])
        if last.all():
            return _Tried(unit[:, :, :1], offsets[:, :, :1])
        tried = _Tried(unit, offsets)
        for closely in (False, True):
            if len(these := np.flatnonzero(self._closely[rows] == closely)):
                self._bent(closely, these, rows[these], [models[i] for i in these], tried)
        return tried

    def _bent(self, closely: bool, these: IntArray, rows: IntArray, models: list[Quadratic], tried: _Tried) -> None:
        """Write bent steps beside the straight ones of ``these`` of the starts tried, which are in ``rows``."""
        z, d, damping = self._z[:, rows], self._d[:, rows], self._damping[rows]
        base = [model.residuals for model in models]
        if not closely:
            base = list(self._aim.residuals(z, d, closely=False).T)
        step, shift = tried.unit[:, these, 0] - z[:, :, None], tried.offsets[:, these, 0] - d[:, :, None]
        near = (z[:, :, None] + SHARE_AHEAD * step).reshape(len(z), -1)
        moved = (d[:, :, None] + SHARE_AHEAD * shift).reshape(len(d), near.shape[1], 6)
        runs = self._aim.residuals(near, moved, closely)
        bends = _bends(runs.reshape(len(runs), *step.shape[1:]), base, models, damping, step, shift)
        tried.unit[:, these, 1], tried.offsets[:, these, 1] = tried.unit[:, these, 0], tried.offsets[:, these, 0]
        for i, k, bend, bend_shift in bends:
            row = these[i]
            tried.unit[:, row, 1, k] = np.clip(tried.unit[:, row, 0, k] + 0.5 * bend, 0.0, 1.0)
            tried.offsets[:, row, 1, k] = models[i].limited(tried.offsets[:, row, 0, k] + 0.5 * bend_shift)

    def _taken(self, i: int, row: int, tried: _Tried, costs: FloatArray, values: FloatArray) -> float:
        """Go to the best of the points tried if it is better, and choose the next damping; the gain."""
        self._iterations[row] += 1
        best = int(np.argmin(values))
        gain = float(self._value[row] - values[best])
        if not gain > 0.0:
            if self._closely[row]:
                self._damping[row] *= 1e3
            self._closely[row] = True
            return gain
        self._further[row] = max(self._further[row] - gain, 0.0)
        bent, k = divmod(best, len(DAMPINGS))
        self._z[:, row], self._d[:, row] = tried.unit[:, i, bent, k], tried.offsets[:, i, bent, k]
        self._J[row], self._value[row] = costs[best], values[best]
        self._damping[row] = min(max(self._damping[row] * DAMPINGS[k], 1e-12), 1e6)
        return gain

    def _judged(self, row: int, gain: float, promised: float, last: bool) -> None:
        """Whether a start has ended, by what its step gained."""
        foretold = gain > 0.0 and abs(gain - promised) <= PROMISE_TOLERANCE * promised
        self._told[row] = self._trusting and foretold and self._iterations[row] >= ITERATIONS_BEFORE_REUSE
        least = max(LEAST_FALL * self._value[row], self._tolerance)
        self._quiet[row] = self._quiet[row] + 1 if 0.0 < gain <= least else 0
        if last or abs(gain - promised) <= self._tolerance:
            self._converged[row], self._running[row] = True, False
        elif self._quiet[row] >= 2 or self._damping[row] > 1e8 or self._value[row] < 1e-24:
            if self._value[row] < self._last_stop[row] - least:
                # It may have been slow only because its damping was high: once more with a low one.
                self._last_stop[row], self._damping[row], self._quiet[row] = self._value[row], 1e-3, 0
            else:
                self._converged[row], self._running[row] = True, False


def _squares(residuals: FloatArray) -> FloatArray:
    """Sums over the first axis; inf where a run diverged."""
    with np.errstate(invalid="ignore", over="ignore"):
        found = np.einsum("ij,ij->j", residuals, residuals)
    return np.where(np.isfinite(found), found, np.inf)


def _bends(
    runs: FloatArray,
    base: Sequence[FloatArray],
    linear: Sequence[Quadratic],
    damping: FloatArray,
    step: FloatArray,
    shift: FloatArray,
) -> Iterator[tuple[int, int, FloatArray, FloatArray]]:
    """Bends of straight steps along the valley they start in: number of the start, and of the damping, the bend
    (n_targets,) and that of the offsets (n_cases, 6).

    runs    (n_residuals, n_starts, n_dampings) residuals at SHARE_AHEAD of the steps, and (n_residuals,) at the starts
    step    (n_targets, n_starts, n_dampings)
    shift   (n_cases, n_starts, n_dampings, 6) of the offsets

    Coefficients that nearly trade against each other make valleys long, narrow and curved.  The second derivative of
    the residuals along a step, from one more run at a tenth of it, gives the bend (geodesic acceleration: Transtrum &
    Sethna 2012, arXiv:1201.5885).  A bend that is no smaller than the step is not to be trusted and left out.
    """
    for i, at in enumerate(linear):
        if not np.isfinite(base[i]).all():  # another method diverged where the start is
            continue
        with np.errstate(invalid="ignore"):
            ahead = (runs[:, i] - base[i][:, None]) / SHARE_AHEAD
            curved = (2.0 / SHARE_AHEAD) * (ahead - at.slope(step[:, i], shift[:, i]))
        for k, factor in enumerate(DAMPINGS):
            if not np.isfinite(runs[:, i, k]).all():
                continue
            bend, bend_shift = at.bend(curved[:, k], damping[i] * factor, step[:, i, k] != 0.0)
            if np.linalg.norm(bend * at.scale) <= np.linalg.norm(2.0 * step[:, i, k] * at.scale):
                yield i, k, bend, bend_shift
