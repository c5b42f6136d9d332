"""How one hypothesis is refitted in a look: from where, and how far."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TypeVar

import numpy as np

from ...arrays import FloatArray
from ...fitting.box import base_of
from ...fitting.journal import side_by_side
from ..bench.hypotheses import Hypothesis
from ..bench.runs import spread_key
from ..bench.workbench import Point, Workbench
from ..signatures.beside import free_with, kept_free, origin
from ..signatures.linear import Linear, far_from_null, inwards, typical
from ..signatures.screening import Score, told_by
from .base_fit import hardly_noticed, unnoticed

STRONG = 1.2
"""Chi-squared per residual beyond which every named hypothesis makes a step before the best are refitted."""

HOPELESS = 10.0
"""Where much is left, what leaves so many times what the best leaves is not refitted further: of values of runs, beside
the best of them; of all others, where the best of these leaves hardly more than noise."""

HARDLY_MORE = 0.05
"""Share of the residuals beyond their noise that any may leave."""

LEAST_SPREAD = 0.01
"""Smallest spread of values that differ between runs in a refit, in typical sizes."""

ROUGH = 4
"""Steps of a refit before it is compared with the others."""

STARTS_KEPT = 2
"""Starts of a hypothesis that go on after a first step from each."""

T = TypeVar("T")

SIZES = (1.0, 0.5, 2.0, 0.25)
"""Sizes of effects with one side only at which refits start, in typical sizes."""


OTHER_SIZES, LOST = (0.85, 0.7, 0.5, 2.0), 0.1
"""Sizes at which such a refit starts where less than that share of what its score promises came of it: from a limit of
the rudder at 28 deg a step may lead beyond all angles there are, where nothing leads back to 39."""


OF_RANGE = (1.0 / 3.0, 2.0 / 3.0)
"""Shares of the range of an effect with one side only at which it begins where leeway is given back."""


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

    def among(self, hypotheses: Sequence[Hypothesis]) -> Known:
        """Those of some of the hypotheses."""
        names = {one.names for one in hypotheses}
        alike = {one.names for one in hypotheses if not one.by}
        ends = {of: end for of, end in self.ends.items() if of in names}
        least = min((end.chi2 for of, end in ends.items() if of in alike), default=math.inf)
        return Known(ends, self.good, {of: begun for of, begun in self.begun.items() if of in names}, least)

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
class Refitter:
    """Refits hypotheses, one at a time, beside what a look has found so far.

    bench   the trials, and the model with every effect
    point   the point with the causes accepted so far
    linear  the problem made linear at that point, with the signatures of hypotheses
    known   refits there are within the look
    given   the same without leeway; None where nothing has leeway or little error is left without it either
    enough  chi-squared from which on no refit is of use
    """

    bench: Workbench
    point: Point
    linear: Linear
    known: Known
    given: Given | None = None
    enough: float = math.inf

    @property
    def strong(self) -> bool:
        """Whether so much is left that a linear score cannot choose."""
        return self.point.chi2 > STRONG * self.bench.problem.n_residuals

    @property
    def hopeless(self) -> float:
        """Chi-squared above which refits are given up in this look."""
        return min(self.enough, hopeless_beside(self.bench, self.known.least))

    @property
    def before(self) -> Point:
        """The point from which named hypotheses make their first steps: one where parameters with leeway have absorbed
        nothing."""
        return self.given.point if self.given else self.point

    def go_on(self) -> None:
        """Raises Stopped where the caller wants no more."""
        if self.bench.stop():
            raise Stopped

    def of_each(self, pieces: Sequence[Callable[[Refitter], T]], alone: int = 1) -> list[T]:
        """Results of pieces of work in their order, done side by side: none knows how far the others came.

        alone  how many are done before, as they tell what is hopeless
        """
        found: list[T] = []
        for those in (pieces[:alone], pieces[alone:]):
            each = [replace(self, known=replace(self.known)) for _ in those]
            found += side_by_side([partial(_going_on, piece, own) for piece, own in zip(those, each, strict=True)])
            self.known.least = min([self.known.least, *(own.known.least for own in each)])
        return found

    def renew(self, ranked: Sequence[Score]) -> None:
        """Redo the cached refits with the present noise: hopeless ones are judged by them."""
        if not self.known.good:
            there = [score for score in ranked if score.hypothesis.names in self.known.ends]
            ends = self.of_each([partial(Refitter.rough, score=score) for score in there])
            self.known.ends.update((score.hypothesis.names, end) for score, end in zip(there, ends, strict=True))
            self.known.good = True

    def rough(self, score: Score) -> Point:
        """A few steps towards the best fit with a hypothesis, continued from its cached refits."""
        names = score.hypothesis.names
        if names in self.known.ends:
            end = self.known.ends[names]
            ends = [end] if self.known.good else self.steps(end, score, end.unit[:, None], ROUGH)
        elif names in self.known.begun:
            before = self.before
            nearest = min(self.known.begun[names], key=lambda end: end.foreseen)
            if nearest.foreseen > self.enough:
                return nearest
            null = origin(self.bench, before, names)
            begun = sorted(self.known.begun[names], key=lambda end: end.chi2)
            away = [end for end in begun if np.any(end.unit[-len(null) :] != null)]  # at the null there is no way on
            best = (away or begun)[:STARTS_KEPT]
            starts = np.column_stack([end.unit for end in best])
            ends = [*begun, *self.steps(replace(best[0], chi2=before.chi2), score, starts, ROUGH - 1)]
            if self.given is not None:
                ends = self._released(score, min(ends, key=lambda end: end.chi2))
        else:
            ends = self.steps(self.point, score, self.starts(self.point, score, SIZES[:1]), ROUGH)
            ends += self._from_one_for_all(score)
            sided = not score.hypothesis.by and bool(inwards(self.bench.null(names)).any())
            if sided and self.point.chi2 - min(end.chi2 for end in ends) < LOST * score.score:
                ends += self.steps(self.point, score, self.starts(self.point, score, OTHER_SIZES), ROUGH)
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
        return self.steps(there, score, start[:, None], ROUGH)

    def _released(self, score: Score, end: Point) -> list[Point]:
        """A few steps with leeway, continued from a refit without, whose form stays, from the step that the score
        promises, and from far.

        In very shallow water the refit without leeway goes back to deep water, so much are all targets off there.
        """
        there = dict(zip(end.names, end.unit, strict=True))
        free = free_with(self.point, score.hypothesis)
        names = (*(name for name in there if name in self.bench.believed.forms and name not in free), *free)
        null = self.bench.null(names)
        on = np.array([there.get(name, z) for name, z in zip(names, null, strict=True)])
        by_score = self.starts(self.point, score, ())[:, 0]
        found = self.steps(replace(self.point, offsets=end.offsets), score, on[:, None], ROUGH, names)
        found += self.steps(self.point, score, by_score[:, None], ROUGH)
        return [*found, *self._from_far(score, names)]

    def _from_far(self, score: Score, names: Sequence[str]) -> list[Point]:
        """Some steps of an effect with one side only, from far sizes beside the targets as tuned without leeway.

        names  what is free, the parameters of the hypothesis last
        """
        n_own, null = len(score.hypothesis.names), self.bench.null(names)
        own, away = null[-n_own:], inwards(null[-n_own:])
        if score.hypothesis.by or not away.any():
            return []
        given = dict(zip(self.before.names, self.before.unit, strict=True))
        rest = [given.get(name, z) for name, z in zip(names[:-n_own], null[:-n_own], strict=True)]
        starts = np.array([[*rest, *(own + share * away)] for share in OF_RANGE]).T
        alone = replace(self, known=Known())  # so far from it that nothing is hopeless yet
        return alone.steps(self.point, score, starts, 2 * ROUGH, names)

    def starts(self, point: Point, score: Score, sizes: Sequence[float]) -> FloatArray:
        """Where the refit of a hypothesis starts from a point, (n_names, n_starts): where its score says, and for an
        effect with one side only, whose slope at the null misleads, at sizes around the typical.  Where much is left
        and several sizes are asked for, it starts far from the null too.

        Where it replaces a target that ended at a bound, the other targets were drawn astray by that one: it also
        starts from the profile's values of the targets.
        """
        names = score.hypothesis.names
        null = origin(self.bench, point, names)
        size = self.typical(score.hypothesis)
        step = self.given.steps[names] if self.given and point is self.given.point else score.step
        places = [null + np.clip(step, -4.0, 4.0) * size]
        away = inwards(self.bench.null(names))
        if away.any():
            places += [null + away * size * factor for factor in sizes]
        if self.strong and len(sizes) > 1 and not score.hypothesis.by:
            places += far_from_null(self.bench, names)
        kept = kept_free(point, score.hypothesis)
        others = [point.unit[kept]]
        if score.hypothesis.instead:
            others.append(self.bench.null([point.names[i] for i in kept]))
        return np.column_stack([np.concatenate([z, np.clip(place, 0.0, 1.0)]) for z in others for place in places])

    def steps(
        self, point: Point, score: Score, starts: FloatArray, iterations: int, names: Sequence[str] = ()
    ) -> list[Point]:
        """A number of steps of fits with a hypothesis, from starts at a point and its offsets.

        names  of the rows of ``starts``, those of forms among them, where they are not what is free at the point
        """
        hypothesis = score.hypothesis
        return self.known.note(
            hypothesis,
            self.bench.refits(
                names or free_with(point, hypothesis),
                starts,
                point.offsets,
                max_iterations=iterations,
                tolerance=hardly_noticed(self.bench, point.chi2),
                spreads=self._spreads(point, hypothesis, max(score.spread, 1.0 if self.strong else LEAST_SPREAD)),
                hopeless=self.hopeless,
            ),
        )

    def on(self, score: Score, end: Point, steps: int) -> Point:
        """A refit continued for a number of steps."""
        spread = 0.0
        if score.hypothesis.by:
            spread = max(told_by(self.linear, score.hypothesis, self.moved(score.hypothesis, end))[0], LEAST_SPREAD)
        (end,) = self.known.note(
            score.hypothesis,
            self.bench.refits(
                end.names,
                end.unit[:, None],
                end.offsets,
                spreads=self._spreads(self.point, score.hypothesis, spread),
                max_iterations=steps,
                tolerance=unnoticed(self.bench, end.chi2),
                hopeless=self.hopeless,
            ),
        )
        return end

    def _spreads(self, point: Point, hypothesis: Hypothesis, spread: float) -> dict[str, float]:
        """Spreads at a point and of a hypothesis, the latter in typical sizes."""
        names = hypothesis.names if hypothesis.by else ()
        return {
            **point.spreads,
            **self.bench.spreads,
            **{spread_key(n): spread * typical(self.bench, n) for n in names},
        }

    def moved(self, hypothesis: Hypothesis, end: Point) -> FloatArray:
        """(n_names,) how far the parameters of a hypothesis moved from where they stood, in typical sizes."""
        names = hypothesis.names
        moved = end.unit[-len(names) :] - origin(self.bench, self.point, names)
        return np.asarray(moved / self.typical(hypothesis))

    def typical(self, hypothesis: Hypothesis) -> FloatArray:
        """(n_names,) typical sizes of the parameters of a hypothesis in the unit cube."""
        return np.array([typical(self.bench, name) for name in hypothesis.names])

    def n_new(self, hypothesis: Hypothesis) -> int:
        """Numbers that a hypothesis adds to the point: means that are not free there, and a spread."""
        there = {base_of(name) for name in self.point.names}
        return sum(base not in there for base in hypothesis.bases) + bool(hypothesis.by)


def _going_on(piece: Callable[[Refitter], T], refitter: Refitter) -> T:
    """What comes of a piece of work.  Raises Stopped where the caller wants no more."""
    refitter.go_on()
    return piece(refitter)


def hopeless_beside(bench: Workbench, chi2: float) -> float:
    """Chi-squared above which refits are given up where the best refit leaves hardly more than noise; inf where it
    leaves more."""
    n = bench.problem.n_residuals
    return math.inf if chi2 > STRONG * n else n + HOPELESS * max(chi2 - n, HARDLY_MORE * n)
