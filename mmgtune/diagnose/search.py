"""The search for causes: screen, refit, decide, add, and look again.

A hypothesis is believed only where all of this holds: refitted together with the targets it explains far more than
chance would bring anywhere in the search, its size is worth speaking of, and no other hypothesis does nearly as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import FloatArray
from ..backends import Integrator
from ..fitting.least_squares import solve
from . import noise as noises
from .hypotheses import Hypothesis
from .linear import Linear, inwards, linearise, typical
from .screening import ChanceScores, Score, evidence, scores
from .workbench import TOLERANCE, Point, Workbench

STARTS = 6
"""Starts of the base fit."""

STRONG = 1.2
"""Chi-squared per residual beyond which every named hypothesis makes a step before the best are refitted."""

AGAIN = 8
"""Times the base fit may begin again where it ended."""

PRECISE = 0.02
"""Fall of chi-squared that counts as none where parameters are reported."""

REFITTED = 9
TERMS_REFITTED = 4
"""Hypotheses that are refitted each time, named ones and terms out of many: those of the best scores."""

LIKELY = 9
"""Hypotheses of the best first steps that are refitted where scores alone cannot choose."""

ROUGH = 4
"""Steps of a refit before it is compared with the others."""

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

WORTH = 0.1
"""Smallest size worth speaking of where another effect would do as well, as a share of the typical one."""

ALMOST = 0.9
"""Share of the best gain from which a finer integration step, which has no parameter, is believed before any effect."""

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
        """Whether this explains so much more that the other is out of the question."""
        better = (self.gain - other.gain) / max(self.score.inflation, other.score.inflation)
        return better >= BETTER and better - self.cost + other.cost >= ENOUGH


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
    """

    base: Point
    linear: Linear
    scores: list[Score]
    refits: list[Refit]
    rivals: list[Refit]
    accepted: bool
    reason: str
    finer: float | None = None


@dataclass(eq=False)
class Found:
    """The outcome of a search.

    base    the model re-tuned without any cause
    final   with all that were accepted
    causes  accepted hypotheses, in the order found, after those that others made superfluous were dropped
    steps   every look, the last one in vain
    rivals  for each cause, the other hypotheses that would do nearly as well in its place
    """

    base: Point
    final: Point
    causes: list[Hypothesis] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    rivals: list[list[Refit]] = field(default_factory=list)
    finer_step: float | None = None


def base_fit(bench: Workbench) -> Point:
    """The targets re-tuned without any effect: from several starts with held initial states, then with free ones."""
    names = bench.targets
    rng = np.random.default_rng(bench.options.seed)
    starts = np.column_stack([bench.null(names), *rng.uniform(size=(STARTS - 1, len(names)))])
    held = bench.problem_of(names, Integrator("euler")).held()  # a quarter of the work, and only a start
    ends = sorted(solve(held, starts, max_iterations=40, tolerance=1.0), key=lambda end: end.J)
    point = bench.refit(names, np.column_stack([end.unit for end in ends[:3]]), np.zeros_like(bench.problem.offsets))
    for _ in range(AGAIN):  # initial states at the end of their range make a bad start; from there it is a new one
        again = bench.refit(names, point.unit[:, None], point.offsets, tolerance=PRECISE)
        better = point.chi2 - again.chi2
        point = min(again, point, key=lambda one: one.chi2)
        if better < 1e-3 * point.chi2:
            break
    return point


