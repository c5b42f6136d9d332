"""Figures as PDF for papers, drawn by matplotlib, which nothing else of a report needs."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from . import ticks
from .plot import Area, Axis, Bar, Dots, Figure, Line, Look, Mark, Panel, Rule, Shapes, Words
from .svg import FILE_COLORS, NARROW, WIDE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_STYLE = {
    "pdf.fonttype": 42, "font.family": "DejaVu Sans", "font.size": 9.0, "axes.titlesize": 9.5, "axes.labelsize": 9.0,
    "text.parse_math": False, "axes.edgecolor": FILE_COLORS["muted"], "axes.labelcolor": FILE_COLORS["ink"],
    "text.color": FILE_COLORS["ink"], "xtick.color": FILE_COLORS["muted"], "ytick.color": FILE_COLORS["muted"],
    "axes.grid": True, "grid.color": FILE_COLORS["grid"], "grid.linewidth": 0.7, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "axes.titlelocation": "left",
}  # fmt: skip
_DASHES: dict[str, Any] = {
    "": "-",
    "dot": (0, (1.2, 1.6)),
    "dash": (0, (6, 2.2)),
    "long": (0, (7, 2, 1, 2)),
}
_INCH = 100.0
"""Pixels of a page to an inch of paper."""


def render(figure: Figure) -> bytes:
    """The figure as a PDF file, its letters as letters of an embedded font."""
    import matplotlib as mpl
    from matplotlib.backends.backend_pdf import FigureCanvasPdf
    from matplotlib.figure import Figure as Paper

    style: dict[Any, Any] = {**mpl.rcParamsDefault, **_STYLE, "backend": "agg"}
    portable = io.BytesIO()
    with mpl.rc_context(style):
        columns, width = figure.columns, WIDE if len(figure.panels) == 1 else NARROW
        rows = -(-len(figure.panels) // columns)
        tall = max(panel.shape * width if panel.shape > 0.0 else -panel.shape for panel in figure.panels)
        paper = Paper(figsize=(columns * width / _INCH, rows * tall / _INCH + 0.4), layout="constrained")
        axes = paper.subplots(rows, columns, squeeze=False).flatten().tolist()
        for unused in axes[len(figure.panels) :]:
            unused.remove()
        for panel, ax in zip(figure.panels, axes, strict=False):
            _panel(panel, ax)
        if figure.legend:
            handles = [_handle(words, look) for words, look in figure.legend]
            paper.legend(handles=handles, loc="outside upper left", ncols=min(len(handles), 4), handlelength=3.2)
        canvas: Any = FigureCanvasPdf(paper)
        canvas.print_pdf(portable, metadata={"CreationDate": None, "Creator": None})
    return portable.getvalue()


def _color(name: str) -> str:
    return FILE_COLORS.get(name, name)


def _style(look: Look) -> dict[str, Any]:
    return {
        "color": _color(look.color),
        "linewidth": look.width,
        "linestyle": _DASHES[look.dash],
        "alpha": look.alpha,
        "marker": look.marker or None,
        "markersize": look.size,
        "markerfacecolor": "none" if look.hollow else _color(look.color),
    }


def _handle(words: str, look: Look | tuple[str, float]) -> Any:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    if isinstance(look, tuple):
        return Patch(facecolor=_color(look[0]), alpha=look[1], label=words)
    style = _style(look) | ({"linestyle": "none"} if look.width == 0.0 else {})
    return Line2D([], [], label=words, **style)


def _panel(panel: Panel, ax: Axes) -> None:
    for mark in panel.marks:
        _mark(mark, ax)
    if panel.equal:
        ax.set_aspect("equal", adjustable="datalim")
    ax.set_title(panel.title)
    for axis, of, name in ((panel.x, ax.xaxis, "x"), (panel.y, ax.yaxis, "y")):
        _axis(axis, ax, of, name)


def _axis(axis: Axis, ax: Axes, of: Any, name: str) -> None:
    ax.set(**{f"{name}label": axis.words})
    if axis.log:
        ax.set(**{f"{name}scale": "log"})
    if axis.low is not None or axis.high is not None:
        low, high = of.get_view_interval()
        ax.set(**{f"{name}lim": (low if axis.low is None else axis.low, high if axis.high is None else axis.high)})
    if axis.ticks is not None:
        of.set_ticks([place for place, _ in axis.ticks], [text for _, text in axis.ticks])
    elif axis.log:
        low, high = of.get_view_interval()
        places = ticks.logarithmic(low, high)
        of.set_ticks([place for place, _ in places], [text for _, text in places])
        of.set_ticks([], minor=True)
    if not axis.grid:
        ax.grid(visible=False, axis="x" if name == "x" else "y")


def _mark(mark: Mark, ax: Axes) -> None:
    match mark:
        case Line():
            ax.plot(_known(mark.x), _known(mark.y), drawstyle="steps-post" if mark.steps else None, **_style(mark.look))
        case Dots():
            ax.plot(_known(mark.x), _known(mark.y), **(_style(mark.look) | {"linestyle": "none"}))
        case Area():
            low, high = _known(mark.low), _known(mark.high)
            ax.fill_between(_known(mark.x), low, high, color=_color(mark.color), alpha=mark.alpha, linewidth=0.0)
        case Shapes():
            from matplotlib.patches import PathPatch
            from matplotlib.path import Path

            whole = [Path(outline, closed=True) for outline in mark.outlines if np.isfinite(outline).all()]
            if whole:
                ax.add_patch(
                    PathPatch(
                        Path.make_compound_path(*whole),
                        facecolor=_color(mark.fill) if mark.fill else "none",
                        edgecolor=_color(mark.look.color) if mark.look else "none",
                        linewidth=mark.look.width if mark.look else 0.0,
                        alpha=mark.alpha if mark.fill else None,
                    )
                )
                ax.autoscale_view()
        case Bar():
            (x0, x1), (y0, y1) = sorted(mark.x), sorted(mark.y)
            ax.barh(
                0.5 * (y0 + y1), x1 - x0, left=x0, height=y1 - y0, color=_color(mark.color), alpha=mark.alpha,
                linewidth=0.0,
            )  # fmt: skip
        case Rule():
            style = {
                "color": _color(mark.look.color), "linewidth": mark.look.width, "linestyle": _DASHES[mark.look.dash],
            }  # fmt: skip
            (ax.axvline if mark.upright else ax.axhline)(mark.at, **style)
        case Words():
            where: dict[str, Any] = {"start": "left", "middle": "center", "end": "right"}
            ax.annotate(
                mark.text,
                (1.0 if mark.edge else mark.x, mark.y),
                xycoords=("axes fraction", "data") if mark.edge else "data",
                xytext=(5.0, 0.0) if mark.edge else mark.move,
                textcoords="offset points",
                ha="left" if mark.edge else where[mark.anchor],
                va="center",
                color=_color(mark.color),
                fontsize=0.78 * mark.size,
                annotation_clip=False,
            )


def _known(values: Any) -> Any:
    return np.array(values, dtype=float)
