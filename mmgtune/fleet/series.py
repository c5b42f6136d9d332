"""The same quantity of the same ship over dates, and what changed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import date
from typing import Any

import numpy as np

from ..components import effect_tag
from ..effects import find_effect
from ..units import shown_in
from .changes import Course, course

OFF_TRACK = "off_track"
YEAR = 365.25
"""Days."""

TINY = 1e-6
"""Error [m] that counts as none."""


@dataclass(frozen=True)
class Series:
    """A quantity over the dates of a ship.

    job     name of the jobs it is from
    name    of the coefficient, or ``OFF_TRACK``; tag of the effect it is of, "" for none
    words   what people call it; unit they read it in
    values, errors  by date, in that unit; errors NaN where unknown
    """

    ship: str
    job: str
    name: str
    tag: str
    words: str
    unit: str
    dates: tuple[str, ...]
    values: tuple[float, ...]
    errors: tuple[float, ...]

    @property
    def years(self) -> Any:
        """(n,) time since the first date."""
        days = np.array([middle_of(one).toordinal() for one in self.dates], dtype=float)
        return (days - days[0]) / YEAR

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        errors = [one if math.isfinite(one) else None for one in self.errors]
        return {**asdict(self), "errors": errors}


def series_of(rows: Sequence[Mapping[str, Any]]) -> list[Series]:
    """Every quantity of which there are several dates, of rows in the order of their dates."""
    found: dict[tuple[str, str, str], list[tuple[str, float, float]]] = {}
    for row in rows:
        if row["answer"] == "failed":
            continue
        if row["off_track"] is not None:
            found.setdefault((row["ship"], row["name"], OFF_TRACK), []).append(
                (row["date"], row["off_track"], math.nan)
            )
        for name, value, error in zip(row["names"], row["values"], row["errors"], strict=True):
            if value is not None:
                told = (row["date"], value, math.nan if error is None else error)
                found.setdefault((row["ship"], row["name"], name), []).append(told)
    return [_series(*key, told) for key, told in sorted(found.items()) if len(told) > 1]


def _series(ship: str, job: str, name: str, told: Sequence[tuple[str, float, float]]) -> Series:
    tag, words, unit, factor = called(name)
    dates, values, errors = zip(*told, strict=True)
    scaled = tuple(factor * value for value in values), tuple(abs(factor) * error for error in errors)
    return Series(ship, job, name, tag, words, unit, dates, *scaled)


def called(name: str) -> tuple[str, str, str, float]:
    """Effect, words, unit and factor to it of a quantity."""
    if name == OFF_TRACK:
        return "", "distance off track of the model as given", "m", 1.0
    tag, symbol = effect_tag(name), name.rpartition(".")[2]
    if not tag:
        return "", name, "", 1.0
    effect = find_effect(tag)
    if effect is None:
        return tag, name, "", 1.0
    unit, factor = shown_in(effect.fields[symbol].unit)
    several = len(effect.plain) > 1
    return tag, f"{effect.title} ({symbol})" if several else effect.title, "" if unit in ("-", "1") else unit, factor


def courses(series: Sequence[Series]) -> list[tuple[Series, Course]]:
    """What each series does, of those that are long enough; chance is counted over all of them.

    Errors in metres are looked at by their logarithm: they are never negative, and scatter as they are large.
    """
    found = []
    for one in series:
        values, errors = np.array(one.values), np.array(one.errors)
        lengths = one.name == OFF_TRACK
        what = course(one.years, np.log(np.maximum(values, TINY)) if lengths else values, errors, len(series))
        if what is not None:
            found.append((one, what.exponential() if lengths else what))
    return found


def middle_of(text: str) -> date:
    """The middle of a day, a month or a year."""
    parts = [int(part) for part in text.split("-")]
    year, month, day = (*parts, *(7, 1)[len(parts) - 1 :])[:3] if len(parts) == 1 else (*parts, 15)[:3]
    return date(year, month, day)
