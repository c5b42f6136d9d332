"""The answer of a diagnosis in words a captain understands."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...phrases import LARGE, capital, figures, in_percent, listed, small
from ...units import DEG
from ..bench.hypotheses import n_terms
from ..bench.of_hull import AS_WELL
from ..causes.belief import MOSTLY, TOLD
from ..evidence.leftover import OF_ANOTHER_FORM, change_in_words, in_words
from ..evidence.misread import RUDDER
from ..evidence.misread import in_words as misread_in_words
from ..held_out.gain import MOST
from ..signatures.retuned import besides, far_off, weighed
from ..signatures.retuned import in_words as moved_in_words
from .ended import in_words as ends_in_words
from .jumped import in_words as jumps_in_words
from .one_clock import clock_rate
from .verdict import Answer

IMITATED = 0.5
"""Share of the error removed below which it is said that a hull a little off is part of what it is counted from."""


FADES = 5.0
"""How many times as large as its white part the slow part of a channel's noise must be to be spoken of."""


NAMED = 6
"""Effects asked for that are named, at most."""


class Said(NamedTuple):
    """An answer in pieces: what stands alone at the head of a page, what explains it, the cause that would be most of
    what cannot be named, if one is, and what is said beside."""

    first: str
    why: str = ""
    leading: str = ""
    beside: str = ""

    @property
    def headline(self) -> str:
        """The answer without what explains it."""
        return _joined(self.first, self.leading)

    @property
    def explained(self) -> str:
        """What explains the headline, and what is said beside."""
        return _joined(self.why, self.beside)

    @property
    def sentence(self) -> str:
        """All of it."""
        return _joined(*self)


def said(answer: Answer) -> Said:
    """What is the same in all trials, what differs between voyages, and what all trials together say."""
    told = [
        f"{one.sentence} That accounts for {in_percent(one.explained)} of the error that one value for all leaves."
        for one in answer.between
    ]
    if answer.verdict == "found" and not answer.causes:
        return Said(" ".join(["No cause that is the same in all voyages shows.", *told]))
    more = [*told, *([answer.together.sentence] if answer.together else [])]
    misread = misread_in_words(answer.wrong_logs) if answer.causes else ""
    of_sensors = "; ".join(filter(None, (jumps_in_words(answer.jumped), ends_in_words(answer.ended), misread)))
    apart = f"{capital(of_sensors)}. Apart from that: " if of_sensors else ""
    if answer.verdict == "unexplained":
        unknown = _of_the_unknown(answer)
        pieces = [answer.contradicted, unknown.first] if answer.contradicted else [unknown.first]
        first, *why = [*pieces, unknown.why]
        if answer.ends and not (answer.contradicted or answer.of_a_sensor):
            unlike, ends = answer.ends.first, answer.ends.why(answer.unclear)
            in_few = answer.whereabouts is not None and answer.whereabouts.in_few
            if (answer.options.effects or in_few) and not answer.ends.from_formulas:
                unlike, ends = "", ""  # one that was not looked for, or what went on in these runs, may stand for it
            if unlike and answer.tells_a_part and answer.explained_share >= MOSTLY and not answer.ends.unlike:
                unlike, ends = "", answer.ends.aside  # what few causes do is hardly of many coefficients
            first = unlike if unlike and first == _CANNOT_NAME else _joined(first, unlike)
            why.append(ends)
        return Said(apart + first, _joined(*why, _of_few(answer)), unknown.leading, " ".join(more))
    if answer.verdict == "none":
        one = _of_none(answer)
        return one._replace(first=apart + one.first, beside=_joined(one.beside, *more))
    beside = ""
    if answer.causes and answer.verdict != "interrupted" and not _of_another_form(answer):
        far = moved_in_words(answer.moved)
        beside = _joined(f"Re-tuned beside that: {far}." if far else "", _of_ship(answer))
    return Said(" ".join([apart + _of_causes(answer), *more]), beside)


def _where(answer: Answer) -> str:
    """On which trials the gain was measured."""
    return "on trials not used" if answer.gain.held_out == "test" else f"on {answer.gain.words}"


