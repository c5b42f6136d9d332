"""A fit from beginning to end: search, polish, certificate, identifiability, comparison on every trial."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..arguments import ShipGiven, TrialsGiven, ship_of, trials_of
from ..arrays import FloatArray
from ..errors import all_of, must_be_a
from ..files import kept_in
from ..first_states import J_of_noise
from ..hooks import Hooks
from ..objective import Objective
from ..options import FitOptions
from ..options.choice import must_be
from ..profile import ShipProfile
from ..run_provenance import identity_of, make_provenance
from ..stated_indices import IndexComparison, compare_stated
from ..threads import blas_on_one_thread
from ..trial import Trial, TrialSet, oddities
from .certificate import certify
from .checkpoint import Checkpoint
from .comparison import ComparedTrials, compare, total
from .extending import settled
from .identifiability import analyse
from .journal import journalled
from .least_squares import fit_offsets
from .lost import require_simulated
from .optimum import Optimum, Seeking
from .pooled import read_sisters, unheard
from .problem import FitProblem
from .result import Beside, FitResult
from .setting import Setting, in_pieces, make_problem, make_setting
from .weighing import Weight, weigh


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
    folder = kept_in(folder, resume)
    must_be(options, FitOptions)
    must_be_a(hooks, Hooks, "hooks")
    more_starts = all_of(more_starts, Mapping, "more_starts")
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
    posed = _posed(profile, in_pieces(trials, options), options, hooks)
    recorded = checkpoint.load() if checkpoint and resume and checkpoint.path.is_file() else None
    require = partial(require_simulated, profile, trials=_tuned_on(posed.setting.trials))
    seeking = Seeking(
        posed.problem, posed.options, posed.before, posed.cost_before, require, hooks, checkpoint, recorded
    )
    best = seeking.optimum(more_starts)
    hooks.on_phase("certificate and identifiability")
    found = _looked_at(profile, posed, best, provenance)
    return replace(
        found,
        wall_s=time.perf_counter() - began,
        interrupted=hooks.stop(),
        oddities=(*odd, *unheard(best.problem.box, posed.setting.sisters)),
    )


@dataclass(frozen=True, eq=False)
class _Posed:
    """A fit that is to be searched.

    options  as they were given, with what no trial determines fixed where that was asked for
    plain    the problem without the weight of its terms
    weight   between J and the terms, None without terms
    before   (n_targets,) pre-determined values in the unit cube, and what J and the objective are there
    """

    setting: Setting
    options: FitOptions
    plain: FitProblem
    problem: FitProblem
    weight: Weight | None
    before: FloatArray
    J_before: float
    cost_before: float


def _posed(profile: ShipProfile, trials: TrialSet, options: FitOptions, hooks: Hooks) -> _Posed:
    """The problem of a fit, its terms weighed where it has some."""
    setting = make_setting(profile, trials, options)
    plain = setting.problem()
    if options.identifiable:
        held = traded(profile, trials, plain)
        options = replace(options, fixed=(*options.fixed, *held), identifiable=False)
        setting = setting.holding(held)
        plain = plain.with_targets(setting.model, setting.box)
    before = plain.box.to_unit(plain.box.pre)
    if plain.terms:
        hooks.on_phase("weighing what is known beforehand")
    problem, weight = weigh(plain, np.clip(before, 0.0, 1.0), hooks.stop)
    J_before = float(problem.misfit(before[:, None])[0])
    cost_before = float(problem.costs(before[:, None])[0]) if problem.terms else J_before
    return _Posed(setting, options, plain, problem, weight, before, J_before, cost_before)


def _looked_at(profile: ShipProfile, posed: _Posed, best: Optimum, provenance: dict[str, Any]) -> FitResult:
    """What there is to know of an optimum; not yet what the whole fit took, and whether it was stopped."""
    setting, options, before = posed.setting, posed.options, posed.before
    problem, unit, found, trials = best.problem, best.unit, best.cma_es, setting.trials
    J = float(problem.misfit(unit[:, None])[0]) if problem.terms else best.cost
    restarts = found.restarts if found else []
    certificate = certify(
        problem,
        unit,
        best.cost,
        posed.cost_before,
        best.ends,
        restarts,
        found.J if found else None,
        best.ridge,
        before,
    )
    held_by_bound = np.isin(problem.box.names, [bound.name for bound in certificate.active])
    roles = {name: trials.role(name) for name in (*trials.trials, *trials.stated)}
    everything = setting.problem(tuple(trials.trials)) if trials.trials else posed.plain
    compared = ComparedTrials(compare(everything, list(trials.trials.values()), setting.objective, roles, before, unit))
    from_noise = not setting.estimated and bool(trials.tune)
    return FitResult(
        profile=profile,
        options=options,
        box=problem.box,
        unit=unit,
        J=J if options.loss == "squares" else float(total(compared, "tune", "after") or J),
        J_before=posed.J_before,
        J_free_start=J_free_start(posed.plain.estimated(setting.deviations()), unit) if from_noise else None,
        J_of_noise=noise_by_role(everything, unit, trials, setting.objective) if from_noise else {},
        beside=beside(problem, before, unit, posed.weight) if posed.weight else None,
        compared=compared,
        stated=compared_stated(setting, roles, before, unit),
        restarts=tuple(restarts),
        starts=tuple(best.ends),
        history=tuple(found.history if found else ()),
        certificate=certificate,
        identifiability=analyse(problem, unit, held_by_bound),
        evaluations=problem.evaluations,
        diverged=found.diverged if found else 0,
        wall_s=0.0,
        held=tuple(options.fixed),
        ties=setting.model.ties,
        scales=setting.objective.scales,
        channels=setting.objective.channels,
        provenance=provenance,
    )


def _tuned_on(trials: TrialSet) -> list[Trial]:
    """Tune trials that have a motion, a case of the problem each."""
    return [trials.trials[name] for name in trials.tune if name in trials.trials]


def J_free_start(problem: FitProblem, unit: FloatArray) -> float:
    """J of coefficients (n_targets,) if each trial started from the state that fits best within its noise."""
    return float(problem.misfit(unit[:, None], fit_offsets(problem, unit)[:, None])[0])


def noise_by_role(problem: FitProblem, unit: FloatArray, trials: TrialSet, objective: Objective) -> dict[str, float]:
    """J that the noise of first samples alone would bring a faultless model to, by role of the trials.

    problem  over all trials that have a motion, in their order; unit: (n_targets,)
    """
    by_trial = J_of_noise(problem.predictor(unit[:, None]), list(trials.trials.values()), objective)
    found: dict[str, float] = {}
    for name, J in zip(trials.trials, by_trial, strict=True):
        found[trials.role(name)] = found.get(trials.role(name), 0.0) + float(J)
    return found


def beside(problem: FitProblem, before: FloatArray, unit: FloatArray, weight: Weight) -> Beside:
    """The terms of a weighted problem at two points (n_targets,) of the unit cube."""
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
    """One coefficient of every direction that no trial determines, found at the pre-determined values."""
    free = np.zeros(len(problem.box), dtype=bool)
    before = problem.box.to_unit(problem.box.pre)
    require_simulated(profile, problem, before, _tuned_on(trials), "with the values of the profile")
    directions = analyse(problem, before, free).null_directions
    return tuple(next(iter(direction.weights)) for direction in directions)


def fixed_where_undetermined(profile: ShipProfile, trials: TrialSet, options: FitOptions) -> FitOptions:
    """The options with one coefficient fixed for every direction that no trial determines, found before searching."""
    held = traded(profile, trials, make_problem(profile, trials, options))
    return replace(options, fixed=(*options.fixed, *held), identifiable=False)
