"""What all problems of one fit have in common, and how problems are made from profile, trials and options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES, Backend, Integrator, get_backend
from ..errors import OptionError, Problem
from ..first_states import deviations
from ..model import Model
from ..objective import Objective, cases_of, make_objective, spread
from ..options import FitOptions, TuningOptions
from ..profile import ShipProfile
from ..stated_indices import possible
from ..trial import Coverage, TrialSet
from .box import Box, choose_targets, make_box
from .one_sided import tied
from .pooled import Pooled, SistersPrior, pooled, read_sisters, with_sisters
from .problem import FitProblem
from .terms import ScatterPrior, StatedIndices, Term


def in_pieces(trials: TrialSet, options: TuningOptions) -> TrialSet:
    """The trials cut into windows where the options ask for that; unchanged where they are windows already."""
    if options.restart is None or any(trial.part_of for trial in trials.trials.values()):
        return trials
    return trials.in_windows(options.restart, options.every)


@dataclass(frozen=True, eq=False)
class Setting:
    """What all problems of one fit have in common.

    estimated  whether trials start from an estimated state
    terms      terms of the objective besides J
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
        """The setting with some targets held at their pre-determined values."""
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
