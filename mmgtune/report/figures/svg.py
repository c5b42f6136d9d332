"""Figures as SVG: inside a page, where each panel is a picture of its own that flows, or as one file.

A page has its letters and colours from its style sheet; a file has its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

import numpy as np

from ...arrays import runs_of_true
from ...text_tables import cut as shortened
from . import ticks
from .plot import DASHES_OF, Area, Axis, Bar, Dots, Figure, Line, Look, Mark, Panel, Rule, Shapes, Words

if TYPE_CHECKING:
    from ...arrays import FloatArray

FILE_COLORS = {
    "ink": "#16202b", "muted": "#5a6673", "grid": "#d4dae1", "before": "#b34f00", "after": "#0067a3",
    "flag": "#a80058", "box": "#e6ebf0", "third": "#4d7d1f", "good": "#12652f", "paper": "#ffffff",
}  # fmt: skip
"""Of files; a page has the same names in its style sheet, with others for dark."""

FONT = 11.5
WIDE, NARROW = 760, 360
_LETTER = 0.62
"""Width of a letter over its size, of a plain font."""

_WIDE_LETTER = 0.97
"""The same of letters such as m, of a font that runs wide."""

_LINE = 13.5
"""From one line to the next of words that stand on several."""

_MARGIN = 12.0
"""Room beside a panel, at least."""

LETTERS = 24
"""Letters of a line beside a vertical axis that narrow panels have room for; wide ones have for twice as many."""

_POINTS = 900
"""Points of a curve that a page of this width can show."""


@dataclass(frozen=True)
class Ink:
    """Turns names of colours into attributes: variables of a style sheet in a page, numbers in a file."""

    inside: bool

    def of(self, color: str) -> str:
        """A colour as it is written."""
        if color.startswith("#"):
            return color
        return f"var(--{color})" if self.inside else FILE_COLORS[color]

    def paint(self, **named: str) -> str:
        """Attributes: stroke="..." and so on."""
        pairs = [(key, value if value == "none" else self.of(value)) for key, value in named.items()]
        if self.inside:
            return 'style="' + ";".join(f"{key}:{value}" for key, value in pairs) + '"'
        return " ".join(f'{key}="{value}"' for key, value in pairs)


def inline(figure: Figure) -> str:
    """The figure for a page: a legend and panels that flow; one panel alone is there for wide and for narrow pages."""
    ink = Ink(True)
    legend = _legend_inline(figure, ink)
    alone = len(figure.panels) == 1
    panels = []
    for k, panel in enumerate(figure.panels):
        alt = figure.alt if alone else f"{figure.alt}: {panel.title or k + 1}"
        widths = ((WIDE, "wide"), (NARROW, "narrow")) if alone else ((NARROW, ""),)
        for width, name in widths:
            height = _height(panel, width)
            body = _panel(panel, width, height, ink)
            label = f'role="img" aria-label="{_quoted(alt)}"'
            panels.append(f'<svg class="panel {name}" viewBox="0 0 {width} {height}" {label}>{body}</svg>')
    many = "panels alone" if alone else "panels few" if len(figure.panels) <= 3 else "panels"
    if figure.columns == 2 and len(figure.panels) > 2:
        many = "panels pairs"  # neighbours belong together, and of four none stands alone
    return f'<div class="drawn">{legend}<div class="{many}">{"".join(panels)}</div></div>'


def file(figure: Figure) -> str:
    """The figure as the text of a file."""
    ink = Ink(False)
    columns = figure.columns
    width = WIDE if len(figure.panels) == 1 else NARROW
    heights = [_height(panel, width) for panel in figure.panels]
    rows = [heights[k : k + columns] for k in range(0, len(heights), columns)]
    head, top = _legend_file(figure, width * columns, ink)
    parts, y = [head], top
    for row, tall in enumerate(rows):
        for column in range(len(tall)):
            k = row * columns + column
            body = _panel(figure.panels[k], width, heights[k], ink)
            parts.append(f'<g transform="translate({column * width},{y})">{body}</g>')
        y += max(tall)
    across = width * columns
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {across} {y}" width="{across}" height="{y}" '
        f'font-family="DejaVu Sans, Liberation Sans, Arial, sans-serif" font-size="{FONT}">'
        f"<title>{_text(figure.alt)}</title>"
        f'<rect width="{across}" height="{y}" fill="{FILE_COLORS["paper"]}"/>{"".join(parts)}</svg>\n'
    )


def _height(panel: Panel, width: int) -> int:
    """Narrow panels of few pixels are relatively higher, so that what they hold has room."""
    return round(panel.shape * width) if panel.shape > 0.0 else round(-panel.shape)


def _text(text: str) -> str:
    return escape(text)


def _quoted(text: str) -> str:
    return escape(text, {'"': "&quot;"})


def _width(text: str, size: float = FONT) -> float:
    wide = sum(letter in "mwMW%@" for letter in text)
    return size * (_LETTER * (len(text) - wide) + _WIDE_LETTER * wide)


@dataclass(frozen=True)
class Scale:
    """Turns values of an axis into pixels from ``first`` to ``last``."""

    low: float
    high: float
    first: float
    last: float
    log: bool

    def __call__(self, values: Any) -> FloatArray:
        """(n,) pixels."""
        array = np.array(values, dtype=float)
        low, high = self.low, self.high
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # of records that somebody edited
            if self.log:
                array = np.where(array > 0.0, np.log10(array), np.nan)
                low, high = math.log10(low), math.log10(high)
            found: FloatArray = self.first + (array - low) / (high - low) * (self.last - self.first)
        return found


def _extent(marks: Sequence[Mark], axis: Axis, of: int) -> tuple[float, float]:
    """Least and greatest value of the marks on one axis, with the limits that are given."""
    pieces: list[Any] = []
    for mark in marks:
        match mark:
            case Line() | Dots():
                pieces.append(mark.y if of else mark.x)
            case Area():
                pieces += [mark.low, mark.high] if of else [mark.x]
            case Shapes():
                pieces += [outline[:, of] for outline in mark.outlines]
            case Bar():
                pieces.append(mark.y if of else mark.x)
            case Words():
                pieces += [] if mark.edge else [[mark.y if of else mark.x]]
    arrays = [np.array(piece, dtype=float) for piece in pieces if len(piece)]
    values = np.concatenate(arrays) if arrays else np.empty(0)
    values = values[np.isfinite(values) & ((values > 0.0) if axis.log else np.full(values.shape, True))]
    low, high = (float(values.min()), float(values.max())) if len(values) else (1.0, 10.0) if axis.log else (0.0, 1.0)
    if axis.log:
        if high / low < 1.0001:
            low, high = low / 1.5, high * 1.5
        more = (high / low) ** axis.room
        low, high = low / more, high * more
    else:
        if high - low < 1e-9 * max(abs(low), abs(high), 1e-12):
            size = abs(high) * 0.1 or 1.0
            low, high = low - size, high + size
        more = axis.room * (high - low)
        low, high = low - more, high + more
    low = low if axis.low is None else axis.low
    high = high if axis.high is None else axis.high
    return (low, high) if high != low else (low, low + 1.0)


def _fitting(text: str, longest: int, roomy: bool) -> str:
    """Words beside a vertical axis that have room there: what is too long goes on in a second line from its bracket
    on, so that names whose brackets differ are still told apart, and is cut only then.

    roomy  whether two lines stand beside each place
    """
    lines = text.split("\n")
    head, bracket, rest = text.partition(" (")
    if len(lines) == 1 and len(text) > longest and bracket and roomy:
        lines = [head, f"({rest}"]
    return "\n".join(shortened(line, longest) for line in lines)


def _panel(panel: Panel, width: int, height: int, ink: Ink) -> str:
    """What stands in a panel of this size in pixels."""
    narrow = width < 500
    x_low, x_high = _extent(panel.marks, panel.x, 0)
    y_low, y_high = _extent(panel.marks, panel.y, 1)
    top = 22.0 if panel.title else 9.0
    lines = max((text.count("\n") + 1 for _, text in panel.x.ticks or ()), default=1)
    bottom = 8.0 + 14.0 * lines + (17.0 if panel.x.words else 0.0)
    edge = max(
        (_width(mark.text, mark.size) for mark in panel.marks if isinstance(mark, Words) and mark.edge), default=0
    )
    right = _MARGIN + edge
    y_places = panel.y.ticks
    if y_places is None:
        few = max(2, int((height - top - bottom) / 34))
        y_places = tuple(ticks.logarithmic(y_low, y_high) if panel.y.log else ticks.linear(y_low, y_high, few))
    longest = LETTERS if narrow else 2 * LETTERS
    roomy = height - top - bottom >= 2.0 * _LINE * len(y_places)
    y_places = tuple((place, _fitting(text, longest, roomy)) for place, text in y_places)
    left = (
        12.0
        + max((_width(line) for _, text in y_places for line in text.split("\n")), default=10.0)
        + (17.0 if panel.y.words else 0.0)
    )
    left = min(left, 0.5 * width)
    if panel.equal:
        (x_low, x_high), (y_low, y_high) = _equal(
            (x_low, x_high), (y_low, y_high), width - left - right, height - top - bottom
        )
        few = max(2, int((height - top - bottom) / 40))
        y_places = tuple(ticks.linear(y_low, y_high, few))
    across = Scale(x_low, x_high, left, width - right, panel.x.log)
    up = Scale(y_low, y_high, height - bottom, top, panel.y.log)
    x_places = panel.x.ticks
    if x_places is None:
        few = max(2, int((width - left - right) / 62))
        x_places = tuple(ticks.logarithmic(x_low, x_high) if panel.x.log else ticks.linear(x_low, x_high, few))
    out = [_grid(panel, across, up, x_places, y_places, ink)]
    inner = [_mark(mark, across, up, ink) for mark in panel.marks if not (isinstance(mark, Words) and mark.edge)]
    box = (
        f'x="{left:.1f}" y="{top - 4:.1f}" width="{width - left - right:.1f}" height="{height - top - bottom + 8:.1f}"'
    )
    view = f'viewBox="{left:.1f} {top - 4:.1f} {width - left - right:.1f} {height - top - bottom + 8:.1f}"'
    out.append(f'<svg {box} {view} overflow="hidden">{"".join(inner)}</svg>')
    for mark in panel.marks:
        if isinstance(mark, Words) and mark.edge:
            y = float(up(mark.y))
            out.append(
                _letters(width - right + 6.0, y + 0.35 * mark.size, mark.text, mark.color, "start", mark.size, ink)
            )
    if panel.title:
        most = int((width - left - 4) / (1.04 * _LETTER * FONT))
        out.append(_letters(left, 13.0, _cut(panel.title, most), "ink", "start", FONT, ink, bold=True))
    if panel.x.words:
        words = _cut(panel.x.words, int((width - 8) / (_LETTER * FONT)))
        middle = min(max(0.5 * (left + width - right), 0.5 * _width(words)), width - 0.5 * _width(words))
        out.append(_letters(middle, height - 5.0, words, "muted", "middle", FONT, ink))
    if panel.y.words:
        y = 0.5 * (top + height - bottom)
        words = _cut(panel.y.words, int(height / (_LETTER * FONT)))
        out.append(
            f'<text transform="translate(11,{y:.1f}) rotate(-90)" text-anchor="middle" {ink.paint(fill="muted")}>'
            f"{_text(words)}</text>"
        )
    return "".join(out)


def _equal(
    x: tuple[float, float], y: tuple[float, float], width: float, height: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits with which a metre is as long on both axes, each widened about its middle."""
    per_pixel = max((x[1] - x[0]) / width, (y[1] - y[0]) / height)
    halves = 0.5 * per_pixel * width, 0.5 * per_pixel * height
    middles = 0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])
    return (middles[0] - halves[0], middles[0] + halves[0]), (middles[1] - halves[1], middles[1] + halves[1])


