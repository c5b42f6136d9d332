"""Figures of a validation on voyages: how far off, by class, where the error lives, and windows to look at."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from .drawing import AFTER, BEFORE, BOX, FLAG, INK, MUTED, log_ticks, new_figure, thinned
from .wording import clean, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Motion = Mapping[str, FloatArray]

STYLES: tuple[dict[str, Any], ...] = (
    {"color": AFTER, "linestyle": "-", "marker": "o"},
    {"color": BEFORE, "linestyle": (0, (6, 2.2)), "marker": "^"},
    {"color": FLAG, "linestyle": (0, (1.2, 1.6)), "marker": "s"},
    {"color": MUTED, "linestyle": (0, (7, 2, 1, 2)), "marker": "D"},
)
"""How each model is drawn everywhere: colour, dash and marker all differ; a fifth begins anew."""

MEASURED: dict[str, Any] = {"color": INK, "linestyle": "-", "linewidth": 1.6}
SHADES = ((AFTER, 0.5), (BOX, 1.0), (BEFORE, 0.5))
"""Fill of the three classes and how dense it is: letters can be read on each, on light paper and on dark."""

PARTS = {"position": AFTER, "heading": BEFORE, "surge": MUTED, "sway": BOX, "yaw": FLAG}
"""Colours of the parts of cVDM."""


def style(place: int) -> dict[str, Any]:
    """Of the model at that place."""
    return STYLES[place % len(STYLES)]


def draw_classes(names: Sequence[str], counts: Sequence[Sequence[int]], classes: Sequence[str]) -> Figure:
    """Share of windows in each class, a bar per model."""
    figure = new_figure(7.6, 0.5 * len(names) + 1.1)
    ax = figure.subplots()
    for row, of in enumerate(counts):
        total, left = max(sum(of), 1), 0.0
        for size, (fill, density) in zip(of, SHADES, strict=True):
            share = 100.0 * size / total
            ax.barh(row, share, left=left, height=0.62, color=fill, alpha=density, linewidth=0.0)
            if share >= 6.0:
                ax.text(left + share / 2.0, row, f"{share:.0f}\u00a0%", ha="center", va="center", color=INK)
            left += share
    ax.set_yticks(range(len(names)), [cut(name) for name in names])
    ax.set_ylim(len(names) - 0.5, -0.5)
    ax.set_xlim(0.0, 100.0)
    ax.set_xlabel("share of windows [%]")
    ax.grid(visible=False)
    ax.tick_params(left=False)
    from matplotlib.patches import Patch

    handles = [
        Patch(facecolor=fill, alpha=density, linewidth=0.0, label=label)
        for label, (fill, density) in zip(classes, SHADES, strict=True)
    ]
    figure.legend(handles=handles, loc="outside upper left", ncols=3, handlelength=1.4)
    return figure


def draw_distributions(values: Mapping[str, FloatArray], limits: Sequence[float], classes: Sequence[str]) -> Figure:
    """Share of windows below each cVDM, a curve per model, with the limits of the classes."""
    import numpy as np

    figure = new_figure(7.6, 3.7)
    ax = figure.subplots()
    ends = []
    for place, (name, all_of) in enumerate(values.items()):
        of = np.sort(all_of[~np.isnan(all_of)])
        share = 100.0 * np.arange(1, len(of) + 1) / max(len(of), 1)
        finite = np.isfinite(of) & (of > 0.0)
        if not finite.any():
            continue
        part = thinned(of[finite], 600)
        look = style(place)
        ax.plot(of[finite][part], share[finite][part], color=look["color"], linestyle=look["linestyle"],
                linewidth=1.8, label=cut(name, 30))  # fmt: skip
        ends += [of[finite][0], of[finite][-1]]
    ax.set_xscale("log")
    if ends:
        ax.set_xlim(min(0.8 * min(ends), 0.7 * limits[0]), max(1.2 * max(ends), 1.8 * limits[-1]))
    for limit in limits:
        ax.axvline(limit, color=MUTED, linewidth=1.0, linestyle=(0, (4, 3)))
    low, high = ax.get_xlim()
    edges = [low, *limits, high]
    for k, name in enumerate(classes):
        ax.text((edges[k] * edges[k + 1]) ** 0.5, 101.5, name, ha="center", va="bottom", color=MUTED, fontsize=8.0)
    log_ticks(ax.xaxis)
    ax.set_ylim(0.0, 100.0)
    ax.set_xlabel("cVDM [%]")
    ax.set_ylabel("windows below [%]")
    figure.legend(loc="outside upper left", ncols=2, handlelength=3.6)
    return figure


def draw_where(panels: Sequence[Mapping[str, Any]]) -> Figure:
    """Mean cVDM by bin with its interval, a panel per feature and a line per model.

    panels  each with ``title``, ``labels`` of the bins, ``counts``, and ``models``: name to (mean, low, high) by bin
    """
    columns = 1 if len(panels) == 1 else 2
    rows = -(-len(panels) // columns)
    figure = new_figure(4.2 * columns, 2.45 * rows + 0.4)
    axes = figure.subplots(rows, columns, squeeze=False).flatten().tolist()
    for unused in axes[len(panels) :]:
        unused.remove()
    for ax, panel in zip(axes, panels, strict=False):
        _where(ax, panel)
    figure.supylabel("mean cVDM [%]", fontsize=9)
    _legend(figure, list(panels[0]["models"]))
    return figure


def _where(ax: Axes, panel: Mapping[str, Any]) -> None:
    n_bins, models = len(panel["labels"]), panel["models"]
    for place, rows in enumerate(models.values()):
        look = style(place)
        off = 0.12 * (place - (len(models) - 1) / 2.0)
        known = [(k, *row) for k, row in enumerate(rows) if row[0] is not None]
        ax.plot([k + off for k, *_ in known], [mean for _, mean, *_ in known], linewidth=1.3, markersize=4.5, **look)
        for k, _, low, high in known:
            if low is not None and high is not None:
                ax.plot([k + off] * 2, [low, high], color=look["color"], linewidth=1.1)
    ax.set_title(panel["title"])
    labels = [f"{label}\n{count}" for label, count in zip(panel["labels"], panel["counts"], strict=True)]
    ax.set_xticks(range(n_bins), labels, fontsize=7.5)
    ax.set_xlim(-0.5, n_bins - 0.5)
    ax.set_ylim(bottom=0.0)
    ax.grid(visible=False, axis="x")


def draw_parts(labels: Sequence[str], parts: Mapping[str, Sequence[float]], x_label: str) -> Figure:
    """What cVDM is the sum of, stacked, by bin of one feature."""
    figure = new_figure(7.6, 3.3)
    ax = figure.subplots()
    bottom = [0.0] * len(labels)
    for name, values in parts.items():
        ax.bar(range(len(labels)), values, bottom=bottom, width=0.72, color=PARTS[name], label=name, edgecolor=MUTED,
               linewidth=0.6)  # fmt: skip
        bottom = [low + value for low, value in zip(bottom, values, strict=True)]
    ax.set_xticks(range(len(labels)), labels)
    ax.set_xlabel(x_label)
    ax.set_ylabel("mean cVDM [%]")
    ax.grid(visible=False, axis="x")
    figure.legend(loc="outside upper left", ncols=5, handlelength=1.4)
    return figure


def draw_windows(
    titles: Sequence[str], windows: Sequence[tuple[Motion, Mapping[str, Motion]]], names: Sequence[str]
) -> Figure:
    """Windows one below the other: the track, then heading and speed over time, measured and by every model."""
    import numpy as np

    figure = new_figure(9.0, 2.35 * len(windows) + 0.5)
    grid = figure.subplots(len(windows), 3, squeeze=False, width_ratios=(1.15, 1.0, 1.0))
    for row, (title, (measured, models)) in enumerate(zip(titles, windows, strict=True)):
        track, heading, speed = grid[row]
        x0, y0 = measured["x"][0], measured["y"][0]
        lines = [(measured, MEASURED)]
        lines += [
            (models[name], {key: value for key, value in style(k).items() if key != "marker"} | {"linewidth": 1.4})
            for k, name in enumerate(names)
            if name in models
        ]
        for motion, look in lines:
            track.plot(motion["y"] - y0, motion["x"] - x0, **look)
            track.plot(motion["y"][-1:] - y0, motion["x"][-1:] - x0, marker="o", markersize=3.0, color=look["color"])
            heading.plot(motion["t"], np.degrees(motion["psi"] - measured["psi"][0]), **look)
            speed.plot(motion["t"], np.hypot(motion["u"], motion["v_m"]), **look)
        track.plot([0.0], [0.0], marker="+", markersize=9, color=MUTED, linestyle="none")
        track.set_aspect("equal", adjustable="datalim")
        track.locator_params(nbins=4)
        track.set_title(title)
        heading.set_title("heading turned [deg]" if row == 0 else "")
        speed.set_title("speed [m/s]" if row == 0 else "")
        spread = max(float(np.nanmax(np.hypot(m["u"], m["v_m"]))) for m, _ in lines)
        speed.set_ylim(0.0, 1.1 * spread)
        if row == len(windows) - 1:
            track.set_xlabel("east [m]")
            heading.set_xlabel("time [s]")
            speed.set_xlabel("time [s]")
        track.set_ylabel("north [m]")
    _legend(figure, list(names), measured=True)
    return figure


def _legend(figure: Figure, names: Sequence[str], measured: bool = False) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], label="measured", **MEASURED)] if measured else []
    handles += [
        Line2D([], [], label=cut(name, 30), markersize=4, linewidth=1.5, **style(k)) for k, name in enumerate(names)
    ]
    figure.legend(handles=handles, loc="outside upper left", ncols=min(len(handles), 4), handlelength=3.6)


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
