"""What a diagnosis does not name: traces too small to matter, and where an error lives that nothing explains."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..blocks import Block, Fold, Prose, Table, cells
from ..common import picture
from ..figures.plot import Area, Axis, Bar, Color, Dots, Figure, Line, Look, Mark, Panel, Rule
from ..wording import CHANNELS, NONE, clean, index_words, number, share, shown

_AXES = {"X": "surge force X\u2032", "Y": "sway force Y\u2032", "N": "yaw moment N\u2032"}
_COLOURS: dict[str, Color] = {"X": "ink", "Y": "after", "N": "before"}
_DASHES = {"X": Look("ink", 1.2), "Y": Look("after", 1.2, "dash"), "N": Look("before", 1.2, "dot")}
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
        removed = found["share_held_out"]
        rows.append(
            cells(
                clean(" or ".join([trace["sentence"], *trace.get("alike", ())])),
                NONE if removed is None else f"{100.0 * removed:.2g} %" if removed > 0.0 else "none",
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
    return [Fold(f"Traces ({len(listed)}), in no profile", (table,))]


def _largest(values: Mapping[str, float], factor: float, unit: str, words: Mapping[str, str]) -> str:
    """The largest of some values with its name; lengths as a share of them."""
    if not values:
        return NONE
    name = max(values, key=lambda one: values[one])
    told, of = index_words(name) if name not in words else (words[name], "")
    if name not in words and of != "deg":
        factor, unit = 100.0, " %"
    return f"{clean(told)} {shown(factor * values[name], 2)}{unit or (' ' + of)}"


def blocks(data: Mapping[str, Any]) -> list[Block]:
    """Where an error lives that nothing explains; nothing where something does, and for records of older versions."""
    found = data.get("whereabouts")
    if not found:
        return []
    made: list[Block] = [Prose(tuple(clean(text) for text in found["sentences"]), listed=True)]
    if found["runs"]:
        caption = "Share of the error beyond noise by run; residual force over its noise by part of a run."
        made.append(picture(_where(found), "Which runs, and when in them", caption, _phase_table(found)))
    if found["curves"]:
        caption = (
            "Averages over a ship length: mean in bins of equal numbers, their scatter (upright lines), and what noise "
            "of the sensors makes of such an average (band). In brackets the share of the force that this quantity "
            "alone predicts."
        )
        title = "Residual forces against what they follow most"
        made.append(picture(_curves(found["curves"]), title, caption, _follow_table(found)))
    if found["histories"]:
        caption = (
            "Averaged over the time of a ship length; the yaw moment ten times. Shaded: checking, the rudder against "
            "the turn."
        )
        title = "Residual forces over time in the worst runs"
        made.append(picture(_histories(found["histories"]), title, caption))
    if found["removable"]:
        names, shares = zip(*list(found["removable"].items())[:_BARS], strict=True)
        title = "What each known cause would remove at most"
        drawn = Figure("removable", title, (_bars(names, shares, "share of the error beyond noise"),))
        caption = "Each refitted alone, with targets and initial states; together they remove less than the sum."
        made.append(picture(drawn, title, caption))
    return made


def _phase_table(found: Mapping[str, Any]) -> Table:
    return Table(
        "phases-table",
        "Mean square of residual forces beyond noise, over that of the noise, by part of a run",
        ("when", "share of the time", *_AXES.values()),
        tuple(
            cells(
                _PHASES.get(name, clean(name)),
                share(found["share_of_time"][name]),
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
            cells(_AXES.get(axis, axis), *(share(shares[name]) for name in names))
            for axis, shares in found["follows"].items()
        ),
        tuple(range(1, 1 + len(names))),
    )


def _where(found: Mapping[str, Any]) -> Figure:
    runs = list(found["runs"].items())[:_BARS]
    names, shares = zip(*runs, strict=True)
    panels = [_bars(names, shares, "share of the error beyond noise", "By run")]
    phases = found["phases"]
    if phases:
        marks: list[Mark] = []
        for k, axis in enumerate(_AXES):
            for at, of in enumerate(phases.values()):
                size = math.sqrt(max(number(of.get(axis)) or 0.0, 0.0))
                middle = at + 0.26 * (k - 1)
                marks.append(Bar((0.0, size), (middle - 0.12, middle + 0.12), _COLOURS[axis]))
        ticks = tuple((float(k), _PHASES.get(name, clean(name))) for k, name in enumerate(phases))
        y = Axis(low=len(phases) - 0.4, high=-0.6, ticks=ticks, grid=False)
        x = Axis("residual force over its noise [–]", low=0.0)
        panels.append(Panel(tuple(marks), x, y, "By part of a run", shape=-_height(len(runs))))
    legend = tuple((words, (_COLOURS[axis], 1.0)) for axis, words in _AXES.items())
    return Figure("where-and-when", "Which runs, and when in them", tuple(panels), legend if phases else ())


def _height(n_rows: int) -> float:
    """Pixels of a panel of bars."""
    return max(25.0 * n_rows, 100.0) + 60.0


def _bars(names: Sequence[str], shares: Sequence[float], what: str, title: str = "") -> Panel:
    marks = tuple(
        Bar((0.0, 100.0 * of), (k - 0.31, k + 0.31), "flag" if k == 0 else "muted", 1.0 if k == 0 else 0.7)
        for k, of in enumerate(shares)
    )
    ticks = tuple((float(k), clean(name)[-28:]) for k, name in enumerate(names))
    y = Axis(low=len(names) - 0.4, high=-0.6, ticks=ticks, grid=False)
    return Panel(marks, Axis(f"{what} [%]", low=0.0), y, title, shape=-_height(len(names)))


def _curves(curves: Mapping[str, Mapping[str, Any]]) -> Figure:
    panels = []
    for axis, curve in curves.items():
        title, factor = _QUANTITIES.get(curve["quantity"], (clean(curve["quantity"]), 1.0))
        at = factor * np.array(curve["at"], dtype=float)
        mean, spread, noise = (_MILLI * np.array(curve[name], dtype=float) for name in ("mean", "spread", "noise"))
        look = Look(_COLOURS.get(axis, "ink"), 1.4, "", "o")
        marks: list[Mark] = [Area(at, -noise, noise), Rule(0.0, Look("muted", 1.0), upright=False)]
        for place, middle, wide in zip(at, mean, spread, strict=True):
            ends = (float(middle - wide), float(middle + wide))
            marks.append(Line((float(place), float(place)), ends, Look(look.color, 0.8)))
        marks += [Line(at, mean, Look(look.color, 1.4)), Dots(at, mean, look)]
        words = f"{_AXES.get(axis, clean(axis))} · 1000 ({share(curve['share'])})"
        panels.append(Panel(tuple(marks), Axis(title), Axis(), words))
    return Figure("against-what", "Residual forces against what they follow most", tuple(panels))


def _histories(histories: Sequence[Mapping[str, Any]]) -> Figure:
    """Forces, and under each run its rudder."""
    panels = []
    for run in histories:
        t = np.array(run["t"], dtype=float)
        forces = {axis: (10.0 if axis == "N" else 1.0) * _MILLI * np.array(run[axis], dtype=float) for axis in _AXES}
        largest = 1.15 * max([float(np.nanquantile(np.abs(force), 0.98)) for force in forces.values()]) or 1.0
        against = np.array([phase == "checking" for phase in run["phase"]])
        shade = np.where(against, largest, np.nan)
        marks: list[Mark] = [Area(t, -shade, shade)]
        marks += [Line(t, force, _DASHES[axis]) for axis, force in forces.items()]
        y = Axis("force · 1000 [–]", low=-largest, high=largest)
        panels.append(Panel(tuple(marks), Axis("time [s]"), y, clean(run["trial"])))
        rudder = Line(t, np.array(run["rudder_deg"], dtype=float), Look("muted", 1.2))
        panels.append(Panel((rudder,), Axis("time [s]"), Axis("rudder [deg]"), f"{clean(run['trial'])}: rudder"))
    legend = tuple((f"{words} × 10" if axis == "N" else words, _DASHES[axis]) for axis, words in _AXES.items())
    title = "Residual forces over time in the worst runs"
    return Figure("force-histories", title, tuple(panels), legend, 2)
