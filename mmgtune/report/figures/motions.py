"""Tracks and time histories to move about in: the numbers that a page's script draws, small.

A page shows curves, so it has 16 bits of each number between the least and the greatest of its column; all samples, as
they were computed, are in the Parquet files of the run folder.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray
from ...trial.headings import unwrapped
from ..wording import CHANNELS, Channel
from .plot import DASHES_OF, Look

if TYPE_CHECKING:
    Motion = Mapping[str, FloatArray]

LIMIT = 2500
"""Samples of one motion that are drawn at most."""

BUDGET = 1_500_000
"""Numbers in a page at most: 2.7 letters each."""

_NONE = 65535
"""Stands for a gap."""


@dataclass(frozen=True)
class Run:
    """One of the motions of every manoeuvre: measured, or of a model.

    key    column of the motions
    truth  whether the others are held against this one
    """

    key: str
    words: str
    look: Look
    truth: bool = False


@dataclass(frozen=True)
class Manoeuvre:
    """What is drawn of one manoeuvre.

    runs     run -> column -> (n_samples,) in SI
    bands    run -> channel -> "low" and "high" at the times of its run
    regions  places of a region of positions: t, x, y and covariance xx, xy, yy
    note     what is said of it under its track
    """

    name: str
    runs: Mapping[str, Motion]
    bands: Mapping[str, Mapping[str, tuple[FloatArray, FloatArray]]] = field(default_factory=dict)
    regions: Sequence[Mapping[str, float]] = ()
    note: str = ""


FORCES = (
    Channel("X", "surge force", "kN", 1e-3, 1),
    Channel("Y", "sway force", "kN", 1e-3, 1),
    Channel("N", "yaw moment", "kN m", 1e-3, 1),
)
"""Of a model along its own run; of small ships in N."""


def payload(
    manoeuvres: Sequence[Manoeuvre], runs: Sequence[Run], inputs: Sequence[Channel], *, L_pp: float | None = None
) -> tuple[dict[str, Any], bool]:
    """What the page's script draws, and whether any motion had to be thinned.

    inputs   what drove the ship, columns of the motions
    L_pp     length of the ship [m], None where no outlines can be drawn
    """
    states = [CHANNELS[name] for name in ("psi", "u", "v_m", "r")]
    forces = forces_drawn(manoeuvres)
    channels = [*states, *inputs, *forces]
    columns = len(channels) + 2
    limit = max(120, min(LIMIT, BUDGET // max(1, columns * sum(len(one.runs) for one in manoeuvres))))
    found, thinned = [], False
    for one in manoeuvres:
        written: dict[str, Any] = {}
        for run in runs:
            if run.key in one.runs and len(one.runs[run.key]["t"]):
                written[run.key], cut = _written(one, run.key, channels, limit)
                thinned = thinned or cut
        found.append({"note": one.note, "runs": written, "regions": _regions(one.regions)})
    plan = {
        "L": L_pp,
        "channels": [
            {
                "name": channel.name,
                "words": channel.words,
                "unit": channel.unit,
                "group": "state" if channel in states else "force" if channel in forces else "input",
            }
            for channel in channels
        ],
        "runs": [
            {
                "key": run.key,
                "words": run.words,
                "color": run.look.color,
                "dash": DASHES_OF[run.look.dash],
                "truth": run.truth,
            }
            for run in runs
        ],
        "manoeuvres": found,
    }
    return plan, thinned


def forces_drawn(manoeuvres: Sequence[Manoeuvre]) -> list[Channel]:
    """The forces that any motion has, in N where they are small."""
    largest = 0.0
    for one in manoeuvres:
        for motion in one.runs.values():
            if "Y" in motion:
                good = np.abs(motion["Y"][np.isfinite(motion["Y"])])
                largest = max(largest, float(good.max()) if len(good) else 0.0)
    if largest == 0.0:
        return []
    if largest >= 1e3:
        return list(FORCES)
    return [Channel(one.name, one.words, one.unit.replace("k", ""), 1.0, 2) for one in FORCES]


def _written(one: Manoeuvre, key: str, channels: Sequence[Channel], limit: int) -> tuple[dict[str, Any], bool]:
    """The columns of one motion, and whether it was thinned."""
    motion = one.runs[key]
    t = motion["t"]
    keep = spread([motion[name] for name in ("psi", "r", "u") if name in motion], len(t), limit)
    columns = {"t": packed(t[keep], steady=True)}
    for name in ("x", "y"):
        columns[name] = packed(motion[name][keep])
    bands = one.bands.get(key, {})
    for channel in channels:
        if channel.name not in motion:
            continue
        values = motion[channel.name]
        turn = 0.0
        if channel.name == "psi":
            values = unwrapped(values)
            truth = unwrapped(one.runs.get("measured", next(iter(one.runs.values())))["psi"])
            turn = turns(values, truth) + _whole_turns(truth)
            values = values - turn
        columns[channel.name] = packed(values[keep] * channel.factor)
        if channel.name in bands:
            low, high = ((end - turn)[keep] * channel.factor for end in bands[channel.name])
            columns[f"{channel.name}<"], columns[f"{channel.name}>"] = packed(low), packed(high)
    return columns, len(keep) < len(t)


def packed(values: FloatArray, *, steady: bool = False) -> dict[str, Any]:
    """Numbers as 16 bits each between the least and the greatest, in base64; as start and step where they are steady.

    The error is at most 1/130,000 of their span.
    """
    good = np.isfinite(values)
    if steady and len(values) > 1 and good.all():
        steps = np.diff(values)
        if np.allclose(steps, steps[0], rtol=1e-6, atol=1e-9):
            return {"n": len(values), "o": _plain(values[0]), "s": _plain(steps[0])}
    low, high = (float(values[good].min()), float(values[good].max())) if good.any() else (0.0, 0.0)
    step = (high - low) / (_NONE - 1) or 1.0
    codes = np.full(len(values), _NONE, dtype="<u2")
    codes[good] = np.round((values[good] - low) / step).astype("<u2")
    return {"o": _plain(low), "s": _plain(step), "d": base64.b64encode(codes.tobytes()).decode("ascii")}


def unpacked(found: Mapping[str, Any]) -> FloatArray:
    """The numbers again, (n,), NaN in gaps: what the page's script does, for those who read a page in Python."""
    if "d" not in found:
        return np.asarray(found["o"] + found["s"] * np.arange(found["n"]), dtype=np.float64)
    codes = np.frombuffer(base64.b64decode(found["d"]), dtype="<u2")
    return np.where(codes == _NONE, np.nan, found["o"] + found["s"] * codes.astype(np.float64))


