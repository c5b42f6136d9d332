"""What a long command would do, before it does it: the problem it would solve, and about how long that takes here."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..backends import WIDTH, get_ready_backend
from ..options import FitOptions, LeaveOutOptions, SweepOptions
from ..profile import ShipProfile
from ..run_files import DRAWN_UP, FIT, HISTORY, LEFT_OUT, MOTIONS, PROFILE, SWEEP
from ..threads import cores
from ..trial import TrialSet
from ..units import in_time
from .amounts import of_iteration
from .box import width_words
from .cmaes import LAMBDAS
from .extending import held_words, settled, tune_trials
from .leaving_out import leaving_out
from .problem import FitProblem
from .setting import in_pieces, make_problem

GENERATIONS = (150, 600)
"""Generations of a restart of CMA-ES, from few to many."""

ITERATIONS = (15, 60)
"""Iterations of least squares from one start, from few to many; each is a Jacobian and some trials."""

FIT_FILES = (FIT, PROFILE, HISTORY, MOTIONS, *DRAWN_UP)
LEFT_OUT_FILES = (LEFT_OUT, MOTIONS, *DRAWN_UP)


TRIED = 8 * WIDTH
"""Candidates that are run to see how long one takes."""

ROUGHLY = 2e-8
"""Time [s] a stage of a lane-step takes on a core, where it cannot be tried yet."""


@dataclass(frozen=True)
class Plan:
    """The plan of a command.

    lines    in words
    seconds  about how long it takes, from and to
    writes   the files it would write
    tried    whether evaluations were timed here; not where their simulator would have to be compiled first
    """

    lines: tuple[str, ...]
    seconds: tuple[float, float]
    writes: tuple[str, ...]
    tried: bool = True

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "schema": 1,
            "kind": "dry-run",
            "plan": list(self.lines),
            "seconds": list(self.seconds),
            "timed": self.tried,
            "writes": list(self.writes),
        }

    def __str__(self) -> str:
        """The lines, and the time."""
        low, high = (in_time(seconds) for seconds in self.seconds)
        first = "" if self.tried else ", once its simulator is compiled: 5 to 40 s, at the first run of such a model"
        return "\n".join([*self.lines, f"time      about {low} to {high} on this machine{first}"])


def plan_fit(profile: ShipGiven, trials: TrialsGiven, options: FitOptions) -> Plan:
    """What a fit would do.  Raises OptionError for what the fit would refuse."""
    trials = trials_of(trials)
    profile, options = settled(ship_of(profile), options, trials)
    pieces = in_pieces(trials, options)
    problem = make_problem(profile, pieces, options)
    search = f"{options.method}, seed {options.seed}, {options.starts} least-squares starts"
    lines = [*whole(profile, pieces, search, options), *_problem(problem, options)]
    return Plan(tuple(lines), fit_seconds(problem, options), FIT_FILES, can_be_tried(problem))


def plan_sweep(profile: ShipGiven, trials: TrialsGiven, options: SweepOptions) -> Plan:
    """What a sweep would do, with the box of its narrowest fit.  Raises OptionError for what it would refuse."""
    trials = trials_of(trials)
    profile, options = settled(ship_of(profile), options, trials)
    pieces = in_pieces(trials, options)
    widths = sorted(options.widths)
    problems = [make_problem(profile, pieces, options.at(a_r)) for a_r in widths]
    one = plan_fit(profile, pieces, options.at(widths[0]))
    low, high = fit_seconds(problems[0], options.at(widths[0]))
    lines = (f"sweep     over a_r = {', '.join(f'{a_r:g}' for a_r in widths)}; the first:", *one.lines)
    files = (SWEEP, "a folder for each a_r", *DRAWN_UP)
    return Plan(lines, (len(widths) * low, len(widths) * high), files, one.tried)


def plan_leave_out(profile: ShipGiven, trials: TrialsGiven, options: LeaveOutOptions) -> Plan:
    """What leaving runs out would do.  Raises OptionError for what it would refuse."""
    trials = trials_of(trials)
    profile, options = settled(ship_of(profile), options, trials)
    own = options.fit_options()
    pieces = in_pieces(trials, own)
    problem = make_problem(profile, pieces, own)
    parts = sum(1 for _ in leaving_out(pieces, options.folds))
    search = f"{parts} fits by least-squares, after one to all runs from {own.starts} starts, seed {own.seed}"
    lines = [*whole(profile, pieces, search, own), *_problem(problem, own)]
    low, high = fit_seconds(problem, own)
    share = 1.0 + parts / own.starts
    return Plan(tuple(lines), (share * low, share * high), LEFT_OUT_FILES, can_be_tried(problem))


def whole(profile: ShipProfile, trials: TrialSet, search: str, options: FitOptions) -> list[str]:
    """Profile, trials and choices in lines."""
    tune, test = (*trials.tune, *trials.tune_stated), (*trials.test, *trials.test_stated)
    return [
        f"profile   {profile.name} ({profile.path})",
        f"trials    tune: {', '.join(tune)}; test: {', '.join(test) or 'none'} ({trials.path})",
        *(f"stated    {one.id}: {one.order}; {', '.join(one.indices)}" for one in trials.stated.values()),
        f"search    {search}",
        f"runs      {options.integrator}, initial states {options.initial}",
        *(f"held      {words}" for words in held_words(profile, options, tune_trials(trials))),
    ]


def _problem(problem: FitProblem, options: FitOptions) -> list[str]:
    low, high = problem.box.limits
    pre = problem.box.pre
    prior = any(term.known_before for term in problem.terms)

    def by(i: int) -> str:
        formula = problem.box.prior_of(i) if prior else None
        return f"  prior {formula[0]:.5g} +- {formula[1]:.2g}" if formula else ""

    return [
        f"compares  {problem.n_residuals} differences over {problem.cases.steps} steps; back end {options.backend}",
        *([f"prior     {len(problem.box.from_formula)} targets by the scatter of their formulas"] if prior else []),
        f"targets   within {width_words(options.a_r)} of their values:",
        *(
            f"  {name:<22}{low[i]:>12.5g} .. {pre[i]:>10.5g} .. {high[i]:<10.5g}{by(i)}".rstrip()
            for i, name in enumerate(problem.box.names)
        ),
    ]


def fit_seconds(problem: FitProblem, options: FitOptions) -> tuple[float, float]:
    """About how long a fit of the problem takes [s], from and to: what it may evaluate, timed here."""
    by_start = [n * of_iteration(problem) for n in ITERATIONS]
    work = [options.starts * n for n in by_start]
    if options.method == "cma-es":
        work = [n + g * sum(LAMBDAS) for n, g in zip(work, GENERATIONS, strict=True)]
    each = evaluation_seconds(problem)
    return work[0] * each, work[1] * each


def can_be_tried(problem: FitProblem) -> bool:
    """Whether an evaluation needs nothing compiled first."""
    return problem.backend.name != "compiled" or get_ready_backend(problem.model) is not None


def evaluation_seconds(problem: FitProblem) -> float:
    """How long one evaluation of all trials takes [s], among many at once; roughly where it cannot be tried."""
    if not can_be_tried(problem):
        stages = problem.cases.steps * len(problem.integrator.tableau[0]) * problem.integrator.substeps
        return ROUGHLY * stages / cores()
    middle = np.repeat(problem.box.to_unit(problem.box.pre)[:, None], TRIED, axis=1)
    problem.costs(middle[:, :1])  # read before it is timed
    began = time.perf_counter()
    problem.costs(middle)
    return (time.perf_counter() - began) / TRIED
