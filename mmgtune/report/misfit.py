"""Misfit against the range a_r in a sweep: the figure, what it shows, and its numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from .drawing import AFTER, BEFORE, FLAG, INK, MUTED, log_ticks, new_figure
from .page import Cell, Table, cells
from .wording import NONE, change, number, percent, shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .load import SweepRecord


def run_folder(run: Mapping[str, Any]) -> str | None:
    """A run's folder relative to the sweep's, or None where it is not a plain path inside it."""
    path = PurePosixPath(str(run.get("out") or ""))
    if path.is_absolute() or ".." in path.parts or str(path) == "." or "\\" in str(path) or ":" in str(path):
        return None
    return str(path)


def left_out(data: Mapping[str, Any]) -> dict[float, float | None]:
    return {float(row["a_r"]): number(row.get("J")) for row in data.get("leave_one_out") or ()}


def draw(record: SweepRecord, best: float | None) -> Figure:
    """J of the tuning set, the test set and the trials left out, against a_r."""
    data, runs, left = record.data, record.runs, left_out(record.data)
    figure = new_figure(7.2, 3.6)
    ax = figure.subplots()
    ranges = [float(run["a_r"]) for run in runs]
    series = (
        ("trials tuned on", [number(run.get("J_tune")) for run in runs], AFTER, "o", "-", data.get("J_tune_before")),
        (
            "test trials",
            [number(run.get("J_test")) for run in runs],
            FLAG,
            "s",
            (0, (6, 2.2)),
            data.get("J_test_before"),
        ),
        ("each trial left out in turn", [left.get(a_r) for a_r in ranges], INK, "^", (0, (1.2, 1.6)), None),
    )
    for label, values, color, marker, dash, before in series:
        known = [(a_r, value) for a_r, value in zip(ranges, values, strict=True) if value is not None and value > 0.0]
        if not known:
            continue
        ax.plot(*zip(*known, strict=True), color=color, marker=marker, linestyle=dash, linewidth=1.7, label=label)
        start = number(before)
        if start is not None and start > 0.0:
            ax.axhline(start, color=color, linewidth=0.9, linestyle=dash, alpha=0.6)
            left_side = label == series[0][0]
            ax.annotate(
                f"{label}, before tuning",
                (ranges[0 if left_side else -1], start),
                fontsize=7.5,
                color=MUTED,
                xytext=(0, 3 if left_side else -3),
                textcoords="offset points",
                ha="left" if left_side else "right",
                va="bottom" if left_side else "top",
            )
    if best is not None:
        ax.axvline(best, color=BEFORE, linewidth=1.0, linestyle=(0, (1.2, 1.6)))
        ax.annotate(
            "recommended",
            (best, 0.0),
            xycoords=("data", "axes fraction"),
            xytext=(4, 5),
            textcoords="offset points",
            color=BEFORE,
            fontsize=8.5,
        )
    ax.set_yscale("log")
    log_ticks(ax.yaxis)
    ax.set_xticks(ranges, [f"{a_r:g}" for a_r in ranges])
    ax.margins(x=0.08)
    ax.set_xlabel("range a_r: coefficients within ± a_r of their pre-determined values")
    ax.set_ylabel("J [–]")
    figure.legend(loc="outside upper left", ncols=3, handlelength=3.6)
    return figure


def finding(data: Mapping[str, Any], runs: Sequence[Mapping[str, Any]]) -> str:
    parts = []
    for key, words in (("J_tune", "the trials tuned on"), ("J_test", "the test trials")):
        known = [(value, float(run["a_r"])) for run in runs if (value := number(run.get(key))) is not None]
        if known:
            value, a_r = min(known)
            parts.append(f"on {words} J is least at a_r = {a_r:g} ({shown(value)})")
    left = [(value, a_r) for a_r, value in left_out(data).items() if value is not None]
    if left:
        parts.append(f"on trials left out in turn it is least at a_r = {min(left)[1]:g} ({shown(min(left)[0])})")
    text = "; ".join(parts) + "." if parts else "No misfits were recorded."
    return text[:1].upper() + text[1:]


def table(record: SweepRecord) -> Table:
    left, data = left_out(record.data), record.data
    rows = [
        cells(
            "pre-determined",
            shown(data.get("J_tune_before")),
            NONE,
            shown(data.get("J_test_before")),
            NONE,
            NONE,
            NONE,
            NONE,
        )
    ]
    for run in record.runs:
        folder = run_folder(run)
        there = folder is not None and (record.folder / folder / "fit.json").is_file()
        link = Cell("report", link=f"./{quote(folder or '')}/report.html") if there else Cell(NONE)
        rows.append(
            cells(
                f"{run['a_r']:g}",
                shown(run.get("J_tune")),
                percent(change(data.get("J_tune_before"), run.get("J_tune"))),
                shown(run.get("J_test")),
                percent(change(data.get("J_test_before"), run.get("J_test"))),
                shown(left.get(float(run["a_r"]))),
                str(len(run.get("at_bound") or [])),
                link,
            )
        )
    titles = ("a_r", "J tuned on", "change", "J test", "change", "J left out", "at a bound", "details")
    return Table("misfit-table", "Misfit for every range", titles, tuple(rows), numeric=range(1, 7))