def search(
    bench: Workbench,
    hypotheses: Sequence[Hypothesis],
    say: Callable[[str], None] = lambda _: None,
    stop: Stop = lambda: False,
) -> Found:
    """Forward search with a backward look after each addition; where it is stopped, what was accepted by then."""
    say("re-tuning the model without any cause")
    base = base_fit(bench)
    found = Found(base, base)
    left = list(hypotheses)
    while not stop():
        say("looking for a cause" if not found.causes else f"looking for cause {len(found.causes) + 1}")
        try:
            step = look(bench, found.final, left, first=not found.steps, stop=stop)
        except _Stopped:
            break
        found.steps.append(step)
        if step.finer is not None and step.finer > max(2.0 * ENOUGH, ALMOST * _gain(step)):
            say("the integration step is a cause")
            found.finer_step = step.finer
            bench.integrate(finer(bench.problem.integrator))
            found.final = bench.refit(step.base.names, step.base.unit[:, None], step.base.offsets)
            continue
        if not step.accepted:
            found.final = step.base
            break
        best = step.refits[0]
        found.causes.append(best.hypothesis)
        found.final = best.point
        left = [h for h in left if not set(h.names) & set(best.hypothesis.names)]
        if len(found.causes) >= bench.options.most:
            break
    if found.steps:
        first = found.steps[0].base
        found.base = bench.refit(first.names, first.unit[:, None], first.offsets)
        found.final = bench.refit(found.final.names, found.final.unit[:, None], found.final.offsets, tolerance=PRECISE)
    if stop():
        found.rivals = [[] for _ in found.causes]
        return found
    if len(found.causes) > 1:
        _drop_superfluous(bench, found)
    say("comparing the causes with their rivals")
    found.rivals = [_rivals_of(bench, found, k) for k in range(len(found.causes))]
    return found


def _gain(step: Step) -> float:
    return step.refits[0].gain if step.refits else 0.0


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
    names = [name for h in hypotheses for name in h.names]
    linear = linearise(bench, point, names)
    ranked = scores(linear, hypotheses)
    best = _refit_best(bench, point, ranked, linear, quick=True, stop=stop)
    richest = best[0].point if best and best[0].gain > 2.0 * ENOUGH else point
    at_best = linear if richest is point else linearise(bench, richest, [n for n in names if n not in richest.names])
    known = _noise_at(bench, at_best)
    if _differs(bench.noise, known):
        bench.know(known)
        point = bench.refit(point.names, point.unit[:, None], point.offsets)
        linear = linearise(bench, point, names)
        ranked = scores(linear, hypotheses)
    refits = _believable_first(_refit_best(bench, point, ranked, linear, quick=False, stop=stop))
    finer_gain = None
    if first:
        other = bench.refit(point.names, point.unit[:, None], point.offsets, integrator=finer(point.integrator))
        finer_gain = point.chi2 - other.chi2
    rivals = _rivals(refits) if refits else []
    accepted, reason = _decide(bench, refits, rivals)
    return Step(point, linear, ranked, refits, rivals, accepted, reason, finer_gain)


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
    return noises.estimate(bench.problem.cases, bench.noise.restore(linear.noise[linear.measured]))


def _differs(a: noises.NoiseModel, b: noises.NoiseModel) -> bool:
    """Whether two noise models give noticeably different weights."""
    for channel, one in a.channels.items():
        other = b.channels[channel]
        if abs(np.log(one.filter[2] / other.filter[2])) > 0.02 or abs(one.phi - other.phi) > 0.05:
            return True
    return False


def _refit_best(
    bench: Workbench, point: Point, ranked: Sequence[Score], linear: Linear, *, quick: bool, stop: Stop
) -> list[Refit]:
    """The most promising hypotheses refitted, best first."""
    order = sorted(ranked, key=lambda score: -score.score)
    named = [s for s in order if not s.hypothesis.effect.one_of_many]
    terms = [s for s in order if s.hypothesis.effect.one_of_many]
    strong = point.chi2 > STRONG * bench.problem.n_residuals  # too far away for a linear score to choose
    if quick:
        chosen = named[:3] + terms[:1]
    else:
        chosen = _likely(bench, point, named, stop) if strong else named[:REFITTED]
        chosen += terms[: (2 if strong else 1) * TERMS_REFITTED]
    chosen = [s for s in chosen if s.power > 0.0]
    rough = []
    for score in chosen:
        _go_on(stop)
        rough.append(_rough(bench, point, score, strong))
    gains = sorted((point.chi2 - end.chi2 for end in rough), reverse=True)
    enough = min([WORTH_GOING_ON * gains[0], *gains[FEW - 1 : FEW]]) if gains else 0.0
    chance = None if quick else ChanceScores(linear, [s.hypothesis for s in ranked], bench.options.seed)
    refits = []
    for score, end in zip(chosen, rough, strict=True):
        _go_on(stop)
        gain = point.chi2 - end.chi2
        if gain >= enough and gain > 0.5 * ENOUGH * score.inflation:
            end = bench.refit(end.names, end.unit[:, None], end.offsets)
        refits.append(_judged(bench, point, score, end, chance, n_terms=max(1, len(terms))))
    return sorted(refits, key=lambda refit: refit.cost - refit.gain)


