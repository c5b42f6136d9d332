"""Trials of one ship against each other: what is wrong in one of them alone."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from ..model import Trial
from .all_checks import check_trial
from .cross_checks import ON_APPROACH, WAY, usual_way, way_finding, way_per_turn
from .finding import SEVERITIES, Finding

NAMED = 3
"""Things told where a result says that trials are odd."""
APART = 1.3
"""Factor between trials that neither currents nor the weather make, but wrong units do."""
COPIED = 0.9
"""Share of the samples of a trial from which it is another one again."""
FEWEST_COPIED = 20
"""Samples that differ from each other and stand in another trial too, which no two runs have by chance."""


def check_trials(trials: Mapping[str, Trial], L_pp: float | None = None) -> dict[str, list[Finding]]:
    """Everything a user should know about each trial of a set, worst first; arguments as for ``check_trial``.

    Three or more approaches are held against each other besides: a unit that is wrong in one trial shows there.
    What is wrong in all that have an approach is told of the others too where it shows.
    """
    found = {name: check_trial(trial, L_pp) for name, trial in trials.items()}
    of_the_set = (_ways(trials), _of_a_gear(trials, found, L_pp), _copies(trials))
    for name, finding in (pair for one in of_the_set for pair in one.items()):
        found[name] = sorted([*found[name], finding], key=lambda one: SEVERITIES.index(one.severity))
    return found


def oddest(checked: Mapping[str, Sequence[Finding]]) -> dict[str, str]:
    """By trial, what is oddest of all that ``check_trials`` calls wrong or warns of; nothing of those where nothing is.

    Gaps are not: what falls into them counts in no comparison, and results say that themselves.
    """
    return {
        name: odd[0].what
        for name, findings in checked.items()
        if (odd := [one for one in findings if one.severity != "note" and one.code != "gaps"])
    }


def oddities(trials: Mapping[str, Trial], L_pp: float | None = None) -> list[str]:
    """A sentence for results, where trials they are made of have something odd; see ``oddest``."""
    return told_of(check_trials(trials, L_pp))


def told_of(checked: Mapping[str, Sequence[Finding]]) -> list[str]:
    """The same of what ``check_trials`` found."""
    worst = oddest(checked)
    if not worst:
        return []
    said = odd_in_words(worst)
    return [f"Something is odd in {len(worst)} of {len(checked)} trials: {said}. 'mmgtune trials check' says more."]


def another_ship(trials: str, ship: str) -> list[str]:
    """What to say, as a sentence goes on behind a colon, where trials are not of the ship they are compared with.

    trials  id of the ship they are of, "" where they do not say
    ship    id of the model's
    """
    return [f"the trials are of '{trials}', the model is of '{ship}'"] if trials and trials != ship else []


def odd_in_words(odd: Mapping[str, str]) -> str:
    """What is odd, by trial, in words: what differs in its numbers alone once, of the first of those trials."""
    alike: dict[str, list[str]] = {}
    for name, what in odd.items():
        alike.setdefault(re.sub(r"\d[\d.e+-]*", "", what), []).append(name)
    told = [
        f"{odd[first]} ({first}{f', and {len(others)} more alike' if others else ''})"
        for first, *others in alike.values()
    ]
    more = [f"and {len(told) - NAMED} more"] if len(told) > NAMED else []
    return "; ".join([*told[:NAMED], *more])


def found_in(checked: Mapping[str, Sequence[Finding]], code: str) -> dict[str, Finding]:
    """The finding with a code among what ``check_trials`` found, by trial that has one."""
    return {name: one for name, findings in checked.items() for one in findings if one.code == code}


def _of_a_gear(
    trials: Mapping[str, Trial], found: Mapping[str, list[Finding]], L_pp: float | None
) -> dict[str, Finding]:
    """Trials without an approach that make too little or too much way with each turn, as all do that have one."""
    steady = [name for name, trial in trials.items() if way_per_turn(trial) is not None]
    wrong = [name for name, findings in found.items() if any(one.code == WAY for one in findings)]
    if L_pp is None or len(wrong) < 2 or not set(steady) <= set(wrong):
        return {}
    ways = {name: usual_way(trial) for name, trial in trials.items() if name not in wrong}
    return {
        name: way_finding(way, L_pp, trials[name], str(trials[name].path or name), as_others=True)
        for name, way in ways.items()
        if way is not None and not ON_APPROACH[0] <= way / L_pp <= ON_APPROACH[1]
    }


def _copies(trials: Mapping[str, Trial]) -> dict[str, Finding]:
    """Trials that are another one again, as a filtered copy is: measured numbers are equal to the last digit."""
    found: dict[str, Finding] = {}
    for channels, said in ((("x", "y"), "positions"), (("psi", "r", "u", "v_m"), "heading and velocities")):
        of: dict[tuple[float, ...], str] = {}
        for name, trial in trials.items():
            samples = set(zip(*(getattr(trial, one).tolist() for one in channels), strict=True))
            (other, shared), *_ = Counter(of[one] for one in samples if one in of).most_common(1) or [("", 0)]
            if shared >= max(FEWEST_COPIED, COPIED * len(samples)) and name not in found:
                found[name] = Finding(
                    "warning",
                    f"its {said} are those of '{other}'",
                    str(trials[name].path or name),
                    f"{shared} samples are equal to the last digit: one run is there twice, and counts twice; where "
                    "only one of the two is held out, that one is not unseen",
                    "leave one of them out",
                )
            of |= dict.fromkeys(samples - of.keys(), name)
    return found


def _ways(trials: Mapping[str, Trial]) -> dict[str, Finding]:
    ways = {name: way for name, trial in trials.items() if (way := way_per_turn(trial)) is not None}
    found = {}
    for name, way in ways.items():
        others = [one for other, one in ways.items() if other != name]
        if len(others) < 2:
            continue
        usual = float(np.median(others))
        alike = sum(1.0 / APART < one / usual < APART for one in others)
        if not 1.0 / APART < way / usual < APART and alike > 0.75 * len(others):
            found[name] = Finding(
                "warning",
                f"on her approach the ship makes {way:.3g} m with each turn of the propeller, {usual:.3g} m in others",
                f"{trials[name].path or name}, columns 'n' and 'u'",
                f"{way / usual:.3g} times as much as in {alike} of the other trials: the unit of one of them is wrong, "
                "or the propeller or its gear was another",
                "compare how 'n' and 'u' of this trial were logged with the others",
            )
    return found
