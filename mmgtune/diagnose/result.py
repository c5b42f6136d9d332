"""What a diagnosis returns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ..displayed import Plotted
from ..documents import finite_values
from ..options import DiagnoseOptions
from ..profile import ShipProfile, tuned, with_effects
from ..trial import Coverage
from . import beliefs, winds
from .causes import Candidate, Cause, Detectability, Trace
from .contributions import Contribution
from .gain import MOST, Gain
from .instead import Instead
from .leftover import Leftover, change_in_words, in_words
from .legs import Difference
from .record import Record, kind_of, record_of
from .retuned import Retuned, besides, far_off, weighed
from .retuned import in_words as moved_in_words
from .search import TOO_MANY
from .separate import Suggestion
from .together import Together
from .voyages import Choice
from .whereabouts import Whereabouts

SCHEMA = 1
VERDICTS = ("none", "found", "not-separable", "unexplained", "interrupted")
"""Codes; people read ``Diagnosis.sentence``."""

IMITATED = 0.5
"""Share of the error removed below which it is said that a hull a little off is part of what it is counted from."""

LARGE = 10.0
"""Variance beyond noise from which it is told as a multiple of the noise."""

MOSTLY = 0.95
"""Share of the error above noise on the trials it was found on that a cause must remove to be named alone, where
something of a shape is left besides."""

ALL, ALL_HELD_OUT = 0.998, 0.98
"""The same from which it is all, and that on held-out trials."""

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
causes anyhow: what little there is any two or three would imitate; and a single one whose size may be none."""

GUSTS_LEAVE, OF_WIND = 20.0, 0.25
"""Variance beyond noise that gusts of a wind that was found would have to account for, and share of chi-squared before
it that it leaves, from which it is no wind: gusts and another shape of the force leave less than that of its work."""

LEFT_AT_END = 1.0
"""Variance beyond noise, as a share of it, from which a single cause at the end of its range is not believed."""

NEEDED = 0.15
"""Share of the fall of chi-squared that the terms of a sum must lose, one left out at a time, all added up, unless all
together leave nothing but noise of far more than noise: what stands for something else does not."""

A_TENTH = 0.1
"""Share of an error that nothing explains up to which what removes it is not spoken of."""

BESIDE = 0.02
"""Variance beyond noise, as a share of it, from which a sum of causes leaves more than noise."""

FAINT = 0.1
"""Fall of chi-squared per residual that a sum of causes must bring: of less, sums that stand for another cause bring as
much."""


@dataclass(frozen=True)
class Doubted:
    """A sum of causes that explains more than the one that is named, and is not believed.

    effects  their tags
    why      what speaks against it, in words
    """

    effects: tuple[str, ...]
    why: str

    @classmethod
    def of(cls, result: Diagnosis) -> Doubted:
        """The causes of a diagnosis that are unclear."""
        return cls(tuple(tag for tag, _ in result.contributions), result.unclear)

    @property
    def sentence(self) -> str:
        sum_ = " + ".join(dict.fromkeys(self.effects))
        return f"More would be removed by {sum_}, but {self.why}, so the rest has no name."

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"effects": list(self.effects), "why": self.why}