def _grid(
    panel: Panel,
    across: Scale,
    up: Scale,
    x_places: Sequence[tuple[float, str]],
    y_places: Sequence[tuple[float, str]],
    ink: Ink,
) -> str:
    left, right, bottom, top = across.first, across.last, up.first, up.last
    lines, out = [], []
    x_shown = _spaced(x_places, across)
    for place, text in x_shown:
        x = float(across(place))
        if not (left - 1 <= x <= right + 1):
            continue
        if panel.x.grid:
            lines.append(f"M{x:.1f} {bottom:.1f}V{top:.1f}")
        for row, piece in enumerate(text.split("\n")):
            inside = min(x, right + _MARGIN - 0.5 * _width(piece))
            out.append(_letters(inside, bottom + 15.0 + 14.0 * row, piece, "muted", "middle", FONT, ink))
    for place, text in y_places:
        y = float(up(place))
        if not (top - 1 <= y <= bottom + 1):
            continue
        if panel.y.grid:
            lines.append(f"M{left:.1f} {y:.1f}H{right:.1f}")
        pieces = text.split("\n")
        for row, piece in enumerate(pieces):
            down = y + 4.0 + _LINE * (row - 0.5 * (len(pieces) - 1))
            out.append(_letters(left - 6.0, down, piece, "muted", "end", FONT, ink))
    grid = f'<path d="{"".join(lines)}" fill="none" stroke-width="0.8" {ink.paint(stroke="grid")}/>' if lines else ""
    return grid + "".join(out)


