"""Static figures of the motions: the tracks on the water, and how far off them the simulation is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from .drawing import LINES, MUTED, grid_of, legend_above, thinned
from .wording import CHANNELS, Channel, clean

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Motion = Mapping[str, FloatArray]

WORDS = {"measured": "measured", "before": "before tuning", "after": "after tuning"}
ROLES = {"tune": "tuned on", "test": "test", "other": "not used"}
PANELS = 16
SHOWN = ("psi", "u", "v_m", "r")
"""Motions shown over time; positions are seen in the tracks."""


def chosen(results: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The trials to draw: all of them, or of many the ones that fit worst, in the data set's order."""
    if len(results) <= PANELS:
        return list(results)
    worst = sorted(results, key=lambda row: -(row.get("J_after") or 0.0))[:PANELS]
    return [row for row in results if row in worst]


def tick_spacing(results: Sequence[Mapping[str, Any]], motions: Mapping[str, Mapping[str, Motion]]) -> float:
    """Seconds between the time marks on the tracks: a minute, or more for long trials."""
    longest = max((_duration(motions.get(str(row["id"]), {}).get("measured")) for row in results), default=0.0)
    return next((step for step in (60.0, 120.0, 300.0, 600.0, 1800.0) if longest / step <= 25.0), 3600.0)


def draw_tracks(
    results: Sequence[Mapping[str, Any]],
    motions: Mapping[str, Mapping[str, Motion]],
    words: Mapping[str, str] = WORDS,
) -> Figure:
    """Tracks of every trial, north up and east to the right, with marks at equal times."""
    figure, axes = grid_of(len(results), (3.0, 3.1))
    spacing = tick_spacing(results, motions)
    for ax, row in zip(axes, results, strict=True):
        _track(ax, motions.get(str(row["id"]), {}), spacing)
        ax.set_title(_title(row), wrap=True)
    figure.supxlabel("east [m]", fontsize=9)
    figure.supylabel("north [m]", fontsize=9)
    legend_above(figure, dict(words))
    return figure


def draw_distances(
    results: Sequence[Mapping[str, Any]],
    motions: Mapping[str, Mapping[str, Motion]],
    words: Mapping[str, str] = WORDS,
) -> Figure:
    """Distance between the simulated and the measured position over time, for every trial."""
    import numpy as np

    figure, axes = grid_of(len(results), (3.0, 1.85))
    for ax, row in zip(axes, results, strict=True):
        found = motions.get(str(row["id"]), {})
        measured = found.get("measured")
        for which in ("before", "after"):
            if measured is None or which not in found:
                continue
            t, distance = distance_from(found[which], measured)
            part = thinned(t)
            style = {**LINES[which], "marker": "." if len(t) < 3 else None}
            ax.plot(t[part], distance[part], **style)
        ax.set_ylim(bottom=0.0)
        ax.set_title(_title(row), wrap=True)
        if measured is not None and len(measured["t"]) and np.isfinite(measured["t"]).any():
            ax.margins(x=0.02)
    figure.supxlabel("time [s]", fontsize=9)
    figure.supylabel("distance off [m]", fontsize=9)
    legend_above(figure, {"before": words["before"], "after": words["after"]})
    return figure


def draw_histories(found: Mapping[str, Motion], inputs: Sequence[Channel]) -> Figure:
    """Motions and inputs of one trial over time."""
    panels = [*(CHANNELS[name] for name in SHOWN), *inputs]
    figure, axes = grid_of(len(panels), (3.6, 1.9))
    for ax, channel in zip(axes, panels, strict=True):
        for which in ("measured",) if channel in inputs else ("measured", "before", "after"):
            if which in found:
                t, values = found[which]["t"], found[which][channel.name] * channel.factor
                part = thinned(t, 1200)
                ax.plot(
                    t[part], values[part], **{**LINES[which], "marker": "o" if len(t) < 3 else None, "linewidth": 1.1}
                )
        ax.set_title(channel.title)
    figure.supxlabel("time [s]", fontsize=9)
    legend_above(figure, WORDS)
    return figure


def distance_from(one: Motion, measured: Motion) -> tuple[FloatArray, FloatArray]:
    """Times and the distance of a simulated position from the measured one [m]."""
    import numpy as np

    t = measured["t"]
    x, y = onto(one, "x", t), onto(one, "y", t)
    return t, np.hypot(x - measured["x"], y - measured["y"])


def onto(motion: Motion, name: str, t: FloatArray) -> FloatArray:
    """A column of a motion at the times ``t``; NaN outside the motion."""
    import numpy as np

    own, values = motion["t"], motion[name]
    if own.shape == t.shape and np.allclose(own, t):
        return values
    good = np.isfinite(own) & np.isfinite(values)
    if not good.any():
        return np.full_like(t, math.nan)
    return np.interp(t, own[good], values[good], left=math.nan, right=math.nan)


def _track(ax: Axes, found: Mapping[str, Motion], spacing: float) -> None:
    """One trial's tracks."""
    import numpy as np

    for which, style in LINES.items():
        if which not in found:
            continue
        motion = found[which]
        x, y, t = motion["x"], motion["y"], motion["t"]
        part = thinned(x)
        line = {key: value for key, value in style.items() if key != "marker"}
        ax.plot(y[part], x[part], **line)
        marks = np.unique([int(np.nanargmin(np.abs(t - at))) for at in _times(t, spacing)]).astype(int)
        ax.plot(y[marks], x[marks], linestyle="none", marker=style["marker"], markersize=2.8, color=style["color"])
    measured = found.get("measured")
    if measured is not None and len(measured["x"]):
        ax.plot(measured["y"][:1], measured["x"][:1], marker="+", markersize=9, color=MUTED, linestyle="none")
    ax.set_aspect("equal", adjustable="datalim")
    ax.locator_params(nbins=5)


def _times(t: FloatArray, spacing: float) -> FloatArray:
    import numpy as np

    good = t[np.isfinite(t)]
    return np.arange(good[0], good[-1] + 1e-9, spacing) if len(good) else np.empty(0)


def _duration(motion: Motion | None) -> float:
    if motion is None or not len(motion["t"]):
        return 0.0
    return float(motion["t"][-1] - motion["t"][0])


def _title(row: Mapping[str, Any]) -> str:
    name = clean(row["id"])
    name = name if len(name) <= 24 else name[:23] + "…"
    return f"{name} ({ROLES.get(str(row.get('role')), 'not used')})"
