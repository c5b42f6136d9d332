"""Refits of a look: those on the shortlist, the likeliest first, and what each is worth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...fitting.box import base_of
from ...profile import scale_of
from ..bench.hypotheses import Hypothesis
from ..bench.workbench import Point, Workbench
from ..signatures.beside import free_with, kept_free, origin
from ..signatures.linear import inwards, typical
from ..signatures.screening import ChanceScores, Score, evidence, told_by
from .refit import ENOUGH, Refit
from .refitter import HOPELESS, SIZES, STARTS_KEPT, Known, Refitter
from .shortlist import Shortlist, akin

FAR_LESS = 1.0 / 3.0
"""Share of the error left by the best value for all runs that values which differ between them may leave, where much is
left."""

MOST_STEPS, ALL_STEPS = 10, 30
"""Further steps of a refit where much is left, and of the best few."""

LONG_WAYS = 3
"""Times the refit with the best predicted end is continued: along a narrow valley steps are short."""

UNLIKE_SIDES = 5.0
"""Gain that a term of a hull with unlike sides must bring in addition: on turns to one side it acts like the symmetric
term."""

WORTH_GOING_ON = 0.5
"""Share of the best gain from which a refit is continued to its end, besides those of the best few."""

FEW = 4
"""The best few."""

FURTHER = (1.0, 2.0)
"""Typical sizes at which a refit begins again beside a form of its effect with fewer parameters."""


@dataclass(frozen=True, eq=False)
class Refitting:
    """The refits of a look.

    refitter  of single hypotheses
    every     whether every hypothesis makes first steps, before those worth a refit are chosen
    """

    refitter: Refitter
    every: bool = False

    def best(self, ranked: Sequence[Score], *, quick: bool) -> list[Refit]:
        """Refits of the most promising hypotheses, best first; they are kept in ``known``.

        Raises Stopped where the caller stopped it.
        """
        refitter, shortlist = self.refitter, Shortlist(self.refitter, self.every)
        order = sorted(ranked, key=lambda score: -score.score)
        if not quick:
            refitter.renew(ranked)
        fitted = self._fitted(shortlist.for_all_runs(order, quick=quick))
        fitted += self._fitted(shortlist.of_runs(order, [end for _, end in fitted], quick=quick))
        fitted += self._fitted(akin(order, fitted, refitter.point.chi2))
        if refitter.strong and not quick:
            fitted = self._from_their_kin(fitted)
        fitted = [(score, self._beside_fewer(score, end, fitted)) for score, end in fitted]
        fitted = [(score, end) for score, end in fitted if self._may_be_of_runs(score.hypothesis, end)]
        asked = [s.hypothesis for s in ranked]
        chance = None if quick else ChanceScores(refitter.linear, asked, refitter.bench.options.seed)
        n_terms = max(1, sum(s.hypothesis.effect.one_of_many for s in ranked))
        return self._ordered([self._judged(score, end, chance, n_terms) for score, end in fitted])

    def _fitted(self, chosen: Sequence[Score]) -> list[tuple[Score, Point]]:
        """Refits of hypotheses; those that promise much are carried to the end."""
        refitter = self.refitter
        rough = self._all_rough(chosen)
        n = refitter.bench.problem.n_residuals
        gains = sorted((refitter.point.chi2 - end.foreseen for end in rough), reverse=True)
        enough = min([WORTH_GOING_ON * gains[0], *gains[FEW - 1 : FEW]]) if gains else 0.0
        left = min((end.chi2 for end in rough), default=refitter.point.chi2) - n
        ends = list(rough)
        steps = MOST_STEPS if refitter.strong else ALL_STEPS
        going = []
        for k, (score, end) in enumerate(zip(chosen, rough, strict=True)):
            gain = refitter.point.chi2 - end.foreseen
            far = bool(score.hypothesis.by) and refitter.strong and end.chi2 - n > HOPELESS * max(left, 0.0)
            hopeless = far or end.foreseen > refitter.enough
            if not hopeless and gain >= enough and gain > 0.5 * ENOUGH * score.inflation:
                going.append(k)
        self._continue(chosen, ends, going, steps)
        best = sorted(range(len(ends)), key=lambda k: ends[k].chi2)[:FEW] if refitter.strong else []
        # Where little is known the others may take for ever, and are out of the question.
        self._continue(chosen, ends, [k for k in best if ends[k].foreseen <= refitter.enough], ALL_STEPS)
        for _ in range(LONG_WAYS):
            k = min(range(len(ends)), key=lambda k: ends[k].foreseen, default=0)
            if not ends or min(end.chi2 for end in ends) - ends[k].foreseen < ENOUGH:
                break
            refitter.go_on()
            ends[k] = refitter.on(chosen[k], ends[k], ALL_STEPS)
        refitter.known.ends.update((score.hypothesis.names, end) for score, end in zip(chosen, ends, strict=True))
        return list(zip(chosen, ends, strict=True))

    def _beside_fewer(self, score: Score, end: Point, fitted: Sequence[tuple[Score, Point]]) -> Point:
        """The refit of a hypothesis, begun again from that of one with fewer parameters where it ended worse than this,
        or with what it has more at the end of its range: the way on may be flat from there, as for the lag of a gear
        whose rate is limited, or no way at all, as for the direction of a wind of nothing."""
        asked, refitter = score.hypothesis, self.refitter
        own = dict(zip(end.names, end.unit, strict=True))
        for fewer, there in fitted:
            if not asked.holds(fewer.hypothesis) or fewer.hypothesis.by != asked.by:
                continue
            known = dict(zip(there.names, there.unit, strict=True))
            more = [name for name in asked.names if name not in known]
            if not more:
                continue
            null = refitter.bench.null(more)
            away = inwards(null)
            at_end = away.all() and all(own[name] == z for name, z in zip(more, null, strict=True))
            if not at_end and end.chi2 <= there.chi2 + ENOUGH:
                continue
            size = np.array([typical(refitter.bench, name) for name in more])
            steps = [by * away for by in FURTHER] if away.all() else [np.where(away, away, by) for by in (1.0, -1.0)]
            beside = [dict(zip(more, np.clip(null + step * size, 0.0, 1.0), strict=True)) for step in steps]
            starts = np.array([[{**known, **one}[name] for name in end.names] for one in beside]).T
            begun = replace(refitter.point, offsets=there.offsets)
            again = refitter.steps(begun, score, starts, MOST_STEPS, end.names)
            end = min([end, *again], key=lambda one: one.chi2)
            own = dict(zip(end.names, end.unit, strict=True))
            refitter.known.ends[asked.names] = end
        return end

    def _from_their_kin(self, fitted: Sequence[tuple[Score, Point]]) -> list[tuple[Score, Point]]:
        """Refits of hypotheses with one value for all runs, begun again where one that acts much like it, or the same
        with values of each run, ended better; what ends better then may lead others on.

        From a ship that is far off no way may lead to a strong wind, where one led to a force of waves much like it.
        """
        ends = [end for _, end in fitted]
        for _ in range(2):
            best = {}
            for k, (score, _) in enumerate(fitted):
                asked = score.hypothesis
                kin = [j for j, (of, _) in enumerate(fitted) if not asked.by and _are_kin(asked, of.hypothesis)]
                nearest = min(kin, key=lambda j: ends[j].chi2, default=k)
                if ends[nearest].chi2 < ends[k].chi2 - ENOUGH:
                    best[k] = nearest
            for k, nearest in best.items():
                self.refitter.go_on()
                ends[k] = self._in_the_place_of(fitted[nearest][0].hypothesis, ends[nearest], fitted[k][0], ends[k])
        return [(score, end) for (score, _), end in zip(fitted, ends, strict=True)]

    def _in_the_place_of(self, other: Hypothesis, there: Point, score: Score, end: Point) -> Point:
        """The refit of a hypothesis with the ship as tuned beside another one, from the sizes that do best there.

        Of values of each run it is their mean; where these are not alike, it does no better than what there is.
        """
        asked, refitter, n_own = score.hypothesis, self.refitter, len(score.hypothesis.names)
        values = dict(zip(there.names, there.unit, strict=True))
        begun = replace(refitter.point, offsets=there.offsets)
        if other.by:
            of_runs = {base: [z for name, z in values.items() if base_of(name) == base] for base in asked.bases}
            own = np.array([[np.mean(of_runs[base])] for base in asked.bases])
        else:
            own = np.column_stack([refitter.starts(begun, score, SIZES)[-n_own:], end.unit[-n_own:]])
        rest = [values.get(name, z) for name, z in zip(end.names[:-n_own], end.unit[:-n_own], strict=True)]
        starts = np.concatenate([np.repeat(np.array(rest)[:, None], own.shape[1], axis=1), own])
        alone = replace(refitter, known=Known())  # nothing is hopeless for what the other explains
        left = [one.chi2 for one in alone.steps(begun, score, starts, 0, end.names)]
        if other.by and not min(left) < end.chi2:
            return end
        nearest = np.argsort(left, kind="stable")[:STARTS_KEPT]
        ends = alone.steps(begun, score, starts[:, nearest], ALL_STEPS, end.names)
        end = min([end, *ends], key=lambda one: one.chi2)
        refitter.known.ends[asked.names] = end
        return end

    def _may_be_of_runs(self, hypothesis: Hypothesis, end: Point) -> bool:
        """Whether values of runs are such as runs may have, each by itself; of any other whether it is one."""
        if not hypothesis.by:
            return True
        bench = self.refitter.bench
        values, scale = bench.values(end), scale_of(bench.model.profile)
        for name in hypothesis.names:
            of_run = bench.parameter(name).of_run
            if of_run is not None and not of_run(scale)[0] <= values[name] <= of_run(scale)[1]:
                return False
        return True

    def _continue(self, chosen: Sequence[Score], ends: list[Point], going: Sequence[int], steps: int) -> None:
        """Continue some of the refits, in their place among ``ends``."""
        asked = [partial(Refitter.on, score=chosen[k], end=ends[k], steps=steps) for k in going]
        further = self.refitter.of_each(asked, alone=0)
        for k, end in zip(going, further, strict=True):
            ends[k] = end

    def _all_rough(self, chosen: Sequence[Score]) -> list[Point]:
        """A few steps towards the best fit with each hypothesis, the likeliest first: others may be hopeless then."""
        begun = [self.refitter.known.begun.get(score.hypothesis.names, ()) for score in chosen]
        likely = np.argsort([min((end.chi2 for end in ends), default=np.inf) for ends in begun], kind="stable")
        ends = self.refitter.of_each([partial(Refitter.rough, score=chosen[k]) for k in likely])
        found = dict(zip(likely.tolist(), ends, strict=True))
        return [found[k] for k in range(len(chosen))]

    def _ordered(self, refits: Sequence[Refit]) -> list[Refit]:
        """The best first: one value for all before values that differ between runs, unless these explain far more."""
        found = sorted(refits, key=lambda refit: refit.cost - refit.gain)
        alike = next((refit for refit in found if not refit.hypothesis.by), None)
        if alike is None or not found[0].hypothesis.by:
            return found
        n = self.refitter.bench.problem.n_residuals
        noise = n if alike.point.chi2 >= n else found[0].point.chi2  # beneath n, noise was known as too large
        left = [max(refit.point.chi2 - noise, math.sqrt(2.0 * n)) for refit in (found[0], alike)]
        inflation = max(found[0].score.inflation, alike.score.inflation)
        better = (found[0].gain - alike.gain) / inflation - found[0].cost + alike.cost
        none = alike.evidence < ENOUGH
        if (better >= ENOUGH or none) and (not self.refitter.strong or left[0] <= FAR_LESS * left[1]):
            return found
        return [alike, *(refit for refit in found if refit is not alike)]

    def _judged(self, score: Score, end: Point, chance: ChanceScores | None, n_terms: int) -> Refit:
        """A refit with its gain, cost, evidence and p-value; ``n_terms`` is how many terms there are to choose from."""
        refitter, hypothesis = self.refitter, score.hypothesis
        bench, point = refitter.bench, refitter.point
        null = bench.null(hypothesis.names)
        # A wind of nearly nothing is not quite nothing, and numbers may run away: the null itself is always open.
        if not end.chi2 <= point.chi2:
            kept = kept_free(point, hypothesis)
            unit = np.concatenate([point.unit[kept], origin(bench, point, hypothesis.names)])
            end = Point(free_with(point, hypothesis), unit, point.offsets, point.chi2, point.integrator, end.spreads)
        gain = point.chi2 - end.chi2
        volume = told_by(refitter.linear, hypothesis, refitter.moved(hypothesis, end))[1] if hypothesis.by else 0.0
        k = refitter.n_new(hypothesis)
        cost = k * bench.price + (2.0 * np.log(n_terms) if hypothesis.effect.one_of_many else 0.0)
        cost += volume + (UNLIKE_SIDES if hypothesis.lopsided else 0.0)
        return Refit(
            hypothesis,
            score,
            end,
            gain,
            cost,
            gain / score.inflation - cost,
            float(np.max(np.abs(end.unit[-len(null) :] - null) / refitter.typical(hypothesis))),
            chance.p_value(evidence(max(gain / score.inflation - volume, 0.0), k)) if chance else 1.0,
            _unvisited(bench, end, hypothesis),
        )


def _are_kin(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether another hypothesis acts much like one with a value for all runs, or is the same with values of each."""
    return other.bases == one.bases if other.by else other.tag in one.effect.akin


def _unvisited(bench: Workbench, end: Point, hypothesis: Hypothesis) -> str:
    """What the trials would have to visit for a fitted hypothesis to be believed; "" where they do."""
    if hypothesis.effect.unvisited is None:
        return ""
    values = bench.values(end)
    found = {name.rpartition(".")[2]: values[name] for name in hypothesis.names}
    return hypothesis.effect.unvisited(found, bench.visited)