def _spaced(places: Sequence[tuple[float, str]], across: Scale) -> list[tuple[float, str]]:
    """Ticks whose words do not touch those before them on any of their lines."""
    found, ends = [], [-math.inf] * max((text.count("\n") + 1 for _, text in places), default=1)
    for place, text in places:
        x = float(across(place))
        halves = {row: 0.5 * _width(piece) for row, piece in enumerate(text.split("\n")) if piece}
        if all(x - half > ends[row] + 4.0 for row, half in halves.items()):
            found.append((place, text))
            for row, half in halves.items():
                ends[row] = x + half
    return found


def _mark(mark: Mark, across: Scale, up: Scale, ink: Ink) -> str:
    match mark:
        case Line():
            return _line(mark, across, up, ink)
        case Dots():
            return _markers(across(mark.x), up(mark.y), mark.look, ink)
        case Area():
            x = across(mark.x)
            low, high = up(mark.low), up(mark.high)
            good = np.isfinite(x) & np.isfinite(low) & np.isfinite(high)
            pieces = []
            for first, end in runs_of_true(good):
                there = _pairs(x[first:end], high[first:end])
                back = _pairs(x[first:end][::-1], low[first:end][::-1])
                pieces.append(f"M{there}L{back}Z")
            return f'<path d="{"".join(pieces)}" fill-opacity="{mark.alpha:g}" {ink.paint(fill=mark.color)}/>'
        case Shapes():
            path = "".join(
                f"M{_pairs(across(outline[:, 0]), up(outline[:, 1]))}Z"
                for outline in mark.outlines
                if np.isfinite(outline).all()
            )
            look = mark.look
            stroke = {"stroke": look.color} if look else {}
            width = f'stroke-width="{look.width:g}" ' if look else ""
            paint = ink.paint(fill=mark.fill or "none", **stroke)
            return f'<path d="{path}" fill-opacity="{mark.alpha:g}" {width}{paint}/>'
        case Bar():
            x, y = np.sort(across(mark.x)), np.sort(up(mark.y))
            return (
                f'<rect x="{x[0]:.1f}" y="{y[0]:.1f}" width="{x[1] - x[0]:.1f}" height="{y[1] - y[0]:.1f}" '
                f'fill-opacity="{mark.alpha:g}" {ink.paint(fill=mark.color)}/>'
            )
        case Rule():
            scale, other = (across, up) if mark.upright else (up, across)
            at = float(scale(mark.at))
            if not math.isfinite(at):
                return ""
            ends = (at, other.first, at, other.last) if mark.upright else (other.first, at, other.last, at)
            return (
                f'<line x1="{ends[0]:.1f}" y1="{ends[1]:.1f}" x2="{ends[2]:.1f}" y2="{ends[3]:.1f}" '
                f"{_stroke(mark.look, ink)}/>"
            )
        case Words():
            right, down = float(across(mark.x)) + mark.move[0], float(up(mark.y)) - mark.move[1] + 0.35 * mark.size
            return _letters(right, down, mark.text, mark.color, mark.anchor, mark.size, ink)


