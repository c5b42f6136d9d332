"""The evidence beside an answer: residuals, short horizons, residual forces, and where an error without a name is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...backends import STATES
from ...documents import finite
from ...fitting.box import group_of
from ...model import Model
from ...trial import Trial
from ...trial.checks.set_checks import check_trials, oddest
from ...trial.smoothing import FEWEST
from ..bench.workbench import Point, Workbench
from ..searching.search import Found
from . import ResidualForces, can_be_explained, explain_forces, noise_share, residual_forces, short_horizon
from .leftover import Leftover, residuals_of
from .logged import LOGGED
from .whereabouts import Whereabouts, whereabouts


def evidence(bench: Workbench, found: Found, before: Leftover, left: Leftover) -> dict[str, Any]:
    """Residuals before and after by trial and channel, short horizons, and residual forces with what explains them."""
    shown: dict[str, Any] = {"excess_before": before.channels, "excess_after": left.channels}
    long_enough = _long_enough(bench)
    for which, point in (("before", found.base), ("after", found.final)):
        models = _models(bench, point, long_enough)
        shown[f"short_horizon_{which}"] = {}
        if long_enough:
            short = _short_horizon(models, long_enough, point)
            shown[f"short_horizon_{which}"] = dict(zip(STATES, map(finite, map(float, short)), strict=True))
        forces = [forces for forces, _ in _forces(bench, point)]
        if can_be_explained(forces):
            shown[f"forces_{which}"] = {
                "explained": {axis: dict(shares) for axis, shares in explain_forces(forces).items()},
                "noise": dict(noise_share(forces)),
            }
    return shown


def error_of(bench: Workbench, found: Found, before: Leftover, told: Leftover) -> Whereabouts:
    """Where the error of the model without any cause lives, what of it is an offset of a log, and what logs warn of.

    before, told  what the model leaves without any cause, and with what is not believed: a sensor is blamed where both
                  show it
    """
    by_run = _excess_by_run(bench, found.base)
    whole = sum(by_run.values())
    removable: dict[str, float] = {}
    for refit in found.steps[0].refits if found.steps and whole > 0.0 else ():
        if refit.hypothesis.by:  # what is told is of one value for all runs
            continue
        tag = refit.hypothesis.tag
        left = sum(_excess_by_run(bench, refit.point).values())
        removable[tag] = max(removable.get(tag, 0.0), min(1.0, 1.0 - left / whole))
    ranked = dict(sorted(removable.items(), key=lambda one: -one[1]))
    odd = oddest(check_trials({trial.id: trial for trial in bench.trials}, bench.model.L_pp))
    of_runs = {trial.run: odd[trial.id] for trial in bench.trials if trial.id in odd}
    offsets = {name: of for name, of in told.offsets.items() if name in before.offsets}
    where = whereabouts(_forces(bench, found.base), by_run, ranked, offsets, of_runs)
    where = replace(where, channel=told.alone if told.alone == before.alone else "")
    changed = {trial: f"the factor of the {LOGGED[name]} changes" for name, of in told.changed.items() for trial in of}
    changed |= {trial: f"the {LOGGED[name]} is misread" for name, of in told.misread.items() for trial in of}
    return replace(where, odd=changed) if changed else where


def _excess_by_run(bench: Workbench, point: Point) -> dict[str, float]:
    """Squared error of the motion beyond white noise of the sensors, in variances of that noise, by run."""
    at = [STATES.index(name) for name in bench.channels]
    found: dict[str, float] = {}
    for trial, off in zip(bench.trials, residuals_of(bench, point), strict=True):
        square = (off[1:, at] / bench.sigma[at]) ** 2
        found[trial.run] = found.get(trial.run, 0.0) + float(np.nansum(square - 1.0))
    return found


def _forces(bench: Workbench, point: Point) -> list[tuple[ResidualForces, Trial]]:
    """Residual forces of the trials that are long and whole enough for inverse dynamics."""
    found = []
    trials = _long_enough(bench)
    for trial, model in zip(trials, _models(bench, point, trials), strict=True):
        try:
            found.append((residual_forces(model, trial), trial))
        except ValueError:  # too short or too full of gaps
            continue
    return found


def _long_enough(bench: Workbench) -> list[Trial]:
    return [trial for trial in bench.trials if np.isfinite(trial.motion[:, 2:]).all(axis=1).sum() >= FEWEST]


def _models(bench: Workbench, point: Point, trials: Sequence[Trial]) -> list[Model]:
    """The model of a point for each trial: one for all where nothing differs between runs."""
    if any(group_of(name) for name in point.names):
        return [Model(bench.tuned(point, trial)) for trial in trials]
    return [Model(bench.tuned(point))] * len(trials)


def _short_horizon(models: Sequence[Model], trials: Sequence[Trial], point: Point) -> FloatArray:
    """(6,) root mean square over the trials of short runs, in deviations of the noise."""
    if models[0] is models[-1]:
        return short_horizon(models[0], trials, integrator=point.integrator).pooled_rms_in_noise
    each = [
        short_horizon(model, [trial], integrator=point.integrator).pooled_rms_in_noise
        for model, trial in zip(models, trials, strict=True)
    ]
    return np.asarray(np.sqrt(np.average(np.array(each) ** 2, axis=0, weights=[t.n_samples for t in trials])))
