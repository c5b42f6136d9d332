"""What a diagnosis does not name: traces too small to matter, and where an error lives that nothing explains."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .common import picture
from .drawing import AFTER, BEFORE, BOX, GRID, INK, MUTED, Drawn, new_figure
from .page import Block, Details, Prose, Section, Table, cells
from .wording import CHANNELS, NONE, clean, index_words, number, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_AXES = {"X": "surge force X\u2032", "Y": "sway force Y\u2032", "N": "yaw moment N\u2032"}
_COLOURS = {"X": INK, "Y": AFTER, "N": BEFORE}
_PHASES = {"before": "before the first order", "entry": "entry", "checking": "checking", "steady": "steady"}
_QUANTITIES = {
    "heading": ("heading [deg]", 180.0 / math.pi),
    "drift": ("drift angle [deg]", 180.0 / math.pi),
    "yaw_rate": ("yaw rate r L/U [\u2013]", 1.0),
    "rudder": ("rudder angle [deg]", 180.0 / math.pi),
    "ordered": ("log(1 + ship lengths since the last order)", 1.0),
    "speed": ("speed [m/s]", 1.0),
    "time": ("time [s]", 1.0),
    "north": ("position north [m]", 1.0),
    "east": ("position east [m]", 1.0),
    "wind_angle": ("angle of the measured wind off the bow [deg]", 180.0 / math.pi),
    "wind_speed": ("speed of the measured wind [m/s]", 1.0),
}
"""Quantities forces are held against: title, factor from SI."""

_BARS = 10
"""Runs and effects drawn."""

_MILLI = 1e3
"""Prime forces are drawn in thousandths."""


def traces(data: Mapping[str, Any]) -> list[Block]:
    """What is statistically there and changes nothing that a user would notice, folded away; nothing without any."""
    listed = data.get("traces") or []
    if not listed:
        return []
    rows = []
    for trace in listed:
        found = trace["contribution"]
        share = found["share_held_out"]
        rows.append(
            cells(
                clean(trace["sentence"]),
                NONE if share is None else f"{100.0 * share:.2g} %",
                _largest(found["error_over_noise"], 100.0, " %", {name: one.words for name, one in CHANNELS.items()}),
                _largest(found["index_changes"], 1.0, "", {}),
            )
        )
    table = Table(
        "traces-table",
        "What is there by the statistics and would not be noticed: share of the error removed on held-out trials, the "
        "largest error it removes in a channel over the variance of its noise, the largest change of an index",
        ("trace", "share removed", "largest in a channel", "largest change of an index"),
        tuple(rows),
        (1,),
    )
    return [Details(f"Traces ({len(listed)}), in no profile", (table,))]


def _largest(values: Mapping[str, float], factor: float, unit: str, words: Mapping[str, str]) -> str:
    """The largest of some values with its name; lengths as a share of them."""
    if not values:
        return NONE
    name = max(values, key=lambda one: values[one])
    told, of = index_words(name) if name not in words else (words[name], "")
    if name not in words and of != "deg":
        factor, unit = 100.0, " %"
    return f"{clean(told)} {shown(factor * values[name], 2)}{unit or (' ' + of)}"


def section(data: Mapping[str, Any], drawings: dict[str, Drawn]) -> Section | None:
    """Where an error lives that nothing explains; None where something does, and for records of older versions."""
    found = data.get("whereabouts")
    if not found:
        return None
    blocks: list[Block] = [Prose(tuple(clean(text) for text in found["sentences"]), listed=True)]

    def draw(name: str, title: str, caption: str, figure: Any, *tables: Table) -> None:
        drawings[name] = Drawn(name, title, figure)
        blocks.append(picture(drawings[name], title, caption, *tables))

    if found["runs"]:
        draw(
            "where-and-when",
            "Which runs, and when in them",
            "Share of the error of the motion beyond noise by run; residual force over its noise by part of a run.",
            lambda: _draw_where(found),
            _phase_table(found),
        )
    if found["curves"]:
        draw(
            "against-what",
            "Residual forces against what they follow most",
            "Averages over a ship length: mean in bins of equal numbers, their scatter (bars), and what noise of the "
            "sensors makes of such an average (band).",
            lambda: _draw_curves(found["curves"]),
            _follow_table(found),
        )
    if found["histories"]:
        draw(
            "force-histories",
            "Residual forces over time in the worst runs",
            "Averaged over the time of a ship length; the yaw moment ten times. Shaded: checking, the rudder against "
            "the turn. Dotted: rudder angle, on the scale of the right.",
            lambda: _draw_histories(found["histories"]),
        )
    if found["removable"]:
        rows = list(found["removable"].items())[:_BARS]
        draw(
            "removable",
            "What each known cause would remove at most",
            "Each refitted alone, with targets and initial states; together they remove less than the sum.",
            lambda: _draw_bars(
                [name for name, _ in rows], [share for _, share in rows], "share of the error beyond noise"
            ),
        )
    return Section("whereabouts", "Where the error lives", tuple(blocks))


def _phase_table(found: Mapping[str, Any]) -> Table:
    return Table(
        "phases-table",
        "Mean square of residual forces beyond noise, over that of the noise, by part of a run",
        ("when", "share of the time", *_AXES.values()),
        tuple(
            cells(
                _PHASES.get(name, clean(name)),
                f"{100.0 * found['share_of_time'][name]:.0f} %",
                *(shown(of.get(axis), 3) for axis in _AXES),
            )
            for name, of in found["phases"].items()
        ),
        (1, 2, 3, 4),
    )


def _follow_table(found: Mapping[str, Any]) -> Table:
    names = list(dict.fromkeys(name for shares in found["follows"].values() for name in shares))
    return Table(
        "follows-table",
        "Share of the variance of each residual force that one quantity alone predicts, on stretches left out",
        ("force", *(_QUANTITIES.get(name, (clean(name), 1.0))[0].partition(" [")[0] for name in names)),
        tuple(
            cells(_AXES.get(axis, axis), *(f"{100.0 * shares[name]:.0f} %" for name in names))
            for axis, shares in found["follows"].items()
        ),
        tuple(range(1, 1 + len(names))),
    )


def _draw_where(found: Mapping[str, Any]) -> Figure:
    runs = list(found["runs"].items())[:_BARS]
    figure = new_figure(7.6, max(0.27 * len(runs), 1.6) + 0.9)
    left, right = figure.subplots(1, 2)
    _bars(left, [name for name, _ in runs], [share for _, share in runs], "share of the error beyond noise")
    phases = found["phases"]
    width = 0.26
    for k, (axis, words) in enumerate(_AXES.items()):
        sizes = [math.sqrt(max(number(of.get(axis)) or 0.0, 0.0)) for of in phases.values()]
        at = np.arange(len(sizes)) + (k - 1) * width
        right.barh(at, sizes, height=width, color=_COLOURS[axis], label=words)
    right.set_yticks(range(len(phases)), [_PHASES.get(name, name) for name in phases])
    right.set_ylim(len(phases) - 0.4, -0.6)
    right.set_xlabel("residual force over its noise")
    right.grid(axis="y", visible=False)
    if phases:
        figure.legend(loc="outside upper right", ncols=3)
    return figure


def _draw_bars(names: Sequence[str], shares: Sequence[float], what: str) -> Figure:
    figure = new_figure(7.6, 0.27 * len(names) + 0.8)
    _bars(figure.subplots(), names, shares, what)
    return figure


def _bars(ax: Axes, names: Sequence[str], shares: Sequence[float], what: str) -> None:
    ax.barh(
        range(len(names)), [100.0 * share for share in shares], height=0.62, color=[AFTER, *[MUTED] * (len(names) - 1)]
    )
    ax.set_yticks(range(len(names)), [clean(name)[-28:] for name in names])
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.set_xlim(0.0, None)
    ax.set_xlabel(f"{what} [%]")
    ax.grid(axis="y", visible=False)


def _draw_curves(curves: Mapping[str, Mapping[str, Any]]) -> Figure:
    figure = new_figure(7.6, 2.7)
    for ax, (axis, curve) in zip(figure.subplots(1, len(curves), squeeze=False)[0], curves.items(), strict=True):
        title, factor = _QUANTITIES.get(curve["quantity"], (clean(curve["quantity"]), 1.0))
        at = factor * np.array(curve["at"], dtype=float)
        mean, spread, noise = (_MILLI * np.array(curve[name], dtype=float) for name in ("mean", "spread", "noise"))
        ax.fill_between(at, -noise, noise, color=BOX, linewidth=0.0)
        ax.axhline(0.0, color=GRID, linewidth=1.0)
        ax.errorbar(
            at, mean, spread, color=_COLOURS.get(axis, INK), linewidth=1.4, marker="o", markersize=3.0, elinewidth=0.6
        )
        ax.set_xlabel(title)
        ax.set_title(f"{_AXES.get(axis, axis)} \u00b7 1000 ({100.0 * max(curve['share'], 0.0):.0f} %)")
    return figure


def _ten_times(axis: str, words: str) -> str:
    return f"{words} \u00d7 10" if axis == "N" else words


def _draw_histories(histories: Sequence[Mapping[str, Any]]) -> Figure:
    figure = new_figure(7.6, 1.7 * len(histories) + 0.5)
    for k, (ax, run) in enumerate(zip(figure.subplots(len(histories), 1, squeeze=False)[:, 0], histories, strict=True)):
        t = np.array(run["t"], dtype=float)
        against = np.array([phase == "checking" for phase in run["phase"]])
        largest = 0.0
        for axis, words in _AXES.items():
            force = (10.0 if axis == "N" else 1.0) * _MILLI * np.array(run[axis], dtype=float)
            largest = max(largest, float(np.quantile(np.abs(force), 0.98)))
            ax.plot(t, force, color=_COLOURS[axis], linewidth=1.0, label=_ten_times(axis, words) if k == 0 else None)
        largest = largest or 1.0
        ax.set_ylim(-1.15 * largest, 1.15 * largest)
        ax.fill_between(t, -1.15 * largest, 1.15 * largest, where=against.tolist(), color=BOX, linewidth=0.0)
        rudder = ax.twinx()
        rudder.plot(t, run["rudder_deg"], color=MUTED, linewidth=0.9, linestyle=(0, (1.2, 1.6)))
        rudder.set_ylabel("rudder [deg]")
        rudder.grid(visible=False)
        ax.set_title(clean(run["trial"]))
        ax.set_ylabel("thousandths")
    ax.set_xlabel("time [s]")
    figure.legend(loc="outside upper right", ncols=3)
    return figure
