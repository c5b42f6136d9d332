"""The search for causes: screen, refit, decide, add, and look again.

A hypothesis is believed only where all of this holds: refitted together with the targets it explains far more than
chance would bring anywhere in the search, its size is worth speaking of, and no other hypothesis does nearly as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import FloatArray
from ..backends import Integrator
from ..fitting.box import base_of
from ..fitting.least_squares import solve
from ..trial import Held
from . import noise as noises
from .hypotheses import Hypothesis
from .linear import Linear, inwards, linearise, typical
from .runs import spread_key
from .screening import ChanceScores, Score, evidence, scores, told_by
from .workbench import TOLERANCE, Point, Workbench

STARTS = 6
"""Starts of the base fit."""

QUICK = 20
"""Steps from each."""

BEST = 3
"""Ends of these that are gone on from, where they differ."""

SAME = 1e-3
"""Relative difference of what is made small within which two of them are one."""

ROUGHLY = 20.0
"""Fall of chi-squared that counts as none there."""

STRONG = 1.2
"""Chi-squared per residual beyond which every named hypothesis makes a step before the best are refitted."""

AGAIN = 8
"""Times the base fit may begin again where it ended."""

PRECISE = 0.02
"""Fall of chi-squared that counts as none where parameters are reported."""

OF_EXCESS = 1e-4
"""The same as a share of what is left beyond the noise: where much is, its last digits choose nothing."""

REFITTED = 9
TERMS_REFITTED = 4
"""Hypotheses that are refitted each time, named ones and terms out of many: those of the best scores."""

LIKELY = 9
"""Hypotheses of the best first steps that are refitted where scores alone cannot choose."""
HOPELESS = 10.0
"""Where much is left, values of runs that leave so many times what the best of them leave are not refitted further."""

RUNS_REFITTED = 6
"""Hypotheses of values that differ between runs that are refitted each time, at most."""

FAR_LESS = 1.0 / 3.0
"""Share of the error left by the best value for all that such values may leave, where much is left."""

LEAST_SPREAD = 0.01
"""Smallest spread of such values in a refit, in typical sizes."""

ROUGH = 4
"""Steps of a refit before it is compared with the others."""

MOST_STEPS, ALL_STEPS = 10, 30
"""Further steps of a refit where much is left, and of the best few."""

STARTS_KEPT = 2
"""Starts of a hypothesis that go on after a first step from each."""

SIZES = (1.0, 0.5, 2.0)
"""Sizes of effects with one side only at which refits start, in typical sizes."""

WORTH_GOING_ON = 0.5
"""Share of the best gain from which a refit is continued to its end, besides those of the best few."""

FEW = 4

ENOUGH = 10.0
"""A hypothesis must beat none by this much of chi-squared beyond its share by the information criterion (BIC), and
another hypothesis by as much to be told from it; in units of the noise along it."""

BETTER = 5.0
"""It must also fit that much better: that it has fewer parameters does not rule a rival out."""

AS_MUCH, AS_LITTLE = 0.97, 0.9
"""Share of the fall of chi-squared, and of what is left, within which one value of an effect for all runs is a rival of
values of another that differ between runs: these bend to an effect whose form is a little off."""

WORTH = 0.1
"""Smallest size worth speaking of where another effect would do as well, as a share of the typical one."""

ALMOST = 0.9
"""Share of the best gain from which a finer integration step, which has no parameter, is believed before any effect."""

HALF = 0.5
"""The same of a log that looks held and is read accordingly: it is seen in the log, and a clock that is late explains
most of it too."""

FINER = 4
"""The integration step as a cause: a Runge-Kutta step this many times finer."""


Stop = Callable[[], bool]
"""Asked often; True ends the search with what it has."""


class _Stopped(Exception):
    """A look that was not finished, of which nothing can be told."""


@dataclass(frozen=True, eq=False)
class Refit:
    """A hypothesis fitted together with all that is known so far.

    gain      fall of chi-squared
    cost      what its parameters would bring by chance, by BIC (and for one of many, the choice)
    evidence  the gain over its inflation, less the cost
    size      largest of its parameters' distances from their null, in typical sizes
    p_value   probability of such a fall anywhere in the search, were there nothing to find
    unvisited what the trials would have to visit for it to be believed, "" where they do
    """

    hypothesis: Hypothesis
    score: Score
    point: Point
    gain: float
    cost: float
    evidence: float
    size: float
    p_value: float
    unvisited: str = ""

    def beats(self, other: Refit) -> bool:
        """Whether this explains so much more that the other is out of the question.

        One value for all runs need not fit better than values of each run do: these are charged for what they could
        have been, not by their number.
        """
        if self.hypothesis.by and not other.hypothesis.by and self._hardly_above(other):
            return False
        better = (self.gain - other.gain) / max(self.score.inflation, other.score.inflation)
        simpler = other.hypothesis.by and not self.hypothesis.by
        return (better >= BETTER or bool(simpler)) and better - self.cost + other.cost >= ENOUGH

    def _hardly_above(self, other: Refit) -> bool:
        """Whether another explains hardly less and leaves hardly more."""
        return other.gain >= AS_MUCH * self.gain and other.point.chi2 <= self.point.chi2 / AS_LITTLE


@dataclass(frozen=True, eq=False)
class Step:
    """One look at what is left.

    base     what was known before
    refits   best first
    scores   of every hypothesis
    rivals   of the best: hypotheses of other effects that do nearly as well
    accepted whether the best is believed
    reason   why not, where it is not
    finer    fall of chi-squared by a finer integration step, None where not tried
    evenly   the same by inputs that change evenly between the updates of a log that looks held
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

    def settled_by(self, fall: float | None, share: float) -> bool:
        """Whether a fall of chi-squared by what has no parameter is believed before any effect, from a share of the
        best of these."""
        best = self.refits[0].gain if self.refits else 0.0
        return fall is not None and fall > max(2.0 * ENOUGH, share * best)


