"""A diagnosis from beginning to end."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES
from ..fitting.box import group_of, parameter_of
from ..fitting.extending import with_width
from ..fitting.journal import journalled
from ..fitting.one_sided import coverage_notes, followers
from ..fitting.run import Hooks, identity_of, in_pieces, make_provenance
from ..given import ShipGiven, TrialsGiven, ship_of
from ..model import Model
from ..options import DiagnoseOptions
from ..profile import ShipProfile, with_all_effects
from ..threads import blas_on_one_thread
from ..trial import Coverage, Trial, TrialSet, VoyageSet
from ..trial.smoothing import FEWEST
from .by_run import ByRun
from .contributions import Aside, Contribution, alone_of, contributions, set_aside
from .evidence import ResidualForces, explain_forces, noise_share, residual_forces, short_horizon
from .gain import J_of, held_out
from .hypotheses import INPUTS_HELD, INTEGRATION_STEP, Hypothesis, known_causes, of_runs
from .intervals import Estimate, estimates
from .leftover import Leftover, leftover, residuals_of
from .legs import LEG_NAMES, differences
from .linear import typical
from .narrow import narrow_box
from .result import Candidate, Cause, Detectability, Diagnosis, Doubted, Trace
from .screening import angles
from .search import ENOUGH, WORTH, Found, Refit, Step, rivals_of, search
from .separate import Suggestion, suggest
from .voyages import Choice, looked_at
from .whereabouts import Whereabouts, whereabouts
from .workbench import Point, Workbench, make_workbench

TWINS = 3
"""Most similar effects listed for each."""


@blas_on_one_thread
def diagnose(
    profile: ShipGiven,
    trials: TrialsGiven | VoyageSet,
    options: DiagnoseOptions = DiagnoseOptions(),
    *,
    hooks: Hooks = Hooks(),
    folder: Path | None = None,
    resume: bool = False,
    command: str = "",
) -> Diagnosis:
    """Show what the model gets wrong on the trials, name the cause, extend the model, measure the gain.

    Causes are looked for on every trial that the split does not keep for testing; the gain is that on the test trials,
    or on each trial in turn where there are none.  Nothing is read but the profile, the columns and the split.

    Of voyages, logs of hours, a bounded number of windows is looked at, and what differs from one to the next is told.

    profile, trials  objects, paths or bundled names
    folder  where each finished refit is noted at once; None for nowhere
    resume  continue what was stopped in the folder
    Raises OptionError for choices that make no sense, OutputError where the folder cannot be written to.
    """
    profile = ship_of(profile)
    options = with_width(profile, options)
    trials, choice = looked_at(profile, trials, options)
    provenance = make_provenance(profile, trials, command)
    identity = identity_of(profile, trials, options, provenance)
    with journalled(folder, identity, hooks.stop, resume=resume):
        return _diagnose(profile, trials, choice, options, hooks, provenance)


def _diagnose(
    profile: ShipProfile,
    trials: TrialSet,
    choice: Choice | None,
    options: DiagnoseOptions,
    hooks: Hooks,
    provenance: dict[str, Any],
) -> Diagnosis:
    began = time.perf_counter()
    trials = in_pieces(trials, options.fit_options())
    seen = _in_order([trial for name, trial in trials.trials.items() if name not in trials.test])
    test = _in_order([trials.trials[name] for name in trials.test])
    known = known_causes(profile, seen, options)
    names = [name for h in known for name in h.names]
    bench = make_workbench(profile, seen, options, [*names, *(_legs(profile, names) if choice else ())])
    known = [h for h in known if not set(h.names) & set(bench.targets)]
    known = [h for h in known if not {h.effect.absorbed.get(v) for v in h.variant} & set(bench.targets)]
    differing_by_run = of_runs(known, seen) if choice is None else []
    found = search(bench, [*known, *differing_by_run], hooks.on_phase, hooks.stop)
    test = [found.held.evenly(trial) for trial in test] if found.held else test
    hooks.on_phase("measuring the gain")
    traces, brought = set_aside(bench, found, test)
    before = leftover(bench, found.base)
    differing = None
    if choice is not None and not hooks.stop():
        hooks.on_phase("comparing the voyages")
        differing = differences(bench, found.final, choice.voyages)
    hooks.on_phase("gathering the evidence")
    coverage = Coverage.of(bench.trials, profile.L_pp)

    def judged(found: Found, brought: Sequence[Contribution], doubted: Doubted | None = None) -> Diagnosis:
        sizes = estimates(bench, found.final)
        left = leftover(bench, found.final) if found.causes or found.finer_step else before
        theta, retuned = (_targets_of(bench, point) for point in (found.final, found.base))
        return Diagnosis(
            profile=profile,
            options=options,
            causes=tuple(_causes(bench, found, sizes, test)),
            traces=tuple(_trace(bench, one) for one in traces),
            contributions=tuple((h.tag, one) for h, one in zip(found.causes, brought, strict=True)),
            groups=(),
            candidates=tuple(_candidates(bench, found, test)),
            detectability=tuple(_detectability(bench, found.steps[0], known)) if found.steps else (),
            suggestion=None,
            gain=held_out(bench, found, test),
            leftover=left,
            explained_share=_explained(found, before, left),
            theta=theta,
            retuned=retuned,
            coverage=coverage,
            warnings=tuple(coverage_notes(bench.model, bench.targets, coverage)),
            noise=_noise(bench),
            chi2=(
                _first(found).chi2 / max(1, bench.problem.n_residuals),
                found.final.chi2 / max(1, bench.problem.n_residuals),
            ),
            evidence=_evidence(bench, found, before, left),
            provenance=provenance,
            choice=choice,
            differing=differing or (),
            doubted=doubted,
            wall_s=0.0,
            interrupted=hooks.stop(),
        )

    def compared(result: Diagnosis, found: Found) -> Diagnosis:
        """With what these trials cannot tell from the causes, where these are believed."""
        if result.verdict in ("unexplained", "interrupted") or not found.causes:
            return result
        hooks.on_phase("comparing the causes with their rivals")
        rivals = [rivals_of(bench, found, cause) for cause in found.causes]
        groups = tuple(
            (cause.tag, *(rival.hypothesis.tag for rival in of))
            for cause, of in zip(found.causes, rivals, strict=True)
            if of
        )
        return replace(result, groups=groups, suggestion=_suggestion(bench, found, rivals), interrupted=hooks.stop())

    result = compared(judged(found, brought), found)
    if result.unclear and not hooks.stop():  # perhaps the first of them would have been believed alone
        alone = alone_of(bench, found)
        other = compared(judged(alone, contributions(bench, alone, test), Doubted.of(result)), alone)
        if other.verdict in ("found", "not-separable") and other.explains_nearly_all:
            result, found = other, alone
    if result.verdict == "unexplained":
        result = replace(result, whereabouts=_whereabouts(bench, found, result.leftover.offsets))
    warnings = (*result.warnings, *narrow_box(bench, found)) if not hooks.stop() else result.warnings
    return replace(result, warnings=warnings, wall_s=time.perf_counter() - began)


def _first(found: Found) -> Point:
    """The model re-tuned before anything was put right."""
    as_given = found.held is None and found.finer_step is None
    return found.base if as_given else found.steps[0].base


def _whereabouts(bench: Workbench, found: Found, offsets: Mapping[str, float]) -> Whereabouts:
    """Where the error of the model without any cause lives, and what of it is an offset of a log."""
    by_run = _excess_by_run(bench, found.base)
    whole = sum(by_run.values())
    removable: dict[str, float] = {}
    for refit in found.steps[0].refits if found.steps and whole > 0.0 else ():
        tag = refit.hypothesis.tag
        left = sum(_excess_by_run(bench, refit.point).values())
        removable[tag] = max(removable.get(tag, 0.0), min(1.0, 1.0 - left / whole))
    ranked = dict(sorted(removable.items(), key=lambda one: -one[1]))
    return whereabouts(_forces(bench, found.base), by_run, ranked, offsets)


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
    return [trial for trial in bench.trials if np.isfinite(trial.motion[:, 3:]).all(axis=1).sum() >= FEWEST]


def _legs(profile: ShipProfile, names: Sequence[str]) -> list[str]:
    """What may differ from voyage to voyage, of the effects that apply, besides what is looked for anyhow."""
    there = {f"{effect.kind}.{name}" for effect in Model(with_all_effects(profile)).effects for name in effect.fields}
    return [name for name in LEG_NAMES if name in there and name not in names]


def _in_order(trials: Sequence[Trial]) -> list[Trial]:
    """Trials without what their files say about them, in an order that depends on what was measured alone."""
    bare = [replace(trial, noise={}) for trial in trials]
    return sorted(bare, key=lambda trial: (trial.n_samples, trial.motion[0].tolist(), trial.delta.tobytes()))


def _targets_of(bench: Workbench, point: Point) -> dict[str, float]:
    """Targets at a point, with what is tied to them."""
    values = bench.values(point)
    own = {name: values[name] for name in bench.targets}
    return own | followers(bench.model.ties, own)


def _causes(bench: Workbench, found: Found, sizes: Mapping[str, Estimate], test: Sequence[Trial]) -> list[Cause]:
    """Causes by tag, those of several parameters together."""
    causes: list[Cause] = []
    if found.finer_step is not None:
        causes.append(Cause(INTEGRATION_STEP, None, {}, 0.0, None))
    if found.held is not None:
        causes.append(Cause(INPUTS_HELD, None, {}, 0.0, None, words=found.held.sentence))
    J_before = J_of(bench, found.base, test)
    for tag, by in dict.fromkeys((h.tag, h.by) for h in found.causes):
        own = [h for h in found.causes if (h.tag, h.by) == (tag, by)]
        names = [name for h in own for name in h.names]
        steps = [s for s in found.steps if s.refits and s.refits[0].hypothesis in own]
        J_after = J_of(bench, steps[0].refits[0].point, test) if steps else None
        gain = 1.0 - J_after / J_before if J_before and J_after is not None else None
        p_value = max((s.refits[0].p_value for s in steps), default=0.0)
        estimated = {name: sizes[name] for name in names}
        effect, variant = own[0].effect, tuple(dict.fromkeys(name for h in own for name in h.variant))
        runs = ByRun.of(effect, variant, by, own[0].groups, bench.trials, estimated) if by else None
        causes.append(Cause(tag, effect, {} if by else estimated, p_value, gain, runs))
    return causes


def _trace(bench: Workbench, aside: Aside) -> Trace:
    one = aside.hypothesis
    runs = ByRun.of(one.effect, one.variant, one.by, one.groups, bench.trials, aside.estimates) if one.by else None
    cause = Cause(one.tag, one.effect, {} if one.by else aside.estimates, aside.p_value, None, runs)
    return Trace(cause, aside.contribution)


def _candidates(bench: Workbench, found: Found, test: Sequence[Trial]) -> list[Candidate]:
    """Every hypothesis of the first look that was refitted, best first; then scores of the others."""
    if not found.steps:
        return []
    first = found.steps[0]
    listed = [
        Candidate(
            r.hypothesis.tag,
            tuple(r.hypothesis.variant),
            r.score.score,
            r.gain,
            r.p_value,
            J_of(bench, r.point, test) if _promising(r, first) else None,
            r.unvisited if _promising(r, first) else "",
            by=r.hypothesis.by,
        )
        for r in first.refits
    ]
    refitted = [r.hypothesis for r in first.refits]
    others = sorted((s for s in first.scores if s.hypothesis not in refitted), key=lambda s: -s.score)
    return listed + [
        Candidate(s.hypothesis.tag, s.hypothesis.variant, s.score, 0.0, 1.0, None, by=s.hypothesis.by) for s in others
    ]


def _promising(refit: Refit, step: Step) -> bool:
    return refit.gain >= 0.05 * step.refits[0].gain


def _detectability(bench: Workbench, step: Step, known: Sequence[Hypothesis]) -> list[Detectability]:
    """The table for every named hypothesis, from the first look."""
    named = [s for s in step.scores if not s.hypothesis.effect.one_of_many and not s.hypothesis.by]
    cosine = angles(step.linear, [s.hypothesis for s in named])
    found = []
    for i, score in enumerate(named):
        h = score.hypothesis
        needed = ENOUGH + len(h.names) * math.log(bench.problem.n_residuals)
        sizes = math.sqrt(needed * score.inflation) / score.power if score.power > 0.0 else math.inf
        sizes = max(sizes, WORTH)
        order = [j for j in np.argsort(-cosine[i]) if named[j].hypothesis.tag != h.tag][:TWINS]
        found.append(
            Detectability(
                h.tag,
                tuple(h.variant),
                score.share,
                score.power,
                {name.rpartition(".")[2]: _limit(bench, name, sizes) for name in h.names},
                {name: h.effect.parameters[name].unit for name in h.variant},
                tuple((named[j].hypothesis.tag, math.degrees(math.acos(min(1.0, cosine[i, j])))) for j in order),
            )
        )
    return found


def _limit(bench: Workbench, name: str, sizes: float) -> float | None:
    """Value of a parameter that many typical sizes from its null; None where no value of its range is enough."""
    parameter = parameter_of(bench.model, name)
    assert parameter is not None  # asked of parameters of effects only
    i = bench.box.names.index(name)
    if any(i == direction for _, direction in bench.box.polar):
        return None
    step = sizes * typical(bench, name) * float(bench.box.width[i])
    if any(i == size for size, _ in bench.box.polar):
        return step if step <= bench.box.high[i] else None
    null = 0.0 if parameter.chart == "reciprocal" else parameter.null
    value = null + step
    if parameter.chart == "reciprocal":
        return 1.0 / value if bench.box.low[i] < value <= bench.box.high[i] else None
    return value if value <= bench.box.high[i] else None


def _explained(found: Found, before: Leftover, left: Leftover) -> float:
    """Share of the error above white noise on the trials looked at that the causes remove."""
    if not found.causes:
        return 0.0
    return 1.0 - max(left.excess, 0.0) / before.excess if before.excess > 0.0 else 0.0


def _suggestion(bench: Workbench, found: Found, rivals: Sequence[Sequence[Refit]]) -> Suggestion | None:
    """The trial that would separate the first cause that has rivals."""
    for cause, of in zip(found.causes, rivals, strict=True):
        if of:
            best = [(cause.tag, found.final), *((r.hypothesis.tag, r.point) for r in of[:3])]
            return suggest(bench, best)
    return None


def _noise(bench: Workbench) -> dict[str, dict[str, float]]:
    """Noise by channel in SI units: white part, fading part and its autocorrelation."""
    return {
        name: {
            "white": float(bench.sigma[STATES.index(name)] * np.sqrt(noise.white)),
            "fading": float(bench.sigma[STATES.index(name)] * np.sqrt(noise.fading)),
            "autocorrelation": noise.phi,
        }
        for name, noise in bench.noise.channels.items()
    }


def _evidence(bench: Workbench, found: Found, before: Leftover, left: Leftover) -> dict[str, Any]:
    """Residuals before and after by trial and channel, short horizons, and residual forces with what explains them."""
    shown: dict[str, Any] = {"excess_before": before.channels, "excess_after": left.channels}
    long_enough = _long_enough(bench)
    for which, point in (("before", found.base), ("after", found.final)):
        models = _models(bench, point, long_enough)
        shown[f"short_horizon_{which}"] = {}
        if long_enough:
            short = _short_horizon(models, long_enough, point)
            shown[f"short_horizon_{which}"] = dict(zip(STATES, map(float, short), strict=True))
        forces = [forces for forces, _ in _forces(bench, point)]
        if forces:
            shown[f"forces_{which}"] = {
                "explained": {axis: dict(shares) for axis, shares in explain_forces(forces).items()},
                "noise": dict(noise_share(forces)),
            }
    return shown


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