def _of_causes(answer: Answer) -> str:
    """What is the same in all trials, in words, where that can be named."""
    if answer.verdict == "interrupted":
        known = ", ".join(dict.fromkeys(cause.tag for cause in answer.causes))
        told = (
            f"What was tried on by then, not compared with its rivals and not to be relied on: {known}."
            if known
            else "No cause was found by then."
        )
        return f"The search was stopped before its end, so nothing can be concluded. {told}"
    named = _of_the_named(answer)
    if all(cause.effect is None for cause in answer.causes):
        before, after = map(math.sqrt, answer.chi2)
        digits = 2 if figures(before) != figures(after) else 3
        return (
            f"{named} With that put right no other cause shows: the error of the re-tuned model falls from "
            f"{figures(before, digits)} to {figures(after, digits)} times the noise of the measurements."
        )
    named = _joined(named, clock_rate(answer.causes), _at_ends(answer))
    gained = _joined(named, *_brought(answer), _of_another_form(answer))
    if answer.doubted:
        gained = f"{gained} {answer.doubted.sentence}"
    if not answer.differs_by_run:
        return gained
    if not answer.gain.first_part:
        return f"{gained} The extended profile leaves out what differs between runs."
    return (
        f"{gained} What differs between runs was estimated there from the first {100.0 * answer.gain.first_part:.0f} "
        "% of each run, and the rest was judged; the extended profile leaves it out."
    )


def _of_another_form(answer: Answer) -> str:
    """How much the causes leave where their form is not quite that of the ship, in a sentence; "" where it is."""
    off = "the form of what was found is not quite that of the ship, or something smaller is at work beside it."
    if answer.gain.form_is_off:
        left = f"{_times(answer.gain.left)} times the noise of the sensors"
        return f"What is left there is {left}, more than coefficients known no better explain: {off}"
    if answer.leftover.unknown > OF_ANOTHER_FORM:
        return f"Where it was found, {_of_noise(answer.leftover.unknown)} is left: {off}"
    return ""


def _at_ends(answer: Answer) -> str:
    """That a size is no more than the end of what was looked for; "" where none is."""
    ended = listed(list(dict.fromkeys(cause.tag for cause in answer.causes if cause.at_ends)))
    return f"The size of {ended} is at the end of what was looked for, and may lie beyond it." if ended else ""


def _brought(answer: Answer) -> list[str]:
    """What the causes remove on held-out trials, and what no ship has that the model would take without one of them,
    where that decides."""
    gained = _gained(answer, "it" if len(answer.causes) == 1 else "them", _where(answer))
    nothing = answer.gain.share_removed <= 0.0
    needed = [(tag, one) for tag, one in answer.contributions if one.unlike_any and (nothing or one.of_hull >= AS_WELL)]
    without = {tag: f"takes {one.unlike_any}, as no ship has it." for tag, one in needed}
    if without and nothing:
        no_worse = f"the model is no worse {_where(answer)}, but"
        return [f"Re-tuned without {tag}, {no_worse} {takes}" for tag, takes in without.items()]
    return [gained, *(f"Without {tag} the model {takes}" for tag, takes in without.items())]


def _of_none(answer: Answer) -> Said:
    """That no cause shows; what re-tuning changed and may stand for, and what the log of the inputs leaves open."""
    if answer.swell:
        return Said(answer.swell)
    if answer.leaves_open:
        left_open = (
            f"The re-tuned model leaves {_of_noise(answer.leftover.left_open)}, "
            "no more than what revolutions and rudder angle did between two samples of their log leaves "
            "open: inputs logged more often would tell more."
        )
        return Said("No cause shows.", left_open)
    alone = ", ".join(dict.fromkeys(one.cause.tag for one in answer.traces if one.contribution.harmful))
    like_hull = listed([one.cause.tag for one in answer.traces if one.contribution.like_hull])
    none = "no cause that was looked for shows"
    if answer.traces:
        none = "none of the causes that were looked for is more than a trace"
    if alone:
        none = f"what alone shows, {alone}, tells held-out trials worse"
    if like_hull:
        none = f"what alone shows, {like_hull}, a hull further off than believed would explain as well"
    few = ""
    if answer.gain.too_few and answer.choice is None:
        few = (
            f"Fitted to the other runs, it errs by {_times(answer.gain.left)} times the noise on one left out: these "
            "are too few for all that is re-tuned."
        )
    if far := moved_in_words(answer.moved):
        said = f"Re-tuning is all it takes: with {far}, the model fits these trials to their noise, and {none}."
        why = _joined(besides(answer.moved), _of_ship(answer), few, _fading(answer))
        return Said(said, why, *_in_place(answer))
    far = _joined(far_off(answer.moved), _of_ship(answer))
    noise = "the noise of the measurements"
    first = f"Nothing is wrong beyond {noise}: the re-tuned model fits these trials, and {none}."
    if far or few or answer.instead:  # it fits, which is not to say that nothing is wrong
        first = f"The re-tuned model fits these trials to {noise}, and {none}."
    return Said(first, _joined(far, few, _fading(answer)), *_in_place(answer))


