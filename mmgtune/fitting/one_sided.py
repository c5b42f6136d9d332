"""Trials that turn to one side only: coefficients of the other side are tied to those of this one.

A coefficient that acts on one side alone learns nothing of the other.  Tuned while its twin stays where it was, it
gives the ship an asymmetry that nobody measured; tied, both keep the ratio of the pre-determined values.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from ..model import Model, Tie
from ..profile import ShipProfile
from ..trial import BY_SIDE, Coverage

LOPSIDED_HULL = re.compile(r"effects\.hull-term\.[YN]_(one|absr|vv|rr|rrabsr)")
"""Terms of a hull of two unlike sides."""

LOPSIDED = re.compile(
    r"propeller\.(C_PY|C_PN)\w*|effects\.rudder-offset\.angle|effects\.propeller-(side-force|walk)\.\w+"
    rf"|{LOPSIDED_HULL.pattern}"
)
"""Coefficients that push to one side whatever the rudder does: on one side they are any change of the others."""


def tied(profile: ShipProfile, targets: Sequence[str], coverage: Coverage) -> tuple[tuple[str, ...], tuple[Tie, ...]]:
    """Targets without those of a side that trials never turned to, and what these follow."""
    ties = []
    for starboard, port in BY_SIDE:
        seen, unseen = (starboard, port) if coverage.unseen_side == "port" else (port, starboard)
        if coverage.unseen_side and {seen, unseen} <= set(targets) and profile.value(seen) != 0.0:
            ties.append(Tie(unseen, seen, profile.value(unseen) / profile.value(seen)))
    away = {tie.name for tie in ties}
    return tuple(name for name in targets if name not in away), tuple(ties)


def followers(ties: Sequence[Tie], values: Mapping[str, float]) -> dict[str, float]:
    """Values of what is tied, by name, from those of what it follows."""
    return {tie.name: tie.ratio * values[tie.to] for tie in ties if tie.to in values}


def coverage_notes(model: Model, targets: Sequence[str], coverage: Coverage) -> list[str]:
    """What a reader must know of what trials do not visit, in sentences; nothing where both sides are there."""
    if not coverage.to_dict():
        return []
    side = coverage.unseen_side
    if not side:
        if coverage.sides:
            return _offered(model, targets)
        return ["The trials hold no turn to either side: what this says of turns, nobody measured."]
    other = coverage.sides[0]
    hardly = coverage.hardly_turns(side)
    if hardly:
        rates = " and ".join(f"{coverage.most_rate(one):.2g} to {one}" for one in (side, other))
        found = [
            f"The trials hardly turn to {side} (r L/U of {rates}): errors and intervals here are of turns to {other}."
        ]
    else:
        what = f"errors and intervals here are of that side; to {side} none was measured"
        found = [f"The trials turn to {other} only: {what}."]
    ties = [tie for tie in model.ties if tie.to in targets]
    if ties:
        words = ", ".join(f"{tie.name} (to {tie.to})" for tie in ties)
        little = "hardly anything" if hardly else "nothing"
        found.append(f"Tied, as {little} was measured on its side: {words}.")
    alone = [
        seen
        for pair in BY_SIDE
        for seen, unseen in (pair if side == "port" else pair[::-1],)
        if seen in targets and unseen not in {tie.name for tie in ties}
    ]
    wrong = [*alone, *(name for name in targets if LOPSIDED.fullmatch(name))]
    if wrong:
        found.append(
            f"Targets that may make turns to {side} wrong, as only turns to {other} tell of them: {', '.join(wrong)}."
        )
    return found


def _offered(model: Model, targets: Sequence[str]) -> list[str]:
    """Coefficients by side that could be tuned, where one of a pair is: both sides were turned to."""
    names = set(model.rows)
    missing = [
        name
        for pair in BY_SIDE
        if set(pair) <= names and set(pair) & set(targets)
        for name in pair
        if name not in targets
    ]
    if not missing:
        return []
    return [f"The trials turn to both sides, so that {', '.join(missing)} may be tuned too: only the other side's is."]