@dataclass(eq=False)
class Found:
    """The outcome of a search.

    base    the model re-tuned without any cause
    final   with all that were accepted
    causes  accepted hypotheses, in the order found, after those that others made superfluous were dropped
    steps   every look, the last one in vain
    held    what the logs hold between updates, where that is a cause; the base is read accordingly too
    """

    base: Point
    final: Point
    causes: list[Hypothesis] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    finer_step: float | None = None
    held: Held | None = None


@dataclass(eq=False)
class _Known:
    """Refits there are within a look, by the names of the hypothesis.

    ends   finished ones
    good   whether their noise is the one in use; else they are places to go on from
    begun  a first step from each start
    """

    ends: dict[tuple[str, ...], Point] = field(default_factory=dict)
    good: bool = True
    begun: dict[tuple[str, ...], list[Point]] = field(default_factory=dict)


def base_fit(bench: Workbench) -> Point:
    """The targets re-tuned without any effect: from several starts, in larger steps of the integration at first.

    Initial states are estimated from the first: on long runs those that were measured, noise and all, lead astray.
    """
    names = bench.targets
    rng = np.random.default_rng(bench.options.seed)
    starts = np.column_stack([bench.null(names), *rng.uniform(size=(STARTS - 1, len(names)))])
    quick = bench.problem_of(names, Integrator("euler"))  # a quarter of the work, and only a start
    ends = sorted(solve(quick, starts, max_iterations=QUICK, tolerance=ROUGHLY, trusting=True), key=lambda end: end.J)
    apart = [end for k, end in enumerate(ends) if k == 0 or end.J > (1.0 + SAME) * ends[k - 1].J][:BEST]
    starts = np.column_stack([end.unit for end in apart])
    point = bench.refit(names, starts, ends[0].offsets, tolerance=_unnoticed(bench, ends[0].J))
    for _ in range(AGAIN):  # initial states at the end of their range make a bad start; from there it is a new one
        tolerance = _unnoticed(bench, point.chi2, PRECISE)
        again = bench.refit(names, point.unit[:, None], point.offsets, tolerance=tolerance)
        better = point.chi2 - again.chi2
        point = min(again, point, key=lambda one: one.chi2)
        if better < 1e-3 * point.chi2:
            break
    return point


