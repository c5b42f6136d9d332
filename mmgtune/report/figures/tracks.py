"""Static figures of the motions: the tracks on the water, how far apart they are, and motions over time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import FloatArray
from ..wording import CHANNELS, OVER_TIME, Channel
from .motions import Manoeuvre, Run
from .plot import LOOKS, Axis, Dots, Figure, Line, Look, Mark, Panel

if TYPE_CHECKING:
    Motion = Mapping[str, FloatArray]

WORDS = {"measured": "measured", "before": "before tuning", "after": "after tuning"}
PANELS = 12
LONGEST = 38
"""Letters of a title of a panel."""


def runs_of(words: Mapping[str, str]) -> list[Run]:
    """The three motions of a trial with what they are called."""
    return [Run(which, text, LOOKS[which], which == "measured") for which, text in words.items()]


def chosen(results: Sequence[Mapping[str, Any]], model: str = "after") -> list[Mapping[str, Any]]:
    """The trials to draw: all of them, or of many the ones that fit worst, in the data set's order."""
    if len(results) <= PANELS:
        return list(results)
    worst = sorted(results, key=lambda row: -(row.get(f"J_{model}") or 0.0))[:PANELS]
    return [row for row in results if row in worst]


def tick_spacing(manoeuvres: Sequence[Manoeuvre]) -> float:
    """Seconds between the time marks on the tracks: a minute, or more for long trials."""
    longest = max((_duration(motion) for one in manoeuvres for motion in one.runs.values()), default=0.0)
    return next((step for step in (10.0, 60.0, 120.0, 300.0, 600.0, 1800.0) if longest / step <= 25.0), 3600.0)


def tracks(manoeuvres: Sequence[Manoeuvre], runs: Sequence[Run], alt: str) -> Figure:
    """Tracks of every manoeuvre, north up and east to the right, with marks at equal times."""
    spacing = tick_spacing(manoeuvres)
    titles = distinct([one.name for one in manoeuvres])
    panels = tuple(_track(one, runs, spacing, title) for one, title in zip(manoeuvres, titles, strict=True))
    return Figure("tracks", alt, panels, tuple((run.words, run.look) for run in runs), 3)


def distances(manoeuvres: Sequence[Manoeuvre], runs: Sequence[Run]) -> Figure:
    """Distance between the simulated and the measured position over time, for every manoeuvre."""
    panels = []
    truth = next(run for run in runs if run.truth)
    others = [run for run in runs if not run.truth]
    for one, title in zip(manoeuvres, distinct([one.name for one in manoeuvres]), strict=True):
        marks: list[Mark] = []
        for run in others:
            if truth.key in one.runs and run.key in one.runs:
                t, distance = distance_from(one.runs[run.key], one.runs[truth.key])
                marks.append(Line(t, distance, dense(run.look, len(t))))
        panels.append(Panel(tuple(marks), Axis("time [s]"), Axis("off track [m]", low=0.0), title=title, shape=0.5))
    legend = tuple((run.words, dense(run.look)) for run in others)
    alt = "Distance of the simulated from the measured position over time"
    return Figure("distances", alt, tuple(panels), legend, 3)


def histories(one: Manoeuvre, runs: Sequence[Run], inputs: Sequence[Channel]) -> Figure:
    """Motions and inputs of one manoeuvre over time."""
    panels = []
    for channel in [*(CHANNELS[name] for name in OVER_TIME), *inputs]:
        marks: list[Mark] = []
        known = [run for run in runs if channel.name in one.runs.get(run.key, {})]
        for run in known[:1] if channel in inputs else known:
            t, values = one.runs[run.key]["t"], one.runs[run.key][channel.name] * channel.factor
            marks.append(Line(t, values, dense(run.look, len(t))))
        panels.append(Panel(tuple(marks), Axis("time [s]"), Axis(), title=channel.title, shape=0.5))
    legend = tuple((run.words, dense(run.look)) for run in runs)
    return Figure("histories", f"Time histories of {one.name}", tuple(panels), legend, 3)


def distinct(names: Sequence[str]) -> list[str]:
    """Names short enough for titles that still differ: their ends where the beginnings agree."""
    cut = [name if len(name) <= LONGEST else name[: LONGEST - 1] + "…" for name in names]
    if len(set(cut)) == len(set(names)):
        return cut
    return [name if len(name) <= LONGEST else "…" + name[1 - LONGEST :] for name in names]


def dense(look: Look, points: int = 2) -> Look:
    """The look of a curve of many samples; a single one is a point."""
    return replace(look, marker="o" if points < 2 else "", size=4.0)


def distance_from(one: Motion, measured: Motion) -> tuple[FloatArray, FloatArray]:
    """Times and the distance of a simulated position from the measured one [m]."""
    t = measured["t"]
    x, y = onto(one, "x", t), onto(one, "y", t)
    return t, np.hypot(x - measured["x"], y - measured["y"])


def onto(motion: Motion, name: str, t: FloatArray) -> FloatArray:
    """A column of a motion at the times ``t``; NaN outside the motion."""
    own, values = motion["t"], motion[name]
    if own.shape == t.shape and np.allclose(own, t):
        return values
    good = np.isfinite(own) & np.isfinite(values)
    if not good.any():
        return np.full_like(t, math.nan)
    return np.interp(t, own[good], values[good], left=math.nan, right=math.nan)


def _track(one: Manoeuvre, runs: Sequence[Run], spacing: float, title: str) -> Panel:
    """One manoeuvre's tracks."""
    marks: list[Mark] = []
    for run in runs:
        if run.key not in one.runs:
            continue
        x, y, t = (one.runs[run.key][name] for name in ("x", "y", "t"))
        marks.append(Line(y, x, dense(run.look)))
        places = np.unique([int(np.nanargmin(np.abs(t - at))) for at in _times(t, spacing)]).astype(int)
        marks.append(Dots(y[places], x[places], replace(run.look, size=4.0, marker=run.look.marker or "o")))
    first = next((one.runs[run.key] for run in runs if len(one.runs.get(run.key, {}).get("x", ()))), None)
    if first is not None:
        marks.append(Dots(first["y"][:1], first["x"][:1], Look("muted", marker="+", size=9.0)))
    return Panel(tuple(marks), Axis("east [m]"), Axis("north [m]"), title, 1.0, equal=True)


def _times(t: FloatArray, spacing: float) -> FloatArray:
    good = t[np.isfinite(t)]
    return np.arange(good[0], good[-1] + 1e-9, spacing) if len(good) else np.empty(0)


def _duration(motion: Motion) -> float:
    t = motion["t"][np.isfinite(motion["t"])]
    return float(t[-1] - t[0]) if len(t) else 0.0