def _likely(bench: Workbench, point: Point, named: Sequence[Score], stop: Stop) -> list[Score]:
    """Of named hypotheses, best scores first, those whose first step from any start explains most, and a few of the
    best scores."""
    first = []
    for score in named:
        _go_on(stop)
        first.append(_rough(bench, point, score, True, iterations=1).chi2 if score.power > 0.0 else np.inf)
    kept = {*np.argsort(first)[:LIKELY].tolist(), *range(REFITTED // 2)}
    return [score for k, score in enumerate(named) if k in kept]


def _starts(bench: Workbench, point: Point, score: Score, strong: bool) -> FloatArray:
    """Where the refit of a hypothesis starts, (n_names, n_starts): where its score says, and for an effect with one
    side only, whose slope at the null misleads, at sizes around the typical."""
    names = score.hypothesis.names
    null = bench.null(names)
    size = np.array([typical(bench, name) for name in names])
    places = [null + np.clip(score.step, -4.0, 4.0) * size]
    away = inwards(null)
    if away.any():
        places += [null + away * size * factor for factor in (SIZES if strong else SIZES[:1])]
    return np.column_stack([np.concatenate([point.unit, np.clip(place, 0.0, 1.0)]) for place in places])


def _rough(bench: Workbench, point: Point, score: Score, strong: bool, iterations: int = ROUGH) -> Point:
    """A few steps towards the best fit with a hypothesis."""
    excess = max(point.chi2 - bench.problem.n_residuals, 0.0)
    return bench.refit(
        (*point.names, *score.hypothesis.names),
        _starts(bench, point, score, strong),
        point.offsets,
        max_iterations=iterations,
        tolerance=max(TOLERANCE, 1e-3 * excess),
    )


def _judged(
    bench: Workbench, point: Point, score: Score, end: Point, chance: ChanceScores | None, n_terms: int
) -> Refit:
    hypothesis = score.hypothesis
    null = bench.null(hypothesis.names)
    size = np.array([typical(bench, name) for name in hypothesis.names])
    if end.chi2 > point.chi2:  # a wind of nearly nothing is not quite nothing; the null itself is always open
        unit = np.concatenate([point.unit, null])
        end = Point(end.names, unit, point.offsets, point.chi2, point.integrator)
    gain = point.chi2 - end.chi2
    assert gain >= 0.0, "a nested refit ended above the model it extends"
    k = len(hypothesis.names)
    cost = k * np.log(bench.problem.n_residuals) + (2.0 * np.log(n_terms) if hypothesis.effect.one_of_many else 0.0)
    return Refit(
        hypothesis,
        score,
        end,
        gain,
        cost,
        gain / score.inflation - cost,
        float(np.max(np.abs(end.unit[len(point.names) :] - null) / size)),
        chance.p_value(evidence(gain / score.inflation, k)) if chance else 1.0,
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
    return bench.refit([point.names[i] for i in kept], point.unit[kept][:, None], point.offsets)


def _drop_superfluous(bench: Workbench, found: Found) -> None:
    """Drop causes that those found later explain."""
    for hypothesis in list(found.causes[:-1]):
        fewer = without(bench, found.final, hypothesis)
        share = len(hypothesis.names) * np.log(bench.problem.n_residuals)
        if fewer.chi2 - found.final.chi2 < share + ENOUGH:
            found.causes.remove(hypothesis)
            found.final = fewer


def _rivals_of(bench: Workbench, found: Found, k: int) -> list[Refit]:
    """Rivals of one cause with all others in place, among those that were near when it was found."""
    cause = found.causes[k]
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
        if set(rival.hypothesis.names) & set(fewer.names):
            continue
        start = rival.point.unit[len(step.base.names) :]
        other = bench.refit(
            (*fewer.names, *rival.hypothesis.names), np.concatenate([fewer.unit, start])[:, None], fewer.offsets
        )
        rival = replace(rival, point=other, gain=fewer.chi2 - other.chi2)
        if not best.beats(rival):
            rivals.setdefault(rival.hypothesis.tag, rival)
    return list(rivals.values())