def _unnoticed(bench: Workbench, chi2: float, least: float = TOLERANCE) -> float:
    """Fall of chi-squared that counts as none where it is as large as this."""
    return max(least, OF_EXCESS * (chi2 - bench.problem.n_residuals))


def search(
    bench: Workbench,
    hypotheses: Sequence[Hypothesis],
    in_place: Sequence[Hypothesis] = (),
    say: Callable[[str], None] = lambda _: None,
    stop: Stop = lambda: False,
) -> Found:
    """Forward search with a backward look after each addition; where it is stopped, what was accepted by then.

    in_place  hypotheses that do the same as targets; looked at where these end at a bound of their box
    """
    say("re-tuning the model without any cause")
    base = base_fit(bench)
    at_end = {name for name, z in zip(base.names, base.unit, strict=True) if z <= 0.0 or z >= 1.0}
    hypotheses = [*hypotheses, *(one for one in in_place if set(one.instead) <= at_end)]
    found = Found(base, base)
    left = list(hypotheses)
    dropped: list[Hypothesis] = []
    once: list[Hypothesis] = []
    while not stop():
        say("looking for a cause" if not found.causes else f"looking for cause {len(found.causes) + 1}")
        try:
            step = look(bench, found.final, left, first=not found.steps, stop=stop)
        except _Stopped:
            break
        found.steps.append(step)
        if step.settled_by(step.evenly, HALF):
            say("the log holds its values")
            found.held = bench.held
            bench.read_evenly()
            found.final = bench.refit(step.base.names, step.base.unit[:, None], step.base.offsets)
            _drop_superfluous(bench, found, found.causes)  # what was taken for it
            left = _left(hypotheses, found, dropped)
            continue
        if step.settled_by(step.finer, ALMOST):
            say("the integration step is a cause")
            found.finer_step = step.finer
            bench.integrate(finer(bench.problem.integrator))
            found.final = bench.refit(step.base.names, step.base.unit[:, None], step.base.offsets)
            continue
        if not step.accepted:
            found.final = step.base
            break
        best = step.refits[0]
        found.causes = [*(cause for cause in found.causes if not best.hypothesis.holds(cause)), best.hypothesis]
        found.final = best.point
        bench.spreads = dict(best.point.spreads)
        known = list(found.causes)
        _drop_superfluous(bench, found, [cause for cause in known[:-1] if cause.by])  # these bend to much
        dropped += [cause for cause in known if cause not in found.causes]
        bent = [cause for cause in found.causes[:-1] if cause.by and cause not in once]
        _make_alike(bench, found, bent)
        once += bent
        left = _left(hypotheses, found, dropped)
        if len(found.causes) >= bench.options.most:
            break
    if found.steps:
        first = found.steps[0].base
        found.base = bench.refit(first.names, first.unit[:, None], first.offsets)
        found.final = bench.refit(found.final.names, found.final.unit[:, None], found.final.offsets, tolerance=PRECISE)
    if len(found.causes) > 1 and not stop():
        _drop_superfluous(bench, found, found.causes[:-1])
    return found


def _beside(hypothesis: Hypothesis, cause: Hypothesis) -> bool:
    """Whether a hypothesis may be looked at where a cause is known: it is of something else, or says more of it."""
    return hypothesis.holds(cause) or not set(hypothesis.bases) & set(cause.bases)


def _left(hypotheses: Sequence[Hypothesis], found: Found, dropped: Sequence[Hypothesis]) -> list[Hypothesis]:
    """What may be looked at beside what was found."""
    return [h for h in hypotheses if h not in dropped and all(_beside(h, cause) for cause in found.causes)]


def finer(integrator: Integrator) -> Integrator:
    """A Runge-Kutta step that is fine enough for any ship."""
    return Integrator("rk4", FINER * integrator.substeps)


