"""Which column is time, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ... import units
from ...arrays import FloatArray
from ...phrases import listed
from ..cells.stopwatch import DIGITS, EITHER, MINUTES, TIME_OF_DAY, in_digits
from ..cells.time_parts import WORDS
from ..clock import falls
from .parted import seconds_of, time_parts
from .sampling import Sample, seconds
from .words import TIME

CELLS = {
    TIME_OF_DAY: "clock times",
    DIGITS: "clock times in digits",
    MINUTES: "minutes and seconds",
    EITHER: "two numbers with a colon",
}
"""What cells are that are times without a date."""
_NAMED = {TIME_OF_DAY: re.compile(r"\bh{1,2} ?: ?m"), MINUTES: re.compile(r"\bm(in)?m? ?: ?s")}


@dataclass(frozen=True)
class Clock:
    """A column that may be time.

    format  of dates and clocks, "" for numbers; EITHER of stamps that are hours and minutes or minutes and seconds
    unit    of numbers, "" where it is not known
    score   how much speaks for it; words: what does
    by_name whether its name or header says the unit
    parts   by unit the columns that hold a part of the time each, ``column`` the first of them; empty for one column
    """

    column: int
    format: str
    unit: str
    score: float
    words: str
    by_name: bool = False
    parts: Mapping[str, int] = field(default_factory=dict)


def clocks(sample: Sample, said: Sequence[str], units_said: Sequence[str]) -> list[Clock]:
    """Columns that may be time, the likeliest first."""
    found = []
    parts = time_parts(sample, said, units_said)
    if parts:
        held = listed([WORDS[unit] for unit in parts])
        words = f"together they are {held} of a time that goes on"
        found.append(Clock(next(iter(parts.values())), "", "s", 1.5, words, parts=parts))
    for k, numbers in enumerate(sample.numbers):
        if k in parts.values():
            continue
        named = 1.0 if said[k] == TIME else 0.0 if said[k] in ("", "date") else -0.6
        if np.isfinite(numbers).mean() < 0.5:
            stamps = seconds(sample, k)
            if stamps is not None:
                shown = str(next((one for one in sample.texts[k] if isinstance(one, str) and one), ""))[:40]
                what = CELLS.get(stamps[1], "dates")
                found.append(Clock(k, stamps[1], "", 0.9 + named, f"its cells are {what}, such as {shown}"))
            continue
        if said[k] in ("latitude", "longitude"):
            continue  # a ship that holds her course makes one grow as evenly
        if said[k] != TIME and units_said[k] not in ("", *units.factors("s")):
            continue  # what is in metres is no time, however steadily it grows
        known = numbers[np.isfinite(numbers)]
        if said[k] in ("", TIME) and in_digits(numbers):
            words = f"its cells are {CELLS[DIGITS]}, hours, minutes and seconds, such as {known[0]:06.0f}"
            found.append(Clock(k, DIGITS, "", 0.9 + named, words))
            continue
        steps = np.diff(known)
        if len(steps) < 5 or known[-1] <= known[0] or np.mean(steps < 0.0) > 0.01:
            continue
        usual = float(np.median(steps[steps > 0.0]))
        # Where stamps repeat for want of digits, steps are uneven; over more of them they are even.
        wide = np.diff(known[:: max(1, len(known) // 50)])
        uneven = float(np.std(wide) / max(float(np.mean(wide)), 1e-300))
        unit, words = _unit(known, usual, units_said[k])
        score = 0.6 + named + 0.1 * (k == 0) - min(1.0, 3.0 * uneven)
        # Numbers of rows count by one.
        score -= 0.2 * bool(np.all(steps == 1.0) and k > 0 and not named)
        by_name = units_said[k] in units.factors("s")
        found.append(Clock(k, "", unit, score, f"it grows steadily, by {usual:.4g} a row{words}", by_name))
    return sorted(found, key=lambda one: -one.score)


def in_order(sample: Sample, said: Sequence[str], units_said: Sequence[str]) -> Sample:
    """A log whose rows stand newest first by what is called time, turned round; another one as it is."""
    if (parts := time_parts(sample, said, units_said)) and falls(seconds_of(parts, sample)):
        return sample.turned_round()
    for k, numbers in enumerate(sample.numbers):
        stamps = None if np.isfinite(numbers).mean() >= 0.5 else seconds(sample, k)
        if falls(numbers if stamps is None else stamps[0]) and (said[k] == TIME or stamps is not None):
            return sample.turned_round()
    return sample


def _unit(values: FloatArray, step: float, said: str) -> tuple[str, str]:
    """The unit of numbers that are time, "" where only the motion can tell, and why."""
    if said in units.factors("s"):
        return said, f"; its name or header says {said}"
    low, high = float(values.min()), float(values.max())
    if low > 2e4 and high < 8e5 and high - low < 100.0 and step < 0.5:
        return "d", f"; {low:.6g} is a day as {'Excel' if high < 1e5 else 'MATLAB'} counts them"
    if 9e8 < low < 4e9:
        return "s", "; seconds since 1970"
    if 9e11 < low < 4e12:
        return "ms", "; milliseconds since 1970"
    return "", ""


def format_named(sample: Sample, k: int) -> str:
    """The format of stamps that the name of a column, or the unit below it, says, as in "Time [mm:ss]"; else ""."""
    written = f"{sample.names[k]} {sample.units[k]}".lower()
    return next((form for form, pattern in _NAMED.items() if pattern.search(written)), "")


def in_seconds(sample: Sample, clock: Clock, unit: str) -> FloatArray:
    """Stamps (n_rows,) [s]; ``unit`` of numbers, or the format that those are read in that are EITHER."""
    if clock.parts:
        t = seconds_of(clock.parts, sample)
        return t - next(iter(t[np.isfinite(t)]), 0.0)
    if clock.format:
        form = unit if clock.format == EITHER else clock.format if clock.format in CELLS else None
        stamps = seconds(sample, clock.column, form)
        return stamps[0] if stamps is not None else np.full(len(sample.numbers[0]), np.nan)
    numbers = sample.numbers[clock.column]
    known = numbers[np.isfinite(numbers)]
    return (numbers - (known[0] if len(known) else 0.0)) * units.factors("s")[unit]


def likely_units(sample: Sample, clock: Clock) -> tuple[str, ...]:
    """Units in which a log would have a usual rate, the usual one first; before all the one that its name says.

    Of stamps that are EITHER both formats: first that of the name, else minutes and seconds, as of a manoeuvre.
    """
    if clock.format == EITHER:
        both = (MINUTES, TIME_OF_DAY)
        return both[::-1] if format_named(sample, clock.column) == TIME_OF_DAY else both
    if clock.format or (clock.unit and not clock.by_name):
        return (clock.unit or "s",)
    steps = np.diff(sample.numbers[clock.column])
    step = float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else 1.0
    usual = [one for one in ("s", "ms", "min", "h") if 0.004 < step * units.factors("s")[one] < 130.0]
    return tuple(dict.fromkeys([*([clock.unit] if clock.unit else []), *usual])) or ("s",)
