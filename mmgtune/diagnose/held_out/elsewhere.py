"""What differs between runs, estimated for runs that were held out.

A current of one day says nothing of the next.  A held-out run shows its own current in its first part; the rest of the
run is then a test.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from ...arrays import FloatArray, IntArray
from ...fitting.box import AT, base_of, group_of
from ...fitting.least_squares import LeastSquaresResult, solve, squares_by_case
from ...fitting.problem import FitProblem
from ...model import Model
from ...objective import cases_of
from ...trial import Trial
from ..bench.runs import groups_of, labels_of, spread_key
from ..bench.workbench import LOOSE, Point, Workbench
from ..searching.base_fit import PRECISE

FIRST = 0.4
"""Share of a held-out run on which run-specific parameters are estimated."""

BESIDE = 1.5
"""Spreads beside the mean at which fits of run-specific parameters also begin."""


def unknown(point: Point, trials: Sequence[Trial]) -> tuple[str, ...]:
    """Run-specific parameters that ``point`` lacks for these trials."""
    keys = dict.fromkeys((base_of(name), group_of(name).partition(":")[0]) for name in point.names if group_of(name))
    bases: dict[str, list[str]] = {}
    for base, by in keys:
        bases.setdefault(by, []).append(base)
    wanted = (f"{base}{AT}{by}:{groups_of(trial)[by]}" for by, of in bases.items() for trial in trials for base in of)
    return tuple(name for name in dict.fromkeys(wanted) if name not in point.names)


def first_part(point: Point, trials: Sequence[Trial]) -> IntArray:
    """(n_trials,) samples of each trial on which run-specific parameters are estimated, 0 where there are none."""
    groups = {group_of(name) for name in unknown(point, trials)}
    return np.array([int(FIRST * trial.n_samples) if groups & labels_of(trial) else 0 for trial in trials])


def estimated_there(bench: Workbench, point: Point, trials: Sequence[Trial]) -> Point:
    """The point with run-specific parameters estimated for these trials, from the first part of each.

    Values are expected about the mean of those of the other runs, with the spread of these.
    """
    names = unknown(point, trials)
    if not names:
        return point
    own = bench.model
    cases = cases_of(list(trials), bench.in_noise, own.inputs, own.draught)
    weight = cases.weight.copy()
    for case, end in enumerate(first_part(point, trials)):
        weight[case, max(end, 2) :] = 0.0
    sigma = np.repeat(LOOSE * bench.sigma[None], len(trials), axis=0)
    problem = FitProblem.of(
        Model(bench.tuned(point)),
        replace(cases, weight=weight),
        bench.sub_box(names),
        bench.problem.backend,
        point.integrator,
        sigma,
    ).with_groups([labels_of(trial) for trial in trials])
    noise = replace(bench.noise, cases=problem.cases)
    known: dict[str, list[float]] = {}
    for name, z in zip(point.names, point.unit, strict=True):
        if group_of(name):
            known.setdefault(spread_key(name), []).append(float(z))
    mean = np.array([np.mean(known[spread_key(name)]) for name in names])
    spread = np.array([point.spreads[spread_key(name)] for name in names])
    starts = np.clip(mean[:, None] + spread[:, None] * _around(names), 0.0, 1.0)
    beliefs = np.diag(1.0 / spread), mean
    ends = solve(
        problem,
        starts,
        max_iterations=20,
        whiten=noise.apply,
        tolerance=PRECISE,
        beliefs=beliefs,
        trusting=True,
        slopes=bench.slopes,
    )
    unit = _best_of_each(problem, names, ends, noise.apply, beliefs)
    return replace(point, names=(*point.names, *names), unit=np.concatenate([point.unit, unit]))


def _around(names: Sequence[str]) -> FloatArray:
    """(n_names, n_starts) where fits of values of runs begin, in spreads from the mean: there, and beside it in every
    direction, as a wind that only some runs had is far from the mean of all and a fit may stay on this side of calm.

    Two parameters of each run at a time, as directions have two: all at once would be twice as many starts for each.
    """
    bases = list(dict.fromkeys(base_of(name) for name in names))
    starts = [np.zeros(len(bases))]
    for pair in (slice(k, k + 2) for k in range(0, len(bases), 2)):
        for signs in product((-BESIDE, BESIDE), repeat=len(bases[pair])):
            starts.append(np.zeros(len(bases)))
            starts[-1][pair] = signs
    return np.array(starts)[:, [bases.index(base_of(name)) for name in names]].T


def _best_of_each(
    problem: FitProblem,
    names: Sequence[str],
    ends: Sequence[LeastSquaresResult],
    whiten: Callable[[FloatArray], FloatArray],
    beliefs: tuple[FloatArray, FloatArray],
) -> FloatArray:
    """(n_names,) the values of each group from the fit that ended best on its runs: no two groups share any."""
    rows, centre = beliefs
    unit = np.array([end.unit for end in ends])
    left = np.array([squares_by_case(problem, end.unit, end.offsets, whiten) for end in ends])
    left += np.array([np.sum(problem.prior * end.offsets**2, axis=1) for end in ends])
    unlike = np.array([(rows @ (one - centre)) ** 2 for one in unit])
    best: FloatArray = unit[0].copy()
    for group in dict.fromkeys(map(group_of, names)):
        own = [k for k, name in enumerate(names) if group_of(name) == group]
        cases = [k for k, labels in enumerate(problem.groups) if group in labels]
        cost = left[:, cases].sum(axis=1) + unlike[:, own].sum(axis=1)
        best[own] = unit[int(np.argmin(np.nan_to_num(cost, nan=np.inf))), own]
    return best
