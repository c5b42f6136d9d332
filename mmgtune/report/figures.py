"""Static figures of a fit: coefficients in their box, their correlation, and how the search converged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from .drawing import AFTER, BEFORE, BOX, FLAG, INK, MUTED, log_ticks, new_figure
from .wording import MINUS, clean, coefficient_text, number, short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLD, _WARM, _DARK = (33, 102, 172), (178, 74, 10), "#111111"


def draw_forest(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Every coefficient inside its box: bounds at the edges, pre-determined value in the middle, value +- 2 sigma."""
    figure = new_figure(7.6, 0.34 * len(rows) + 1.25)
    ax = figure.subplots()
    for place, row in enumerate(rows):
        _forest_row(ax, place, row)
    ax.axvline(0.5, color=BEFORE, linewidth=1.1, linestyle=(0, (1.2, 1.6)))
    ax.set_yticks(range(len(rows)), [_cut(short(clean(row["name"]))) for row in rows])
    ax.set_ylim(len(rows) - 0.4, -0.6)
    ax.set_xlim(-0.14, 1.14)
    ax.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0], ["low\nbound", "", "pre-determined\nvalue", "", "high\nbound"])
    ax.grid(visible=False)
    ax.tick_params(left=False)
    ax.spines[["left", "bottom"]].set_visible(False)
    figure.legend(handles=_forest_legend(), loc="outside upper left", ncols=3, handlelength=2.2)
    return figure


def _forest_row(ax: Axes, place: int, row: Mapping[str, Any]) -> None:
    low, high = (number(row[end]) or 0.0 for end in ("low", "high"))
    position = number(row.get("position"))
    if position is None:
        position = (float(row["value"]) - low) / (high - low) if high > low else 0.5
    ax.barh(place, 1.0, height=0.62, color=BOX)
    sigma = number(row.get("stderr"))
    color = FLAG if row.get("at_bound") else AFTER
    if sigma is not None and high > low:
        reach = 2.0 * sigma / (high - low)
        ends = max(position - reach, -0.12), min(position + reach, 1.12)
        ax.plot(ends, [place, place], color=color, linewidth=1.6)
        for end, true, marker in ((ends[0], position - reach, "<"), (ends[1], position + reach, ">")):
            ax.plot([end], [place], color=color, marker=marker if abs(end - true) > 1e-9 else "|", markersize=5)
    known = row.get("determined") is not False
    marker = "D" if row.get("at_bound") else "o"
    ax.plot(
        [position],
        [place],
        marker=marker,
        markersize=6.5,
        color=color,
        markerfacecolor=color if known else "none",
        linestyle="none",
        markeredgewidth=1.5,
    )
    ax.annotate(
        coefficient_text(row["value"]),
        (1.0, place),
        xycoords=("axes fraction", "data"),
        xytext=(6, 0),
        textcoords="offset points",
        va="center",
        color=INK,
    )


def _forest_legend() -> list[Any]:
    from matplotlib.lines import Line2D

    kinds = (
        ("inside, ± 2 standard errors", "o", AFTER, AFTER),
        ("at a bound", "D", FLAG, FLAG),
        ("hollow: not determined by these trials", "o", AFTER, "none"),
    )
    return [
        Line2D(
            [],
            [],
            marker=marker,
            color=color,
            markerfacecolor=face,
            label=label,
            markersize=6,
            linewidth=1.6 if face == AFTER else 0.0,
        )
        for label, marker, color, face in kinds
    ]


def draw_correlation(names: Sequence[str], matrix: Sequence[Sequence[float | None]]) -> Figure:
    """The correlation of the coefficients' errors as a shaded, numbered matrix (below its diagonal)."""
    size = len(names) - 1
    labels = [_cut(short(clean(name))) for name in names]
    figure = new_figure(min(0.5 * size + 1.7, 11.0), min(0.42 * size + 1.1, 10.0))
    ax = figure.subplots()
    for i in range(size):
        for j in range(i + 1):
            value = number(matrix[i + 1][j])
            shade_cell(ax, j, i, value, "" if value is None else f"{value:.2f}".replace("-", MINUS), size <= 20)
    _cell_axes(ax, labels[:-1], labels[1:])
    return figure