def _of_ship(answer: Answer) -> str:
    """What the trials contradict of the ship that is no target; of her hull where they are not too few for that."""
    return weighed(answer.moved, of_hull=not answer.gain.too_few, beside=bool(answer.causes))


def _in_place(answer: Answer) -> tuple[str, str]:
    """What re-tuning may stand for, and why; nothing where it may not."""
    return (answer.instead.sentence, answer.instead.why) if answer.instead else ("", "")


def _joined(*sentences: str) -> str:
    """Sentences in a row, those that say nothing left out."""
    return " ".join(filter(None, sentences))


def _fading(answer: Answer) -> str:
    """That slow errors of positions or heading count as noise, where they are far larger than quick ones."""
    far = {name: one["fading"] for name, one in answer.noise.items() if one["fading"] > FADES * one["white"]}
    positions = max(far.get("x", 0.0), far.get("y", 0.0))
    told = [f"{figures(positions)} m in the positions"] if positions else []
    told += [f"{far['psi'] / DEG:.2g}° in the heading"] if "psi" in far else []
    if not told:
        return ""
    slow = f"Errors that fade slowly, {listed(told)}, count as noise of the sensors"
    return f"{slow}: a cause that does no more does not show."


def _times(ratio: float) -> str:
    """A ratio to two figures, without a power of ten."""
    return f"{float(f'{ratio:.2g}'):,g}" if ratio < 1e6 else f"{ratio:,.0f}"


_CANNOT_NAME = "Something is wrong that this program cannot name."
_NOT_KNOWN = "Something is wrong that this program does not know"
_NOT_ASKED_FOR = "Something is wrong, and nothing of what was looked for explains it"


def _of_few(answer: Answer) -> str:
    """That no other effects than those asked for were looked for; "" where all were."""
    asked = answer.options.effects
    if not asked or answer.looked_for_none or answer.of_a_sensor:
        return ""
    return f"Only {listed(asked, NAMED)} {'was' if len(asked) == 1 else 'were'} looked for."


def _summed(answer: Answer) -> str:
    """Causes of a sum by their tags: how many there are of one that is of many, as terms of a hull are, and which have
    a value of each run."""
    tags, by_run = [tag for tag, _ in answer.contributions], {cause.tag for cause in answer.causes if cause.runs}
    many = {tag: n_terms([one for one in tags if one == tag]) for tag in tags}
    several = {tag: f"{n} times {tag}" if n > 1 else tag for tag, n in many.items()}
    return " + ".join(words + (" of each run" if tag in by_run else "") for tag, words in several.items())


