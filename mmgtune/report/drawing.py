"""Matplotlib in this report's style, and its output as files and as SVG inside a page that has a dark mode.

Colours are few and exact, so that the page can replace each by a variable of its style sheet.
"""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from .wording import shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

INK, MUTED, GRID, PAPER = "#16202b", "#5a6673", "#d4dae1", "#fffffe"
BEFORE, AFTER, FLAG, BOX = "#d55e00", "#0072b2", "#b3005e", "#e8edf2"
_VARIABLES = {
    INK: "currentColor", MUTED: "var(--muted)", GRID: "var(--grid)", PAPER: "none", BEFORE: "var(--before)",
    AFTER: "var(--after)", FLAG: "var(--flag)", BOX: "var(--box)",
}  # fmt: skip
LINES: dict[str, dict[str, Any]] = {
    "measured": {"color": INK, "linewidth": 1.5, "linestyle": "-", "marker": "o"},
    "before": {"color": BEFORE, "linewidth": 1.3, "linestyle": (0, (1.2, 1.6)), "marker": "^"},
    "after": {"color": AFTER, "linewidth": 1.5, "linestyle": (0, (6, 2.2)), "marker": "s"},
}
"""How each of the three motions is drawn everywhere: colour, dash and marker all differ."""

_STYLE = {
    "svg.fonttype": "none", "svg.hashsalt": "mmgtune", "pdf.fonttype": 42, "font.family": "DejaVu Sans",
    "font.size": 9.0, "axes.titlesize": 9.5, "axes.labelsize": 9.0, "text.parse_math": False,
    "axes.edgecolor": MUTED, "axes.labelcolor": INK, "text.color": INK, "xtick.color": MUTED, "ytick.color": MUTED,
    "xtick.labelcolor": INK, "ytick.labelcolor": INK, "axes.facecolor": "none", "figure.facecolor": PAPER,
    "axes.grid": True, "grid.color": GRID, "grid.linewidth": 0.7, "axes.axisbelow": True, "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False, "axes.unicode_minus": True, "axes.titlelocation": "left",
    "path.simplify": True,
}  # fmt: skip

_SVG = "http://www.w3.org/2000/svg"
_LINK = "http://www.w3.org/1999/xlink"
_HEX = re.compile(r"#[0-9a-f]{6}")


class Drawn:
    """A finished figure: SVG text for a file, and SVG to stand inside a page that has a dark mode."""

    def __init__(self, name: str, alt: str, draw: Callable[[], Figure]):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.backends.backend_svg import FigureCanvasSVG

        with _in_style():
            self._figure = draw()
            FigureCanvasAgg(self._figure)
            self._figure.draw_without_rendering()
            self._figure.set_layout_engine("none")  # the layout is done; each format would do it again
            text = io.StringIO()
            # Without savefig, which draws every figure of a layout once more for each format.
            canvas: Any = FigureCanvasSVG(self._figure)
            canvas.print_svg(text, metadata={"Date": None, "Creator": None})
        self.name = name
        self.svg = text.getvalue()
        self.inline = _inline(self.svg, name, alt)

    def pdf(self) -> bytes:
        """The figure as a PDF file, its letters as letters of an embedded font."""
        from matplotlib.backends.backend_pdf import FigureCanvasPdf

        portable = io.BytesIO()
        with _in_style():
            canvas: Any = FigureCanvasPdf(self._figure)
            canvas.print_pdf(portable, metadata={"CreationDate": None, "Creator": None})
        return portable.getvalue()


def _in_style() -> AbstractContextManager[None]:
    import matplotlib as mpl

    style: dict[Any, Any] = {**mpl.rcParamsDefault, **_STYLE, "backend": "agg"}
    return mpl.rc_context(style)


def new_figure(width: float, height: float) -> Figure:
    """An empty figure [inches]."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def grid_of(amount: int, cell: tuple[float, float], top: float = 0.45) -> tuple[Figure, list[Axes]]:
    """A figure of ``amount`` axes in rows of up to four, each of about ``cell`` inches, with room for a legend."""
    columns = amount if amount <= 4 else 3 if amount in (5, 6, 9) else 4
    rows = -(-amount // columns)
    figure = new_figure(max(cell[0] * columns, 4.2), cell[1] * rows + top)
    axes = figure.subplots(rows, columns, squeeze=False).flatten().tolist()
    for unused in axes[amount:]:
        unused.remove()
    return figure, axes[:amount]


def legend_above(figure: Figure, words: dict[str, str]) -> None:
    """One legend for all axes, above them."""
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], label=label, markersize=4, **LINES[which]) for which, label in words.items()]
    figure.legend(handles=handles, loc="outside upper left", ncols=len(handles), handlelength=3.6)


def log_ticks(axis: Axis) -> None:
    """Plain numbers on a logarithmic axis, also between the powers of ten where it spans few of them."""
    import math

    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    narrow = math.log10(high / low) < 2.2
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if narrow else (1.0,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: shown(value, 3)))
    axis.set_minor_formatter(NullFormatter())


def thinned(values: FloatArray, limit: int = 500) -> slice:
    """Every so many samples that at most ``limit`` are drawn."""
    return slice(None, None, max(1, -(-len(values) // limit)))


def _inline(text: str, name: str, alt: str) -> str:
    """The SVG with ids of its own, the page's colours and fonts, and a text alternative."""
    ElementTree.register_namespace("", _SVG)
    ElementTree.register_namespace("xlink", _LINK)
    root = ElementTree.fromstring(text)
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag in (f"{{{_SVG}}}metadata", f"{{{_SVG}}}style"):
                parent.remove(child)
    for element in root.iter():
        for key, value in list(element.attrib.items()):
            if key == "id":
                element.set(key, f"{name}-{value}")
            elif key == f"{{{_LINK}}}href":
                element.set(key, f"#{name}-{value.removeprefix('#')}")
            elif key in ("style", "clip-path"):
                element.set(key, _restyled(value, name))
    width, height = root.get("width", ""), root.get("height", "")
    least = round(0.7 * _points(width))
    root.set(
        "style", f"min-width:{least}px;max-width:{_points(width)}px;aspect-ratio:{_points(width)}/{_points(height)}"
    )
    for key in ("width", "height"):
        root.attrib.pop(key, None)
    root.set("role", "img")
    root.set("aria-label", alt)
    root.set("class", "drawn")
    return ElementTree.tostring(root, encoding="unicode")


def _points(size: str) -> int:
    """An SVG size in points as CSS pixels."""
    return round(float(size.removesuffix("pt")) * 96.0 / 72.0)


def _restyled(style: str, name: str) -> str:
    style = style.replace("url(#", f"url(#{name}-")
    style = re.sub(r"font: ([\d.]+)px [^;]*", r"font-size: \1px", style)
    style = re.sub(r"font-family: [^;]*;?", "", style)
    return _HEX.sub(lambda match: _VARIABLES.get(match.group(), match.group()), style)
