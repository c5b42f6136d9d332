"""Figures of a prediction: fans of tracks and motions, bands on indices, and whether bands hold what they say."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from ..physics.frame import to_earth
from .drawing import AFTER, BEFORE, BOX, GRID, INK, MUTED, grid_of, new_figure, thinned
from .wording import CHANNELS, clean, number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Columns = Mapping[str, FloatArray]

SHOWN = ("psi", "u", "v_m", "r")
OUTLINES = 7
"""Ships drawn along a track."""

FINER = 3
"""Places between two marks at which the region of positions is drawn."""

SLENDER = 6.0
"""Length over beam of the outline of a ship."""


def draw_track(
    marks: Sequence[Mapping[str, float]],
    particles: Sequence[Columns],
    mean: Columns | None,
    measured: Columns | None,
    L_pp: float,
    level: float,
) -> Figure:
    """The fan of a track, north up: mean, regions of half the positions and of ``level`` percent, particles, ships."""
    figure = new_figure(5.6, 5.2)
    ax = figure.subplots()
    if len(particles) > 1:
        for share, fill in ((level / 100.0, BOX), (0.5, GRID)):
            _region(ax, marks, share, fill)
        for one in particles:
            ax.plot(one["y"], one["x"], color=AFTER, linewidth=0.5, alpha=0.35)
    if mean is not None:
        part = thinned(mean["x"])
        ax.plot(mean["y"][part], mean["x"][part], color=AFTER, linewidth=1.8)
    if measured is not None:
        part = thinned(measured["x"])
        ax.plot(measured["y"][part], measured["x"][part], color=INK, linewidth=1.5, linestyle=(0, (5, 2)))
    for mark in _spread(marks, OUTLINES):
        _outline(ax, mark, L_pp)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("east [m]")
    ax.set_ylabel("north [m]")
    _legend(figure, level, len(particles) > 1, measured is not None, particles_too=True)
    return figure


def draw_motions(bands: Mapping[str, Columns], level: float, several: bool) -> Figure:
    """Heading, velocities and yaw rate over time, each with its fan."""
    import numpy as np

    figure, axes = grid_of(len(SHOWN), (3.6, 2.1))
    axes = _two_by_two(figure, axes)
    seen = False
    for ax, name in zip(axes, SHOWN, strict=True):
        channel, found = CHANNELS[name], bands[name]
        part = thinned(found["t"], 400)
        t = found["t"][part]
        columns = {key: values[part] * channel.factor for key, values in found.items() if key != "t"}
        if several:
            ax.fill_between(t, columns["low"], columns["high"], facecolor=BOX, edgecolor=GRID, linewidth=0.8)
            ax.fill_between(t, columns["q25"], columns["q75"], facecolor=GRID, edgecolor=MUTED, linewidth=0.4)
        ax.plot(t, columns["mean"], color=AFTER, linewidth=1.6)
        if np.isfinite(columns["measured"]).any():
            seen = True
            ax.plot(t, columns["measured"], color=INK, linewidth=1.2, linestyle=(0, (5, 2)))
        ax.set_title(channel.title)
        ax.margins(x=0.01)
    figure.supxlabel("time [s]", fontsize=9)
    _legend(figure, level, several, seen)
    return figure


def draw_indices(rows: Mapping[str, Sequence[Mapping[str, Any]]], level: float, several: bool) -> Figure:
    """Whiskers: mean and band of each index, a panel for each unit.

    rows  by unit: ``label``, ``mean``, ``low``, ``high`` and ``measured``, None where there is none
    """
    amount = sum(len(of) for of in rows.values())
    figure = new_figure(7.0, 0.27 * amount + 0.7 * len(rows) + 0.6)
    axes = figure.subplots(len(rows), 1, squeeze=False, height_ratios=[len(of) + 1.5 for of in rows.values()])[:, 0]
    seen = False
    for ax, (unit, of) in zip(axes, rows.items(), strict=True):
        _whiskers(ax, of)
        seen = seen or any(row["measured"] is not None for row in of)
        ax.set_xlabel(f"[{unit}]", loc="right", labelpad=1)
    _legend(figure, level, several, seen, whiskers=True)
    return figure


def draw_calibration(nominal: Sequence[float], by_model: Mapping[str, Sequence[float | None]]) -> Figure:
    """Share of what was measured that lies in bands, against the share they say, a line for each model."""
    from .voyages_figures import style

    figure = new_figure(4.6, 4.4)
    ax = figure.subplots()
    ax.plot([0.0, 100.0], [0.0, 100.0], color=MUTED, linewidth=1.0, linestyle=(0, (4, 3)), label="bands that are right")
    for place, (name, covered) in enumerate(by_model.items()):
        points = [(100.0 * said, 100.0 * held) for said, held in zip(nominal, covered, strict=True) if held is not None]
        if points:
            look = style(place)
            ax.plot(*zip(*points, strict=True), markersize=4, linewidth=1.6, label=clean(name)[-40:], **look)
    ax.set_xlim(0.0, 100.0)
    ax.set_ylim(0.0, 100.0)
    ax.set_aspect("equal")
    ax.set_xlabel("the band says [%]")
    ax.set_ylabel("it holds [%]")
    figure.legend(loc="outside upper left", ncols=1, handlelength=3.6)
    return figure


def _region(ax: Axes, marks: Sequence[Mapping[str, float]], share: float, fill: str) -> None:
    """Where a share of the positions lies along a track: ellipses of mean and covariance, drawn as one area."""
    import numpy as np
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    radius = math.sqrt(-2.0 * math.log(1.0 - share))  # of a bivariate normal distribution
    turn = np.linspace(0.0, 2.0 * math.pi, 17)
    circle = radius * np.array([np.cos(turn), np.sin(turn)])
    t = [mark["t"] for mark in marks]
    finer = np.interp(np.linspace(0.0, len(t) - 1.0, FINER * len(t)), range(len(t)), t)
    x, y, xx, xy, yy = (np.interp(finer, t, [mark[name] for mark in marks]) for name in ("x", "y", "xx", "xy", "yy"))
    shapes = []
    for k in range(len(finer)):
        values, axes = np.linalg.eigh([[yy[k], xy[k]], [xy[k], xx[k]]])
        axes[:, 0] *= np.sign(np.linalg.det(axes))  # all turn the same way, so that overlaps are inside
        around = axes @ (np.sqrt(np.maximum(values, 0.0))[:, None] * circle)
        shapes.append(Path(np.array([y[k], x[k]]) + around.T, closed=True))
    ax.add_patch(PathPatch(Path.make_compound_path(*shapes), facecolor=fill, edgecolor="none"))


def _outline(ax: Axes, mark: Mapping[str, float], L_pp: float) -> None:
    """A ship at her mean place and heading."""
    import numpy as np

    half, side = 0.5 * L_pp, 0.5 * L_pp / SLENDER
    ahead = np.array([half, 0.6 * half, -half, -half, 0.6 * half])
    abeam = np.array([0.0, side, side, -side, -side])
    north, east = to_earth(mark["psi"], ahead, abeam)
    ax.fill(mark["y"] + east, mark["x"] + north, facecolor="none", edgecolor=BEFORE, linewidth=1.0)


def _spread(marks: Sequence[Mapping[str, float]], most: int) -> list[Mapping[str, float]]:
    """Some of the marks, first and last among them."""
    if len(marks) <= most:
        return list(marks)
    return [marks[round(k * (len(marks) - 1) / (most - 1))] for k in range(most)]


def _two_by_two(figure: Figure, axes: Sequence[Axes]) -> list[Axes]:
    """Four panels in two rows, which are still read on a phone."""
    for ax in axes:
        ax.remove()
    figure.set_size_inches(7.2, 4.6)
    found: list[Axes] = figure.subplots(2, 2).flatten().tolist()
    return found


def _whiskers(ax: Axes, rows: Sequence[Mapping[str, Any]]) -> None:
    known = [value for row in rows for key in ("mean", "low", "high", "measured") if (value := row[key]) is not None]
    reach = max(known, default=1.0)
    for place, row in enumerate(rows):
        low, high, mean, measured = (number(row[key]) for key in ("low", "high", "mean", "measured"))
        if low is not None:
            last = 1.05 * reach if high is None else high
            ax.plot([low, last], [place, place], color=AFTER, linewidth=1.6)
            ax.plot([low], [place], color=AFTER, linestyle="none", marker="|", markersize=9)
            ends: dict[str, Any] = (
                {"marker": ">", "markersize": 5} if high is None else {"marker": "|", "markersize": 9}
            )
            ax.plot([last], [place], color=AFTER, linestyle="none", **ends)
        if mean is not None:
            ax.plot([mean], [place], color=AFTER, linestyle="none", marker="o", markersize=5)
        if measured is not None:
            ax.plot([measured], [place], color=INK, linestyle="none", marker="D", markersize=4.5)
    ax.set_yticks(range(len(rows)), [clean(row["label"])[-44:] for row in rows])
    ax.set_ylim(len(rows) - 0.4, -0.6)
    ax.set_xlim(left=min(0.0, *known) if known else 0.0)
    ax.grid(visible=False, axis="y")
    ax.tick_params(axis="y", length=0)


def _legend(
    figure: Figure, level: float, several: bool, measured: bool, *, particles_too: bool = False, whiskers: bool = False
) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    dot: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 5} if whiskers else {"linewidth": 1.8}
    handles: list[Any] = [Line2D([], [], color=AFTER, label="mean" if several else "foretold", **dot)]
    if several and whiskers:
        handles.append(Line2D([], [], color=AFTER, marker="|", markersize=8, label=f"band of {level:g}\u00a0%"))
    elif several:
        handles.append(Patch(facecolor=GRID, edgecolor=MUTED, label="50\u00a0%"))
        handles.append(Patch(facecolor=BOX, edgecolor=GRID, label=f"{level:g}\u00a0%"))
        if particles_too:
            handles.append(Line2D([], [], color=AFTER, linewidth=0.5, alpha=0.6, label="particles"))
    if measured:
        look: dict[str, Any] = (
            {"linestyle": "none", "marker": "D", "markersize": 4.5} if whiskers else {"linestyle": (0, (5, 2))}
        )
        handles.append(Line2D([], [], color=INK, label="measured", **look))
    figure.legend(handles=handles, loc="outside upper left", ncols=len(handles), handlelength=2.2)