def look(
    bench: Workbench, point: Point, hypotheses: Sequence[Hypothesis], first: bool, stop: Stop = lambda: False
) -> Step:
    """Scores of all hypotheses at a point, refits of the best, and whether the best of those is to be believed.

    Noise is estimated anew from what the best refit and all other signatures together leave: any less, and a cause
    would pass for noise with a memory.
    """
    names = [name for h in hypotheses for name in h.bases]
    varying = [name for h in hypotheses if h.by for name in h.bases]
    linear = linearise(bench, point, names, varying=varying)
    ranked = scores(linear, hypotheses)
    known = _Known()
    best = _refit_best(bench, point, ranked, linear, known, quick=True, stop=stop)
    richest = best[0].point if best and best[0].gain > 2.0 * ENOUGH else point
    at_best = linear if richest is point else linearise(bench, richest, names)
    noise = _noise_at(bench, at_best)
    if _differs(bench.noise, noise):
        bench.know(noise)
        point = bench.refit(point.names, point.unit[:, None], point.offsets)
        linear = linearise(bench, point, names, varying=varying)
        ranked = scores(linear, hypotheses)
        known.good = False
    refits = _believable_first(_refit_best(bench, point, ranked, linear, known, quick=False, stop=stop))
    finer_gain = None
    if first:
        tolerance = _unnoticed(bench, point.chi2)
        by = finer(point.integrator)
        other = bench.refit(point.names, point.unit[:, None], point.offsets, integrator=by, tolerance=tolerance)
        finer_gain = point.chi2 - other.chi2
    evenly = None
    if bench.held and bench.updates is None:
        read = replace(bench)
        read.read_evenly()
        evenly = point.chi2 - read.refit(point.names, point.unit[:, None], point.offsets).chi2
    rivals = _rivals(refits) if refits else []
    accepted, reason = _decide(bench, refits, rivals)
    return Step(point, linear, ranked, refits, rivals, accepted, reason, finer_gain, evenly)


def _believable_first(refits: list[Refit]) -> list[Refit]:
    """The best that is about what the trials visit in front, unless it is far from as good as the best of all."""
    for k, refit in enumerate(refits):
        if refits[0].beats(refit):
            break
        if not refit.unvisited:
            return [refit, *refits[:k], *refits[k + 1 :]]
    return refits


def _go_on(stop: Stop) -> None:
    if stop():
        raise _Stopped


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


def _refit_best(
    bench: Workbench,
    point: Point,
    ranked: Sequence[Score],
    linear: Linear,
    known: _Known,
    *,
    quick: bool,
    stop: Stop,
) -> list[Refit]:
    """The most promising hypotheses refitted, best first; what is found is known from then on."""
    order = sorted(ranked, key=lambda score: -score.score)
    named = [s for s in order if not s.hypothesis.effect.one_of_many and not s.hypothesis.by]
    terms = [s for s in order if s.hypothesis.effect.one_of_many]
    strong = point.chi2 > STRONG * bench.problem.n_residuals  # too far away for a linear score to choose
    if quick:
        chosen = named[:3] + terms[:1]
    else:
        chosen = _likely(bench, point, named, known, stop) if strong else named[:REFITTED]
        chosen += terms[: (2 if strong else 1) * TERMS_REFITTED]
    chosen = [s for s in chosen if s.power > 0.0]
    fitted = _fitted(bench, linear, point, chosen, known, strong, stop)
    differing = _of_runs_worth(bench, point, order, [end for _, end in fitted], quick=quick)
    fitted += _fitted(bench, linear, point, differing, known, strong, stop)
    known.ends.update((score.hypothesis.names, end) for score, end in fitted)
    chance = None if quick else ChanceScores(linear, [s.hypothesis for s in ranked], bench.options.seed)
    n_terms = max(1, len(terms))
    refits = [_judged(bench, linear, point, score, end, chance, n_terms=n_terms) for score, end in fitted]
    return _ordered(bench, point, refits, strong)


