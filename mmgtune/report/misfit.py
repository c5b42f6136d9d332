"""Misfit against the range a_r in a sweep: the figure, what it shows, and its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from .blocks import Cell, Table, cells
from .plot import Axis, Figure, Line, Look, Mark, Panel, Rule, Words
from .wording import NONE, change, number, percent, shown

if TYPE_CHECKING:
    from .load import SweepRecord


@dataclass(frozen=True)
class Series:
    """J of one set of trials over the ranges, ``before`` tuning, and how it is drawn."""

    label: str
    phrase: str
    values: tuple[float | None, ...]
    before: float | None
    look: Look

    def known(self, ranges: Sequence[float]) -> list[tuple[float, float]]:
        """(a_r, J) where J is known."""
        return [(a_r, value) for a_r, value in zip(ranges, self.values, strict=True) if value is not None]


def series_of(record: SweepRecord) -> list[Series]:
    """The sets of trials that have a J in any range."""
    data, runs = record.data, record.runs
    left = {float(row["a_r"]): number(row.get("J")) for row in data.get("leave_one_out") or ()}
    found = [
        Series(
            "trials tuned on",
            "the trials tuned on",
            tuple(number(run.get("J_tune")) for run in runs),
            number(data.get("J_tune_before")),
            Look("after", 1.7, "", "o", 7),
        ),
        Series(
            "test trials",
            "the test trials",
            tuple(number(run.get("J_test")) for run in runs),
            number(data.get("J_test_before")),
            Look("flag", 1.7, "dash", "s", 6),
        ),
        Series(
            "each trial left out",
            "trials left out in turn",
            tuple(left.get(float(run["a_r"])) for run in runs),
            None,
            Look("ink", 1.7, "dot", "^", 7),
        ),
    ]
    return [series for series in found if any(value is not None for value in series.values)]


def run_folder(run: Mapping[str, Any]) -> str | None:
    """A run's folder relative to the sweep's, or None where it is not a plain path inside it."""
    path = PurePosixPath(str(run.get("out") or ""))
    if path.is_absolute() or ".." in path.parts or str(path) == "." or "\\" in str(path) or ":" in str(path):
        return None
    return str(path)


def figure(record: SweepRecord, best: float | None) -> Figure:
    """J of the tuning set, the test set and the trials left out, against a_r."""
    ranges = [float(run["a_r"]) for run in record.runs]
    found = series_of(record)
    marks: list[Mark] = []
    for series in found:
        points = [point for point in series.known(ranges) if point[1] > 0.0]
        if points:
            marks.append(Line([a_r for a_r, _ in points], [J for _, J in points], series.look))
    starts = [(series.before, series) for series in found if series.before is not None and series.before > 0.0]
    for start, series in starts:
        above = start >= max(other for other, _ in starts)
        look = Look(series.look.color, 1.0, series.look.dash, alpha=0.6)
        marks.append(Rule(start, look, upright=False))
        words = f"{series.label}, before tuning"
        marks.append(Words(ranges[0], start, words, "muted", "start", (0.0, 8.0 if above else -8.0), 10.5))
    if best is not None:
        marks.append(Rule(best, Look("before", 1.2, "dot")))
    ticks = tuple((a_r, f"{a_r:g}" + ("\nrecommended" if a_r == best else "")) for a_r in ranges)
    room = 0.1 * ((ranges[-1] - ranges[0]) if len(ranges) > 1 else 1.0)
    x = Axis("range a_r: coefficients within ± a_r of their start", ranges[0] - room, ranges[-1] + room, ticks=ticks)
    panel = Panel(tuple(marks), x, Axis("J [–]", log=True, room=0.12), shape=0.5)
    legend = tuple((series.label, series.look) for series in found)
    return Figure("misfit", "J on tuning and test trials against the range a_r", (panel,), legend)


def finding(record: SweepRecord) -> str:
    """Where J is least."""
    ranges = [float(run["a_r"]) for run in record.runs]
    parts = []
    for series in series_of(record):
        J, a_r = min((J, a_r) for a_r, J in series.known(ranges))
        parts.append(f"on {series.phrase} J is least at a_r = {a_r:g} ({shown(J)})")
    text = "; ".join(parts) + "." if parts else "No misfits were recorded."
    return text[:1].upper() + text[1:]


def table(record: SweepRecord) -> Table:
    """J of every range, with a link to its run's report."""
    found = series_of(record)
    titles, rows = ["a_r"], [["pre-determined"], *([f"{run['a_r']:g}"] for run in record.runs)]
    for series in found:
        titles.append(f"J {series.label}")
        for row, value in zip(rows, (series.before, *series.values), strict=True):
            row.append(shown(value))
        if series.before is not None:
            titles.append("change")
            for row, value in zip(rows, (None, *series.values), strict=True):
                row.append(percent(change(series.before, value)))
    numeric = range(1, len(titles) + 1)
    bounds = [NONE, *(str(len(run.get("at_bound") or [])) for run in record.runs)]
    links = [Cell(NONE), *(_link(record, run) for run in record.runs)]
    lines = tuple(cells(*row, bound, link) for row, bound, link in zip(rows, bounds, links, strict=True))
    return Table("misfit-table", "Misfit for every range", (*titles, "at a bound", "details"), lines, numeric)


def _link(record: SweepRecord, run: Mapping[str, Any]) -> Cell:
    folder = run_folder(run)
    if folder is None or not (record.folder / folder / "fit.json").is_file():
        return Cell(NONE)
    return Cell("report", link=f"./{quote(folder)}/report.html")
