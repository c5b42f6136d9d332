"""A hypothesis fitted together with all that is known: whether it is believed, and which others do nearly as well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..bench.hypotheses import Hypothesis
from ..bench.inputs import unsteady
from ..bench.workbench import Point, Workbench
from ..signatures.screening import Score

ENOUGH = 10.0
"""A hypothesis must beat none by this much of chi-squared beyond its share by the information criterion (BIC), and
another hypothesis by as much to be told from it; in units of the noise along it."""

BETTER = 5.0
"""It must also fit that much better: that it has fewer parameters does not rule a rival out."""

AS_MUCH, AS_LITTLE = 0.97, 0.9
"""Share of the fall of chi-squared, and of what is left, within which one value of an effect for all runs is a rival of
values of another that differ between runs: these bend to an effect whose form is a little off."""

OF_FORMULA, LEFT_BY_IT = 0.001, 2.0
"""Share of the fall of chi-squared that another may bring less, where both are forces of wind and waves: as much is
left by a formula that is 3 % off, and these differ by more from ship to ship.  But what leaves twice what the other
does is none: then that one's formula is not off."""

AKIN = 0.3
"""Share of the fall of chi-squared from which on an effect that acts much like the best may be meant."""

OF_REST, REST = 0.9, 0.05
"""Share of the error beyond noise that a cause takes which leaves nothing, and the least of it, over the noise."""

WORTH = 0.1
"""Smallest size worth speaking of where another effect would do as well, as a share of the typical one."""


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
        """Whether this refit explains so much more that the other is out of the question.

        One value for all runs need not fit better than values of each run do: these are charged for what they could
        have been, not by their number.  What chance would bring, along a signature that noise has much of, is no rival
        of what it would not.
        """
        if self.evidence >= ENOUGH and other.evidence <= 0.0:
            return True
        if self.hypothesis.by and not other.hypothesis.by and self._hardly_above(other):
            return False
        if self._of_formula(other):
            return False
        better = (self.gain - other.gain) / max(self.score.inflation, other.score.inflation)
        simpler = other.hypothesis.by and not self.hypothesis.by
        return (better >= BETTER or bool(simpler)) and better - self.cost + other.cost >= ENOUGH

    def takes_the_rest(self, n: int) -> bool:
        """Whether one value for all runs explains nearly all that was left beyond noise of n residuals: what gusts, or
        groups of waves, leave is not of its shape, however much they may leave."""
        rest = self.point.chi2 + self.gain - n
        return not self.hypothesis.by and self.gain >= ENOUGH + self.cost and self.gain >= max(OF_REST * rest, REST * n)

    def by_chance(self, level: float) -> bool:
        """Whether chance brings as large a gain at this probability level, or its evidence is less than ``ENOUGH``."""
        return self.p_value > level or self.evidence < ENOUGH

    def _hardly_above(self, other: Refit) -> bool:
        """Whether another explains hardly less and leaves hardly more."""
        return other.gain >= AS_MUCH * self.gain and other.point.chi2 <= self.point.chi2 / AS_LITTLE

    def _of_formula(self, other: Refit) -> bool:
        """Whether both are forces of wind and waves, between which no more than the formula decides."""
        both = unsteady(self.hypothesis.effect) and unsteady(other.hypothesis.effect)
        as_much = other.gain >= (1.0 - OF_FORMULA) * self.gain
        return both and as_much and other.point.chi2 <= LEFT_BY_IT * self.point.chi2


def believable_first(refits: list[Refit], level: float) -> list[Refit]:
    """Refits with the best one that concerns what the trials visit in front, unless it is far worse than the best of
    all.

    Noise may have so much of a signature that chance brings more of it than a true cause brings of another: where that
    is so of the best, what has the most evidence comes first.
    """
    told = [refit for refit in refits if not (refit.unvisited or refit.by_chance(level))]
    if told and refits[0].by_chance(level):
        best = max(told, key=lambda refit: refit.evidence)
        return [best, *(refit for refit in refits if refit is not best)]
    for k, refit in enumerate(refits):
        if refits[0].beats(refit):
            break
        if not refit.unvisited:
            return [refit, *refits[:k], *refits[k + 1 :]]
    return refits


def decide(bench: Workbench, refits: Sequence[Refit], rivals: Sequence[Refit]) -> tuple[bool, str]:
    """Whether the best of several is believed, and why not."""
    if not refits:
        return False, "no effect applies"
    best = refits[0]
    if best.unvisited:
        return False, f"{best.hypothesis.tag} would be believed only where trials visit {best.unvisited}"
    if best.p_value > bench.options.level:
        return False, f"chance brings as much in {best.p_value:.2g} of all searches"
    if best.evidence < ENOUGH and not best.takes_the_rest(bench.problem.n_residuals):
        return False, "it explains too little for one more parameter"
    if best.size < WORTH and rivals:  # so little, and not even told apart
        return False, f"its size is below a {1.0 / WORTH:.0f}th of what is worth speaking of"
    return True, ""


def rivals_among(refits: Sequence[Refit]) -> list[Refit]:
    """Refits of other effects than the best that explain nearly as much."""
    best = refits[0]
    found: dict[str, Refit] = {}
    for refit in refits[1:]:
        if not best.beats(refit) and refit.hypothesis.tag != best.hypothesis.tag:
            found.setdefault(refit.hypothesis.tag, refit)
    return list(found.values())


def kin_among(refits: Sequence[Refit], tag: str, share: float = AKIN) -> list[Refit]:
    """Refits of effects that act much like that of a tag and explain a share of what the best of it does: where that
    leaves more than noise it has another form than the true cause, and form is all that tells such effects apart."""
    own = next((refit for refit in refits if refit.hypothesis.tag == tag), None)
    if own is None:
        return []
    akin = [refit for refit in refits if refit.hypothesis.tag in own.hypothesis.effect.akin]
    nearest = max(akin, key=lambda refit: refit.gain, default=own)
    return [nearest] if nearest is not own and nearest.gain >= share * own.gain else []