def _fitted(
    bench: Workbench,
    linear: Linear,
    point: Point,
    chosen: Sequence[Score],
    known: _Known,
    strong: bool,
    stop: Stop,
) -> list[tuple[Score, Point]]:
    """Hypotheses refitted, those that promise much to the end."""
    rough = []
    for score in chosen:
        _go_on(stop)
        rough.append(_rough(bench, point, score, known, strong))
    gains = sorted((point.chi2 - end.chi2 for end in rough), reverse=True)
    enough = min([WORTH_GOING_ON * gains[0], *gains[FEW - 1 : FEW]]) if gains else 0.0
    left = min((end.chi2 for end in rough), default=point.chi2) - bench.problem.n_residuals
    ends = []
    for score, end in zip(chosen, rough, strict=True):
        _go_on(stop)
        gain = point.chi2 - end.chi2
        hopeless = score.hypothesis.by and strong and end.chi2 - bench.problem.n_residuals > HOPELESS * max(left, 0.0)
        if not hopeless and gain >= enough and gain > 0.5 * ENOUGH * score.inflation:
            end = _on(bench, linear, point, score, end, MOST_STEPS if strong else ALL_STEPS)
        ends.append(end)
    best = sorted(range(len(ends)), key=lambda k: ends[k].chi2)[:FEW] if strong else []
    for k in best:  # where little is known the others may take for ever, and are out of the question
        _go_on(stop)
        ends[k] = _on(bench, linear, point, chosen[k], ends[k], ALL_STEPS)
    return list(zip(chosen, ends, strict=True))


def _on(bench: Workbench, linear: Linear, point: Point, score: Score, end: Point, steps: int) -> Point:
    """A refit gone on with, for so many steps."""
    spreads = _spreads(bench, point, score.hypothesis, _spread(bench, linear, point, score, end))
    tolerance = _unnoticed(bench, end.chi2)
    start = end.unit[:, None]
    return bench.refit(end.names, start, end.offsets, spreads=spreads, max_iterations=steps, tolerance=tolerance)


def _of_runs_worth(
    bench: Workbench, point: Point, order: Sequence[Score], fitted: Sequence[Point], *, quick: bool
) -> list[Score]:
    """Hypotheses of values that differ between runs that are worth a refit beside those of one value for all.

    Where one value for all leaves little more than noise, that it differs is seen once it is in place.
    """
    differing = [s for s in order if s.hypothesis.by and s.spread > 0.0]
    n = bench.problem.n_residuals
    left = min((end.chi2 for end in fitted), default=point.chi2)
    price = math.log(n)
    earned = [s for s in differing if s.score - _new(point, s.hypothesis) * price > 0.5 * ENOUGH]
    if left > STRONG * n:
        return earned[: 1 if quick else RUNS_REFITTED]
    alike = max((s.score / s.inflation - len(s.step) * price for s in order if not s.hypothesis.by), default=0.0)
    return [s for s in earned if s.score - _new(point, s.hypothesis) * price > alike][: 1 if quick else 2]


def _new(point: Point, hypothesis: Hypothesis) -> int:
    """Numbers that a hypothesis adds to a point: means that are not free there, and a spread."""
    there = {base_of(name) for name in point.names}
    return sum(base not in there for base in hypothesis.bases) + bool(hypothesis.by)


def _ordered(bench: Workbench, point: Point, refits: Sequence[Refit], strong: bool) -> list[Refit]:
    """The best first: one value for all before values that differ between runs, unless these explain far more."""
    found = sorted(refits, key=lambda refit: refit.cost - refit.gain)
    alike = next((refit for refit in found if not refit.hypothesis.by), None)
    if alike is None or not found[0].hypothesis.by:
        return found
    n = bench.problem.n_residuals
    left = [max(refit.point.chi2 - n, math.sqrt(2.0 * n)) for refit in (found[0], alike)]
    inflation = max(found[0].score.inflation, alike.score.inflation)
    better = (found[0].gain - alike.gain) / inflation - found[0].cost + alike.cost
    none = alike.evidence < ENOUGH
    if (better >= ENOUGH or none) and (not strong or left[0] <= FAR_LESS * left[1]):
        return found
    return [alike, *(refit for refit in found if refit is not alike)]


