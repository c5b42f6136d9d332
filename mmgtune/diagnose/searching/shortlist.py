"""Which hypotheses are worth a refit in a look."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

import numpy as np

from ...arrays import FloatArray
from ...components import effect_tag
from ...fitting.journal import side_by_side
from ..bench.hypotheses import Hypothesis
from ..bench.workbench import Point
from ..signatures.foretelling import Foretelling
from ..signatures.linear import SMALL, inwards
from ..signatures.screening import Score
from .refit import ENOUGH
from .refitter import SIZES, STRONG, Refitter

T = TypeVar("T")

REFITTED, TERMS_REFITTED = 11, 4
"""Hypotheses that are refitted each time, named ones and terms out of many: those of the best scores."""

ANYHOW = 4
"""Hypotheses of the best scores that are refitted whatever first steps promise."""

SURE = 2
"""Hypotheses that are refitted beside a cause, however little they explain: those whose scores chance brings least of.
Before one is known, what stands for a small part of an error that none of the others tells would be taken for it."""

LIKELY = 9
"""Hypotheses of the best first steps that are refitted where scores alone cannot choose."""

BEGUN, STARTS_BEGUN = 18, 3
"""Hypotheses, and starts of each, that make these first steps: those for which derivatives predict the largest gain."""

RUNS_REFITTED, AS_GOOD = 6, 0.85
"""Hypotheses of values that differ between runs that are refitted each time, at most; and share of the best score from
which further ones are where much is left, as scores choose badly there."""

MUCH = 0.5
"""Share of what the best explains from which forms with more parameters are refitted too."""

FIRST = 4
"""First steps of an effect with one side only, from each start: in the first of them the targets only follow."""


@dataclass(frozen=True, eq=False)
class Shortlist:
    """Chooses what is refitted in a look.

    refitter  which makes the first steps
    every     whether every hypothesis makes first steps: where nothing is re-tuned derivatives predict little
    """

    refitter: Refitter
    every: bool = False

    def for_all_runs(self, order: Sequence[Score], *, quick: bool) -> list[Score]:
        """Hypotheses with one value for all runs that are worth a refit, of all, best scores first.

        quick  the few with the best scores
        """
        named = [s for s in order if not s.hypothesis.effect.one_of_many and not s.hypothesis.by]
        terms = [s for s in order if s.hypothesis.effect.one_of_many]
        top = named[:3] + terms[:1]
        if quick:
            chosen = top
        else:
            strong = self.refitter.strong
            chosen = self._likely(named) if strong or self.refitter.given else named[:REFITTED]
            chosen += [] if strong else self._well_formed(named, chosen)
            beside = any(effect_tag(name) for name in self.refitter.point.names)
            sure = sorted(named, key=lambda score: -score.evidence)[: SURE if beside else 0]
            chosen += [score for score in sure if score not in chosen]
            chosen += terms[: (2 if strong else 1) * TERMS_REFITTED]
            if not strong:
                chosen = [s for s in chosen if s in top or self._may_tell(s)]
        return [s for s in chosen if s.power > 0.0]

    def _likely(self, named: Sequence[Score]) -> list[Score]:
        """The named hypotheses (best scores first) whose first steps from any start explain most, and a few with the
        best scores; by fits without leeway where there is ``given``."""
        point = self.refitter.before
        if self.refitter.given:
            place = {names: k for k, names in enumerate(self.refitter.given.steps)}
            named = sorted(named, key=lambda score: place[score.hypothesis.names])
        known = [score.hypothesis.names in self.refitter.known.ends for score in named]
        chi2 = np.where(known, -np.inf, np.inf)
        asked = [k for k, score in enumerate(named) if score.power > 0.0 and not known[k]]
        starts = {k: self.refitter.starts(point, named[k], SIZES) for k in asked}
        begin = self._first_by_step if self.every else self._promising
        begun = begin(point, named, starts)
        first = self.refitter.of_each(
            [
                partial(
                    Refitter.steps,
                    point=point,
                    score=named[k],
                    starts=those,
                    iterations=FIRST if those.shape[1] > 1 else 1,
                )
                for k, those in begun.items()
            ]
        )
        for k, ends in zip(begun, first, strict=True):
            self.refitter.known.begun[named[k].hypothesis.names] = ends
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
        earned = score.score / score.inflation - self.refitter.n_new(hypothesis) * self.refitter.bench.price
        sided = bool(inwards(self.refitter.bench.null(hypothesis.names)).any())
        return earned > 0.0 or sided or bool(hypothesis.effect.form)

    def _by_form(self, score: Score) -> float:
        """Fall of chi-squared that a hypothesis promises when the form of its effect may change too, about a small
        size; the score takes the formula as exact."""
        bench, point, own = self.refitter.bench, self.refitter.point, score.hypothesis.names
        forms = [name for name in bench.believed.form_of(score.hypothesis.effect) if name not in point.names]
        null = bench.null(own)
        small = SMALL * np.where(null > 0.5, -1.0, 1.0) * self.refitter.typical(score.hypothesis)
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
        columns = self.refitter.linear.retuned(np.column_stack([plain, formed / SMALL]) / SMALL)
        believed = np.diag([0.0] * len(own) + [1.0] * len(forms))
        normal = columns.T @ columns + believed
        along = columns.T @ self.refitter.linear.residual
        return float(along @ np.linalg.lstsq(normal, along, rcond=1e-12)[0])

    def _foretelling(self, point: Point, named: Iterable[Score]) -> Foretelling:
        """Predictor of what steps of hypotheses gain, with derivatives taken at a point without them."""
        linear = self.refitter.given.linear if self.refitter.given else self.refitter.linear
        return Foretelling(self.refitter.bench, point, linear, [score.hypothesis for score in named])

    def _side_by_side(
        self, foretold: Callable[[Hypothesis, FloatArray], T], named: Sequence[Score], starts: Mapping[int, FloatArray]
    ) -> list[T]:
        """What is foretold of each of some hypotheses, by number, from its starts."""

        def one(k: int) -> T:
            self.refitter.go_on()
            return foretold(named[k].hypothesis, starts[k])

        return side_by_side([partial(one, k) for k in starts])

    def _first_by_step(
        self, point: Point, named: Sequence[Score], starts: Mapping[int, FloatArray]
    ) -> dict[int, FloatArray]:
        """Where the best step from the starts leads, by number of the hypothesis: for the hypotheses that gain most,
        and for the best scores anyhow."""
        foretelling = self._foretelling(point, (named[k] for k in starts))
        tried = self._side_by_side(foretelling.tried, named, starts)
        led, left = {}, {}
        for k, (where, chi2) in zip(starts, tried, strict=True):
            best = np.argsort(chi2, kind="stable")[:STARTS_BEGUN]
            led[k], left[k] = where[:, best], chi2[best[0]]
        likely = sorted(led, key=lambda k: left[k])[:LIKELY]
        return {k: where for k, where in led.items() if k in likely or k < ANYHOW}

    def _promising(
        self, point: Point, named: Sequence[Score], starts: Mapping[int, FloatArray]
    ) -> dict[int, FloatArray]:
        """The starts with the largest predicted gain, by number of the hypothesis; those of the best scores anyhow."""
        foretelling = self._foretelling(point, (named[k] for k in starts))
        least = dict(zip(starts, self._side_by_side(foretelling.left, named, starts), strict=True))
        likely = sorted(starts, key=lambda k: least[k].min())[:BEGUN]
        return {
            k: those[:, np.argsort(least[k], kind="stable")[:STARTS_BEGUN]]
            for k, those in starts.items()
            if k in likely or k < ANYHOW
        }

    def of_runs(self, order: Sequence[Score], fitted: Sequence[Point], *, quick: bool) -> list[Score]:
        """Hypotheses with run-specific values that are worth a refit beside those with one value for all, ``fitted``.

        Where one value for all leaves little more than noise, it is added first; a later look shows whether it differs
        between runs.
        """
        differing = [s for s in order if s.hypothesis.by and s.spread > 0.0]
        n = self.refitter.bench.problem.n_residuals
        left = min((end.chi2 for end in fitted), default=self.refitter.point.chi2)
        price = self.refitter.bench.price
        earned = [s for s in differing if s.score - self.refitter.n_new(s.hypothesis) * price > 0.5 * ENOUGH]
        if left > STRONG * n:
            best = max((s.score for s in earned), default=0.0)
            nearly = [s for s in earned[RUNS_REFITTED:] if s.score > AS_GOOD * best]
            return earned[:1] if quick else earned[:RUNS_REFITTED] + nearly
        alike = max((s.score / s.inflation - len(s.step) * price for s in order if not s.hypothesis.by), default=0.0)
        better = [s for s in earned if s.score - self.refitter.n_new(s.hypothesis) * price > alike]
        # Where much was left before, scores are far off: the zero of the rudder in one run is behind a wind there.
        return better[: 1 if quick else RUNS_REFITTED if self.refitter.strong else 2]


def akin(order: Sequence[Score], fitted: Sequence[tuple[Score, Point]], chi2: float) -> list[Score]:
    """Hypotheses that act much like the best fit, or the best with one value for all runs, and whose scores may mislead
    (the score of a wind is that of a light one); where the best has values by group of runs, its special cases; and
    forms with more parameters of what explains much: alone these may do nothing, as the direction of a measured wind.

    chi2  of what they are fitted beside
    """
    if not fitted:
        return []
    ends = sorted(fitted, key=lambda one: one[1].chi2)
    ranked = [score.hypothesis for score, _ in ends]
    best = ranked[0]
    for_all = next((one for one in ranked if not one.by), best)
    much = chi2 - MUCH * (chi2 - ends[0][1].chi2)
    good = [score.hypothesis for score, end in ends if end.chi2 <= min(much, chi2 - ENOUGH) and not score.hypothesis.by]
    there = {score.hypothesis.names for score, _ in fitted}
    found = []
    for score in order:
        one = score.hypothesis
        alike = any(one.tag in other.effect.akin and one.by in ("", other.by) for other in (best, for_all))
        special = bool(best.by and one.by) and best.holds(one)
        fuller = not one.by and any(one.holds(other) for other in good)
        if (fuller or (score.power > 0.0 and (alike or special))) and one.names not in there:
            found.append(score)
    return found
