"""Time: which column, and its unit or the order of its dates."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import Any

from ...errors import LogError, Problem
from ...phrases import listed
from ..cells.dates import ORDERS, Dates, Shows, order_told
from ..cells.stopwatch import DIGITS, EITHER, MINUTES, TIME_OF_DAY
from .clocks import Clock, clocks, format_named, in_order
from .finder import MOST_COLUMNS, Finder, moves
from .guess import ASKED, LIKELY, MARK, SURE, Guess
from .words import DATE

CLEARLY = 0.5
"""How much better the motion must fit with another unit of time than with the usual one."""
READ_AS = {MINUTES: "minutes and seconds", TIME_OF_DAY: "hours and minutes"}


def time(find: Finder) -> None:
    find.samples = [in_order(one, find.said, find.units_said) for one in find.samples]
    find.first = find.samples[0]
    usable = [k for k, one in enumerate(find.first.numbers) if any(moves(s.numbers[k]) for s in find.samples)]
    votes: dict[tuple[int, str], list[Clock]] = defaultdict(list)
    found = [clock for sample in find.samples for clock in clocks(sample, find.said, find.units_said)]
    # One log that shows whether its stamps begin with hours or minutes shows it of all.
    told = {clock.column: clock.format for clock in found if clock.format in READ_AS}
    for clock in found:
        if clock.format == EITHER:
            clock = replace(clock, format=told.get(clock.column, EITHER))
        votes[clock.column, clock.format].append(clock)
    if not votes:
        why = "none grows steadily, and none holds dates"
        fix = "write the rows in the order of time, with a column of seconds or dates"
        raise LogError(Problem("no column of the log is time", str(find.first.path), why, fix))
    best = max(votes.values(), key=lambda many: sum(one.score for one in many))
    find.clock = best[0]
    keys: dict[str, Any] = {}
    if find.clock.parts:
        parts = find.clock.parts
        keys |= {"column": [find.first.reference(k) for k in parts.values()], "unit": list(parts)}
    if find.clock.format == DIGITS:
        keys["format"] = DIGITS
    if find.clock.format in ("date", "?"):
        date_order(find, keys)
    column, words = find.clock.column, [best[0].words]
    if find.clock.format in READ_AS and any(one.format == EITHER and one.column == column for one in found):
        keys["format"] = find.clock.format
        words.append(f"another log shows that they are {READ_AS[find.clock.format]}")
    find.used |= {column, *find.clock.parts.values()}
    dates = [k for k, name in enumerate(find.said) if name == DATE and k not in find.used]
    if dates:
        shown = listed([find.shown(k) for k in dates], 4)
        words.append(f"the date in {shown} is not needed: midnight is seen by the clock")
        find.used.update(dates)
    find.numeric = [k for k in usable if k not in find.used]
    if len(find.numeric) > MOST_COLUMNS:
        named = [k for k in find.numeric if find.said[k]]
        rest = [k for k in find.numeric if not find.said[k]]
        find.numeric = sorted([*named, *rest][:MOST_COLUMNS])
        find.notes.append(f"of {len(usable)} columns the {MOST_COLUMNS} that names speak of were looked at")
    asked = any(isinstance(one, str) and one.startswith(MARK) for one in keys.values())
    find.guess_t = Guess("t", column, keys, tuple(words), ASKED if asked else SURE)


def date_order(find: Finder, keys: dict[str, Any]) -> None:
    """Which of day and month stands first, over all logs."""
    possible = set(ORDERS)
    told = set()
    for sample in find.samples:
        dates = Dates(sample.texts[find.clock.column].astype("string").str.strip())
        orders = dates.orders()
        possible &= set(orders) or possible
        if len(orders) > 1:
            found = order_told({one: dates.since(one) for one in orders})
            if found.shows is not Shows.ANY:
                told.add(found.order or MARK)
    if len(possible) == 1:
        keys["format"] = possible.pop()
    elif len(told - {MARK}) == 1:
        keys["format"] = (told - {MARK}).pop()
    elif MARK in told:
        keys["format"] = f'{MARK} "dmy" or "mdy": which of day and month stands first?'


def time_unit(find: Finder) -> None:
    """What the map says of time, once its unit is known."""
    guess = find.guess_t
    keys = dict(guess.keys)
    if find.clock.format == EITHER:
        keys["format"], said = first_number(find)
        asked = keys["format"].startswith(MARK)
        guess = replace(guess, evidence=(*guess.evidence, said), confidence=ASKED if asked else SURE)
    elif not find.clock.format and not find.clock.parts:
        keys["unit"] = find.unit
        if find.clock.by_name and find.unit != find.clock.unit:
            keys["header_says"] = find.clock.unit
            said = f"but the motion agrees with itself in {find.unit}, not in {find.clock.unit}"
            guess = replace(guess, evidence=(*guess.evidence, said))
        elif not find.clock.unit:
            how = "the usual one at this rate" if find.unit == "s" else "the one in which the motion agrees with itself"
            guess = replace(guess, evidence=(*guess.evidence, f"{find.unit} is {how}"))
    find.add(replace(guess, keys=keys))


def first_number(find: Finder) -> tuple[str, str]:
    """The format of stamps whose first number is hours or minutes, or the question which, and why.

    The motion shows it: distance and turn beside the time they take; where it does not, names do.
    """
    best, other = sorted(READ_AS, key=lambda one: -find.readings.get(one, 0.0))
    if find.readings.get(best, 0.0) > find.readings.get(other, 0.0) + CLEARLY:
        return best, f"read as {READ_AS[best]} the motion agrees with itself, as {READ_AS[other]} it does not"
    if named := format_named(find.first, find.clock.column):
        return named, f"its name says {READ_AS[named]}"
    question = f'{MARK} "{TIME_OF_DAY}" or "{MINUTES}": are the stamps hours and minutes, or minutes and seconds?'
    return question, "nothing shows which"


def doubt_rates(find: Finder) -> None:
    """What is told by a time that is asked for is likely at most, and says so: the units of rates that no name says."""
    if find.clock.format != EITHER or find.guesses["t"].confidence != ASKED:
        return
    for name in ("r", "n", "n_port", "n_stbd"):
        guess = find.guesses.get(name)
        if guess is None or guess.column is None or find.units_said[guess.column] or guess.confidence == ASKED:
            continue
        said = f"its unit is the one if time is {READ_AS[find.unit]}"
        find.guesses[name] = replace(guess, evidence=(*guess.evidence, said), confidence=LIKELY)