def _likely(bench: Workbench, point: Point, named: Sequence[Score], known: _Known, stop: Stop) -> list[Score]:
    """Of named hypotheses, best scores first, those whose first step from any start explains most, and a few of the
    best scores."""
    chi2 = []
    for score in named:
        _go_on(stop)
        names = score.hypothesis.names
        if names in known.ends:
            chi2.append(-np.inf)
        elif score.power > 0.0:
            known.begun[names] = _steps(bench, point, score, _starts(bench, point, score, True), 1)
            chi2.append(min(end.chi2 for end in known.begun[names]))
        else:
            chi2.append(np.inf)
    kept = {*np.argsort(chi2)[:LIKELY].tolist(), *range(REFITTED // 2)}
    return [score for k, score in enumerate(named) if k in kept]


def _starts(bench: Workbench, point: Point, score: Score, strong: bool) -> FloatArray:
    """Where the refit of a hypothesis starts, (n_names, n_starts): where its score says, and for an effect with one
    side only, whose slope at the null misleads, at sizes around the typical."""
    names = score.hypothesis.names
    null = origin(bench, point, names)
    size = np.array([typical(bench, name) for name in names])
    places = [null + np.clip(score.step, -4.0, 4.0) * size]
    away = inwards(bench.null(names))
    if away.any():
        places += [null + away * size * factor for factor in (SIZES if strong else SIZES[:1])]
    kept = point.unit[_kept(point, score.hypothesis)]
    return np.column_stack([np.concatenate([kept, np.clip(place, 0.0, 1.0)]) for place in places])


def _kept(point: Point, hypothesis: Hypothesis) -> list[int]:
    """What stays free beside a hypothesis: all but the parameters it has itself, for all runs or for fewer, and the
    targets it takes the place of."""
    gone = {*hypothesis.bases, *hypothesis.instead}
    return [i for i, name in enumerate(point.names) if base_of(name) not in gone]


def origin(bench: Workbench, point: Point, names: Sequence[str]) -> FloatArray:
    """(n_names,) where parameters stand in a point: their own value, that of all runs, or their null; of a factor, what
    the target whose place it takes has become."""
    unit = dict(zip(point.names, point.unit, strict=True))
    null = bench.null(names)
    for k, name in enumerate(names):
        target = bench.factors.get(base_of(name))
        if target in unit:
            low, pre = bench.box.low, bench.box.pre
            factor = bench.values(point)[target] / pre[bench.box.names.index(target)]
            i = bench.box.names.index(base_of(name))
            null[k] = np.clip((factor - low[i]) / bench.box.width[i], 0.0, 1.0)
    return np.array([unit.get(name, unit.get(base_of(name), z)) for name, z in zip(names, null, strict=True)])


def _spreads(bench: Workbench, point: Point, hypothesis: Hypothesis, spread: float) -> dict[str, float]:
    """Spreads at a point and of a hypothesis, the latter in typical sizes."""
    keys = {spread_key(name): spread * typical(bench, name) for name in hypothesis.names} if hypothesis.by else {}
    return {**point.spreads, **bench.spreads, **keys}


def _spread(bench: Workbench, linear: Linear, point: Point, score: Score, end: Point) -> float:
    """Spread [typical sizes] of the values that a refit ended with."""
    if not score.hypothesis.by:
        return 0.0
    return max(told_by(linear, score.hypothesis, _values(bench, point, score.hypothesis, end))[0], LEAST_SPREAD)


def _values(bench: Workbench, point: Point, hypothesis: Hypothesis, end: Point) -> FloatArray:
    """(n_names,) how far the parameters of a hypothesis moved from where they stood, in typical sizes."""
    names = hypothesis.names
    size = np.array([typical(bench, name) for name in names])
    return np.asarray((end.unit[-len(names) :] - origin(bench, point, names)) / size)


def _rough(bench: Workbench, point: Point, score: Score, known: _Known, strong: bool) -> Point:
    """A few steps towards the best fit with a hypothesis, on from what is known of it."""
    names = score.hypothesis.names
    if names in known.ends:
        end = known.ends[names]
        ends = [end] if known.good else _steps(bench, end, score, end.unit[:, None], ROUGH, strong)
    elif names in known.begun:
        null = origin(bench, point, names)
        begun = sorted(known.begun[names], key=lambda end: end.chi2)
        away = [end for end in begun if np.any(end.unit[-len(null) :] != null)]  # at the null there is no way on
        best = (away or begun)[:STARTS_KEPT]
        starts = np.column_stack([end.unit for end in best])
        ends = [*begun, *_steps(bench, replace(point, offsets=best[0].offsets), score, starts, ROUGH - 1, strong)]
    else:
        ends = _steps(bench, point, score, _starts(bench, point, score, strong), ROUGH, strong)
    return min(ends, key=lambda end: end.chi2)


def _steps(
    bench: Workbench, point: Point, score: Score, starts: FloatArray, iterations: int, strong: bool = True
) -> list[Point]:
    """So many steps of fits with a hypothesis, offsets beginning at those of the point."""
    excess = max(point.chi2 - bench.problem.n_residuals, 0.0)
    hypothesis = score.hypothesis
    return bench.refits(
        (*(point.names[i] for i in _kept(point, hypothesis)), *hypothesis.names),
        starts,
        point.offsets,
        max_iterations=iterations,
        tolerance=max(TOLERANCE, 1e-3 * excess),
        spreads=_spreads(bench, point, hypothesis, max(score.spread, 1.0 if strong else LEAST_SPREAD)),
    )


def _judged(
    bench: Workbench, linear: Linear, point: Point, score: Score, end: Point, chance: ChanceScores | None, n_terms: int
) -> Refit:
    hypothesis = score.hypothesis
    null = bench.null(hypothesis.names)
    size = np.array([typical(bench, name) for name in hypothesis.names])
    if end.chi2 > point.chi2:  # a wind of nearly nothing is not quite nothing; the null itself is always open
        kept = point.unit[_kept(point, hypothesis)]
        unit = np.concatenate([kept, origin(bench, point, hypothesis.names)])
        end = Point(end.names, unit, point.offsets, point.chi2, point.integrator, end.spreads)
    gain = point.chi2 - end.chi2
    assert gain >= 0.0, "a nested refit ended above the model it extends"
    volume = told_by(linear, hypothesis, _values(bench, point, hypothesis, end))[1] if hypothesis.by else 0.0
    k = _new(point, hypothesis)
    cost = k * np.log(bench.problem.n_residuals) + (2.0 * np.log(n_terms) if hypothesis.effect.one_of_many else 0.0)
    cost += volume
    return Refit(
        hypothesis,
        score,
        end,
        gain,
        cost,
        gain / score.inflation - cost,
        float(np.max(np.abs(end.unit[-len(null) :] - null) / size)),
        chance.p_value(evidence(max(gain / score.inflation - volume, 0.0), k)) if chance else 1.0,
        _unvisited(bench, end, hypothesis),
    )


def _unvisited(bench: Workbench, end: Point, hypothesis: Hypothesis) -> str:
    """What the trials would have to visit for a fitted hypothesis to be believed; "" where they do."""
    if hypothesis.effect.unvisited is None:
        return ""
    values = bench.values(end)
    found = {name.rpartition(".")[2]: values[name] for name in hypothesis.names}
    return hypothesis.effect.unvisited(found, bench.visited)


def _decide(bench: Workbench, refits: Sequence[Refit], rivals: Sequence[Refit]) -> tuple[bool, str]:
    if not refits:
        return False, "no effect applies"
    best = refits[0]
    if best.unvisited:
        return False, f"{best.hypothesis.tag} would be believed only where trials visit {best.unvisited}"
    if best.p_value > bench.options.level:
        return False, f"chance brings as much in {best.p_value:.2g} of all searches"
    if best.evidence < ENOUGH:
        return False, "it explains too little for one more parameter"
    if best.size < WORTH and rivals:  # so little, and not even told apart
        return False, f"its size is below a {1.0 / WORTH:.0f}th of what is worth speaking of"
    return True, ""


def _rivals(refits: Sequence[Refit]) -> list[Refit]:
    """Refits of other effects than the best that explain nearly as much."""
    best = refits[0]
    found: dict[str, Refit] = {}
    for refit in refits[1:]:
        if not best.beats(refit) and refit.hypothesis.tag != best.hypothesis.tag:
            found.setdefault(refit.hypothesis.tag, refit)
    return list(found.values())


def without(bench: Workbench, point: Point, hypothesis: Hypothesis) -> Point:
    """The point refitted without one of its hypotheses."""
    kept = [i for i, name in enumerate(point.names) if name not in hypothesis.names]
    names = [point.names[i] for i in kept]
    back = [name for name in hypothesis.instead if name in bench.targets and name not in names]
    start = np.concatenate([point.unit[kept], bench.null(back)])
    return bench.refit((*names, *back), start[:, None], point.offsets, spreads=point.spreads)


def _drop_superfluous(bench: Workbench, found: Found, asked: Sequence[Hypothesis]) -> None:
    """Drop causes of those asked for that others explain."""
    for hypothesis in list(asked):
        fewer = without(bench, found.final, hypothesis)
        if fewer.chi2 - found.final.chi2 < _price(bench, found, hypothesis) + ENOUGH:
            found.causes.remove(hypothesis)
            found.final = fewer


def _make_alike(bench: Workbench, found: Found, asked: Sequence[Hypothesis]) -> None:
    """Make values of each run one for all where that leaves little more than noise beside what was found since.

    The next look asks again whether they differ.
    """
    for cause in asked:
        one = replace(cause, by="", groups=())
        final = found.final
        kept = [i for i, name in enumerate(final.names) if name not in cause.names]
        values = dict(zip(final.names, final.unit, strict=True))
        mean = [float(np.mean([values[name] for name in cause.names if base_of(name) == base])) for base in one.names]
        alike = bench.refit(
            (*(final.names[i] for i in kept), *one.names),
            np.concatenate([final.unit[kept], mean])[:, None],
            final.offsets,
            spreads=final.spreads,
        )
        if alike.chi2 < STRONG * bench.problem.n_residuals:
            found.causes[found.causes.index(cause)] = one
            found.final = alike


def _price(bench: Workbench, found: Found, hypothesis: Hypothesis) -> float:
    """What a cause must explain at least: its share by BIC, or what it was charged when it was found."""
    paid = [r.cost for step in found.steps for r in step.refits[:1] if r.hypothesis == hypothesis and hypothesis.by]
    return paid[0] if paid else len(hypothesis.names) * float(np.log(bench.problem.n_residuals))


def rivals_of(bench: Workbench, found: Found, cause: Hypothesis) -> list[Refit]:
    """Other hypotheses that would do nearly as well in the place of a cause, all others in place: of those that were
    near when it was found."""
    step = next((s for s in found.steps if s.refits and s.refits[0].hypothesis == cause), None)
    if step is None:
        return []
    near = [r for r in step.refits[1:] if r.hypothesis.tag != cause.tag and r.gain > 0.5 * step.refits[0].gain]
    if len(found.causes) == 1:
        return _rivals(step.refits)
    fewer = without(bench, found.final, cause)
    best = replace(step.refits[0], point=found.final, gain=fewer.chi2 - found.final.chi2)
    rivals: dict[str, Refit] = {}
    for rival in near:
        if set(rival.hypothesis.bases) & {base_of(name) for name in fewer.names}:
            continue
        start = rival.point.unit[-len(rival.hypothesis.names) :]
        kept = _kept(fewer, rival.hypothesis)
        other = bench.refit(
            (*(fewer.names[i] for i in kept), *rival.hypothesis.names),
            np.concatenate([fewer.unit[kept], start])[:, None],
            fewer.offsets,
            spreads={**fewer.spreads, **rival.point.spreads},
        )
        rival = replace(rival, point=other, gain=fewer.chi2 - other.chi2)
        if not best.beats(rival):
            rivals.setdefault(rival.hypothesis.tag, rival)
    return list(rivals.values())
