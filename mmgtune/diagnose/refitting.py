"""Which hypotheses are refitted in a look, from where, and how far."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import FloatArray
from ..fitting.box import base_of
from .base_fit import unnoticed
from .beside import free_with, kept_free, origin
from .foretelling import Foretelling
from .hypotheses import Hypothesis
from .linear import SMALL, Linear, inwards, typical
from .refit import ENOUGH, Refit
from .runs import spread_key
from .screening import ChanceScores, Score, evidence, told_by
from .workbench import TOLERANCE, Point, Workbench

STRONG = 1.2
"""Chi-squared per residual beyond which every named hypothesis makes a step before the best are refitted."""

REFITTED, TERMS_REFITTED = 11, 4
"""Hypotheses that are refitted each time, named ones and terms out of many: those of the best scores."""

ANYHOW = 4
"""Hypotheses of the best scores that are refitted whatever first steps promise."""

LIKELY = 9
"""Hypotheses of the best first steps that are refitted where scores alone cannot choose."""

BEGUN, STARTS_BEGUN = 18, 3
"""Hypotheses, and starts of each, that make these first steps: those for which derivatives predict the largest gain."""

HOPELESS = 10.0
"""Where much is left, what leaves so many times what the best leaves is not refitted further: of values of runs, beside
the best of them; of all others, where the best of these leaves hardly more than noise."""

HARDLY_MORE = 0.05
"""Share of the residuals beyond their noise that any may leave."""

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

LONG_WAYS = 3
"""Times the refit with the best predicted end is continued: along a narrow valley steps are short."""

UNLIKE_SIDES = 5.0
"""Gain that a term of a hull with unlike sides must bring in addition: on turns to one side it acts like the symmetric
term."""

FIRST = 4
"""First steps of an effect with one side only, from each start: in the first of them the targets only follow."""

STARTS_KEPT = 2
"""Starts of a hypothesis that go on after a first step from each."""

SIZES = (1.0, 0.5, 2.0, 0.25)
"""Sizes of effects with one side only at which refits start, in typical sizes."""

WORTH_GOING_ON = 0.5
"""Share of the best gain from which a refit is continued to its end, besides those of the best few."""

FEW = 4
"""The best few."""


class Stopped(Exception):
    """Raised where a look was stopped before its end; it has no result."""


@dataclass(eq=False)
class Known:
    """Cache of the refits of a look, by the names of the hypothesis.

    ends   finished ones
    good   whether they were made with the noise in use; else they only serve as starts
    begun  first steps from each start
    least  chi-squared of the best refit with one value for all runs, finished or not, in the noise in use
    """

    ends: dict[tuple[str, ...], Point] = field(default_factory=dict)
    good: bool = True
    begun: dict[tuple[str, ...], list[Point]] = field(default_factory=dict)
    least: float = math.inf

    def outdate(self) -> None:
        """Mark refits as made with outdated noise."""
        self.good, self.least = False, math.inf

    def note(self, hypothesis: Hypothesis, ends: list[Point]) -> list[Point]:
        """The ends of refits of a hypothesis, noted in ``least`` where one of them is the best of all."""
        if not hypothesis.by:
            self.least = min([self.least, *(end.chi2 for end in ends)])
        return ends


@dataclass(frozen=True, eq=False)
class Given:
    """Starting state of a look with leeway parameters fixed at the profile's values, where they have absorbed nothing
    of any cause.

    point  the causes accepted so far, fitted that way
    linear the problem made linear at that point, with the signatures of hypotheses
    steps  of hypotheses by name, in typical sizes, as their scores there promise; the best scores first
    """

    point: Point
    linear: Linear
    steps: Mapping[tuple[str, ...], FloatArray]


@dataclass(frozen=True, eq=False)
class Refitting:
    """What a look refits hypotheses from.

    bench   the trials, and the model with every effect
    point   the point with the causes accepted so far
    linear  the problem made linear at that point, with the signatures of hypotheses
    known   refits there are within the look
    given   the same without leeway; None where nothing has leeway or little error is left without it either
    every   whether every hypothesis makes first steps: where nothing is re-tuned derivatives predict little
    enough  chi-squared from which on no refit is of use
    """

    bench: Workbench
    point: Point
    linear: Linear
    known: Known
    given: Given | None = None
    every: bool = False
    enough: float = math.inf

    @property
    def strong(self) -> bool:
        """Whether so much is left that a linear score cannot choose."""
        return self.point.chi2 > STRONG * self.bench.problem.n_residuals

    @property
    def _hopeless(self) -> float:
        """Chi-squared above which refits are given up in this look."""
        return min(self.enough, hopeless_beside(self.bench, self.known.least))

    @property
    def _before(self) -> Point:
        """The point from which named hypotheses make their first steps: one where parameters with leeway have absorbed
        nothing."""
        return self.given.point if self.given else self.point

    def best(self, ranked: Sequence[Score], *, quick: bool) -> list[Refit]:
        """Refits of the most promising hypotheses, best first; they are kept in ``known``.

        Raises Stopped where the caller stopped it.
        """
        order = sorted(ranked, key=lambda score: -score.score)
        named = [s for s in order if not s.hypothesis.effect.one_of_many and not s.hypothesis.by]
        terms = [s for s in order if s.hypothesis.effect.one_of_many]
        top = named[:3] + terms[:1]
        if quick:
            chosen = top
        else:
            self._renew(ranked)
            chosen = self._likely(named) if self.strong or self.given else named[:REFITTED]
            chosen += [] if self.strong else self._well_formed(named, chosen)
            chosen += terms[: (2 if self.strong else 1) * TERMS_REFITTED]
            if not self.strong:
                chosen = [s for s in chosen if s in top or self._may_tell(s)]
        fitted = self._fitted([s for s in chosen if s.power > 0.0])
        fitted += self._fitted(self._of_runs_worth(order, [end for _, end in fitted], quick=quick))
        fitted += self._fitted(akin(order, fitted))
        asked = [s.hypothesis for s in ranked]
        chance = None if quick else ChanceScores(self.linear, asked, self.bench.options.seed)
        return self._ordered([self._judged(score, end, chance, max(1, len(terms))) for score, end in fitted])

    def _renew(self, ranked: Sequence[Score]) -> None:
        """Redo the cached refits with the present noise: hopeless ones are judged by them."""
        if not self.known.good:
            for score in ranked:
                if score.hypothesis.names in self.known.ends:
                    self._go_on()
                    self.known.ends[score.hypothesis.names] = self._rough(score)
            self.known.good = True

    def _go_on(self) -> None:
        if self.bench.stop():
            raise Stopped

    def _likely(self, named: Sequence[Score]) -> list[Score]:
        """The named hypotheses (best scores first) whose first steps from any start explain most, and a few with the
        best scores; by fits without leeway where there is ``given``."""
        point = self._before
        if self.given:
            place = {names: k for k, names in enumerate(self.given.steps)}
            named = sorted(named, key=lambda score: place[score.hypothesis.names])
        known = [score.hypothesis.names in self.known.ends for score in named]
        chi2 = np.where(known, -np.inf, np.inf)
        asked = [k for k, score in enumerate(named) if score.power > 0.0 and not known[k]]
        starts = {k: self._starts(point, named[k], SIZES) for k in asked}
        begin = self._first_by_step if self.every else self._promising
        for k, those in begin(point, named, starts).items():
            self._go_on()
            ends = self._steps(point, named[k], those, FIRST if those.shape[1] > 1 else 1)
            self.known.begun[named[k].hypothesis.names] = ends
            chi2[k] = min(end.chi2 for end in ends)
        kept = {*np.argsort(chi2)[:LIKELY].tolist(), *range(ANYHOW)}
        return [score for k, score in enumerate(named) if k in kept]

    def _well_formed(self, named: Sequence[Score], chosen: Sequence[Score]) -> list[Score]:
        """Named hypotheses, best scores first, that would do as well as the best if the form of their effect may
        change, less those that were chosen already."""
        there = {score.hypothesis.names for score in chosen}
        enough = max([ENOUGH, *(score.score for score in named[REFITTED - 1 : REFITTED])])
        others = [s for s in named if s.power > 0.0 and s.hypothesis.effect.form and s.hypothesis.names not in there]
        return [score for score in others if self._by_form(score) > enough]

    def _may_tell(self, score: Score) -> bool:
        """Whether a refit may gain more than its price where little error is left: by its score, or because the score
        says little, as for one-sided effects, whose slope at the null misleads, and for effects with a form."""
        hypothesis = score.hypothesis
        earned = score.score / score.inflation - self._new(hypothesis) * self.bench.price
        sided = bool(inwards(self.bench.null(hypothesis.names)).any())
        return earned > 0.0 or sided or bool(hypothesis.effect.form)

    def _by_form(self, score: Score) -> float:
        """Fall of chi-squared that a hypothesis promises when the form of its effect may change too, about a small
        size; the score takes the formula as exact."""
        bench, point, own = self.bench, self.point, score.hypothesis.names
        forms = [name for name in bench.believed.form_of(score.hypothesis.effect) if name not in point.names]
        null = bench.null(own)
        small = SMALL * np.where(null > 0.5, -1.0, 1.0) * self._typical(score.hypothesis)
        problem = bench.problem_of((*point.names, *own, *forms), point.integrator).with_offsets(point.offsets)
        here = np.concatenate([point.unit, null, bench.null(forms)])
        at = [len(point.names) + k for k in range(len(own) + len(forms))]
        moved = np.repeat(here[:, None], 2 + len(at), axis=1)
        moved[at[: len(own)], 1 + np.arange(len(own))] += small
        moved[at[: len(own)], 1 + len(own) :] += small[:, None]
        deviations = np.array([bench.believed.forms[name] for name in forms])
        moved[at[len(own) :], 2 + len(own) + np.arange(len(forms))] += deviations * SMALL
        runs = problem.residuals(moved).T
        if not np.isfinite(runs).all():
            return 0.0
        values = bench.noise.apply(runs)
        plain = values[:, 1 : 1 + len(own)] - values[:, :1]
        formed = values[:, 2 + len(own) :] - values[:, 1 + len(own) : 2 + len(own)]
        columns = self.linear.retuned(np.column_stack([plain, formed / SMALL]) / SMALL)
        believed = np.diag([0.0] * len(own) + [1.0] * len(forms))
        normal = columns.T @ columns + believed
        along = columns.T @ self.linear.residual
        return float(along @ np.linalg.lstsq(normal, along, rcond=1e-12)[0])

    def _foretelling(self, point: Point, named: Iterable[Score]) -> Foretelling:
        """Predictor of what steps of hypotheses gain, with derivatives taken at a point without them."""
        linear = self.given.linear if self.given else self.linear
        return Foretelling(self.bench, point, linear, [score.hypothesis for score in named])

    def _first_by_step(
        self, point: Point, named: Sequence[Score], starts: Mapping[int, FloatArray]
    ) -> dict[int, FloatArray]:
        """Where the best step from the starts leads, by number of the hypothesis: for the hypotheses that gain most,
        and for the best scores anyhow."""
        foretelling = self._foretelling(point, (named[k] for k in starts))
        led, left = {}, {}
        for k, those in starts.items():
            self._go_on()
            where, chi2 = foretelling.tried(named[k].hypothesis, those)
            best = np.argsort(chi2, kind="stable")[:STARTS_BEGUN]
            led[k], left[k] = where[:, best], chi2[best[0]]
        likely = sorted(led, key=lambda k: left[k])[:LIKELY]
        return {k: where for k, where in led.items() if k in likely or k < ANYHOW}

    def _promising(
        self, point: Point, named: Sequence[Score], starts: Mapping[int, FloatArray]
    ) -> dict[int, FloatArray]:
        """The starts with the largest predicted gain, by number of the hypothesis; those of the best scores anyhow."""
        foretelling = self._foretelling(point, (named[k] for k in starts))
        least = {}
        for k, those in starts.items():
            self._go_on()
            least[k] = foretelling.left(named[k].hypothesis, those)
        likely = sorted(starts, key=lambda k: least[k].min())[:BEGUN]
        return {
            k: those[:, np.argsort(least[k], kind="stable")[:STARTS_BEGUN]]
            for k, those in starts.items()
            if k in likely or k < ANYHOW
        }

    def _fitted(self, chosen: Sequence[Score]) -> list[tuple[Score, Point]]:
        """Refits of hypotheses; those that promise much are carried to the end."""
        rough = self._all_rough(chosen)
        n = self.bench.problem.n_residuals
        gains = sorted((self.point.chi2 - end.foreseen for end in rough), reverse=True)
        enough = min([WORTH_GOING_ON * gains[0], *gains[FEW - 1 : FEW]]) if gains else 0.0
        left = min((end.chi2 for end in rough), default=self.point.chi2) - n
        ends = []
        for score, end in zip(chosen, rough, strict=True):
            self._go_on()
            gain = self.point.chi2 - end.foreseen
            far = bool(score.hypothesis.by) and self.strong and end.chi2 - n > HOPELESS * max(left, 0.0)
            hopeless = far or end.foreseen > self.enough
            if not hopeless and gain >= enough and gain > 0.5 * ENOUGH * score.inflation:
                end = self._on(score, end, MOST_STEPS if self.strong else ALL_STEPS)
            ends.append(end)
        best = sorted(range(len(ends)), key=lambda k: ends[k].chi2)[:FEW] if self.strong else []
        for k in best:  # where little is known the others may take for ever, and are out of the question
            if ends[k].foreseen > self.enough:
                continue
            self._go_on()
            ends[k] = self._on(chosen[k], ends[k], ALL_STEPS)
        for _ in range(LONG_WAYS):
            k = min(range(len(ends)), key=lambda k: ends[k].foreseen, default=0)
            if not ends or min(end.chi2 for end in ends) - ends[k].foreseen < ENOUGH:
                break
            self._go_on()
            ends[k] = self._on(chosen[k], ends[k], ALL_STEPS)
        self.known.ends.update((score.hypothesis.names, end) for score, end in zip(chosen, ends, strict=True))
        return list(zip(chosen, ends, strict=True))

    def _all_rough(self, chosen: Sequence[Score]) -> list[Point]:
        """A few steps towards the best fit with each hypothesis, the likeliest first: others may be hopeless then."""
        begun = [self.known.begun.get(score.hypothesis.names, ()) for score in chosen]
        likely = np.argsort([min((end.chi2 for end in ends), default=np.inf) for ends in begun], kind="stable")
        found: dict[int, Point] = {}
        for k in likely.tolist():
            self._go_on()
            found[k] = self._rough(chosen[k])
        return [found[k] for k in range(len(chosen))]

    def _of_runs_worth(self, order: Sequence[Score], fitted: Sequence[Point], *, quick: bool) -> list[Score]:
        """Hypotheses with run-specific values that are worth a refit beside those with one value for all.

        Where one value for all leaves little more than noise, it is added first; a later look shows whether it differs
        between runs.
        """
        differing = [s for s in order if s.hypothesis.by and s.spread > 0.0]
        n = self.bench.problem.n_residuals
        left = min((end.chi2 for end in fitted), default=self.point.chi2)
        price = self.bench.price
        earned = [s for s in differing if s.score - self._new(s.hypothesis) * price > 0.5 * ENOUGH]
        if left > STRONG * n:
            return earned[: 1 if quick else RUNS_REFITTED]
        alike = max((s.score / s.inflation - len(s.step) * price for s in order if not s.hypothesis.by), default=0.0)
        return [s for s in earned if s.score - self._new(s.hypothesis) * price > alike][: 1 if quick else 2]

    def _ordered(self, refits: Sequence[Refit]) -> list[Refit]:
        """The best first: one value for all before values that differ between runs, unless these explain far more."""
        found = sorted(refits, key=lambda refit: refit.cost - refit.gain)
        alike = next((refit for refit in found if not refit.hypothesis.by), None)
        if alike is None or not found[0].hypothesis.by:
            return found
        n = self.bench.problem.n_residuals
        noise = n if alike.point.chi2 >= n else found[0].point.chi2  # beneath n, noise was known as too large
        left = [max(refit.point.chi2 - noise, math.sqrt(2.0 * n)) for refit in (found[0], alike)]
        inflation = max(found[0].score.inflation, alike.score.inflation)
        better = (found[0].gain - alike.gain) / inflation - found[0].cost + alike.cost
        none = alike.evidence < ENOUGH
        if (better >= ENOUGH or none) and (not self.strong or left[0] <= FAR_LESS * left[1]):
            return found
        return [alike, *(refit for refit in found if refit is not alike)]

    def _rough(self, score: Score) -> Point:
        """A few steps towards the best fit with a hypothesis, continued from its cached refits."""
        names = score.hypothesis.names
        if names in self.known.ends:
            end = self.known.ends[names]
            ends = [end] if self.known.good else self._steps(end, score, end.unit[:, None], ROUGH)
        elif names in self.known.begun:
            before = self._before
            nearest = min(self.known.begun[names], key=lambda end: end.foreseen)
            if nearest.foreseen > self.enough:
                return nearest
            null = origin(self.bench, before, names)
            begun = sorted(self.known.begun[names], key=lambda end: end.chi2)
            away = [end for end in begun if np.any(end.unit[-len(null) :] != null)]  # at the null there is no way on
            best = (away or begun)[:STARTS_KEPT]
            starts = np.column_stack([end.unit for end in best])
            ends = [*begun, *self._steps(replace(best[0], chi2=before.chi2), score, starts, ROUGH - 1)]
            if self.given is not None:
                ends = self._released(score, min(ends, key=lambda end: end.chi2))
        else:
            ends = self._steps(self.point, score, self._starts(self.point, score, SIZES[:1]), ROUGH)
            ends += self._from_one_for_all(score)
        return min(ends, key=lambda end: end.foreseen)

    def _from_one_for_all(self, score: Score) -> list[Point]:
        """A few steps with values that differ between runs, from one value for all where that is fitted: they cannot do
        worse, and a linear score may lead elsewhere."""
        hypothesis = score.hypothesis
        alike = self.known.ends.get(replace(hypothesis, by="", groups=()).names) if hypothesis.by else None
        if alike is None:
            return []
        values = dict(zip(alike.names, alike.unit, strict=True))
        start = np.array([values.get(name, values.get(base_of(name))) for name in free_with(alike, hypothesis)])
        there = replace(alike, chi2=self.point.chi2, spreads=self.point.spreads)
        return self._steps(there, score, start[:, None], ROUGH)

    def _released(self, score: Score, end: Point) -> list[Point]:
        """A few steps with leeway, continued from a refit without, and from the step that the score promises."""
        names = [self.point.names[i] for i in kept_free(self.point, score.hypothesis)]
        there = dict(zip(end.names, end.unit, strict=True))
        own = [there.get(name, z) for name, z in zip(names, self.bench.null(names), strict=True)]
        by_score = self._starts(self.point, score, ())[:, 0]
        on = np.array([*own, *(there[name] for name in score.hypothesis.names)])
        found = []
        for offsets, start in ((end.offsets, on), (self.point.offsets, by_score)):
            found += self._steps(replace(self.point, offsets=offsets), score, start[:, None], ROUGH)
        return found

    def _starts(self, point: Point, score: Score, sizes: Sequence[float]) -> FloatArray:
        """Where the refit of a hypothesis starts from a point, (n_names, n_starts): where its score says, and for an
        effect with one side only, whose slope at the null misleads, at sizes around the typical.

        Where it replaces a target that ended at a bound, the other targets were drawn astray by that one: it also
        starts from the profile's values of the targets.
        """
        names = score.hypothesis.names
        null = origin(self.bench, point, names)
        size = self._typical(score.hypothesis)
        step = self.given.steps[names] if self.given and point is self.given.point else score.step
        places = [null + np.clip(step, -4.0, 4.0) * size]
        away = inwards(self.bench.null(names))
        if away.any():
            places += [null + away * size * factor for factor in sizes]
        kept = kept_free(point, score.hypothesis)
        others = [point.unit[kept]]
        if score.hypothesis.instead:
            others.append(self.bench.null([point.names[i] for i in kept]))
        return np.column_stack([np.concatenate([z, np.clip(place, 0.0, 1.0)]) for z in others for place in places])

    def _steps(self, point: Point, score: Score, starts: FloatArray, iterations: int) -> list[Point]:
        """A number of steps of fits with a hypothesis, from starts at a point and its offsets."""
        hypothesis = score.hypothesis
        excess = max(point.chi2 - self.bench.problem.n_residuals, 0.0)
        return self.known.note(
            hypothesis,
            self.bench.refits(
                free_with(point, hypothesis),
                starts,
                point.offsets,
                max_iterations=iterations,
                tolerance=max(TOLERANCE, 1e-3 * excess),
                spreads=self._spreads(point, hypothesis, max(score.spread, 1.0 if self.strong else LEAST_SPREAD)),
                hopeless=self._hopeless,
            ),
        )

    def _on(self, score: Score, end: Point, steps: int) -> Point:
        """A refit continued for a number of steps."""
        spread = 0.0
        if score.hypothesis.by:
            spread = max(told_by(self.linear, score.hypothesis, self._moved(score.hypothesis, end))[0], LEAST_SPREAD)
        (end,) = self.known.note(
            score.hypothesis,
            self.bench.refits(
                end.names,
                end.unit[:, None],
                end.offsets,
                spreads=self._spreads(self.point, score.hypothesis, spread),
                max_iterations=steps,
                tolerance=unnoticed(self.bench, end.chi2),
                hopeless=self._hopeless,
            ),
        )
        return end

    def _judged(self, score: Score, end: Point, chance: ChanceScores | None, n_terms: int) -> Refit:
        """A refit with its gain, cost, evidence and p-value; ``n_terms`` is how many terms there are to choose from."""
        bench, point, hypothesis = self.bench, self.point, score.hypothesis
        null = bench.null(hypothesis.names)
        # A wind of nearly nothing is not quite nothing, and numbers may run away: the null itself is always open.
        if not end.chi2 <= point.chi2:
            kept = kept_free(point, hypothesis)
            unit = np.concatenate([point.unit[kept], origin(bench, point, hypothesis.names)])
            end = Point(free_with(point, hypothesis), unit, point.offsets, point.chi2, point.integrator, end.spreads)
        gain = point.chi2 - end.chi2
        volume = told_by(self.linear, hypothesis, self._moved(hypothesis, end))[1] if hypothesis.by else 0.0
        k = self._new(hypothesis)
        cost = k * bench.price + (2.0 * np.log(n_terms) if hypothesis.effect.one_of_many else 0.0)
        cost += volume + (UNLIKE_SIDES if hypothesis.lopsided else 0.0)
        return Refit(
            hypothesis,
            score,
            end,
            gain,
            cost,
            gain / score.inflation - cost,
            float(np.max(np.abs(end.unit[-len(null) :] - null) / self._typical(hypothesis))),
            chance.p_value(evidence(max(gain / score.inflation - volume, 0.0), k)) if chance else 1.0,
            _unvisited(bench, end, hypothesis),
        )

    def _new(self, hypothesis: Hypothesis) -> int:
        """Numbers that a hypothesis adds to the point: means that are not free there, and a spread."""
        there = {base_of(name) for name in self.point.names}
        return sum(base not in there for base in hypothesis.bases) + bool(hypothesis.by)

    def _spreads(self, point: Point, hypothesis: Hypothesis, spread: float) -> dict[str, float]:
        """Spreads at a point and of a hypothesis, the latter in typical sizes."""
        names = hypothesis.names if hypothesis.by else ()
        return {
            **point.spreads,
            **self.bench.spreads,
            **{spread_key(n): spread * typical(self.bench, n) for n in names},
        }

    def _moved(self, hypothesis: Hypothesis, end: Point) -> FloatArray:
        """(n_names,) how far the parameters of a hypothesis moved from where they stood, in typical sizes."""
        names = hypothesis.names
        moved = end.unit[-len(names) :] - origin(self.bench, self.point, names)
        return np.asarray(moved / self._typical(hypothesis))

    def _typical(self, hypothesis: Hypothesis) -> FloatArray:
        """(n_names,) typical sizes of the parameters of a hypothesis in the unit cube."""
        return np.array([typical(self.bench, name) for name in hypothesis.names])


def _unvisited(bench: Workbench, end: Point, hypothesis: Hypothesis) -> str:
    """What the trials would have to visit for a fitted hypothesis to be believed; "" where they do."""
    if hypothesis.effect.unvisited is None:
        return ""
    values = bench.values(end)
    found = {name.rpartition(".")[2]: values[name] for name in hypothesis.names}
    return hypothesis.effect.unvisited(found, bench.visited)


def hopeless_beside(bench: Workbench, chi2: float) -> float:
    """Chi-squared above which refits are given up where the best refit leaves hardly more than noise; inf where it
    leaves more."""
    n = bench.problem.n_residuals
    return math.inf if chi2 > STRONG * n else n + HOPELESS * max(chi2 - n, HARDLY_MORE * n)


def akin(order: Sequence[Score], fitted: Sequence[tuple[Score, Point]]) -> list[Score]:
    """Hypotheses that act much like the best fit and whose scores may mislead (the score of a wind is that of a light
    one); and, where the best has values by group of runs, its special cases."""
    if not fitted:
        return []
    best = min(fitted, key=lambda one: one[1].chi2)[0].hypothesis
    there = {score.hypothesis.names for score, _ in fitted}
    found = []
    for score in order:
        one = score.hypothesis
        alike = one.tag in best.effect.akin and one.by in ("", best.by)
        special = bool(best.by and one.by) and best.holds(one)
        if (alike or special) and score.power > 0.0 and one.names not in there:
            found.append(score)
    return found