def _of_the_unknown(answer: Answer) -> Said:
    """That something is wrong, the best that is known of it, and how much is left."""
    tags = " + ".join(dict.fromkeys(cause.tag for cause in answer.causes))
    if answer.looked_for_none:
        left = _of_noise(answer.leftover.unknown, "measurements")
        return Said(f"No cause was looked for: with the logs as they are, the re-tuned model leaves {left}.")
    if answer.unclear and answer.tells_a_part:
        what = "this sum" if len(answer.contributions) > 1 else "this"
        best = (
            f"The best partial explanation, {_summed(answer)}, removes {_explained(answer)} of the error it was found "
            f"on, but {answer.unclear}: {what} stands for something else, or for more than these trials can tell apart."
        )
        return Said(_CANNOT_NAME, best, answer.leading.sentence if answer.leading else "")
    if answer.tells_a_part and not answer.leftover.noticed:
        them = "it was" if len(answer.causes) == 1 else "they were"
        share = answer.gain.share_removed
        held_out = f"leaves {in_percent(1.0 - share)} of it" if share > 0.0 else "errs more"
        best = (
            f"The best of what is known, {tags}, would remove {_explained(answer)} of the error {them} found on, but "
            f"the model with it {held_out} {_where(answer)}."
        )
        return Said(_CANNOT_NAME, _joined(best, _as_a_part(answer)))
    if answer.contradicted and not (answer.causes or answer.leaves_shape):
        return Said("What the re-tuned model leaves is taken for noise of the sensors.", _fading(answer))
    asked = answer.options.effects
    unknown = _NOT_ASKED_FOR if asked else _NOT_KNOWN
    if answer.misses_test:
        return Said(
            f"{unknown}: the re-tuned model fits the trials looked at, "
            f"but leaves an error {_times(answer.gain.left)} times the noise of the sensors on trials kept for "
            "testing, more than coefficients known no better would."
        )
    if answer.of_a_sensor:
        changed = (change_in_words(*one) for one in answer.leftover.changed.items())
        told = "; ".join(filter(None, (*changed, misread_in_words(answer.wrong_logs))))
        gone = (
            "With that put right all logs are" if [*answer.misread] == [RUDDER] else "Without that log all others are"
        )
        without = f"{gone} fitted to the noise of the measurements."
        fits = answer.misread and not (answer.causes or answer.leftover.noticed)
        return Said(f"Something is wrong with a sensor, and no known cause shows: {told}.", without if fits else "")
    excess = answer.leftover.unknown
    left = _of_noise(excess, "measurements")
    offsets = [f"{in_words(*one)}." for one in answer.leftover.offsets.items()]
    if answer.tells_a_part:
        best = f"The best of what is known, {tags}, removes {_explained(answer)} of the error and leaves {left}."
        return Said(f"{unknown}.", _joined(best, _as_a_part(answer), *offsets))
    rest = "" if asked else ", and no known cause accounts for it"
    return Said(f"{unknown}: the re-tuned model leaves {left}{rest}.", " ".join(offsets))


def _as_a_part(answer: Answer) -> str:
    """How large the only cause that is known would be, where that is told; "" where not."""
    one = answer.causes[0] if len(answer.causes) == 1 else None
    told = one is not None and one.effect is not None and one.sized and not (one.at_ends or one.runs)
    return f"If it is a part of what is wrong, {small(one.sentence)}." if one and told else ""


def _of_the_named(answer: Answer) -> str:
    """The causes; last, the groups of causes that the trials cannot tell apart."""
    unsure = {tag for group in answer.groups for tag in group}
    sure, doubtful = (
        " ".join(f"{cause.sentence}." for cause in answer.causes if (cause.tag in unsure) == asked)
        for asked in (False, True)
    )
    if not answer.groups:
        return sure
    groups = "; ".join(" or ".join(group) for group in answer.groups)
    which = "what else there was" if sure else "which it was"
    return f"{sure} These trials cannot tell {which}: {groups}. If the first: {doubtful}".lstrip()


def _explained(answer: Answer) -> str:
    """How much of the error the causes explain, in words: what is told by less has a share below zero."""
    return in_percent(answer.explained_share) if answer.explained_share > 0.0 else "none"


def _gained(answer: Answer, them: str, where: str) -> str:
    """What adding the causes removes of the error on held-out trials, in a sentence."""
    share = answer.gain.share_removed
    told, runs = answer.gain.runs_told
    if answer.gain.tells_most_runs and share < MOST:
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
    if answer.gain.too_few and share < TOLD:
        return (
            f"Adding {them} removes {_explained(answer)} of the error where all runs are fitted together, and "
            f"{in_percent(share)} of it {where}: the others are too few for all that is re-tuned."
        )
    imitated = share < IMITATED and answer.options.leeway > 0.0 and answer.choice is None
    hull = f", counted from a model whose hull may be {100.0 * answer.options.leeway:.3g} % off" if imitated else ""
    few = ", and runs are too few to be sure of that" if answer.gain.surely_removed < TOLD <= share else ""
    return f"Adding {them} removes {in_percent(share)} of the error {where}{hull}{few}."


def _of_noise(variance: float, of: str = "sensors") -> str:
    """An error whose variance beyond noise is given as a share of that of the noise, in words."""
    if variance < LARGE:
        return f"an error with {100.0 * variance:.0f} % of the variance of the noise of the {of}"
    return f"an error {math.sqrt(1.0 + variance):,.0f} times the noise of the sensors"
