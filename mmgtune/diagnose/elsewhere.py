"""What differs between runs, estimated for runs that were held out.

A current of one day says nothing of the next.  A held-out run shows its own current in its first part; the rest of the
run is then a test.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import IntArray
from ..fitting.box import AT, base_of, group_of
from ..fitting.least_squares import solve
from ..fitting.problem import FitProblem
from ..model import Model
from ..objective import cases_of
from ..trial import Trial
from .runs import groups_of, labels_of, spread_key
from .workbench import LOOSE, Point, Workbench

FIRST = 0.4
"""Share of a held-out run on which run-specific parameters are estimated."""


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
    expected = np.diag([1.0 / point.spreads[spread_key(name)] for name in names])
    (end,) = solve(problem, mean[:, None], max_iterations=20, whiten=noise.apply, beliefs=(expected, mean))
    return replace(point, names=(*point.names, *names), unit=np.concatenate([point.unit, end.unit]))
