"""Dates with a time of day as people write them, to seconds."""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import Enum
from typing import Any, NamedTuple

import numpy as np

from ...arrays import BoolArray, FloatArray

DAY = 86400.0
ORDERS = ("dmy", "mdy", "ymd")
"""Orders of day, month and year."""

_MONTHS = (
    "jan janv jän ene gen sty", "feb fév fevr fev lut", "mar mär mrz maa mrt", "apr avr abr kwi", "may mai mei maj mag",
    "jun juin giu cze", "jul juil lug lip", "aug aou aoû ago sie", "sep set wrz", "oct okt ott out paź paz",
    "nov lis", "dec déc dez dic des gru",
)  # fmt: skip
_NUMBER = {start: number for number, starts in enumerate(_MONTHS, start=1) for start in starts.split()}
"""Months by the first letters of their names: English, Dutch, German, French, Italian, Spanish, Portuguese, Swedish,
Danish, Norwegian and Polish."""

DATE = (
    r"(?P<a>\d{1,4})(?P<mark>[./\- ])(?P<b>\d{1,2}|[^\W\d_]{3,12}\.?)(?P=mark)(?P<c>\d{1,4})"
    r"[T ,]\s*(?P<h>\d{1,2})[:.](?P<m>\d{2})(?:[:.](?P<s>\d{2}(?:[.,:]\d*)?))?"
    r"\s*(?P<half>[AaPp]\.?[Mm]\.?)?\s*(?P<zone>Z|[A-Za-z]{2,5}|(?:UTC|GMT)?[+-]\d{1,2}:?(?:\d{2})?)?"
)
"""A date and a time of day: three numbers, or a month by name, one mark between them; then hours and minutes."""

_PATTERN = re.compile(DATE)


def is_date(text: str) -> bool:
    """Whether a text is a date with a time of day."""
    return _PATTERN.fullmatch(text.strip()) is not None


class Dates:
    """Dates (n_rows,) taken apart.

    first, second, third  the three numbers as they stand, NaN where there is no date
    named                 whether the second is a month by name
    seconds               since midnight, of UTC where the text says its zone by hours
    """

    def __init__(self, texts: Any):
        """Of a pandas column of texts."""
        # Few texts are looked at: what is longer is no date.
        parts = texts.str.slice(0, 60).str.extract(f"^{DATE}$")
        month = parts["b"].str.lower().str.rstrip(".")
        by_name = month.str.slice(0, 4).map(_NUMBER).fillna(month.str.slice(0, 3).map(_NUMBER))
        self.named: BoolArray = by_name.notna().to_numpy(dtype=bool)
        self.first, self.third = _numbers(parts["a"]), _numbers(parts["c"])
        self.second = np.where(self.named, _numbers(by_name), _numbers(parts["b"]))
        self.years_first: BoolArray = (parts["a"].str.len() >= 3).fillna(False).to_numpy(dtype=bool)
        hours, minutes = _numbers(parts["h"]), _numbers(parts["m"])
        written = parts["s"].str.replace(r"[,:]", ".", regex=True)
        given = np.nan_to_num(_numbers(written))
        half = parts["half"].str.slice(0, 1).str.lower()
        afternoon, morning = (half == "p").to_numpy(dtype=bool, na_value=False), half.notna().to_numpy(dtype=bool)
        hours = np.where(morning, np.mod(hours, 12.0), hours) + 12.0 * afternoon
        right = (hours <= 24.0) & (minutes < 60.0) & (given < 61.0)
        self.seconds: FloatArray = np.where(
            right, 3600.0 * hours + 60.0 * minutes + given - _zone(parts["zone"]), np.nan
        )

    def orders(self) -> tuple[str, ...]:
        """Orders in which every part is one that a date has."""
        known = np.isfinite(self.first) & np.isfinite(self.second) & np.isfinite(self.third)
        if not known.any():
            return ()
        whole = {order: np.isfinite(self.days(order))[known].mean() for order in ORDERS}
        # A few damaged cells leave what all the others say.
        return tuple(order for order in ORDERS if whole[order] > 0.9)

    def days(self, order: str) -> FloatArray:
        """Days (n_rows,) since 1970, NaN where the parts are no date in this order; years of two digits are of 2000."""
        first, second, third = self.first, self.second, self.third
        year, month, day = {"dmy": (third, second, first), "mdy": (third, first, second)}.get(
            order, (first, second, third)
        )
        if order == "mdy":
            month, day = np.where(self.named, second, month), np.where(self.named, first, day)
        right = np.isfinite(year) & (self.years_first == (order == "ymd"))
        year = np.where(year < 100.0, year + 2000.0, year)
        right &= (year >= 1900.0) & (year < 2200.0) & (month >= 1.0) & (month <= 12.0) & (day >= 1.0)
        year, month, day = (np.where(right, one, 1.0) for one in (year, month, day))
        lengths = np.array([31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31])[month.astype(np.intp) - 1]
        leap = (np.mod(year, 4.0) == 0.0) & ((np.mod(year, 100.0) != 0.0) | (np.mod(year, 400.0) == 0.0))
        right &= day <= lengths + (leap & (month == 2.0))
        # Years that begin in March have their odd day last.
        late = year - (month <= 2.0)
        passed = np.floor((153.0 * np.mod(month + 9.0, 12.0) + 2.0) / 5.0) + day - 1.0
        count = (
            365.0 * late + np.floor(late / 4.0) - np.floor(late / 100.0) + np.floor(late / 400.0) + passed - 719468.0
        )
        return np.asarray(np.where(right, count, np.nan))

    def since(self, order: str) -> FloatArray:
        """Seconds (n_rows,) since 1970."""
        return np.asarray(DAY * self.days(order) + self.seconds)