def shade_cell(ax: Axes, column: float, row: float, value: float | None, text: str, lettered: bool = True) -> None:
    """A cell coloured from blue (-1) over white to brown (+1), with its number on it."""
    from matplotlib.patches import Rectangle

    size = min(abs(value or 0.0), 1.0)
    end = _WARM if (value or 0.0) > 0.0 else _COLD
    mix = [round(245 + (part - 245) * size) for part in end]
    ax.add_patch(Rectangle((column - 0.48, row - 0.46), 0.96, 0.92, facecolor="#" + "".join(f"{p:02x}" for p in mix)))
    if lettered and text:
        ax.text(column, row, text, ha="center", va="center", fontsize=7.5, color="#ffffff" if size > 0.62 else _DARK)


def _cell_axes(ax: Axes, columns: list[str], rows: list[str]) -> None:
    ax.set_xticks(range(len(columns)), columns, rotation=40, ha="right", rotation_mode="anchor")
    ax.set_yticks(range(len(rows)), rows)
    ax.set_xlim(-0.5, len(columns) - 0.5)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ax.grid(visible=False)
    ax.tick_params(length=0)
    ax.spines[["left", "bottom"]].set_visible(False)


def draw_box_positions(rows: Sequence[str], columns: Sequence[str], values: Sequence[Sequence[float | None]]) -> Figure:
    """Where each coefficient ends in its box, one column per range: -1 low bound, 0 pre-determined, +1 high bound."""
    figure = new_figure(1.0 * len(columns) + 2.2, 0.36 * len(rows) + 0.9)
    ax = figure.subplots()
    for i, line in enumerate(values):
        for j, value in enumerate(line):
            mark = "" if value is None else " ▲" if value >= 0.9995 else " ▼" if value <= -0.9995 else ""
            text = "" if value is None else f"{value:+.2f}".replace("-", MINUS) + mark
            shade_cell(ax, j, i, value, text)
    _cell_axes(ax, list(columns), [_cut(clean(name)) for name in rows])
    ax.set_xticks(range(len(columns)), list(columns), rotation=0, ha="center")
    ax.set_xlabel("range a_r")
    return figure


def draw_convergence(evaluations: FloatArray, history: Mapping[str, FloatArray], least_squares: float | None) -> Figure:
    """J against evaluations: every generation's best, the best so far, and where each restart began."""
    import numpy as np

    figure = new_figure(7.6, 3.4)
    ax = figure.subplots()
    ax.plot(
        evaluations,
        history["J_generation"],
        linestyle="none",
        marker=".",
        markersize=3,
        color=MUTED,
        label="best of a generation",
    )
    best = np.fmin.accumulate(history["J_best"])
    ax.plot(evaluations, best, color=AFTER, linewidth=1.8, label="best so far", drawstyle="steps-post")
    begins = np.flatnonzero(np.diff(history["restart"], prepend=-1.0))
    for count, begin in enumerate(begins):
        ax.axvline(
            evaluations[begin],
            color=BEFORE,
            linewidth=0.9,
            linestyle=(0, (1.2, 1.6)),
            label="a restart begins" if count == 0 else None,
        )
        ax.annotate(
            f"{count + 1}",
            (evaluations[begin], 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(2, 1),
            textcoords="offset points",
            color=BEFORE,
            fontsize=8,
        )
    if least_squares is not None and least_squares > 0.0:
        ax.axhline(least_squares, color=FLAG, linewidth=1.0, linestyle=(0, (7, 2, 1, 2)), label="least squares")
    ax.set_xscale("log")
    ax.set_yscale("log")
    log_ticks(ax.xaxis)
    log_ticks(ax.yaxis)
    ax.set_xlabel("evaluations of J")
    ax.set_ylabel("J [–]")
    figure.legend(loc="outside upper left", ncols=4, handlelength=2.4)
    return figure


def _cut(text: str, limit: int = 22) -> str:
    return text if len(text) <= limit else text[: limit - 1] + "…"
