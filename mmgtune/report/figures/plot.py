"""Figures as data: what is drawn, apart from what draws it.

``svg.py`` makes pictures of a page and of files from them, ``pdf.py`` figures for papers.  Colours are names of the
page's, so that each has a light, a dark and a printed form; curves differ by dash or marker too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    import numpy as np

    from ...arrays import FloatArray

    Numbers = Sequence[float] | Sequence[float | None] | FloatArray | np.ndarray

Color = Literal["ink", "muted", "grid", "before", "after", "flag", "box", "third", "good"]
Dash = Literal["", "dot", "dash", "long"]
Marker = Literal["", "o", "s", "^", "D", "+", "x", "|", "<", ">", "."]


@dataclass(frozen=True)
class Look:
    """How a curve or its points look; ``hollow`` markers are not filled."""

    color: Color = "ink"
    width: float = 1.5
    dash: Dash = ""
    marker: Marker = ""
    size: float = 5.0
    alpha: float = 1.0
    hollow: bool = False


@dataclass(frozen=True)
class Line:
    """A curve through points, (n,) each, open where one is no number; markers at the points where its look has one."""

    x: Numbers
    y: Numbers
    look: Look = Look()
    steps: bool = False


@dataclass(frozen=True)
class Dots:
    """Points alone."""

    x: Numbers
    y: Numbers
    look: Look = Look(marker="o")


@dataclass(frozen=True)
class Area:
    """What lies between two curves over x."""

    x: Numbers
    low: Numbers
    high: Numbers
    color: Color = "box"
    alpha: float = 1.0


@dataclass(frozen=True)
class Shapes:
    """Closed outlines, (n, 2) each of x and y, filled as one area, or only drawn where ``fill`` is empty."""

    outlines: Sequence[FloatArray]
    fill: Color | Literal[""] = ""
    look: Look | None = None
    alpha: float = 1.0


@dataclass(frozen=True)
class Bar:
    """A rectangle between two places on either axis."""

    x: tuple[float, float]
    y: tuple[float, float]
    color: Color | str = "box"
    alpha: float = 1.0


@dataclass(frozen=True)
class Rule:
    """A line right across the panel at one place."""

    at: float
    look: Look = Look("muted", 1.0, "dot")
    upright: bool = True


@dataclass(frozen=True)
class Words:
    """Text at a place, moved by (right, up) pixels; ``edge`` puts it at the end of the x axis, outside."""

    x: float
    y: float
    text: str
    color: Color | str = "ink"
    anchor: Literal["start", "middle", "end"] = "middle"
    move: tuple[float, float] = (0.0, 0.0)
    size: float = 11.0
    edge: bool = False


Mark = Line | Dots | Area | Shapes | Bar | Rule | Words


@dataclass(frozen=True)
class Axis:
    """One axis: words, limits where they are given, and ticks: places with their words, or None for round numbers."""

    words: str = ""
    low: float | None = None
    high: float | None = None
    log: bool = False
    ticks: tuple[tuple[float, str], ...] | None = None
    grid: bool = True
    room: float = 0.04
    """Share of the span left free at both ends that are not given."""


@dataclass(frozen=True)
class Panel:
    """One pair of axes.

    shape  height over width of the whole panel
    equal  one metre is as long on both axes
    """

    marks: tuple[Mark, ...]
    x: Axis = Axis()
    y: Axis = Axis()
    title: str = ""
    shape: float = 0.62
    equal: bool = False


@dataclass(frozen=True)
class Figure:
    """Panels with one legend.

    name    of its file
    alt     what it is, for those who do not see it
    legend  words and look of a curve, or the colour of an area with how dense it is
    """

    name: str
    alt: str
    panels: tuple[Panel, ...]
    legend: tuple[tuple[str, Look | tuple[Color, float]], ...] = ()
    across: int = field(default=0)
    """Panels side by side in a file; 0: as suits their number."""

    @property
    def columns(self) -> int:
        """Panels side by side in a file."""
        n = len(self.panels)
        return self.across or (n if n <= 3 else 2 if n == 4 else 3)


DASHES_OF: dict[Dash, str] = {"": "", "dot": "1.5 2.5", "dash": "7 3", "long": "9 2.5 1.5 2.5"}
"""Pixels on and off of each kind of line."""

LOOKS = {
    "measured": Look("ink", 1.6, "", "o"),
    "before": Look("before", 1.4, "dot", "^"),
    "after": Look("after", 1.6, "dash", "s"),
}
"""How each of the three motions is drawn everywhere: colour, dash and marker all differ."""

MODELS = (
    Look("after", 1.7, "", "o"),
    Look("before", 1.7, "dash", "^"),
    Look("flag", 1.7, "dot", "s"),
    Look("third", 1.7, "long", "D"),
    Look("muted", 1.7, "dash", "x"),
    Look("ink", 1.7, "dot", "+"),
)
"""How the models of a comparison are drawn everywhere; a seventh begins anew."""


def model_look(place: int) -> Look:
    """Of the model at that place."""
    return MODELS[place % len(MODELS)]