class Shows(Enum):
    """Which order of day, month and year time shows: one of them, any, as the day never changes, or none."""

    ONE = "one"
    ANY = "any"
    NONE = "none"


class Told(NamedTuple):
    """The order of day, month and year that time shows.

    order  "" where it shows none
    words  what speaks for it, for people
    """

    order: str
    shows: Shows
    words: str


def order_told(stamps: Mapping[str, FloatArray]) -> Told:
    """Of several orders the one that time itself shows.

    stamps  (n_rows,) seconds by order

    Days follow each other: at midnight one order goes on by a day, the others by a month or more.
    """
    passed = {order: np.diff(t[np.isfinite(t)]) for order, t in stamps.items()}
    spans = {order: float(np.abs(steps).max(initial=0.0)) for order, steps in passed.items()}
    best = min(spans, key=lambda order: (bool((passed[order] < -DAY / 2.0).any()), spans[order]))
    others = [order for order in spans if order != best]
    if all(spans[one] == spans[best] for one in others):
        return Told(best, Shows.ANY, "the day is the same throughout, so its order does not matter")
    if spans[best] < 1.5 * DAY and all(spans[one] > 5.0 * DAY for one in others):
        said = f"read so, no step of time is longer than {spans[best]:.4g} s; else some are of months"
        return Told(best, Shows.ONE, said)
    reach = ", ".join(f"{size / DAY:.3g} days as {order}" for order, size in spans.items())
    return Told("", Shows.NONE, f"steps of time reach {reach}")


def _numbers(texts: Any) -> FloatArray:
    import pandas as pd

    return np.asarray(pd.to_numeric(texts, errors="coerce").to_numpy(dtype=np.float64, na_value=np.nan))


def _zone(zones: Any) -> FloatArray:
    """Seconds (n_rows,) that clocks of a zone written in hours are ahead of UTC; 0 for one by name, which stays."""
    parts = zones.str.extract(r"([+-])(\d{1,2}):?(\d{2})?$")
    size = 3600.0 * np.nan_to_num(_numbers(parts[1])) + 60.0 * np.nan_to_num(_numbers(parts[2]))
    return np.where((parts[0] == "-").to_numpy(dtype=bool, na_value=False), -size, size)