def _plain(value: float) -> float:
    return float(f"{value:.8g}")


def _regions(marks: Sequence[Mapping[str, float]]) -> list[list[float]]:
    names = ("t", "x", "y", "xx", "xy", "yy")
    return [[float(f"{mark[name]:.5g}") for name in names] for mark in marks if all(_known(mark.get(n)) for n in names)]


def _known(value: Any) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def spread(columns: Sequence[FloatArray], size: int, limit: int) -> npt.NDArray[np.intp]:
    """Indices of at most about ``limit`` of ``size`` samples: evenly, and the least and the greatest of every stretch.

    So no peak of any column is lost.
    """
    if size <= limit or not columns:
        return np.arange(size) if size <= limit else np.unique(np.linspace(0, size - 1, limit).astype(np.intp))
    keep = [np.linspace(0, size - 1, limit // 2).astype(np.intp)]
    stretches = max(1, limit // (4 * len(columns)))
    edges = np.linspace(0, size, stretches + 1).astype(np.intp)
    for values in columns:
        for first, last in pairwise(edges):
            part = values[first:last]
            if np.isfinite(part).any():
                keep.append(np.array([first + np.nanargmin(part), first + np.nanargmax(part)], dtype=np.intp))
    return np.unique(np.concatenate(keep))


def _whole_turns(psi: FloatArray) -> float:
    """The turns a heading has behind it where it begins [rad], as after days at sea."""
    first = psi[np.isfinite(psi)][:1]
    return float(2.0 * math.pi * np.trunc(first[0] / (2.0 * math.pi))) if len(first) else 0.0


def turns(psi: FloatArray, reference: FloatArray) -> float:
    """The whole turns by which one heading starts off another [rad]."""
    size = min(len(psi), len(reference))
    both = np.flatnonzero(np.isfinite(psi[:size]) & np.isfinite(reference[:size]))
    if not len(both):
        return 0.0
    return float(2.0 * math.pi * np.round((psi[both[0]] - reference[both[0]]) / (2.0 * math.pi)))
