"""How far off track and heading, and misfit, against the range a_r in a sweep: figures, what they show, and numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from ..run_files import FIT
from .blocks import Cell, Table, cells
from .figures.plot import Axis, Figure, Line, Look, Mark, Panel, Rule, Words
from .wording import NONE, TRIALS_OF_ROLE, change, number, percent, shown

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
            _LOOKS["tune"],
        ),
        Series(
            "test trials",
            "the test trials",
            tuple(number(run.get("J_test")) for run in runs),
            number(data.get("J_test_before")),
            _LOOKS["test"],
        ),
        Series(
            "each trial left out",
            "trials left out in turn",
            tuple(left.get(float(run["a_r"])) for run in runs),
            None,
            _LOOKS["left-out"],
        ),
    ]
    return [series for series in found if any(value is not None for value in series.values)]


_LOOKS = {
    "tune": Look("after", 1.7, "", "o", 7),
    "test": Look("flag", 1.7, "dash", "s", 6),
    "left-out": Look("ink", 1.7, "dot", "^", 7),
}
_WAYS = {"track_m": ("off track", "m", 3), "heading_deg": ("off heading", "deg", 2)}
"""What a record says of how far off trials are: words, unit, digits."""


def off_of(record: SweepRecord, role: str, key: str) -> list[float | None]:
    """How far off the trials of a role are, one number a range."""
    return [number((((run.get("off") or {}).get(role) or {}).get(key) or {}).get("after")) for run in record.runs]


def off_figure(record: SweepRecord, best: float | None) -> Figure | None:
    """Metres off track and degrees off heading against a_r; None for records that do not say them."""
    ranges = [float(run["a_r"]) for run in record.runs]
    panels, roles = [], []
    for key, (words, unit, _) in _WAYS.items():
        marks: list[Mark] = []
        for role in TRIALS_OF_ROLE:
            points = [
                (a_r, size)
                for a_r, size in zip(ranges, off_of(record, role, key), strict=True)
                if size is not None and size > 0.0
            ]
            if points:
                marks.append(Line([a_r for a_r, _ in points], [size for _, size in points], _LOOKS[role]))
                roles.append(role)
        if marks:
            marks += [Rule(best, Look("before", 1.2, "dot"))] if best is not None else []
            panels.append(
                Panel(tuple(marks), _across(ranges, best, "range a_r"), Axis(f"{words} [{unit}]", log=True, room=0.12))
            )
    legend = tuple((TRIALS_OF_ROLE[role], _LOOKS[role]) for role in _LOOKS if role in roles)
    alt = "Metres off track and degrees off heading against the range a_r"
    return Figure("off", alt, tuple(panels), legend) if panels else None


def off_finding(record: SweepRecord) -> str:
    """Where trials that were held out are least off."""
    ranges = [float(run["a_r"]) for run in record.runs]
    parts = []
    role = next((role for role in TRIALS_OF_ROLE if any(off_of(record, role, "track_m"))), "test")
    for key, (words, unit, digits) in _WAYS.items():
        known = [(size, a_r) for size, a_r in zip(off_of(record, role, key), ranges, strict=True) if size is not None]
        if known:
            size, a_r = min(known)
            parts.append(f"least {words} at a_r = {a_r:g} ({shown(size, digits)}{'°' if unit == 'deg' else ' m'})")
    held = TRIALS_OF_ROLE[role]
    return f"{held[:1].upper()}{held[1:]}: {' and '.join(parts)}; root mean square, mean over trials."


def _across(ranges: Sequence[float], best: float | None, words: str) -> Axis:
    """The axis of ranges, the recommended one named."""
    ticks = tuple((a_r, f"{a_r:g}" + ("\nrecommended" if a_r == best else "")) for a_r in ranges)
    room = 0.1 * ((ranges[-1] - ranges[0]) if len(ranges) > 1 else 1.0)
    return Axis(words, ranges[0] - room, ranges[-1] + room, ticks=ticks)


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
    panel = Panel(
        tuple(marks),
        _across(ranges, best, "range a_r, a share of each value"),
        Axis("J [–]", log=True, room=0.12),
        shape=0.5,
    )
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
    """How far off and J of every range, with a link to its run's report."""
    found = series_of(record)
    titles, rows = ["a_r"], [["pre-determined"], *([f"{run['a_r']:g}"] for run in record.runs)]
    for role in ("test", "left-out"):
        for key, (words, unit, digits) in _WAYS.items():
            sizes = off_of(record, role, key)
            if any(sizes):
                start = record.runs[0]["off"][role][key].get("before")
                titles.append(f"{words}, {TRIALS_OF_ROLE[role]} [{unit}]")
                for row, size in zip(rows, (start, *sizes), strict=True):
                    row.append(shown(size, digits))
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
    return Table(
        "misfit-table", "How far off and misfit for every range", (*titles, "at a bound", "details"), lines, numeric
    )


def _link(record: SweepRecord, run: Mapping[str, Any]) -> Cell:
    folder = run_folder(run)
    if folder is None or not (record.folder / folder / FIT).is_file():
        return Cell(NONE)
    return Cell("report", link=f"./{quote(folder)}/report.html")
