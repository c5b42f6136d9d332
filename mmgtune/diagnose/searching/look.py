"""A look at what is left: which hypothesis explains most of it, and whether that is to be believed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...backends import Integrator
from ..bench import noise as noises
from ..bench.hypotheses import Hypothesis
from ..bench.workbench import Point, Workbench
from ..signatures.beside import free_with, kept_free
from ..signatures.linear import Linear, linearise
from ..signatures.screening import Score, scores
from .base_fit import unnoticed
from .refit import ENOUGH, Refit, believable_first, decide, rivals_among
from .refitter import STRONG, Given, Known, Refitter
from .refitting import Refitting

FINER = 4
"""The integration step as a cause: a Runge-Kutta step this many times finer."""


@dataclass(frozen=True, eq=False)
class Begun:
    """Where the refits of a look begin, with noise as it shows there.

    point   the point with the causes accepted before
    linear  the problem made linear there, with the signatures of hypotheses
    scores  of every hypothesis
    known   the refits, as far as they came
    bench   what the workbench knew, see ``Workbench.known``
    """

    point: Point
    linear: Linear
    scores: list[Score]
    known: Known
    given: Given | None
    bench: Mapping[str, Any]

    def among(self, hypotheses: Sequence[Hypothesis]) -> Begun:
        """The same of some of the hypotheses: what others leave says no more what is hopeless."""
        ranked = [score for score in self.scores if score.hypothesis in hypotheses]
        return replace(self, scores=ranked, known=self.known.among([score.hypothesis for score in ranked]))


@dataclass(frozen=True, eq=False)
class Step:
    """One look at what is left.

    base     the point with the causes accepted before
    refits   best first
    scores   of every hypothesis
    rivals   of the best: hypotheses of other effects that do nearly as well
    accepted whether the best is believed
    reason   why not, where it is not
    finer    fall of chi-squared by a finer integration step, None where not tried
    evenly   fall of chi-squared by inputs that change evenly between the updates of a log that looks held
    begun    where the refits began, of a first look
    """

    base: Point
    linear: Linear
    scores: list[Score]
    refits: list[Refit]
    rivals: list[Refit]
    accepted: bool
    reason: str
    finer: float | None = None
    evenly: float | None = None
    begun: Begun | None = None

    def settled_by(self, fall: float | None, share: float) -> bool:
        """Whether a fall of chi-squared by what has no parameter is believed before any effect, from a share of the
        best of these."""
        best = self.refits[0].gain if self.refits else 0.0
        return fall is not None and fall > max(2.0 * ENOUGH, share * best)


def look(bench: Workbench, point: Point, hypotheses: Sequence[Hypothesis], first: bool) -> Step:
    """Scores of all hypotheses at a point, refits of the best, and whether the best of those is to be believed.

    Noise is estimated again from what the best refit and all other signatures together leave: with fewer of them a
    cause would pass for noise with a memory.
    """
    names = [name for h in hypotheses for name in h.bases]
    varying = [name for h in hypotheses if h.by for name in h.bases]
    linear = linearise(bench, point, names, varying=varying, roughly=True)
    ranked = scores(linear, hypotheses)
    known = Known()
    best = Refitting(Refitter(bench, point, linear, known)).best(ranked, quick=True)
    richest = best[0].point if best and best[0].gain > 2.0 * ENOUGH else point
    at_best = linear if richest is point else linearise(bench, richest, names, roughly=True)
    noise = _noise_at(bench, at_best)
    if _differs(bench.noise, noise):
        bench.know(noise)
        left = bench.refit(point.names, point.unit[:, None], point.offsets, max_iterations=0).chi2
        tolerance = unnoticed(bench, left)
        point = bench.refit(point.names, point.unit[:, None], point.offsets, tolerance=tolerance)
        linear = linearise(bench, point, names, varying=varying, roughly=True)
        ranked = scores(linear, hypotheses)
        known.outdate()
    begun = Begun(point, linear, ranked, known, _as_given(bench, point, hypotheses), bench.known())
    finer_gain = None
    if first:
        tolerance = unnoticed(bench, point.chi2)
        by = finer(point.integrator)
        other = bench.refit(point.names, point.unit[:, None], point.offsets, integrator=by, tolerance=tolerance)
        finer_gain = point.chi2 - other.chi2
    evenly = None
    if bench.held and bench.updates is None:
        read = replace(bench)
        read.read_evenly()
        evenly = point.chi2 - read.refit(point.names, point.unit[:, None], point.offsets).chi2
    step = _decided(bench, begun, finer_gain, evenly)
    return step if first else replace(step, begun=None)


def look_again(bench: Workbench, step: Step, hypotheses: Sequence[Hypothesis]) -> Step:
    """A look once more, among some of its hypotheses: each refit goes on from where it came to, with the noise of then.

    Only which is the best may be another for there being fewer of them, and what is given up beside it.
    """
    assert step.begun is not None  # kept of first looks
    bench.put_back(step.begun.bench)
    return _decided(bench, step.begun.among(hypotheses), step.finer, step.evenly)


def _decided(bench: Workbench, begun: Begun, finer_gain: float | None, evenly: float | None) -> Step:
    """The refits of a look, and whether the best is to be believed."""
    point, linear, ranked = begun.point, begun.linear, begun.scores
    refitter = Refitter(bench, point, linear, begun.known, begun.given)
    fitted = Refitting(refitter).best(ranked, quick=False)
    seen = _with_inputs_seen(linear, fitted)
    if seen is not linear:  # with less left open more may be told, and other refits be worth their while
        linear, ranked = seen, scores(seen, [score.hypothesis for score in ranked])
        fitted = Refitting(replace(refitter, linear=linear)).best(ranked, quick=False)
    refits = believable_first(fitted, bench.options.level)
    if refits and refits[0] is not fitted[0] and fitted[0].by_chance(bench.options.level):
        told = _in_a_form_told(refits, fitted[0], bench.options.level)
        refits = refits if told or _stands_beside(bench, refits[0], fitted[0]) else fitted
    rivals = rivals_among(refits) if refits else []
    accepted, reason = decide(bench, refits, rivals)
    return Step(point, linear, ranked, refits, rivals, accepted, reason, finer_gain, evenly, begun)


def finer(integrator: Integrator) -> Integrator:
    """A Runge-Kutta step that is fine enough for any ship."""
    return Integrator("rk4", FINER * integrator.substeps)


def _with_inputs_seen(linear: Linear, fitted: Sequence[Refit]) -> Linear:
    """The linear problem of a look with no more left open by the inputs than the best refit shows."""
    if not fitted or fitted[0].gain < 2.0 * ENOUGH:
        return linear
    best = fitted[0].hypothesis
    explained = linear.columns_of(best.bases, best.groups) if best.by else linear.columns(linear.absent(best.names))
    return linear.with_inputs_seen(fitted[0].point.chi2, explained)


def _in_a_form_told(refits: Sequence[Refit], more: Refit, level: float) -> bool:
    """Whether what explains more, though by chance perhaps, is another form of the best that is believed, or of what
    does nearly as well: two rates of a rudder where one is told."""
    forms = [one for one in refits if one.hypothesis.effect is more.hypothesis.effect and not one.by_chance(level)]
    return any(one is refits[0] or not refits[0].beats(one) for one in forms)


def _stands_beside(bench: Workbench, one: Refit, more: Refit) -> bool:
    """Whether a cause is needed beside what explains more, though by chance perhaps: else it may be a part of that."""
    both = fitted_beside(bench, more.point, one)
    return (more.point.chi2 - both.chi2) / one.score.inflation - one.cost >= ENOUGH


def fitted_beside(bench: Workbench, point: Point, other: Refit, hopeless: float = math.inf) -> Point:
    """A point refitted with the hypothesis of a refit besides, from where that ended."""
    own = other.point.unit[-len(other.hypothesis.names) :]
    return bench.refit(
        free_with(point, other.hypothesis),
        np.concatenate([point.unit[kept_free(point, other.hypothesis)], own])[:, None],
        point.offsets,
        spreads={**point.spreads, **other.point.spreads},
        hopeless=hopeless,
    )


def _as_given(bench: Workbench, point: Point, hypotheses: Sequence[Hypothesis]) -> Given | None:
    """The point refitted with what has leeway at the profile's values, where that leaves much and no run is lost."""
    kept = [i for i, name in enumerate(point.names) if name not in bench.believed.leeway]
    if len(kept) == len(point.names):
        return None
    names, start = [point.names[i] for i in kept], point.unit[kept][:, None]
    there = bench.refit(
        names,
        start,
        point.offsets,
        integrator=point.integrator,
        tolerance=unnoticed(bench, point.chi2),
        spreads=point.spreads,
    )
    if not STRONG * bench.problem.n_residuals <= there.chi2 < math.inf:
        return None
    alike = [h for h in hypotheses if not h.by]
    linear = linearise(bench, there, [name for h in alike for name in h.bases], roughly=True)
    ranked = scores(linear, alike)
    ranked.sort(key=lambda score: -score.score)
    return Given(there, linear, {score.hypothesis.names: score.step for score in ranked})


def _noise_at(bench: Workbench, linear: Linear) -> noises.NoiseModel:
    """Noise from the residual less all signatures, in the units residuals had before any whitening."""

    def fitted(residuals: FloatArray) -> FloatArray:
        return bench.noise.restore(linear.fitted(bench.noise.apply(residuals))[linear.measured])

    return noises.estimate(bench.problem.cases, bench.noise.restore(linear.noise[linear.measured]), fitted)


def _differs(a: noises.NoiseModel, b: noises.NoiseModel) -> bool:
    """Whether two noise models give noticeably different weights."""
    for channel, one in a.channels.items():
        other = b.channels[channel]
        if abs(np.log(one.filter[2] / other.filter[2])) > 0.02 or abs(one.phi - other.phi) > 0.05:
            return True
    return False
