"""Time in several columns, a part in each: hours, minutes and seconds."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ... import units
from ...arrays import BoolArray, FloatArray
from ...errors import LogError, Problem
from .headers import unit_in
from .numerals import holds_numbers, numbers_in
from .periods import Periods

PARTS = ("d", "h", "min", "s", "ms", "us")
"""Units of the parts, the longest first."""
WORDS = {"d": "days", "h": "hours", "min": "minutes", "s": "seconds", "ms": "milliseconds", "us": "microseconds"}


class TimeParts:
    """Turns the columns of the parts into seconds, block by block.

    names  of the columns by the unit of what they hold, the longest unit first
    """

    clock = True
    stated = ""

    def __init__(self, names: Mapping[str, str], path: Path, decimal: str = "."):
        self.names, self.path, self.decimal = names, path, decimal
        self.notes: list[str] = []
        self.periods = Periods()
        self.seen: dict[str, bool] = {}

    def of(self, columns: Mapping[str, Any]) -> FloatArray:
        """Time (n_rows,) [s] of a pandas column for each unit; NaN where a part is missing, or is none.

        Raises LogError where most of a column is no such part, or its header says another unit.
        """
        parts = {unit: _numbers(one, self.decimal) for unit, one in columns.items()}
        for unit, odd in not_parts(parts).items():
            self._hold(unit, parts[unit], odd)
        return going_on(parts, self.periods)

    def _hold(self, unit: str, values: FloatArray, odd: BoolArray) -> None:
        place = f"{self.path}, column '{self.names[unit]}'"
        said = unit_in(self.names[unit])
        if said in PARTS and said != unit:
            what = f"the map says '{self.names[unit]}' is in {unit}, its header says {said}"
            raise LogError(Problem(what, place, "one of them is wrong", "correct 'column' or 'unit' in [time]"))
        known = np.isfinite(values)
        what = f"the column does not hold the {WORDS[unit]} of a time in several columns"
        self.seen[unit] = self.seen.get(unit, False) or bool(known.any())
        if not self.seen[unit]:
            raise LogError(Problem(what, place, "it has no numbers at all", "correct 'column' and 'unit' in [time]"))
        if odd.sum() > 0.5 * known.sum():
            shown = values[odd][0]
            why = f"the first that cannot be is {shown:.10g}; all are to lie within the next longer part"
            if unit != list(self.names)[-1]:
                why += ", and all but the shortest part to be whole numbers"
            raise LogError(Problem(what, place, why, "correct 'column' and 'unit' in [time]"))


def not_parts(parts: Mapping[str, FloatArray]) -> dict[str, BoolArray]:
    """Which numbers (n_rows,) are no such parts, by unit: beyond the next longer one, or no whole ones."""
    seconds = units.factors("s")
    limits = [np.inf, *(seconds[longer] / seconds[unit] for longer, unit in itertools.pairwise(parts))]
    if next(iter(parts)) in ("h", "min"):
        limits[0] = {"h": 24.0, "min": np.inf}[next(iter(parts))]
    last = list(parts)[-1]
    out = {}
    for (unit, values), limit in zip(parts.items(), limits, strict=True):
        # 60 s are what 59.999 s are rounded to, and a leap second.
        outside = (values < 0.0) | (values > limit)
        out[unit] = np.isfinite(values) & (outside | ((values != np.round(values)) & (unit != last)))
    return out


def together(parts: Mapping[str, FloatArray]) -> FloatArray:
    """Seconds (n_rows,) of parts by their unit; NaN where one is missing or is none."""
    seconds = units.factors("s")
    odd = not_parts(parts)
    return np.asarray(sum(np.where(odd[unit], np.nan, values) * seconds[unit] for unit, values in parts.items()))


def going_on(parts: Mapping[str, FloatArray], periods: Periods) -> FloatArray:
    """Seconds (n_rows,) of parts by their unit that go on over midnight, or the hour where parts begin with minutes."""
    t, first = together(parts), next(iter(parts))
    if first == "h":
        return periods.over_midnight(t)
    return periods.over_the_hour(t) if first == "min" else t


def in_order(given: Sequence[str]) -> bool:
    """Whether units are those of parts, each shorter than the one before."""
    places = [PARTS.index(one) if one in PARTS else -1 for one in given]
    return len(given) > 1 and -1 not in places and all(one < two for one, two in itertools.pairwise(places))


def _numbers(column: Any, decimal: str) -> FloatArray:
    if holds_numbers(column):
        return np.asarray(column.to_numpy(dtype=np.float64, na_value=np.nan))
    return numbers_in(column.astype("string").str.strip(), decimal)
