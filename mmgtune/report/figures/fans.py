"""Figures of a prediction: fans of tracks and motions, bands on indices, and whether bands hold what they say."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import FloatArray
from ...physics.frame import to_earth
from ..wording import CHANNELS, OVER_TIME, clean, number
from .plot import Area, Axis, Color, Dots, Figure, Line, Look, Mark, Panel, Shapes, model_look

if TYPE_CHECKING:
    Columns = Mapping[str, FloatArray]

    Legend = list[tuple[str, Look | tuple[Color, float]]]

OUTLINES = 7
"""Ships drawn along a track."""

FINER = 3
"""Places between two marks at which the region of positions is drawn."""

SLENDER = 6.0
"""Length over beam of the outline of a ship."""

MEAN, THREAD, MEASURED = Look("after", 1.9), Look("after", 0.5, alpha=0.4), Look("ink", 1.5, "dash")


def track(
    name: str,
    alt: str,
    marks: Sequence[Mapping[str, float]],
    particles: Sequence[Columns],
    mean: Columns | None,
    measured: Columns | None,
    L_pp: float,
    level: float,
) -> Figure:
    """The fan of a track, north up: mean, regions of half the positions and of ``level`` percent, particles, ships."""
    found: list[Mark] = []
    if len(particles) > 1:
        for share, fill in ((level / 100.0, "box"), (0.5, "grid")):
            found.append(Shapes(regions(marks, share), fill))  # type: ignore[arg-type]
        found += [Line(one["y"], one["x"], THREAD) for one in particles]
    if mean is not None:
        found.append(Line(mean["y"], mean["x"], MEAN))
    if measured is not None:
        found.append(Line(measured["y"], measured["x"], MEASURED))
    found += [Shapes((outline(mark, L_pp),), look=Look("before", 1.0)) for mark in spread(marks, OUTLINES)]
    panel = Panel(tuple(found), Axis("east [m]"), Axis("north [m]"), shape=0.72, equal=True)
    legend = _legend(level, len(particles) > 1, measured is not None, particles_too=True)
    return Figure(name, alt, (panel,), legend)


def motions(name: str, alt: str, bands: Mapping[str, Columns], level: float, several: bool) -> Figure:
    """Heading, velocities and yaw rate over time, each with its fan."""
    panels, seen = [], False
    for state in OVER_TIME:
        channel, found = CHANNELS[state], bands[state]
        t = found["t"]
        with np.errstate(over="ignore"):  # of numbers that somebody damaged
            columns = {key: values * channel.factor for key, values in found.items() if key != "t"}
        marks: list[Mark] = []
        if several:
            marks.append(Area(t, columns["low"], columns["high"], "box"))
            marks.append(Area(t, columns["q25"], columns["q75"], "grid"))
        marks.append(Line(t, columns["mean"], MEAN))
        if np.isfinite(columns["measured"]).any():
            seen = True
            marks.append(Line(t, columns["measured"], MEASURED))
        panels.append(Panel(tuple(marks), Axis("time [s]", room=0.01), Axis(), channel.title, 0.55))
    return Figure(name, alt, tuple(panels), _legend(level, several, seen), 2)


def indices(rows: Mapping[tuple[str, str], Sequence[Mapping[str, Any]]], level: float, several: bool) -> Figure:
    """Whiskers: mean and band of each index, a panel for each run and unit.

    rows  by run and unit: ``label``, ``mean``, ``low``, ``high`` and ``measured``, None where there is none
    """
    seen = any(row["measured"] is not None for of in rows.values() for row in of)
    panels = tuple(_whiskers(of, run, unit) for (run, unit), of in rows.items())
    legend = _legend(level, several, seen, whiskers=True)
    return Figure("indices", "Indices of the manoeuvres with their bands", panels, legend, 1)


def calibration(nominal: Sequence[float], by_model: Mapping[str, Sequence[float | None]]) -> Figure:
    """Share of what was measured that lies in bands, against the share they say, a line for each model."""
    right = Look("muted", 1.0, "dash")
    marks: list[Mark] = [Line((0.0, 100.0), (0.0, 100.0), right)]
    legend: Legend = [("bands that are right", right)]
    for place, (name, covered) in enumerate(by_model.items()):
        points = [(100.0 * said, 100.0 * held) for said, held in zip(nominal, covered, strict=True) if held is not None]
        if points:
            marks.append(Line([said for said, _ in points], [held for _, held in points], model_look(place)))
            legend.append((clean(name)[-40:], model_look(place)))
    x, y = Axis("the band says [%]", 0.0, 100.0), Axis("it holds [%]", 0.0, 100.0)
    alt = "Share of the measured samples in bands against what the bands say"
    return Figure("calibration", alt, (Panel(tuple(marks), x, y, shape=0.62, equal=False),), tuple(legend))


def regions(marks: Sequence[Mapping[str, float]], share: float) -> list[FloatArray]:
    """Where a share of the positions lies along a track: ellipses of mean and covariance, (17, 2) of east and north."""
    radius = math.sqrt(-2.0 * math.log(1.0 - share))  # of a bivariate normal distribution
    turn = np.linspace(0.0, 2.0 * math.pi, 17)
    circle = radius * np.array([np.cos(turn), np.sin(turn)])
    marks = [mark for mark in marks if all(math.isfinite(mark[name]) for name in ("t", "x", "y", "xx", "xy", "yy"))]
    if not marks:
        return []
    t = [mark["t"] for mark in marks]
    finer = np.interp(np.linspace(0.0, len(t) - 1.0, FINER * len(t)), range(len(t)), t)
    x, y, xx, xy, yy = (np.interp(finer, t, [mark[name] for mark in marks]) for name in ("x", "y", "xx", "xy", "yy"))
    shapes = []
    for k in range(len(finer)):
        values, axes = np.linalg.eigh([[yy[k], xy[k]], [xy[k], xx[k]]])
        axes[:, 0] *= np.sign(np.linalg.det(axes))  # all turn the same way, so that overlaps are inside
        around = axes @ (np.sqrt(np.maximum(values, 0.0))[:, None] * circle)
        shapes.append(np.array([y[k], x[k]]) + around.T)
    return shapes


def outline(mark: Mapping[str, float], L_pp: float) -> FloatArray:
    """A ship at her mean place and heading: (5, 2) of east and north."""
    half, side = 0.5 * L_pp, 0.5 * L_pp / SLENDER
    ahead = np.array([half, 0.6 * half, -half, -half, 0.6 * half])
    abeam = np.array([0.0, side, side, -side, -side])
    north, east = to_earth(mark["psi"], ahead, abeam)
    return np.column_stack([mark["y"] + east, mark["x"] + north])


def spread(marks: Sequence[Mapping[str, float]], most: int) -> list[Mapping[str, float]]:
    """Some of the marks, first and last among them."""
    if len(marks) <= most:
        return list(marks)
    return [marks[round(k * (len(marks) - 1) / (most - 1))] for k in range(most)]


def _whiskers(rows: Sequence[Mapping[str, Any]], run: str, unit: str) -> Panel:
    known = [value for row in rows for key in ("mean", "low", "high", "measured") if (value := row[key]) is not None]
    reach = max(known, default=1.0)
    marks: list[Mark] = []
    for place, row in enumerate(rows):
        low, high, mean, measured = (number(row[key]) for key in ("low", "high", "mean", "measured"))
        if low is not None:
            last = 1.05 * reach if high is None else high
            marks.append(Line((low, last), (place, place), Look("after", 1.8)))
            marks.append(Dots((low,), (place,), Look("after", marker="|", size=8)))
            marks.append(Dots((last,), (place,), Look("after", marker=">" if high is None else "|", size=8)))
        if mean is not None:
            marks.append(Dots((mean,), (place,), Look("after", marker="o", size=7)))
        if measured is not None:
            marks.append(Dots((measured,), (place,), Look("ink", marker="D", size=6)))
    ticks = tuple((float(k), clean(row["label"])[-44:]) for k, row in enumerate(rows))
    y = Axis(low=len(rows) - 0.4, high=-0.6, ticks=ticks, grid=False)
    x = Axis(f"[{unit}]", low=min(0.0, *known) if known else 0.0)
    return Panel(tuple(marks), x, y, run, shape=-(26.0 * len(rows) + 62.0))


def _legend(
    level: float, several: bool, measured: bool, *, particles_too: bool = False, whiskers: bool = False
) -> tuple[tuple[str, Look | tuple[Color, float]], ...]:
    dot = Look("after", 0.0, marker="o", size=7) if whiskers else MEAN
    found: Legend = [("mean" if several else "foretold", dot)]
    if several and whiskers:
        found.append((f"band of {level:g}\u00a0%", Look("after", 1.8)))
    elif several:
        found += [("50\u00a0%", ("grid", 1.0)), (f"{level:g}\u00a0%", ("box", 1.0))]
        if particles_too:
            found.append(("particles", THREAD))
    if measured:
        found.append(("measured", Look("ink", 0.0, marker="D", size=6) if whiskers else MEASURED))
    return tuple(found)
