"""By which rules causes are believed.

The rules were set on ships with causes in no registry: a sum of known ones explains much of what none of them did.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...phrases import listed
from ..bench.hypotheses import n_terms
from ..bench.inputs import unsteady
from ..evidence.leftover import NOTICED, Leftover
from ..held_out.gain import MOST, Gain
from ..held_out.together import Together
from ..searching.search import TOO_MANY
from ..signatures.at_ends import AtEnds
from .cause import Cause
from .contributions import Contribution

MOSTLY = 0.95
"""Share of the error above noise on the trials it was found on that a cause must remove to be named alone, where
something of a shape is left besides."""

OF_ALL = 0.995
"""Share of that from which a single cause that leaves nothing but noise is not refuted by runs left out in turn."""

OF_THE_NOISE = 0.03
"""Variance beyond noise, as a share of it, that may be how well that of the noise is known: beside an error that is as
small, the share that a cause leaves of it tells nothing."""

OF_FEW = 3.0
"""Error of a run that is left out, in deviations of the noise, up to which too few others may be the reason then."""

ALL, ALL_HELD_OUT = 0.998, 0.98
"""Share of the error above noise from which it counts as all of it, and that share on held-out trials."""

OPEN = 0.3
"""Variance beyond noise that is spoken of where the log of the inputs leaves it open, as a share of the noise."""

BEYOND_OPEN, AT_ALL = 5.0, 0.2
"""Squared error on trials left out in turn, over noise and what the logged inputs leave open, from which causes are not
believed that fit all of them together, and share of the error that they remove at least: where they change nothing, the
targets are to blame, which too few trials tell."""

BENT = 1.0
"""Variance beyond noise, as a share of it, that a cause with values of each run may leave where it has a shape: such
values bend to what is elsewhere, or at another hour, and not of the run at all."""

TOLD = 0.5
"""Share of the held-out error that causes must remove which were found once no trial was kept for testing, and several
causes anyhow: what little there is any two or three would imitate; and a single one whose size may be none.  One of
several without which that share of the fall of chi-squared is lost is there, whatever its size."""

GUSTS_LEAVE, OF_WIND = 20.0, 0.25
"""Variance beyond noise that gusts of a wind that was found would have to account for, and share of chi-squared before
it that it leaves, from which it is no wind: gusts and another shape of the force leave less than that of its work."""

LEFT_AT_END = 1.0
"""Variance beyond noise, as a share of it, from which a single cause at the end of its range is not believed."""

LEFT_ALONE = 0.3
"""Variance beyond noise, as a share of it, and with a shape, from which a single cause is not believed that removes
less than half of the held-out error: something else is there, that it may stand for."""

NEEDED = 0.15
"""Share of the fall of chi-squared that the terms of a sum must lose, one left out at a time, all added up, unless all
together leave nothing but noise of far more than noise: what stands for something else does not, but for three terms of
which one has values of each run, as of an indicator that is off by a wave of the angle."""

A_TENTH = 0.1
"""Share of an error that nothing explains up to which what removes it is not spoken of."""

BESIDE = 0.02
"""Variance beyond noise, as a share of it, from which a sum of causes leaves more than noise."""

MUCH = 0.4
"""Share of the fall of chi-squared that must be lost without any one of the causes for a sum to leave a little more: of
the noise of sensors that fades within seconds as much is left."""

OF_MANY = 0.05
"""Share of the fall of chi-squared that must be lost without any one of three causes, where not all of them can be told
from others, and none of which has values of each run: a third that brings less is the form of the first two, unless
these are errors of logs."""

FAINT = 0.1
"""Fall of chi-squared per residual that a sum of causes must bring: of less, sums that stand for another cause bring as
much, and so do values of each run."""

NEXT_TO_NOTHING = "what it removes of the error where nothing was fitted may be next to nothing"


@dataclass(frozen=True, eq=False, kw_only=True)
class Belief:
    """Causes, and what speaks for and against them; ``Diagnosis`` says what the fields are."""

    causes: tuple[Cause, ...]
    contributions: tuple[tuple[str, Contribution], ...]
    groups: tuple[tuple[str, ...], ...]
    gain: Gain
    leftover: Leftover
    explained_share: float
    chi2: tuple[float, float]
    together: Together | None = None
    of_traces: float = 0.0
    unlike_any: str = ""
    more: bool = False
    ends: AtEnds | None = None

    @property
    def rest(self) -> float:
        """Variance beyond noise, as a share of it, that neither causes nor traces account for."""
        return self.leftover.unknown - self.of_traces

    @property
    def differs_by_run(self) -> bool:
        """Whether a cause has values of each run, which bend to much where they were found."""
        return any(cause.runs for cause in self.causes)

    @property
    def unclear(self) -> str:
        """Why causes are not believed, in words; "" where they are.

        A single one is doubted only where it was found once trials kept for testing were looked at too, and where it
        removes little and its size may be none, or is that of each run beside noise, or it leaves what has a shape.

        An effect that no registry holds looks like a sum of those that one does; the study says how such sums look.
        """
        brought = [one for _, one in self.contributions]
        if self._told_by_none:
            return "fitted to all runs but one, it tells that one little better"
        if self._excused_by_gusts:
            return "it leaves far more than noise, and more than gusts of such a wind, or groups of such waves, would"
        if why := self._bent:
            return why
        if self.ends and self.ends.unlike and brought and not self._stands_beside_all:
            return f"beside {'it' if len(brought) == 1 else 'them'} {self.ends.words}"
        of_formulas = self.ends is not None and self.ends.from_formulas and len(brought) > 1
        if of_formulas and any(one.effect and one.effect.one_of_many for one in self.causes):
            return "a term that the hull lacks is as likely part of another form of a hull that is from formulas"
        surely = {tag for tag, one in self.contributions if one.seen > TOLD and len(brought) > 1}
        doubtful = [one for one in self.causes if not one.sized and one.tag not in surely]
        unsized = list(dict.fromkeys(one.tag for one in doubtful))
        not_told = f"how large {listed(unsized)} would be is not told, if anything at all" if unsized else ""
        if len(brought) == 1 and self.causes[0].at_ends and self.leftover.unknown > LEFT_AT_END:
            return "its size is at the end of its range, and it leaves more than noise"
        if self._n_terms < 2:
            least = AT_ALL if self._faint else 0.0
            if self.differs_by_run and self.gain.surely_removed < least and (self._faint or self.leftover.structured):
                return NEXT_TO_NOTHING
            if self.gain.share_removed >= TOLD:
                return ""
            if self.leftover.structured and self.rest > LEFT_ALONE:
                return "it removes little of the error where nothing was fitted, and leaves more than noise"
            return not_told
        terms = n_terms([tag for tag, one in self.contributions if not one.apart])
        if self.more or terms >= TOO_MANY:
            return f"it takes {'more than ' if self.more else ''}{len(brought)} terms"
        if ended := list(dict.fromkeys(one.tag for one in self.causes if one.at_ends)):
            return f"the size of {listed(ended)} is at the end of its range"
        if self._faint and not self._told_by_one_log:
            return "all that they remove is little beside noise, and other sums would"
        if self.rest > BESIDE and not (self.explains_all or (self.rest < NOTICED and self._needs_each)):
            return "what they leave is more than noise"
        if terms > 2 and self.groups and (self.differs_by_run or _least_may_be_form(self.causes, brought)):
            return "not all of them can be told from others"
        several = [cause for cause in self.causes if cause.runs]
        alike = any(one.effect and other.tag in one.effect.akin for one in several for other in several)
        if len(several) > 1 and (terms > 2 or alike or not self.explains_all):
            return "more than one of them differs from run to run"
        if self.gain.share_removed < TOLD and not (self.gain.tells_nothing and self._all_by_each):
            return "it removes little of the error where nothing was fitted"
        if self.gain.surely_removed < AT_ALL and self.differs_by_run:
            return NEXT_TO_NOTHING
        if not_told:
            return not_told
        bends = self.leftover.structured or not self.explains_all or (terms > 2 and self.differs_by_run)
        if sum(one.seen for one in brought) < NEEDED and bends:
            return "without any one of them the others, re-tuned, do nearly as well on the trials it was found on"
        if self.gain.mostly_remains:
            return "they leave most of the error on test trials"
        return ""

    @property
    def fails(self) -> bool:
        """Whether the causes are not believed, do not tell what is held out, or leave too much that has a shape."""
        doubted = self.gain.worse or self.differs_by_run or self._misses_each
        untold = self.gain.remains and (self.rest >= NOTICED or doubted)
        return untold or bool(self.unclear) or self._mostly_left or self._of_a_misread_log

    @property
    def _stands_beside_all(self) -> bool:
        """Whether causes are what they are beside any hull: errors of logs, or, where what is known of her is from
        formulas, such as tell all of the error, of which inputs leave little open."""
        of_formulas = self.ends is not None and self.ends.from_formulas
        return all(one.of_logs for one in self.causes) or (of_formulas and self.explains_all and not self.leaves_open)

    @property
    def _n_terms(self) -> int:
        """Terms of the sum of all causes."""
        return n_terms([tag for tag, _ in self.contributions])

    @property
    def is_beyond_all(self) -> bool:
        """Whether several terms are needed and not believed: more trials of an unknown effect take more of them."""
        return (self.more or self._n_terms >= TOO_MANY - 1) and bool(self.unclear)

    @property
    def _told_by_none(self) -> bool:
        """Whether causes that only show in all trials together, those kept for testing among them, do not tell most of
        the error of each from the others: nothing else is left to test them by.

        Nor does it speak for values of each run where next to nothing is told, though these may be uncertain enough to
        excuse it.
        """
        settled = self.together is not None and self.together.settled
        bends = self.differs_by_run and self.gain.leaves_beside()
        share = self.gain.share_removed
        untold = settled and share < TOLD and not self.gain.tells_most_runs
        fitted = bool(self.contributions)  # how a log is read is no number that could stand for something else
        return fitted and (untold or (bends and share < AT_ALL))

    @property
    def _excused_by_gusts(self) -> bool:
        """Whether wind or waves among the causes leave an error that is noise only if gusts or groups make it, and
        these are too small for it: a wind that is found excuses what it leaves."""
        before, after = self.chi2
        excuse = any(unsteady(cause.effect) for cause in self.causes)
        return excuse and self.leftover.left_open > GUSTS_LEAVE and after > OF_WIND * before

    @property
    def _bent(self) -> str:
        """Why values of each run are none of the runs, in words: they bend to what is elsewhere; "" for nothing."""
        for runs in filter(None, (cause.runs for cause in self.causes)):
            if runs.doubt:
                return runs.doubt
            if runs.in_none and self.chi2[1] > 1.0 + BENT:  # whatever excuses that
                return "no run has a value of it for certain, and these leave far more than noise"
        return f"beside values of each run it takes {self.unlike_any}" if self.unlike_any else ""

    @property
    def is_chance(self) -> bool:
        """Whether a single cause is not believed whose size may be none, and that removes little, or a sum of causes,
        or values of each run, that remove little beside noise."""
        one_size = len(self.contributions) == 1 and not self.causes[0].runs
        nothing = not self.causes[0].sized if one_size else self._faint
        return nothing and bool(self.unclear)

    @property
    def is_next_to_nothing(self) -> bool:
        """Whether causes that are not believed may be chance, or remove nothing worth speaking of."""
        doubtful = bool(self.unclear) or self.fails
        return self.is_chance or (doubtful and bool(self.causes) and self.explained_share < A_TENTH)

    @property
    def _told_by_one_log(self) -> bool:
        """Whether at most one of the causes is more than an error in the log of a single state, which shows in no other
        and is told by itself."""
        return sum(not cause.of_one_log for cause in self.causes) <= 1

    @property
    def _faint(self) -> bool:
        """Whether causes bring so little that sums which stand for another cause bring as much."""
        return self.chi2[0] - self.chi2[1] < FAINT

    @property
    def tells_a_part(self) -> bool:
        """Whether causes, though not believed perhaps, remove what is worth speaking of."""
        return bool(self.causes) and not (self.unclear and self.explained_share < A_TENTH)

    @property
    def _misses_each(self) -> bool:
        """Whether the others tell a run that is left out far worse than its noise with the causes, yet otherwise.

        A single cause that leaves nothing but noise of all runs together is not refuted by it, unless the logged inputs
        leave much open: few runs leave some coefficients open, and no cause that stood for another was seen to do that.
        What inputs leave open shows in all states; an error in the log of a single one does not hide in it.
        """
        if self.gain.held_out != "each" or self.gain.share_removed < AT_ALL:
            return False
        hidden = self.leaves_open and not all(cause.of_one_log for cause in self.causes)
        alone = len(self.contributions) == 1 and not hidden
        like_noise = self.rest < OF_THE_NOISE and self.gain.left < OF_FEW and not self.leftover.structured
        if alone and self.rest < NOTICED and (self.explained_share >= OF_ALL or like_noise):
            return False
        return self.gain.left**2 > BEYOND_OPEN * (1.0 + self.leftover.left_open)

    @property
    def leaves_open(self) -> bool:
        """Whether the log of the inputs leaves so much open that a cause may hide in it, and noise hides no more."""
        return self.leftover.left_open > max(OPEN, self.leftover.slow)

    @property
    def explains_all(self) -> bool:
        """Whether the causes leave so little of the error beyond noise, on held-out trials too, that a cause whose form
        is a little off would leave as much."""
        return self.explained_share >= ALL and self.gain.share_removed >= ALL_HELD_OUT

    @property
    def _needs_each(self) -> bool:
        """Whether causes tell all of the error on held-out trials, none of them without the others, and what is left
        has no shape; terms of which there are many bend to what is none of theirs."""
        told = self.gain.share_removed >= ALL_HELD_OUT and all(one.seen >= MUCH for _, one in self.contributions)
        bends = any(one.effect and one.effect.one_of_many for one in self.causes)
        return told and not bends and not self.leftover.structured

    @property
    def _all_by_each(self) -> bool:
        """Whether causes, none of them with values of each run, leave nothing where they were found, and each of them
        is needed for it."""
        whole = self.explained_share >= ALL and not (self.leftover.structured or self.differs_by_run)
        return whole and all(one.seen >= NEEDED for _, one in self.contributions)

    @property
    def explains_nearly_all(self) -> bool:
        """Whether the causes remove nearly all of the error beyond noise, on held-out trials too."""
        return self.explained_share >= MOSTLY and self.gain.share_removed >= MOST

    @property
    def _mostly_left(self) -> bool:
        """Whether what is left has a shape, or is as much as the noise, and is too much beside what the causes
        explain."""
        mostly = self.explained_share < MOSTLY
        bent = self.differs_by_run and self.leftover.excess > BENT and not self.explains_all
        return (self.leftover.unknown > BENT and mostly) or (self.leftover.structured and (mostly or bent))

    @property
    def _of_a_misread_log(self) -> bool:
        """Whether a cause is an error of a log that is off otherwise in single runs, or leaves more than noise in one
        sensor alone."""
        left = self.leftover
        of_another_form = left.alone and left.unknown > LEFT_ALONE and self.explained_share < MOSTLY
        return bool(left.misread or of_another_form) and any(cause.of_one_log for cause in self.causes)


def _least_may_be_form(causes: Sequence[Cause], brought: Sequence[Contribution]) -> bool:
    """Whether the least term of a sum may be the form of the others, so little it brings; errors of logs have none."""
    least, cause = min(
        ((one.seen, cause) for cause, one in zip(causes, brought, strict=True) if not one.apart), key=lambda one: one[0]
    )
    return least < OF_MANY and any(not one.of_logs for one in causes if one is not cause)