@dataclass(frozen=True, eq=False)
class Diagnosis(Plotted):
    """A finished diagnosis.

    theta     tuned targets, and what had leeway, with all causes in place; retuned: without any
    moved     targets beside their pre-determined values, with all causes in place; none where nothing can be named
    instead   a cause that would do most of what re-tuning did, where no other shows; None else
    traces    what is statistically there besides and changes nothing that a user would notice; in no profile
    contributions  of the causes, by tag in their order, the others in place
    groups    causes that cannot be told apart, each a list of tags
    chi2      of the trials it looked at per residual: before, after
    evidence  residuals, residual forces and what explains them, for the report
    read_off  pivots of effects that these trials say themselves, by full name
    unlike_any what values of each run take of mass and inertia that no ship has, in words; "" for nothing
    coverage  what the trials it looked at visit; warnings: what of that a reader must know
    whereabouts  where the error lives, where nothing explains it; None else
    contradicted what the logs say against each other, in a sentence; told first where the answer is unexplained
    doubted      the sum of causes that the one named was found in, where that is not believed; None else
    together  what was found without the trials kept for testing, where these had to be looked at too; None else
    choice    windows of voyages that were looked at, None for trials; differing: what differs between the voyages
    more      whether much is left beside as many causes as are believed together
    """

    written_by = "write_diagnosis"

    profile: ShipProfile
    options: DiagnoseOptions
    causes: tuple[Cause, ...]
    traces: tuple[Trace, ...]
    contributions: tuple[tuple[str, Contribution], ...]
    groups: tuple[tuple[str, ...], ...]
    candidates: tuple[Candidate, ...]
    detectability: tuple[Detectability, ...]
    suggestion: Suggestion | None
    gain: Gain
    leftover: Leftover
    explained_share: float
    theta: Mapping[str, float]
    retuned: Mapping[str, float]
    noise: Mapping[str, Mapping[str, float]]
    chi2: tuple[float, float]
    evidence: Mapping[str, Any]
    provenance: Mapping[str, Any]
    wall_s: float
    coverage: Coverage | None = None
    warnings: tuple[str, ...] = ()
    interrupted: bool = False
    whereabouts: Whereabouts | None = None
    doubted: Doubted | None = None
    together: Together | None = None
    moved: tuple[Retuned, ...] = ()
    instead: Instead | None = None
    contradicted: str = ""
    choice: Choice | None = None
    differing: tuple[Difference, ...] = ()
    more: bool = False
    read_off: Mapping[str, float] = field(default_factory=dict)
    unlike_any: str = ""

    def __repr__(self) -> str:
        """In a line."""
        causes = ", ".join(cause.tag for cause in self.causes) or "no cause"
        return f"Diagnosis({self.profile.id}, {self.verdict}: {causes})"

    @property
    def verdict(self) -> str:
        """One of ``VERDICTS``."""
        if self.interrupted:
            return "interrupted"
        bends = any(cause.runs for cause in self.causes)  # where it was found that explains much of anything
        fails = self.gain.remains and (self.leftover.noticed or self.gain.worse or bends or self._misses_each)
        fails = fails or bool(self.unclear)
        shaped = self.leftover.structured or bool(self.leftover.offsets or self.leftover.changed) or self.misses_test
        if shaped if not self.causes else fails or self._mostly_left:
            return "found" if any(one.explained >= MOSTLY for one in self.between) else "unexplained"
        if self.groups:
            return "not-separable"
        return "found" if self.causes or self.between else "none"

    @property
    def kind(self) -> str:
        """What kind of answer this is, as the study counts them; "" for one that was stopped."""
        verdict = self.verdict
        return kind_of(verdict, self.named, self.groups if verdict == "not-separable" else ())

    @property
    def record(self) -> Record | None:
        """How often such an answer was right in the study; None of a search that was stopped, and of voyages."""
        return record_of(self.kind) if self.kind and not self.between else None

    @property
    def between(self) -> tuple[Difference, ...]:
        """What differs from voyage to voyage."""
        return tuple(one for one in self.differing if one.pattern in ("each", "trend"))

    @property
    def unclear(self) -> str:
        """Why causes are not believed, in words; "" where they are.

        A single one is doubted only where it was found once trials kept for testing were looked at too, and where its
        size may be none and it removes little.

        An effect that no registry holds looks like a sum of those that one does; the study says how such sums look.
        """
        brought = [one for _, one in self.contributions]
        if self._told_by_none:
            return "fitted to all runs but one, it tells that one little better"
        if self._excused_by_gusts:
            return "it leaves far more than noise, and more than gusts of such a wind would"
        if why := self._bent:
            return why
        unsized = [cause.tag for cause in self.causes if not cause.sized]
        not_told = f"{' and '.join(unsized)} may be nothing at all" if unsized else ""
        if len(brought) == 1 and self.causes[0].at_ends and self.leftover.unknown > LEFT_AT_END:
            return "its size is at the end of its range, and it leaves more than noise"
        if len(brought) < 2:
            return not_told if self.gain.share_removed[0] < TOLD else ""
        if self.more or len(brought) >= TOO_MANY:
            return f"it takes {'more than ' if self.more else ''}{len(brought)} terms"
        if self.chi2[0] - self.chi2[1] < FAINT:
            return "all that they remove is little beside noise, and other sums would"
        if self.leftover.unknown > BESIDE and not self.explains_all:
            return "what they leave is more than noise"
        if len(brought) > 2 and self.groups:
            return "not all of them can be told from others"
        several = sum(bool(cause.runs) for cause in self.causes) > 1
        if several and (len(brought) > 2 or not self.explains_all):
            return "more than one of them differs from run to run"
        share, low, _ = self.gain.share_removed
        if share < TOLD:
            return "it removes little of the error where nothing was fitted"
        if low < AT_ALL and any(cause.runs for cause in self.causes):
            return "what it removes of the error where nothing was fitted may be next to nothing"
        if not_told:
            return not_told
        if sum(one.seen for one in brought) < NEEDED and (self.leftover.structured or not self.explains_all):
            return "without any one of them the others, re-tuned, do nearly as well on the trials it was found on"
        if self.gain.mostly_remains:
            return "they leave most of the error on test trials"
        return ""

    @property
    def is_beyond_all(self) -> bool:
        """Whether several terms are needed and not believed: more trials of an unknown effect take more of them."""
        return (self.more or len(self.contributions) >= TOO_MANY - 1) and bool(self.unclear)

    @property
    def _told_by_none(self) -> bool:
        """Whether causes that only show in all trials together, those kept for testing among them, do not tell most of
        the error of each from the others: nothing else is left to test them by.

        Nor does it speak for values of each run where next to nothing is told, though these may be uncertain enough to
        excuse it.
        """
        settled = self.together is not None and self.together.settled
        bends = any(cause.runs for cause in self.causes) and self.gain.leaves_beside()
        share = self.gain.share_removed[0]
        untold = settled and share < TOLD and not self.gain.tells_most_runs
        return bool(self.causes) and (untold or (bends and share < AT_ALL))

    @property
    def _excused_by_gusts(self) -> bool:
        """Whether a wind among the causes leaves an error that is noise only if gusts make it, and gusts are too small
        for it: a wind that is found excuses what it leaves."""
        before, after = self.chi2
        blows = any(winds.blows(cause.effect) for cause in self.causes)
        return blows and self.leftover.left_open > GUSTS_LEAVE and after > OF_WIND * before

    @property
    def _bent(self) -> str:
        """Why values of each run are none of the runs, in words: they bend to what is elsewhere; "" for nothing."""
        for runs in filter(None, (cause.runs for cause in self.causes)):
            if with_what := runs.goes_with:
                return f"its values go with {with_what}, and so with something else than the run"
        return f"beside values of each run it takes {self.unlike_any}" if self.unlike_any else ""

    @property
    def is_chance(self) -> bool:
        """Whether a single cause is not believed whose size may be none, and that removes little."""
        return len(self.contributions) == 1 and not self.causes[0].sized and bool(self.unclear)

    @property
    def of_a_sensor(self) -> bool:
        """Whether a log whose factor changes within trials shows, and no cause worth speaking of."""
        return bool(self.leftover.changed) and not self._tells_a_part

    @property
    def _tells_a_part(self) -> bool:
        """Whether causes, though not believed perhaps, remove what is worth speaking of."""
        return bool(self.causes) and not (self.unclear and self.explained_share < A_TENTH)

    @property
    def misses_test(self) -> bool:
        """Whether the model fits the trials looked at without any cause, and those kept for testing show that something
        is wrong all the same."""
        left = self.leftover
        fits = not (self.causes or left.structured or left.offsets or left.changed or self.choice)
        return fits and self.gain.missed

    @property
    def _misses_each(self) -> bool:
        """Whether the others tell a run that is left out far worse than its noise with the causes, yet otherwise.

        A single cause that leaves nothing but noise of all runs together is not refuted by it, unless the logged inputs
        leave much open: few runs leave some coefficients open, and no cause that stood for another was seen to do that.
        """
        if self.gain.held_out != "each" or self.gain.share_removed[0] < AT_ALL:
            return False
        alone = len(self.contributions) == 1 and not self.leaves_open
        if alone and self.explained_share >= ALL and not self.leftover.noticed:
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
        return self.explained_share >= ALL and self.gain.share_removed[0] >= ALL_HELD_OUT

    @property
    def explains_nearly_all(self) -> bool:
        """Whether the causes remove nearly all of the error beyond noise, on held-out trials too."""
        return self.explained_share >= MOSTLY and self.gain.share_removed[0] >= MOST

    @property
    def _mostly_left(self) -> bool:
        """Whether what is left has a shape and is too much beside what the causes explain."""
        bent = any(cause.runs for cause in self.causes) and self.leftover.excess > BENT and not self.explains_all
        return self.leftover.structured and (self.explained_share < MOSTLY or bent)

    @property
    def names_causes(self) -> bool:
        """Whether causes are named that a reader may rely on, be it one of a group."""
        return self.verdict in ("found", "not-separable")

    @property
    def named(self) -> tuple[Cause, ...]:
        """The causes a reader may rely on: none where something unknown is at work too, or the search was stopped."""
        return () if self.verdict in ("unexplained", "interrupted") else self.causes

    def sentence(self) -> str:
        """The answer in words a captain understands."""
        told = [
            f"{one.sentence} That accounts for {_percent(one.explained)} of the error that one value for all leaves."
            for one in self.between
        ]
        if self.verdict == "found" and not self.causes:
            return " ".join(["No cause that is the same in all voyages shows.", *told])
        together = [self.together.sentence] if self.together else []
        first = [self.contradicted] if self.contradicted and self.verdict == "unexplained" else []
        return " ".join([*first, self._of_causes(), *told, *together])

    def _of_causes(self) -> str:
        """What is the same in all trials, in words."""
        if self.verdict == "interrupted":
            known = ", ".join(dict.fromkeys(cause.tag for cause in self.causes))
            told = (
                f"What was tried on by then, not compared with its rivals and not to be relied on: {known}."
                if known
                else "No cause was found by then."
            )
            return f"The search was stopped before its end, so nothing can be concluded. {told}"
        if self.verdict == "none":
            return self._of_none()
        where = "on trials not used" if self.gain.held_out == "test" else f"on {self.gain.words}"
        if self.verdict == "unexplained":
            return self._of_the_unknown(where)
        named = self._of_the_named()
        if all(cause.effect is None for cause in self.causes):
            before, after = self.chi2
            return (
                f"{named} With that put right no other cause shows: the error of the re-tuned model falls from "
                f"{math.sqrt(before):.2g} to {math.sqrt(after):.2g} times the noise of the measurements."
            )
        gained = f"{named} {self._gained('it' if len(self.causes) == 1 else 'them', where)}"
        if self.doubted:
            gained = f"{gained} {self.doubted.sentence}"
        if not any(cause.runs for cause in self.causes):
            return gained
        if not self.gain.first_part:
            return f"{gained} The extended profile leaves out what differs between runs."
        return (
            f"{gained} What differs between runs was estimated there from the first {100.0 * self.gain.first_part:.0f} "
            "% of each run, and the rest was judged; the extended profile leaves it out."
        )

    def _of_none(self) -> str:
        """That no cause shows, and what re-tuning took or the log of the inputs leaves open."""
        if self.leaves_open:
            return (
                f"No cause shows. The re-tuned model leaves {_of_noise(self.leftover.left_open)} of the sensors, "
                "no more than what revolutions and rudder angle did between two samples of their log leaves "
                "open: inputs logged more often would tell more."
            )
        alone = ", ".join(dict.fromkeys(one.cause.tag for one in self.traces if one.contribution.harmful))
        none = (
            f"what alone shows, {alone}, tells held-out trials worse" if alone else "no cause that was looked for shows"
        )
        few = ""
        if self.gain.too_few and self.choice is None:
            few = (
                f"Fitted to the other runs, it errs by {self.gain.left:,.2g} times the noise on one left out: these "
                "are too few for all that is re-tuned."
            )
        if far := moved_in_words(self.moved):
            said = f"Re-tuning is all it takes: with {far}, the model fits these trials to their noise, and {none}."
            return " ".join(filter(None, (said, besides(self.moved), weighed(self.moved), few)))
        parts = (
            f"Nothing is wrong beyond the noise of the measurements: the re-tuned model fits these trials, and {none}.",
            far_off(self.moved),
            weighed(self.moved),
            self.instead.sentence if self.instead else "",
            few,
        )
        return " ".join(filter(None, parts))

    def _of_the_unknown(self, where: str) -> str:
        """That something is wrong, the best that is known of it, and how much is left."""
        tags = " + ".join(dict.fromkeys(cause.tag for cause in self.causes))
        if self.unclear and self._tells_a_part:
            summed = " + ".join(dict.fromkeys(tag for tag, _ in self.contributions))
            return (
                f"Something is wrong that this program cannot name. The best partial explanation, {summed}, removes "
                f"{self._explained} of the error it was found on, but {self.unclear}: it stands for "
                "something else, or for more than these trials can tell apart."
            )
        if self._tells_a_part and not self.leftover.noticed:
            them = "it was" if len(self.causes) == 1 else "they were"
            share = self.gain.share_removed[0]
            held_out = f"leaves {_percent(1.0 - share)} of it" if share > 0.0 else "errs more"
            return (
                f"Something is wrong that this program cannot name. The best of what is known, {tags}, would "
                f"remove {self._explained} of the error {them} found on, but the model with it {held_out} {where}."
            )
        if self.misses_test:
            return (
                "Something is wrong that this program does not know: the re-tuned model fits the trials looked at, "
                f"but leaves an error {self.gain.left:,.3g} times the noise of the sensors on trials kept for "
                "testing, more than coefficients known no better would."
            )
        if self.of_a_sensor:
            told = "; ".join(change_in_words(*one) for one in self.leftover.changed.items())
            return f"Something is wrong with a sensor, and no known cause shows: {told}."
        excess = self.leftover.unknown
        left = (
            f"{_of_noise(excess)} of the measurements"
            if excess < LARGE
            else f"an error {math.sqrt(1.0 + excess):,.0f} times the noise of the sensors"
        )
        told = (
            f"The best of what is known, {tags}, removes {self._explained} of the error and leaves {left}."
            if self._tells_a_part
            else f"the re-tuned model leaves {left}, and no known cause accounts for it."
        )
        offsets = "".join(f" {in_words(*one)}." for one in self.leftover.offsets.items())
        return f"Something is wrong that this program does not know{'.' if self._tells_a_part else ':'} {told}{offsets}"

    def _of_the_named(self) -> str:
        """The causes, those last of which the trials cannot tell which it is."""
        unsure = {tag for group in self.groups for tag in group}
        sure, doubtful = (
            " ".join(f"{cause.sentence}." for cause in self.causes if (cause.tag in unsure) == asked)
            for asked in (False, True)
        )
        if not self.groups:
            return sure
        groups = "; ".join(" or ".join(group) for group in self.groups)
        which = "what else there was" if sure else "which it was"
        return f"{sure} These trials cannot tell {which}: {groups}. If the first: {doubtful}".lstrip()

    @property
    def _explained(self) -> str:
        """How much of the error the causes explain, in words: what is told by less has a share below zero."""
        return _percent(self.explained_share) if self.explained_share > 0.0 else "none"

    def _gained(self, them: str, where: str) -> str:
        """What adding the causes removes of the error on held-out trials, in a sentence."""
        share, low, _ = self.gain.share_removed
        told, runs = self.gain.runs_told
        if self.gain.tells_most_runs and share < MOST:
            rest = "the other" if runs == told + 1 else "the others"
            return (
                f"Adding {them} removes all of the error in {told} of {runs} runs left out in turn; {rest} "
                f"show{'s' if runs == told + 1 else ''} coefficients that the rest do not tell."
            )
        if share <= 0.0:
            return (
                f"How much {'that' if them == 'it' else 'these'} would remove of the error {where} does not show: that "
                "error is mostly of coefficients which the other trials leave open."
            )
        imitated = share < IMITATED and self.options.leeway > 0.0 and self.choice is None
        hull = f", counted from a model whose hull may be {100.0 * self.options.leeway:.3g} % off" if imitated else ""
        few = ", and runs are too few to be sure of that" if low < TOLD <= share else ""
        return f"Adding {them} removes {_percent(share)} of the error {where}{hull}{few}."

    def _assumptions(self) -> list[dict[str, Any]]:
        """What the profile assumes, and what the search believed beforehand."""
        of_profile = [
            {"name": name, "value": self.profile.written(name), "note": coefficient.note}
            for name, coefficient in self.profile.assumptions()
        ]
        effects = [cause.effect for cause in self.causes if cause.effect is not None]
        held = 0.0 if self.choice is not None else self.options.leeway
        return [*of_profile, *beliefs.in_words(held, effects), *winds.in_words(effects)]

    def _voyages(self) -> dict[str, Any] | None:
        """What was looked at of voyages, and what differs from one to the next."""
        if self.choice is None:
            return None
        chosen = [trial.whole for trial in self.choice.trials.trials.values()]
        return {
            "window_s": self.choice.length,
            "windows": {name: chosen.count(name) for name in self.choice.voyages},
            "windows_there_are": dict(self.choice.of),
            "sentence": self.choice.sentence,
            "differences": [one.to_dict() for one in self.differing],
        }

    def citations(self) -> list[str]:
        """The papers behind the profile's components and the causes."""
        causes = [cite for cause in self.causes if cause.effect for cite in cause.effect.cites]
        return list(dict.fromkeys([*self.profile.cites(), *causes]))

    @property
    def kept(self) -> Mapping[str, float]:
        """Targets beside the named causes: where none is, tuned without any."""
        return self.theta if self.named else self.retuned

    def as_ship(self) -> ShipProfile:
        """The extended profile: what the result stands for where a ship is wanted."""
        return self.extended_profile()

    def extended_profile(self) -> ShipProfile:
        """The profile with re-tuned targets and the named causes, each in its own section.

        What differs between runs belongs to these, not to the ship, and is left out.  Causes of an answer that is not
        believed are named, and not in it: ``best_known`` of the record has their sizes.
        """
        made_by = f"mmgtune {self.provenance['mmgtune']}"
        facts = {
            "made_by": made_by,
            "command": self.provenance["command"],
            "created": self.provenance["created"],
            "profile_sha256": self.profile.sha256,
            "trials": self.provenance["trials"]["sha256"],
            "verdict": self.verdict,
            "causes": [cause.tag for cause in self.named],
            **({"coverage": self.coverage.to_dict()} if self.coverage and self.coverage.to_dict() else {}),
        }
        left_out = [cause.tag for cause in self.named if cause.runs]
        if left_out:
            facts["left_out"] = left_out
        if self.together and self.together.settled:
            facts["tuned_to_test"] = True
        if self.causes and not self.named:
            facts["not_believed"] = [cause.tag for cause in self.causes]
        values: dict[str, dict[str, float]] = {}
        stderr: dict[str, dict[str, float | None]] = {}
        for cause in self.named:
            if cause.effect is not None:
                for full, estimate in cause.estimates.items():
                    name = full.rpartition(".")[2]
                    values.setdefault(cause.tag, {})[name] = estimate.value
                    stderr.setdefault(cause.tag, {})[name] = estimate.stderr
        for full, value in self.read_off.items():
            _, tag, name = full.split(".")
            if tag in values:
                values[tag][name] = value
        told = self.provenance["trials"]
        data = {"licence": told.get("licence", ""), "citation": told.get("citation", "")}
        retuned = tuned(self.profile, self.kept, {}, facts, "extended", **data)
        return with_effects(retuned, values, f"diagnosed by {made_by}", stderr)

    def extended_text(self) -> str:
        """TOML of that."""
        return self.extended_profile().text

    def to_dict(self) -> dict[str, Any]:
        """The document of ``diagnosis.json``, schema 1 (docs/formats.md)."""
        return {
            "schema": SCHEMA,
            "kind": "diagnosis",
            **self.provenance,
            "interrupted": self.interrupted,
            "verdict": self.verdict,
            "sentence": self.sentence(),
            "warnings": list(self.warnings),
            "coverage": self.coverage.to_dict() if self.coverage else {},
            "record": self.record.to_dict() if self.record else None,
            "doubts": [one.to_dict() for one in self.profile.doubts()],
            "causes": [cause.to_dict() for cause in self.named],
            "traces": [trace.to_dict() for trace in self.traces],
            "contributions": [{"effect": tag, **one.to_dict()} for tag, one in self.contributions],
            "groups": [list(group) for group in self.groups] if self.verdict == "not-separable" else [],
            "candidates": [candidate.to_dict() for candidate in self.candidates],
            "suggested_trial": self.suggestion.to_dict() if self.suggestion else None,
            "gain": self.gain.to_dict(),
            "unexplained": {
                "structured": self.leftover.structured,
                "unclear": self.unclear,
                "share_of_noise_variance": self.leftover.unknown,
                "slow_noise": self.leftover.slow,
                "left_open_by_inputs": self.leftover.left_open,
                "by_channel": self.leftover.channels,
                "changed_within": {name: list(ids) for name, ids in self.leftover.changed.items()},
                "share_explained_by_causes": self.explained_share,
                "correlation": self.leftover.alike,
                "largest_share_by_one_quantity": {
                    name: {"quantity": what, "share": share} for name, (what, share) in self.leftover.explained.items()
                },
                "best_known": [cause.to_dict() for cause in self.causes]
                if self.verdict in ("unexplained", "interrupted")
                else [],
            },
            "whereabouts": self.whereabouts.to_dict() if self.whereabouts else None,
            "doubted": self.doubted.to_dict() if self.doubted else None,
            "together": self.together.to_dict() if self.together else None,
            "detectability": [one.to_dict() for one in self.detectability],
            "noise": {name: dict(values) for name, values in self.noise.items()},
            "chi2_per_residual": {"before": self.chi2[0], "after": self.chi2[1]},
            "theta": finite_values(self.kept),
            "retuned": [one.to_dict() for one in self.moved],
            "instead_of_tuning": self.instead.to_dict() if self.instead else None,
            "inputs": [one.to_dict() for one in self.profile.arrangement.inputs],
            "trial_results": [one.to_dict() for one in self.gain.compared],
            "assumptions": self._assumptions(),
            "citations": self.citations(),
            "options": self.options.to_dict(),
            "evidence": dict(self.evidence),
            "voyages": self._voyages(),
            "wall_s": self.wall_s,
        }


def _of_noise(variance: float) -> str:
    """A variance beside that of the noise."""
    return f"an error with {100.0 * variance:.0f} % of the variance of the noise"


def _percent(share: float) -> str:
    """A share for a sentence; never quite all."""
    return f"{100.0 * min(share, 0.999):.{0 if share < 0.995 else 1}f} %"
