"""Figures of a fleet: ships over time, and quantities that changed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from ..wording import clean, number, shown
from .plot import Axis, Bar, Dots, Figure, Line, Look, Mark, Panel, Rule

ROWS = 40
"""Ships in the picture of all at most."""

PALE, FULL = 0.12, 0.95
"""How dense the smallest and the largest error are drawn."""


@dataclass(frozen=True)
class _Density:
    """How dense errors [m] are drawn, by their logarithm about the middle; where all are alike, as that is."""

    low: float
    high: float

    @classmethod
    def of(cls, known: Sequence[float]) -> _Density:
        """That of errors above 0."""
        return cls(min(known), max(known)) if known else cls(math.nan, math.nan)

    @property
    def middle(self) -> float:
        return math.sqrt(self.low) * math.sqrt(self.high)

    @property
    def ends(self) -> tuple[float, ...]:
        """Errors that a legend shows: the smallest, that in the middle and the largest."""
        return () if math.isnan(self.low) else (self.low, self.middle, self.high)

    def __call__(self, error: float) -> float:
        if math.isnan(self.low):
            return PALE
        span = max(math.log(self.high / self.low), math.log(2.0))
        share = 0.5 + math.log(max(error, 1e-12) / self.middle) / span
        return PALE + (FULL - PALE) * min(max(share, 0.0), 1.0)


def ships_over_time(
    ships: Sequence[str],
    dates: Sequence[str],
    errors: Mapping[tuple[str, str], float | None],
    failed: Sequence[tuple[str, str]],
    changed: Sequence[tuple[str, str]],
) -> Figure:
    """A square for each ship and date, the denser the further off the model is.

    errors  [m] by ship and date; failed jobs and dates behind a change likewise
    """
    rows = {ship: k for k, ship in enumerate(ships)}
    columns = {date: k for k, date in enumerate(dates)}
    known = [value for value in errors.values() if value is not None and value > 0.0]
    dense = _Density.of(known)
    marks: list[Mark] = []
    for (ship, date), value in errors.items():
        if value is None or ship not in rows or date not in columns:
            continue
        k, row = columns[date], rows[ship]
        marks.append(Bar((k - 0.47, k + 0.47), (row - 0.44, row + 0.44), "before", round(dense(value), 3)))
    # Dark under the diamonds: they stand on squares of every density, in light and dark.
    for places, look in ((failed, FAILED), (changed, UNDER), (changed, CHANGED)):
        at = [(columns[date], rows[ship]) for ship, date in places if ship in rows and date in columns]
        if at:
            marks.append(Dots([x for x, _ in at], [y for _, y in at], look))
    every = max(1, math.ceil(len(dates) / 6))
    ticks = tuple((float(k), clean(date)) for date, k in columns.items() if k % every == 0)
    x = Axis("", -0.6, len(dates) - 0.4, ticks=ticks, grid=False)
    names = tuple((float(k), clean(ship)[:14]) for ship, k in rows.items())
    y = Axis("", len(ships) - 0.4, -0.6, ticks=names, grid=False)
    panel = Panel(tuple(marks), x, y, shape=-(18.0 * len(ships) + 60.0))
    swatches = {f"{shown(value, 3)} m off track": ("before", dense(value)) for value in dense.ends}
    legend: list[Any] = list(swatches.items())
    legend += [("a change began", CHANGED)] if changed else []
    legend += [("could not run", FAILED)] if failed else []
    return Figure("ships", "Error of the model as given, a square for each ship and date", (panel,), tuple(legend))


UNDER = Look("#111111", 0.0, marker="D", size=10.0)  # type: ignore[arg-type]
CHANGED = Look("flag", 0.0, marker="D", size=6.0)
FAILED = Look("ink", 0.0, marker="x", size=6.0)


def courses(series: Sequence[Mapping[str, Any]]) -> Figure:
    """Quantities over dates with their standard errors, and the line with steps that was found."""
    return Figure(
        "courses",
        "Quantities that changed, over dates",
        tuple(_course(one) for one in series),
        (("by date, ± standard error", Look("ink", 1.2, marker="o")), ("line with steps", Look("after", 1.6, "dash"))),
        across=2,
    )


def _course(one: Mapping[str, Any]) -> Panel:
    dates, values = list(one["dates"]), [number(value) for value in one["values"]]
    at = [float(k) for k in range(len(dates))]
    marks: list[Mark] = [Rule(place - 0.5, Look("flag", 1.0, "dot")) for place in one["course"]["places"]]
    for k, (value, error) in enumerate(zip(values, one["errors"], strict=True)):
        half = number(error)
        if value is not None and half is not None:
            marks.append(Line((k, k), (value - half, value + half), Look("muted", 1.0)))
    marks.append(
        Dots(at, [math.nan if value is None else value for value in values], Look("ink", marker="o", size=4.0))
    )
    fitted = [number(value) for value in one["course"]["fitted"]]
    edges = [0, *one["course"]["places"], len(dates)]
    for first, last in pairwise(edges):
        part = [math.nan if value is None else value for value in fitted[first:last]]
        marks.append(Line(at[first:last], part, Look("after", 1.6, "dash")))
    every = max(1, math.ceil(len(dates) / 4))
    ticks = tuple((float(k), clean(date)) for k, date in enumerate(dates) if k % every == 0)
    unit = f" [{clean(one['unit'])}]" if one["unit"] else ""
    words = "off track, as given" if one["name"] == "off_track" else clean(one["words"])  # a title has little room
    title = f"{clean(one['ship'])}: {words}{unit}"
    return Panel(tuple(marks), Axis("", -0.7, len(dates) - 0.3, ticks=ticks, grid=False), Axis(""), title)
