"""Misfit against the range a_r in a sweep: the figure, what it shows, and its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from .drawing import AFTER, BEFORE, FLAG, INK, MUTED, log_ticks, new_figure
from .page import Cell, Table, cells
from .wording import NONE, change, number, percent, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .load import SweepRecord


@dataclass(frozen=True)
class Series:
    """J of one set of trials over the ranges, ``before`` tuning, and how it is drawn."""

    label: str
    phrase: str
    values: tuple[float | None, ...]
    before: float | None
    style: Mapping[str, Any]

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
            {"color": AFTER, "marker": "o", "linestyle": "-"},
        ),
        Series(
            "test trials",
            "the test trials",
            tuple(number(run.get("J_test")) for run in runs),
            number(data.get("J_test_before")),
            {"color": FLAG, "marker": "s", "linestyle": (0, (6, 2.2))},
        ),
        Series(
            "each trial left out",
            "trials left out in turn",
            tuple(left.get(float(run["a_r"])) for run in runs),
            None,
            {"color": INK, "marker": "^", "linestyle": (0, (1.2, 1.6))},
        ),
    ]
    return [series for series in found if any(value is not None for value in series.values)]


def run_folder(run: Mapping[str, Any]) -> str | None:
    """A run's folder relative to the sweep's, or None where it is not a plain path inside it."""
    path = PurePosixPath(str(run.get("out") or ""))
    if path.is_absolute() or ".." in path.parts or str(path) == "." or "\\" in str(path) or ":" in str(path):
        return None
    return str(path)


def draw(record: SweepRecord, best: float | None) -> Figure:
    """J of the tuning set, the test set and the trials left out, against a_r."""
    figure = new_figure(7.6, 3.8)
    ax = figure.subplots()
    ranges = [float(run["a_r"]) for run in record.runs]
    found = series_of(record)
    for series in found:
        points = [point for point in series.known(ranges) if point[1] > 0.0]
        if points:
            ax.plot(*zip(*points, strict=True), linewidth=1.7, label=series.label, **series.style)
    ax.set_yscale("log")
    starts = [(series.before, series) for series in found if series.before is not None and series.before > 0.0]
    for start, series in starts:
        _draw_before(ax, ranges, start, series, above=start >= max(other for other, _ in starts))
    if best is not None:
        ax.axvline(best, color=BEFORE, linewidth=1.0, linestyle=(0, (1.2, 1.6)))
        ax.annotate("recommended", (best, 0.5), xycoords=("data", "axes fraction"), xytext=(4, 5), color=BEFORE,
                    textcoords="offset points", fontsize=8.5)  # fmt: skip
    log_ticks(ax.yaxis)
    ax.set_xticks(ranges, [f"{a_r:g}" for a_r in ranges])
    ax.margins(x=0.08, y=0.1)
    ax.set_xlabel("range a_r: coefficients within ± a_r of their pre-determined values")
    ax.set_ylabel("J [–]")
    if found:
        figure.legend(loc="outside upper left", ncols=3, handlelength=3.6)
    return figure


def _draw_before(ax: Axes, ranges: Sequence[float], start: float, series: Series, above: bool) -> None:
    """A line at J before tuning, its words above the higher and below the lower of two."""
    ax.axhline(start, color=series.style["color"], linewidth=0.9, linestyle=series.style["linestyle"], alpha=0.6)
    ax.annotate(
        f"{series.label}, before tuning",
        (ranges[0], start),
        fontsize=7.5,
        color=MUTED,
        xytext=(0, 3 if above else -3),
        textcoords="offset points",
        va="bottom" if above else "top",
    )


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
