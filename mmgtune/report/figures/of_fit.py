"""Figures of a fit: coefficients in their box, their correlation, and how the search converged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ..wording import MINUS, clean, coefficient_text, number, short
from .plot import Axis, Bar, Dots, Figure, Line, Look, Mark, Panel, Rule, Words

_COLD, _WARM, _DARK = (33, 102, 172), (178, 74, 10), "#111111"


def forest(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Every coefficient inside its box: bounds at the edges, pre-determined value in the middle, value +- 2 sigma."""
    marks: list[Mark] = [Bar((0.0, 1.0), (place - 0.31, place + 0.31)) for place in range(len(rows))]
    marks.append(Rule(0.5, Look("before", 1.2, "dot")))
    for place, row in enumerate(rows):
        marks += _forest_row(place, row)
    ticks = ((0.0, "low\nbound"), (0.5, "pre-determined\nvalue"), (1.0, "high\nbound"))
    names = tuple((float(place), short(clean(row["name"]))) for place, row in enumerate(rows))
    panel = Panel(
        tuple(marks),
        Axis(low=-0.16, high=1.16, ticks=ticks, grid=False),
        Axis(low=len(rows) - 0.4, high=-0.6, ticks=names, grid=False),
        shape=-(24.0 * len(rows) + 55.0),
    )
    legend = (
        ("inside, ± 2 standard errors", Look("after", 1.6, "", "o", 7)),
        ("at a bound", Look("flag", 0.0, "", "D", 7)),
        ("hollow: not determined by these trials", Look("after", 0.0, "", "o", 7, hollow=True)),
    )
    return Figure("coefficients", "Each tuned coefficient's place between its bounds", (panel,), legend)


def _forest_row(place: int, row: Mapping[str, Any]) -> list[Mark]:
    low, high = (number(row[end]) or 0.0 for end in ("low", "high"))
    position = number(row.get("position"))
    if position is None:
        position = (float(row["value"]) - low) / (high - low) if high > low else 0.5
    marks: list[Mark] = []
    sigma = number(row.get("stderr"))
    color = "flag" if row.get("at_bound") else "after"
    if sigma is not None and high > low:
        reach = 2.0 * sigma / (high - low)
        ends = max(position - reach, -0.13), min(position + reach, 1.13)
        marks.append(Line(ends, (place, place), Look(color, 1.8)))  # type: ignore[arg-type]
        for end, true, marker in ((ends[0], position - reach, "<"), (ends[1], position + reach, ">")):
            shape = marker if abs(end - true) > 1e-9 else "|"
            marks.append(Dots((end,), (place,), Look(color, marker=shape, size=6)))  # type: ignore[arg-type]
    hollow = row.get("determined") is False
    shape = "D" if row.get("at_bound") else "o"
    marks.append(Dots((position,), (place,), Look(color, marker=shape, size=8, hollow=hollow)))  # type: ignore[arg-type]
    marks.append(Words(1.0, place, coefficient_text(row["value"]), edge=True))
    return marks


def correlation(names: Sequence[str], matrix: Sequence[Sequence[float | None]]) -> Figure:
    """The correlation of the coefficients' errors as a shaded, numbered matrix (below its diagonal)."""
    labels = [short(clean(name)) for name in names]
    marks: list[Mark] = []
    size = len(names) - 1
    for i in range(size):
        for j in range(i + 1):
            value = number(matrix[i + 1][j])
            text = "" if value is None else f"{value:.1f}".replace("-", MINUS)
            marks += shaded(j, i, value, text if size <= 20 else "")
    panel = _cells(marks, [str(k + 1) for k in range(size)], [f"{k + 2} {name}" for k, name in enumerate(labels[1:])])
    first = f"columns 1 to {size}: {labels[0]}, then the rows above"
    return Figure(
        "correlation",
        "Correlation matrix of the coefficients' errors",
        (
            Panel(
                panel.marks, Axis(first, -0.5, size - 0.5, ticks=panel.x.ticks, grid=False), panel.y, shape=panel.shape
            ),
        ),
    )


def shaded(column: float, row: float, value: float | None, text: str) -> list[Mark]:
    """A cell coloured from blue (-1) over white to brown (+1), with its number on it."""
    size = min(abs(value or 0.0), 1.0)
    end = _WARM if (value or 0.0) > 0.0 else _COLD
    mix = "#" + "".join(f"{round(245 + (part - 245) * size):02x}" for part in end)
    box = Bar((column - 0.48, column + 0.48), (row - 0.46, row + 0.46), mix)
    if not text:
        return [box]
    return [box, Words(column, row, text, "#ffffff" if size > 0.62 else _DARK, size=10.0)]


def _cells(marks: Sequence[Mark], columns: Sequence[str], rows: Sequence[str]) -> Panel:
    """A panel of cells, with names of columns and rows."""
    across, down = (tuple((float(k), name) for k, name in enumerate(names)) for names in (columns, rows))
    return Panel(
        tuple(marks),
        Axis(low=-0.5, high=len(columns) - 0.5, ticks=across, grid=False),
        Axis(low=len(rows) - 0.5, high=-0.5, ticks=down, grid=False),
        shape=-(25.0 * len(rows) + 50.0),
    )


def box_positions(rows: Sequence[str], columns: Sequence[str], values: Sequence[Sequence[float | None]]) -> Figure:
    """Where each coefficient ends in its box, one column per range: -1 low bound, 0 pre-determined, +1 high bound."""
    marks: list[Mark] = []
    for i, line in enumerate(values):
        for j, value in enumerate(line):
            mark = "" if value is None else " ▲" if value >= 0.9995 else " ▼" if value <= -0.9995 else ""
            text = "" if value is None else f"{value:+.2f}".replace("-", MINUS) + mark
            marks += shaded(j, i, value, text)
    panel = _cells(marks, columns, [clean(name) for name in rows])
    x = Axis("range a_r", -0.5, len(columns) - 0.5, ticks=panel.x.ticks, grid=False)
    alt = "Place of each coefficient in its box for every range"
    return Figure("positions", alt, (Panel(panel.marks, x, panel.y, shape=panel.shape - 12.0),))


def convergence(evaluations: FloatArray, history: Mapping[str, FloatArray], least_squares: float | None) -> Figure:
    """J against evaluations: every generation's best, the best so far, and where each restart began."""
    dots, best = Look("muted", 0.0, "", ".", 3.0), Look("after", 1.8)
    begun, least = Look("before", 1.0, "dot"), Look("flag", 1.1, "long")
    marks: list[Mark] = [Dots(evaluations, history["J_generation"], dots)]
    marks.append(Line(evaluations, np.fmin.accumulate(history["J_best"]), best, steps=True))
    top = float(np.nanmax(history["J_generation"]))
    legend = [("best of a generation", dots), ("best so far", best), ("a restart begins", begun)]
    for count, begin in enumerate(np.flatnonzero(np.diff(history["restart"], prepend=-1.0)), 1):
        marks.append(Rule(float(evaluations[begin]), begun))
        marks.append(Words(float(evaluations[begin]), top, str(count), "before", "start", (3.0, 2.0)))
    if least_squares is not None and least_squares > 0.0:
        marks.append(Rule(least_squares, least, upright=False))
        legend.append(("least squares", least))
    panel = Panel(tuple(marks), Axis("evaluations of J", log=True), Axis("J [–]", log=True), shape=0.45)
    return Figure("convergence", "J against the number of evaluations", (panel,), tuple(legend))
