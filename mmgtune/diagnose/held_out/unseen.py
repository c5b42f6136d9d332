"""Fitted points on trials that they were not fitted to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ...arrays import FloatArray, IntArray
from ...fitting.box import group_of
from ...fitting.comparison import TrialComparison, compare
from ...fitting.journal import side_by_side
from ...fitting.problem import FitProblem
from ...objective import Objective, cases_of, make_objective
from ...trial import Coverage, Trial
from ..bench.runs import labels_of
from ..bench.workbench import Point, Workbench, make_workbench
from ..searching.base_fit import hardly_noticed
from .elsewhere import estimated_there, first_part


@dataclass(frozen=True, eq=False)
class Unseen:
    """The trials that fitted points are judged by: those kept for testing, or each run in turn with everything refitted
    without it.

    bench    what the points were fitted on; what it knows of noise and inputs is settled
    test     trials kept for testing
    without  the workbench without a run, by run; made when asked for
    """

    bench: Workbench
    test: Sequence[Trial]
    without: dict[str, _Without] = field(default_factory=dict)

    def fits(self, points: Sequence[Point]) -> Iterator[tuple[list[Point], list[Trial]]]:
        """Fitted points with trials they were not fitted to.  Where there is but one run, that run."""
        runs = list(dict.fromkeys(trial.run for trial in self.bench.trials))
        if self.test or len(runs) < 2:
            yield list(points), list(self.test or self.bench.trials)
            return
        for run in runs:
            if run not in self.without:
                self.without[run] = _Without.of(self.bench, run)
        refitted = side_by_side([partial(self.without[run].refitted, points) for run in runs])
        for run, found in zip(runs, refitted, strict=True):
            yield found, [trial for trial in self.bench.trials if trial.run == run]


@dataclass(frozen=True, eq=False)
class _Without:
    """The workbench of all runs but one.

    whole  the workbench of all runs; rest: that of the others; keep: its trials, by number in the whole one
    known  points and their refits, by identity of the point: causes are set aside one by one, and points recur
    """

    whole: Workbench
    rest: Workbench
    keep: list[int]
    known: dict[int, tuple[Point, Point]] = field(default_factory=dict)

    @classmethod
    def of(cls, bench: Workbench, run: str) -> _Without:
        coverage = Coverage.of(bench.trials, bench.model.L_pp)  # what is left may turn to one side alone
        keep = [i for i, trial in enumerate(bench.trials) if trial.run != run]
        names = [name for name in bench.box.names if name not in (*bench.targets, *bench.believed.leeway)]
        rest = make_workbench(bench.model.profile, [bench.trials[i] for i in keep], bench.options, names, coverage)
        rest.targets, rest.believed, rest.slopes, rest.stop = bench.targets, bench.believed, bench.slopes, bench.stop
        rest.know(replace(bench.noise, cases=rest.problem.cases))
        return cls(bench, rest, keep)

    def refitted(self, points: Sequence[Point]) -> list[Point]:
        """Points refitted on the trials that are left, without values of runs that are not among them."""
        return [self._refitted(point) for point in points]

    def _refitted(self, point: Point) -> Point:
        if id(point) not in self.known:
            labels = frozenset[str]().union(*self.rest.problem.groups)
            own = [i for i, name in enumerate(point.names) if not group_of(name) or group_of(name) in labels]
            names, start = [point.names[i] for i in own], point.unit[own][:, None]
            refitted = self.rest.refit(
                names,
                start,
                point.offsets[self.keep],
                integrator=point.integrator,
                tolerance=hardly_noticed(self.whole, point.chi2),
                spreads=point.spreads,
            )
            self.known[id(point)] = point, refitted
        return self.known[id(point)][1]


@dataclass(frozen=True, eq=False)
class Beside:
    """Points side by side on trials, each with what differs between runs estimated there.

    begins   (n_trials,) samples of each trial that something is estimated on
    wide     a point whose names are those of all
    units    the position of each point in it
    scaled   the problem in white noise of the sensors, all samples counting
    """

    bench: Workbench
    trials: tuple[Trial, ...]
    begins: IntArray
    wide: Point
    units: list[FloatArray]
    scaled: FitProblem

    @classmethod
    def of(cls, bench: Workbench, points: Sequence[Point], trials: Sequence[Trial]) -> Beside:
        """Fitted points on the trials; the last point says which parameters are run-specific."""
        wide, units = _together(bench, [estimated_there(bench, point, trials) for point in points])
        scaled = problem_on(bench, wide, trials, bench.in_noise)
        return cls(bench, tuple(trials), first_part(points[-1], trials), wide, units, scaled)

    @property
    def judged(self) -> FitProblem:
        """The problem with zero weight on the samples that run-specific parameters are estimated on."""
        weight = self.scaled.cases.weight.copy()
        for case, begin in enumerate(self.begins):
            weight[case, :begin] = 0.0
        return self.scaled.with_cases(replace(self.scaled.cases, weight=weight))

    def compared(self) -> list[TrialComparison]:
        """Each trial "before" and "after" by the last two points, initial states estimated; by the objective of the
        paper."""
        by_paper = make_objective(self.bench.model.L_pp)
        roles = dict.fromkeys((trial.id for trial in self.trials), "test")
        found: list[TrialComparison] = []
        apart = self.scaled.grouped  # coefficients are of each trial then
        for some in [[trial] for trial in self.trials] if apart else [list(self.trials)]:
            problem = problem_on(self.bench, self.wide, some, by_paper)
            found += compare(problem, some, by_paper, roles, *self.units[-2:])
        return found


def problem_on(bench: Workbench, point: Point, trials: Sequence[Trial], objective: Objective) -> FitProblem:
    """The problem of what is free in a point, on other trials."""
    own = bench.problem_of(point.names, point.integrator)
    sigma = np.repeat(bench.sigma[None], len(trials), axis=0)
    cases = cases_of(list(trials), objective, own.model.inputs, own.model.draught)
    problem = FitProblem.of(own.model, cases, own.box, own.backend, own.integrator, sigma)
    return problem.with_groups([labels_of(trial) for trial in trials])


def _together(bench: Workbench, points: Sequence[Point]) -> tuple[Point, list[FloatArray]]:
    """A point whose names are those of all, what is not free in one at its null, and the positions of each in it."""
    names = tuple(dict.fromkeys(name for point in points for name in point.names))
    last = points[-1]
    wide = Point(names, bench.null(names), last.offsets, last.chi2, last.integrator)
    units = []
    for point in points:
        unit = wide.unit.copy()
        unit[[names.index(name) for name in point.names]] = point.unit
        units.append(unit)
    return wide, units
