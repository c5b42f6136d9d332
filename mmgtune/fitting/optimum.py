"""The optimum of a problem in its box: least squares from several starts, robust weights, CMA-ES if asked."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..hooks import Hooks
from ..options import FitOptions
from .amounts import telling
from .checkpoint import EVERY, Checkpoint
from .cmaes import Search, search
from .least_squares import LeastSquaresResult, solve
from .problem import FitProblem
from .robust import weigh_down

EDGE = 0.5
"""Distance from the middle of the box to its edge, in the unit cube."""

RIDGE = 1e-8
"""Weight, as a share of J, of the distance to the pre-determined values: chooses among sets that fit equally well."""

EXACT = 1e-8
"""Squared tolerances of stated indices that count as none: they can be met to the last bit, which is worth nothing."""

LOOSE = 1e-3
"""Ridge where indices are stated, in squared tolerances: a few numbers are met exactly by many sets."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """What a search came to.

    problem  with the initial states and weights that were found
    unit     (n_targets,) in the unit cube; cost: there
    ends     of least squares, from each start
    ridge    weight of squared distances from the pre-determined values
    cma_es   result of CMA-ES, None where it was not asked for
    """

    problem: FitProblem
    unit: FloatArray
    cost: float
    ends: list[LeastSquaresResult]
    ridge: float
    cma_es: Search | None


@dataclass(frozen=True, eq=False)
class Seeking:
    """A search that can begin.

    before      (n_targets,) pre-determined values in the unit cube; cost_before: there
    require     raises where the simulation of a trial runs away at (n_targets,) of a problem
    checkpoint  of CMA-ES, None for nowhere; recorded: costs of its generations that an earlier run has noted
    """

    problem: FitProblem
    options: FitOptions
    before: FloatArray
    cost_before: float
    require: Callable[[FitProblem, FloatArray], None]
    hooks: Hooks
    checkpoint: Checkpoint | None
    recorded: list[FloatArray] | None

    def optimum(self, more_starts: tuple[Mapping[str, float], ...]) -> Optimum:
        """Seek the optimum.  Raises ProfileError where the simulation runs away wherever the targets are."""
        hooks = self.hooks
        hooks.on_phase("least squares")
        ridge = edge_ridge(self.problem, self.options, self.before)
        ends = self._from_starts(more_starts, ridge)
        best = min(ends, key=lambda end: end.J + ridge * float(np.sum((end.unit - self.before) ** 2)))
        problem = self.problem.with_offsets(best.offsets)
        if self.options.loss == "huber" and not hooks.stop():
            self.require(problem, best.unit)
            hooks.on_phase("weighing outliers down")
            problem, best = weigh_down(problem, best, ridge, self.before)
            ends = [best]
        found: Search | None = None
        if self.options.method == "cma-es":
            hooks.on_phase("CMA-ES")
            found = self._by_cma_es(problem, best.J)
            if not hooks.stop():
                ends += solve(problem, found.unit[:, None], stop=hooks.stop)
                best = min(ends, key=lambda end: end.J)
        if not np.isfinite(best.J):
            self.require(problem, best.unit)
        if not hooks.stop() and ridge == 0.0:
            best = _nearest(problem, best, self.before)
        unit, cost = best.unit, best.J
        if found is not None and cost > found.J:
            unit, cost = found.unit, found.J
        return Optimum(problem.with_offsets(best.offsets), unit, cost, ends, ridge, found)

    def _from_starts(self, more: tuple[Mapping[str, float], ...], ridge: float) -> list[LeastSquaresResult]:
        problem = self.problem
        starts = random_starts(problem, self.options, self.before, more)
        first = [] if problem.sigma is None else [problem.from_measured()]
        stop = telling([*first, problem], starts.shape[1], self.hooks)
        for nearer in first:  # far from an optimum, free initial states only lead astray
            starts = np.column_stack([end.unit for end in solve(nearer, starts, stop=stop)])
        exact = 0.0 if all(term.known_before for term in problem.terms) else EXACT * problem.weight
        return solve(problem, starts, ridge=ridge, anchor=self.before, stop=stop, tolerance=exact)

    def _by_cma_es(self, problem: FitProblem, best: float) -> Search:
        """CMA-ES with checkpoints: every few generations, and when it ends for whatever reason."""
        checkpoint, hooks = self.checkpoint, self.hooks

        def on_generation(state: Search) -> None:
            if checkpoint and len(state.costs) % EVERY == 0:
                checkpoint.save(state.costs)
            hooks.on_generation(state)

        found = search(
            problem,
            self.options.seed,
            np.clip(self.before, 0.0, 1.0),
            # Far below the tolerance of the certificate; least squares goes on from where the search ends.
            tolerance=max(1e-9 * self.cost_before, 1e-5 * best),
            recorded=self.recorded,
            on_generation=on_generation,
            stop=hooks.stop,
        )
        if checkpoint:
            checkpoint.save(found.costs)
        return found


def edge_ridge(problem: FitProblem, options: FitOptions, before: FloatArray) -> float:
    """Weight of squared distances from the pre-determined values (n_targets,) in the cube, of a weighed problem."""
    asked = options.regularise * float(problem.misfit(before[:, None])[0]) / EDGE**2 if options.regularise else 0.0
    series_alone = all(term.known_before for term in problem.terms)
    return asked if series_alone else max(asked, LOOSE * problem.weight)


def random_starts(
    problem: FitProblem, options: FitOptions, before: FloatArray, more: tuple[Mapping[str, float], ...]
) -> FloatArray:
    """Where least squares starts, (n_targets, n_starts): pre-determined values, those given, the rest at random."""
    box = problem.box
    rng = np.random.default_rng(options.seed)
    starts = [before]
    starts += [box.to_unit([values.get(name, box.pre[i]) for i, name in enumerate(box.names)]) for values in more]
    starts += [rng.uniform(size=len(box)) for _ in range(max(0, options.starts - len(starts)))]
    return np.clip(np.column_stack(starts), 0.0, 1.0)


def _nearest(problem: FitProblem, best: LeastSquaresResult, before: FloatArray) -> LeastSquaresResult:
    """Of all sets that fit as well as ``best``, the one nearest to the pre-determined values."""
    moved = solve(problem, best.unit[:, None], ridge=RIDGE * best.J, anchor=before)[0]
    return moved if moved.J <= best.J * (1.0 + 1e-7) else best
