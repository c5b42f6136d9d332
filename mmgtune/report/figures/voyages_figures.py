"""Figures of a validation on voyages: how far off, by class, where the error lives, and windows to look at."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ..wording import clean, number, share
from .plot import Axis, Bar, Color, Figure, Line, Look, Mark, Panel, Rule, Words, model_look

SHADES: tuple[tuple[Color, float], ...] = (("after", 0.5), ("box", 1.0), ("before", 0.5))
"""Fill of the three classes and how dense it is: letters can be read on each, on light paper and on dark."""

STRIP = (102.0, 106.0)
"""Where the classes are shown above curves that end at 100 %."""

PARTS: Mapping[str, Color] = {
    "position": "after", "heading": "before", "surge": "muted", "sway": "box", "yaw": "flag",
}  # fmt: skip
"""Colours of the parts of cVDM."""


def classes_figure(names: Sequence[str], counts: Sequence[Sequence[int]], classes: Sequence[str]) -> Figure:
    """Share of windows in each class, a bar per model."""
    marks: list[Mark] = []
    for row, of in enumerate(counts):
        total, left = max(sum(of), 1), 0.0
        for size, (fill, density) in zip(of, SHADES, strict=True):
            width = 100.0 * size / total
            marks.append(Bar((left, left + width), (row - 0.31, row + 0.31), fill, density))
            if width >= 9.0:
                marks.append(Words(left + width / 2.0, row, share(size / total, counted=True)))
            left += width
    ticks = tuple((float(k), cut(name)) for k, name in enumerate(names))
    y = Axis(low=len(names) - 0.5, high=-0.5, ticks=ticks, grid=False)
    panel = Panel(tuple(marks), Axis("share of windows [%]", 0.0, 100.0), y, shape=-(36.0 * len(names) + 45.0))
    legend = tuple(zip(classes, SHADES, strict=True))
    return Figure("classes", "Share of windows in each class, a bar per model", (panel,), legend)


def distributions(values: Mapping[str, FloatArray], limits: Sequence[float], classes: Sequence[str]) -> Figure:
    """Share of windows below each cVDM, a curve per model, with the limits of the classes.

    A strip along the top shows which class lies where: on a phone a narrow class has no room for its name.
    """
    marks: list[Mark] = []
    legend, ends = [], []
    for place, (name, all_of) in enumerate(values.items()):
        of = np.sort(all_of[~np.isnan(all_of)])
        below = 100.0 * np.arange(1, len(of) + 1) / max(len(of), 1)
        finite = np.isfinite(of) & (of > 0.0)
        if not finite.any():
            continue
        look = without_marker(model_look(place))
        marks.append(Line(of[finite], below[finite], look))
        legend.append((cut(name, 30), look))
        ends += [of[finite][0], of[finite][-1]]
    marks += [Rule(limit, Look("muted", 1.0, "dash")) for limit in limits]
    low = min(0.8 * min(ends), 0.7 * limits[0]) if ends else 0.5 * limits[0]
    high = max(1.2 * max(ends), 1.8 * limits[-1]) if ends else 2.0 * limits[-1]
    for ends_of, (fill, density) in zip(pairwise([low, *limits, high]), SHADES, strict=True):
        marks.append(Bar(ends_of, STRIP, fill, density))
    x, y = Axis("cVDM [%]", low, high, log=True), Axis("windows below [%]", 0.0, 108.0)
    panel = Panel(tuple(marks), x, y, shape=0.5)
    strip = zip(classes, SHADES, strict=True)
    return Figure("distributions", "Share of windows below each cVDM, a curve per model", (panel,), (*legend, *strip))


_LETTERS = 30
"""Letters of the bins that a panel has room for side by side."""


def where(panels: Sequence[Mapping[str, Any]]) -> Figure:
    """Mean cVDM by bin with its interval, a panel per feature and a line per model.

    panels  each with ``title``, ``labels`` of the bins, ``counts``, and ``models``: name to (mean, low, high) by bin
    """
    found = tuple(_where(panel) for panel in panels)
    legend = tuple((cut(name, 30), model_look(k)) for k, name in enumerate(panels[0]["models"]))
    return Figure("where", "Mean cVDM by what the ship did", found, legend, min(2, len(panels)))


def _where(panel: Mapping[str, Any]) -> Panel:
    n_bins, models = len(panel["labels"]), panel["models"]
    marks: list[Mark] = []
    for place, rows in enumerate(models.values()):
        look = model_look(place)
        off = 0.12 * (place - (len(models) - 1) / 2.0)
        known = [(k + off, *row) for k, row in enumerate(rows) if row[0] is not None]
        marks.append(Line([k for k, *_ in known], [mean for _, mean, *_ in known], look))
        for k, _, low, high in known:
            if low is not None and high is not None:
                marks.append(Line((k, k), (low, high), Look(look.color, 1.2)))
    labels = [f"{label}\n{count}" for label, count in zip(panel["labels"], panel["counts"], strict=True)]
    if sum(map(len, panel["labels"])) > _LETTERS:  # every second one lower
        labels = [text if k % 2 == 0 else f"\n\n{text}" for k, text in enumerate(labels)]
    x = Axis(low=-0.5, high=n_bins - 0.5, ticks=tuple((float(k), text) for k, text in enumerate(labels)), grid=False)
    return Panel(tuple(marks), x, Axis("mean cVDM [%]", low=0.0), panel["title"])


def parts_figure(labels: Sequence[str], parts: Mapping[str, Sequence[float]], words: str) -> Figure:
    """What cVDM is the sum of, stacked, by bin of one feature."""
    marks: list[Mark] = []
    bottom = [0.0] * len(labels)
    for name, values in parts.items():
        for k, value in enumerate(values):
            marks.append(Bar((k - 0.36, k + 0.36), (bottom[k], bottom[k] + value), PARTS[name]))
        bottom = [low + value for low, value in zip(bottom, values, strict=True)]
    x = Axis(words, -0.6, len(labels) - 0.4, ticks=tuple((float(k), text) for k, text in enumerate(labels)), grid=False)
    panel = Panel(tuple(marks), x, Axis("mean cVDM [%]", low=0.0), shape=0.45)
    legend = tuple((name, (PARTS[name], 1.0)) for name in parts)
    return Figure("parts", "What cVDM is the sum of, by rudder angle", (panel,), legend)


def without_marker(look: Look) -> Look:
    """The look of a dense curve."""
    return Look(look.color, look.width, look.dash)


def cut(name: str, limit: int = 18) -> str:
    """A name short enough for a figure: of a path, its end."""
    text = clean(name)
    return text if len(text) <= limit else "…" + text[1 - limit :]


def bin_label(one: Mapping[str, Any], factor: float) -> str:
    """A bin by its ends, short enough for an axis."""
    if one.get("name"):
        return clean(one["name"])
    low, high = number(one.get("low")), number(one.get("high"))
    first, last = ("" if end is None else f"{end * factor:.3g}" for end in (low, high))
    return f"< {last}" if not first else f"≥ {first}" if not last else f"{first}–{last}"
