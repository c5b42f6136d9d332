"""A fit from beginning to end: search, polish, certificate, identifiability, comparison on every trial."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES, Backend, Integrator, get_backend
from ..errors import OptionError, Problem
from ..files import path_of
from ..given import ShipGiven, TrialsGiven, ship_of, trials_of
from ..hooks import Hooks
from ..model import Model
from ..objective import Objective, cases_of, make_objective, spread
from ..options import FitOptions, Options, TuningOptions
from ..options.choice import must_be
from ..profile import ShipProfile
from ..provenance import made_by as made_by
from ..stated import IndexComparison, compare_stated, possible
from ..threads import blas_on_one_thread
from ..trial import Coverage, Trial, TrialSet, oddities
from .box import Box, choose_targets, make_box
from .certificate import certify
from .checkpoint import EVERY, Checkpoint
from .cmaes import Search, search
from .comparison import compare, total
from .extending import settled
from .identifiability import analyse
from .initial import deviations
from .journal import journalled
from .least_squares import LeastSquaresResult, fit_offsets, solve
from .lost import hold_simulated
from .one_sided import tied
from .pooled import Pooled, SistersPrior, pooled, read_sisters, with_sisters
from .problem import FitProblem
from .result import Beside, FitResult
from .robust import weigh_down
from .terms import ScatterPrior, StatedIndices, Term
from .weighing import Weight, weigh

EDGE = 0.5
"""Distance from the middle of the box to its edge, in the unit cube."""

RIDGE = 1e-8
"""Weight, as a share of J, of the distance to the pre-determined values: chooses among sets that fit equally well."""


EXACT = 1e-8
"""Squared tolerances of stated indices that count as none: they can be met to the last bit, which is worth nothing."""

LOOSE = 1e-3
"""The same where indices are stated, in squared tolerances: a few numbers are met exactly by many sets."""


def in_pieces(trials: TrialSet, options: TuningOptions) -> TrialSet:
    """The trials cut into windows where the options ask for that; unchanged where they are windows already."""
    if options.restart is None or any(trial.part_of for trial in trials.trials.values()):
        return trials
    return trials.in_windows(options.restart, options.every)


@dataclass(frozen=True, eq=False)
class Setting:
    """What all problems of one fit have in common.

    estimated  whether trials start from an estimated state
    terms      what is made small besides J
    sisters    what sister ships say beforehand, None where they are not asked
    """

    model: Model
    trials: TrialSet
    objective: Objective
    box: Box
    a_r: float | None
    backend: Backend
    integrator: Integrator
    estimated: bool
    terms: tuple[Term, ...] = ()
    sisters: Pooled | None = None

    def holding(self, names: Sequence[str]) -> Setting:
        """The same with some targets held at their pre-determined values."""
        left = [name for name in self.box.names if name not in names]
        return replace(self, box=boxed(self.model, left, self.a_r, self.sisters))

    def problem(self, ids: Sequence[str] | None = None) -> FitProblem:
        """The problem of fitting the tune trials, or the trials ``ids``.

        Raises OptionError where the window leaves one without a sample.
        """
        if ids is None:
            ids = (*self.trials.tune, *self.trials.tune_stated)
        chosen = [self.trials.trials[name] for name in ids if name in self.trials.trials]
        stated = [self.trials.stated[name] for name in ids if name in self.trials.stated]
        terms = (*self.terms, StatedIndices(stated)) if stated else self.terms
        cases = cases_of(chosen, self.objective, self.model.inputs, self.model.draught)
        sigma = self.deviations(ids) if self.estimated and chosen else None
        return FitProblem.of(self.model, cases, self.box, self.backend, self.integrator, sigma, terms)

    def deviations(self, ids: Sequence[str] | None = None) -> FloatArray:
        """Deviations (n_trials, 6) of the measured initial states."""
        scales = np.array([self.objective.scales[name] for name in STATES])
        ids = self.trials.tune if ids is None else ids
        return deviations([self.trials.trials[name] for name in ids if name in self.trials.trials], scales)


def make_setting(profile: ShipProfile, trials: TrialSet, options: FitOptions) -> Setting:
    """The setting of fitting ``profile`` to trials.

    Raises OptionError for targets, box or channels that make no sense, and for stated trials the ship cannot be asked
    for.
    """
    coverage = Coverage.of([trials.trials[name] for name in trials.tune], profile.L_pp)
    names = choose_targets(Model(profile), options.targets, options.fixed)
    names, ties = (names, ()) if trials.tune_stated else tied(profile, names, coverage)
    model = Model(profile, ties)
    possible(profile, list(trials.stated.values()))
    if trials.tune_stated and options.method == "cma-es":
        why = "a few numbers leave many sets that fit alike, of which this search takes any"
        raise OptionError(
            Problem("CMA-ES is not for trials given as indices", "method", why, "add method=least-squares")
        )
    # Scales come from all tune trials, whichever of them a problem is over.
    standardised = options.objective == "standardised" and trials.tune
    scales = spread([trials.trials[name] for name in trials.tune]) if standardised else None
    objective = make_objective(model.L_pp, options.channels, options.window, scales=scales, every=options.every)
    sisters = None
    if options.sisters is not None:  # her own trials count once
        sisters = pooled(read_sisters(options.sisters, profile.id).without(profile.id).without(trials.ship))
    box = boxed(model, names, options.a_r, sisters)
    prior = ScatterPrior() if sisters is None else SistersPrior()
    return Setting(
        model,
        trials,
        objective,
        box,
        options.a_r,
        get_backend(options.backend),
        options.make_integrator(),
        options.initial == "estimated",
        (prior,) if options.prior and len(box.from_formula) else (),
        sisters,
    )


def boxed(model: Model, names: Sequence[str], a_r: float | None, sisters: Pooled | None) -> Box:
    """The box of targets, with what sister ships say of them."""
    box = make_box(model, names, a_r)
    return box if sisters is None else with_sisters(box, sisters)


def make_problem(
    profile: ShipProfile, trials: TrialSet, options: FitOptions, ids: Sequence[str] | None = None
) -> FitProblem:
    """The problem of fitting ``profile`` to the tune trials, or to the trials ``ids``.

    Raises OptionError for targets, box, channels or window that make no sense.
    """
    return make_setting(profile, trials, options).problem(ids)


@blas_on_one_thread
def fit(
    profile: ShipGiven,
    trials: TrialsGiven,
    options: FitOptions = FitOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | str | None = None,
    resume: bool = False,
    more_starts: tuple[Mapping[str, float], ...] = (),
    command: str = "",
) -> FitResult:
    """Fine-tune the targets of ``profile`` within their box to the tune trials, and look at the test trials.

    profile, trials  objects, paths or bundled names
    hooks        what is told on the way, and what ends it: see ``until_interrupted`` for Ctrl-C
    folder       where the fit saves its state; None for nowhere
    resume       continue the fit saved there
    more_starts  coefficient sets to start least squares from besides, such as the optimum of a smaller box
    command      what to call this fit in its provenance
    Raises OptionError for choices that make no sense, OutputError where the checkpoint cannot be written, ProfileError
    where the simulation of a tune trial runs away wherever the targets are.
    """
    folder = None if folder is None else path_of(folder)
    must_be(options, FitOptions)
    profile, trials = ship_of(profile), trials_of(trials)
    profile, options = settled(profile, options, trials)
    provenance = make_provenance(profile, trials, command)
    if folder is None:
        return _fit(profile, trials, options, hooks, None, resume, more_starts, provenance)
    identity = identity_of(profile, trials, options, provenance)
    if options.sisters is not None:
        identity["sisters"] = read_sisters(options.sisters, profile.id).sha256
    checkpoint = Checkpoint(folder, identity)
    if resume and checkpoint.path.is_file():
        checkpoint.load()  # says first what is wrong with the larger part
    with journalled(folder, identity, hooks.stop, resume=resume):
        return _fit(profile, trials, options, hooks, checkpoint, resume, more_starts, provenance)


def _fit(
    profile: ShipProfile,
    trials: TrialSet,
    options: FitOptions,
    hooks: Hooks,
    checkpoint: Checkpoint | None,
    resume: bool,
    more_starts: tuple[Mapping[str, float], ...],
    provenance: dict[str, Any],
) -> FitResult:
    began = time.perf_counter()
    odd = oddities(trials.trials, profile.L_pp)
    trials = in_pieces(trials, options)
    setting = make_setting(profile, trials, options)
    problem = setting.problem()
    if options.identifiable:
        held = traded(profile, trials, problem)
        options = replace(options, fixed=(*options.fixed, *held), identifiable=False)
        setting = setting.holding(held)
        problem = problem.with_targets(setting.model, setting.box)
    plain = problem
    recorded = checkpoint.load() if checkpoint and resume and checkpoint.path.is_file() else None
    before = problem.box.to_unit(problem.box.pre)
    if problem.terms:
        hooks.on_phase("weighing what is known beforehand")
    problem, weight = weigh(problem, np.clip(before, 0.0, 1.0), hooks.stop)
    J_before = float(problem.misfit(before[:, None])[0])
    cost_before = float(problem.costs(before[:, None])[0]) if problem.terms else J_before

    hooks.on_phase("least squares")
    starts = random_starts(problem, options, before, more_starts)
    if problem.sigma is not None:  # far from an optimum, free initial states only lead astray
        starts = np.column_stack([end.unit for end in solve(problem.held(), starts, stop=hooks.stop)])
    ridge = edge_ridge(problem, options, before)
    exact = 0.0 if all(term.known_before for term in problem.terms) else EXACT * problem.weight
    ends = solve(problem, starts, ridge=ridge, anchor=before, stop=hooks.stop, tolerance=exact)
    best = min(ends, key=lambda end: end.J + ridge * float(np.sum((end.unit - before) ** 2)))
    problem = problem.with_offsets(best.offsets)
    if options.loss == "huber" and not hooks.stop():
        hold_simulated(profile, problem, best.unit, _tuned_on(trials))
        hooks.on_phase("weighing outliers down")
        problem, best = weigh_down(problem, best, ridge, before)
        ends = [best]
    found: Search | None = None
    if options.method == "cma-es":
        hooks.on_phase("CMA-ES")
        # Far below the tolerance of the certificate; least squares goes on from where the search ends.
        tolerance = max(1e-9 * cost_before, 1e-5 * best.J)
        found = _search(problem, options, np.clip(before, 0.0, 1.0), tolerance, hooks, checkpoint, recorded)
        if not hooks.stop():
            ends += solve(problem, found.unit[:, None], stop=hooks.stop)
            best = min(ends, key=lambda end: end.J)
    if not np.isfinite(best.J):
        hold_simulated(profile, problem, best.unit, _tuned_on(trials))
    if not hooks.stop() and ridge == 0.0:
        best = _nearest(problem, best, before)
    unit, cost = best.unit, best.J
    problem = problem.with_offsets(best.offsets)
    if found is not None and cost > found.J:
        unit, cost = found.unit, found.J
    J = float(problem.misfit(unit[:, None])[0]) if problem.terms else cost

    hooks.on_phase("certificate and identifiability")
    restarts = found.restarts if found else []
    certificate = certify(problem, unit, cost, cost_before, ends, restarts, found.J if found else None, ridge, before)
    held_by_bound = np.isin(problem.box.names, [bound.name for bound in certificate.active])
    roles = {name: trials.role(name) for name in (*trials.trials, *trials.stated)}
    everything = setting.problem(tuple(trials.trials)) if trials.trials else plain
    compared = tuple(compare(everything, list(trials.trials.values()), setting.objective, roles, before, unit))
    free_start = (
        None if setting.estimated or not trials.tune else J_free_start(plain.estimated(setting.deviations()), unit)
    )
    return FitResult(
        profile=profile,
        options=options,
        box=problem.box,
        unit=unit,
        J=J if options.loss == "squares" else float(total(compared, "tune", "after") or J),
        J_before=J_before,
        J_free_start=free_start,
        beside=beside(problem, before, unit, weight) if weight else None,
        compared=compared,
        stated=compared_stated(setting, roles, before, unit),
        restarts=tuple(restarts),
        starts=tuple(ends),
        history=tuple(found.history if found else ()),
        certificate=certificate,
        identifiability=analyse(problem, unit, held_by_bound),
        evaluations=problem.evaluations,
        diverged=found.diverged if found else 0,
        wall_s=time.perf_counter() - began,
        held=tuple(options.fixed),
        ties=setting.model.ties,
        scales=setting.objective.scales,
        channels=setting.objective.channels,
        provenance=provenance,
        interrupted=hooks.stop(),
        oddities=tuple(odd),
    )


def _tuned_on(trials: TrialSet) -> list[Trial]:
    """Tune trials that have a motion, a case of the problem each."""
    return [trials.trials[name] for name in trials.tune if name in trials.trials]


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


def J_free_start(problem: FitProblem, unit: FloatArray) -> float:
    """J of coefficients (n_targets,) if each trial started from the state that fits best within its noise."""
    return float(problem.misfit(unit[:, None], fit_offsets(problem, unit)[:, None])[0])


def beside(problem: FitProblem, before: FloatArray, unit: FloatArray, weight: Weight) -> Beside:
    """What the terms of a weighed problem come to at two points (n_targets,) of the unit cube."""
    squares = {
        name: (float(of[0]), float(of[1])) for name, of in problem.squares(np.column_stack([before, unit])).items()
    }
    return Beside(weight, squares, {term.name: term.sentence for term in problem.terms})


def compared_stated(
    setting: Setting, roles: Mapping[str, str], before: FloatArray, unit: FloatArray
) -> tuple[IndexComparison, ...]:
    """Every stated index beside what the model makes of it at two points (n_targets,) of the unit cube."""
    values = setting.box.from_unit(np.column_stack([before, unit]))
    thetas = dict(zip(("before", "after"), setting.model.matrix(setting.box.names, values).T, strict=True))
    stated = list(setting.trials.stated.values())
    return tuple(compare_stated(setting.model, thetas, stated, roles, setting.backend.name))


def traded(profile: ShipProfile, trials: TrialSet, problem: FitProblem) -> tuple[str, ...]:
    """One coefficient of every direction no trial can tell, found at the pre-determined values."""
    free = np.zeros(len(problem.box), dtype=bool)
    before = problem.box.to_unit(problem.box.pre)
    hold_simulated(profile, problem, before, _tuned_on(trials), "with the values of the profile")
    directions = analyse(problem, before, free).null_directions
    return tuple(next(iter(direction.weights)) for direction in directions)


def hold_directions(profile: ShipProfile, trials: TrialSet, options: FitOptions) -> FitOptions:
    """The same options with one coefficient fixed for every direction no trial can tell, found before searching."""
    held = traded(profile, trials, make_problem(profile, trials, options))
    return replace(options, fixed=(*options.fixed, *held), identifiable=False)


def _search(
    problem: FitProblem,
    options: FitOptions,
    start: FloatArray,
    tolerance: float,
    hooks: Hooks,
    checkpoint: Checkpoint | None,
    recorded: list[FloatArray] | None,
) -> Search:
    """CMA-ES with checkpoints: every few generations, and when it ends for whatever reason."""

    def on_generation(state: Search) -> None:
        if checkpoint and len(state.costs) % EVERY == 0:
            checkpoint.save(state.costs)
        hooks.on_generation(state)

    found = search(
        problem,
        options.seed,
        start,
        tolerance=tolerance,
        recorded=recorded,
        on_generation=on_generation,
        stop=hooks.stop,
    )
    if checkpoint:
        checkpoint.save(found.costs)
    return found


def _nearest(problem: FitProblem, best: LeastSquaresResult, before: FloatArray) -> LeastSquaresResult:
    """Of all sets that fit as well as ``best``, the one nearest to the pre-determined values."""
    moved = solve(problem, best.unit[:, None], ridge=RIDGE * best.J, anchor=before)[0]
    return moved if moved.J <= best.J * (1.0 + 1e-7) else best


def identity_of(
    profile: ShipProfile, trials: TrialSet, options: Options, provenance: Mapping[str, Any]
) -> dict[str, Any]:
    """Everything a run depends on: a run that was stopped is continued only where none of it has changed."""
    return {
        "profile": profile.sha256,
        "trials": trials.hashes(),
        "tune": [*trials.tune, *trials.tune_stated],
        "test": [*trials.test, *trials.test_stated],
        "options": options.to_dict(),
        "versions": {**provenance["environment"], "mmgtune": provenance["mmgtune"]},
    }


def make_provenance(profile: ShipProfile, trials: TrialSet, command: str) -> dict[str, Any]:
    """What a fit was made from, and with which versions."""
    made = made_by(command)
    environment = made.pop("environment")
    return {
        **made,
        "profile": facts_of_profile(profile),
        "trials": {
            "path": str(trials.path) if trials.path else "",
            "ship": trials.ship,
            "licence": trials.licence,
            "citation": trials.citation,
            "tune": [*trials.tune, *trials.tune_stated],
            "test": [*trials.test, *trials.test_stated],
            "coverage": Coverage.of([trials.trials[name] for name in trials.tune], profile.L_pp).to_dict(),
            "sha256": trials.hashes(),
            "source": {name: trial.source for of in (trials.trials, trials.stated) for name, trial in of.items()},
        },
        "environment": environment,
    }


def facts_of_profile(profile: ShipProfile) -> dict[str, str]:
    """What a profile was read from, and on what terms."""
    return {
        "id": profile.id,
        "name": profile.name,
        "path": str(profile.path) if profile.path else "",
        "sha256": profile.sha256,
        "source": profile.source,
        "licence": profile.licence,
        "citation": profile.citation,
    }