def _stroke(look: Look, ink: Ink) -> str:
    dash = f' stroke-dasharray="{DASHES_OF[look.dash]}"' if look.dash else ""
    faint = f' stroke-opacity="{look.alpha:g}"' if look.alpha < 1.0 else ""
    return f'fill="none" stroke-width="{look.width:g}"{dash}{faint} {ink.paint(stroke=look.color)}'


def _line(mark: Line, across: Scale, up: Scale, ink: Ink) -> str:
    x, y = across(mark.x), up(mark.y)
    if mark.steps and len(x) > 1:
        x, y = np.repeat(x, 2)[1:], np.repeat(y, 2)[:-1]
    if len(x) > _POINTS:
        every = -(-len(x) // _POINTS)
        keep = np.unique(np.append(np.arange(0, len(x), every), len(x) - 1))
        x, y = x[keep], y[keep]
    good = np.isfinite(x) & np.isfinite(y)
    path = "".join(f"M{_pairs(x[a:b], y[a:b])}" for a, b in runs_of_true(good))
    drawn = f'<path d="{path}" stroke-linejoin="round" {_stroke(mark.look, ink)}/>' if path else ""
    if mark.look.marker:
        drawn += _markers(across(mark.x), up(mark.y), mark.look, ink)
    return drawn


def _pairs(x: FloatArray, y: FloatArray) -> str:
    """Coordinates as a path has them, without those that fall on the one before."""
    points = np.round(np.column_stack([x, y]), 1)
    if len(points) > 2:
        keep = np.append(True, (np.diff(points, axis=0) != 0.0).any(axis=1))
        points = points[keep]
    return " ".join(f"{a:g},{b:g}" for a, b in points.tolist())


_OUTLINES: dict[str, Callable[[float], str]] = {
    "o": lambda s: f"m{-s:g},0a{s:g},{s:g} 0 1,0 {2 * s:g},0a{s:g},{s:g} 0 1,0 {-2 * s:g},0",
    ".": lambda s: f"m{-s:g},0a{s:g},{s:g} 0 1,0 {2 * s:g},0a{s:g},{s:g} 0 1,0 {-2 * s:g},0",
    "s": lambda s: f"m{-s:g},{-s:g}h{2 * s:g}v{2 * s:g}h{-2 * s:g}z",
    "^": lambda s: f"m0,{-1.2 * s:g}l{1.1 * s:g},{2.1 * s:g}h{-2.2 * s:g}z",
    "D": lambda s: f"m0,{-1.3 * s:g}l{1.3 * s:g},{1.3 * s:g} {-1.3 * s:g},{1.3 * s:g} {-1.3 * s:g},{-1.3 * s:g}z",
    "<": lambda s: f"m{-1.2 * s:g},0l{2.1 * s:g},{-1.1 * s:g}v{2.2 * s:g}z",
    ">": lambda s: f"m{1.2 * s:g},0l{-2.1 * s:g},{-1.1 * s:g}v{2.2 * s:g}z",
    "+": lambda s: f"m{-1.4 * s:g},0h{2.8 * s:g}m{-1.4 * s:g},{-1.4 * s:g}v{2.8 * s:g}",
    "x": lambda s: f"m{-s:g},{-s:g}l{2 * s:g},{2 * s:g}m0,{-2 * s:g}l{-2 * s:g},{2 * s:g}",
    "|": lambda s: f"m0,{-1.4 * s:g}v{2.8 * s:g}",
}


def _markers(x: FloatArray, y: FloatArray, look: Look, ink: Ink) -> str:
    s = round(look.size / 2.0, 2)
    shape = _OUTLINES[look.marker](s)
    x, y = np.atleast_1d(x), np.atleast_1d(y)
    good = np.isfinite(x) & np.isfinite(y)
    places = np.round(np.column_stack([x[good], y[good]]), 1).tolist()
    path = "".join(f"M{a:g},{b:g}{shape}" for a, b in places)
    if not path:
        return ""
    bare = look.hollow or look.marker in "+x|"
    faint = f' fill-opacity="{look.alpha:g}" stroke-opacity="{look.alpha:g}"' if look.alpha < 1.0 else ""
    paint = ink.paint(fill="none" if bare else look.color, stroke=look.color)
    return f'<path d="{path}" stroke-width="1.4"{faint} {paint}/>'


def _letters(
    x: float, y: float, text: str, color: str, anchor: str, size: float, ink: Ink, *, bold: bool = False
) -> str:
    big = "" if size == FONT else f' font-size="{size:g}"'
    heavy = ' font-weight="600"' if bold else ""
    place = "" if anchor == "start" else f' text-anchor="{anchor}"'
    return f'<text x="{x:.1f}" y="{y:.1f}"{place}{big}{heavy} {ink.paint(fill=color)}>{_text(text)}</text>'


def _cut(text: str, limit: int) -> str:
    """Words short enough for their room."""
    return text if len(text) <= limit else text[: max(limit - 1, 1)] + "…"


def _sample(look: Look | tuple[str, float], ink: Ink) -> str:
    """What stands before the words of a legend, 30 by 12 pixels."""
    if isinstance(look, tuple):
        paint = ink.paint(fill=look[0], stroke="muted")
        return f'<rect x="4" y="1" width="22" height="10" fill-opacity="{look[1]:g}" stroke-width="0.6" {paint}/>'
    line = f'<line x1="1" y1="6" x2="29" y2="6" {_stroke(look, ink)}/>' if look.width > 0.0 else ""
    if look.marker:
        line += _markers(np.array([15.0]), np.array([6.0]), look, ink)
    return line


def _legend_inline(figure: Figure, ink: Ink) -> str:
    if not figure.legend:
        return ""
    items = "".join(
        f'<li><svg viewBox="0 0 30 12" width="30" height="12" aria-hidden="true">{_sample(look, ink)}</svg>'
        f"{_text(words)}</li>"
        for words, look in figure.legend
    )
    return f'<ul class="legend" aria-label="Legend">{items}</ul>'


def _legend_file(figure: Figure, width: int, ink: Ink) -> tuple[str, int]:
    """The legend in rows that fit, and the height it takes."""
    if not figure.legend:
        return "", 0
    parts, x, y = [], 8.0, 8.0
    for words, look in figure.legend:
        room = 38.0 + _width(words) + 14.0
        if x + room > width and x > 8.0:
            x, y = 8.0, y + 19.0
        parts.append(
            f'<g transform="translate({x:g},{y:g})">{_sample(look, ink)}</g>'
            + _letters(x + 36.0, y + 10.0, words, "ink", "start", FONT, ink)
        )
        x += room
    return "".join(parts), round(y + 24.0)
