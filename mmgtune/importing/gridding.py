"""Every quantity on one uniform time axis; holes stay holes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, runs_of_true
from ..errors import LogError, OptionError, Problem, brief
from ..limits import as_float, is_real, too_fine
from ..phrases import listed
from .maps.mapping import LogMap
from .maps.quantities import MEASURED, meaning
from .record import Record, Series

FEWEST = 20
"""Samples below which a stretch is no trial."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Quantities on a uniform time axis.

    t        (n_samples,) [s], on the log's clock
    columns  (n_samples,) by quantity; NaN in holes
    step     [s]
    bridged  number of samples interpolated over short holes, by quantity; of motions those of missing rows alone
    """

    t: FloatArray
    columns: dict[str, FloatArray]
    step: float
    bridged: dict[str, int]


def require_step(step: object) -> None:
    """Raises OptionError for what is no time step [s] of trials; None is the map's, or the log's own."""
    if step is None:
        return
    if not is_real(step):
        why, fix = "it is in seconds", "give a number, such as step=0.5"
        raise OptionError(Problem(f"the step is {brief(step)}, not a number", "step", why, fix))
    if not 0.0 < as_float(step) < math.inf:
        why, fix = "samples follow one another", "give a time above 0 s, or leave it out"
        raise OptionError(Problem(f"the step is {brief(step)}", "step", why, fix))


def on_grid(record: Record, log_map: LogMap, step: float | None) -> Grid:
    """A record on a uniform time axis, that of its positions unless a step is asked for.

    Holes longer than ``log_map.gap`` steps (of the series or of the grid, whichever are longer) become NaN, as do
    spikes of the motion; shorter ones are bridged linearly.  Where the grid is coarser than the series,
    samples are averaged.  Constants of the map are added.  The heading begins within half a turn of north.

    Raises LogError where there is no time that all inputs cover, and where the step would make more samples than there
    may be.
    """
    series = record.series
    constant = {name for name, source in log_map.sources.items() if source.value is not None}
    logged = [name for name in log_map.inputs if name not in log_map.means]
    absent = [name for name in ("x", "y", "psi", *logged) if name not in series and name not in constant]
    if absent:
        what = f"the log has fewer than two valid samples of {', '.join(meaning(name) for name in absent)}"
        raise LogError(
            Problem(what, str(record.path), "a trial needs them", "log them, or give n and delta as constants")
        )
    lead = series["x"]
    finite = np.isfinite(lead.values)
    own = float(np.median(np.diff(lead.t))) if len(lead.t) > 1 else 0.0
    chosen = step or log_map.step or own
    motion = [series[name] for name in MEASURED if name in series]
    inputs = [series[name] for name in logged if name in series]
    begins = max(_ends(one)[0] for one in [*motion, *inputs])
    ends = min([max(_ends(one)[1] for one in motion), *(_ends(one)[1] for one in inputs)])
    if finite.sum() < FEWEST or chosen <= 0.0 or ends - begins < FEWEST * chosen:
        spans = ", ".join(
            f"{name} {_ends(series[name])[0]:.6g} to {_ends(series[name])[1]:.6g} s"
            for name in (*MEASURED, *logged)
            if name in series
        )
        why = f"positions, heading and inputs have {max(0.0, ends - begins):.4g} s in common: {spans}"
        raise LogError(Problem(f"fewer than {FEWEST} samples to make a trial of", str(record.path), why))
    first = float(lead.t[np.searchsorted(lead.t, begins - 1e-9)])
    rows = max(len(one.t) for one in series.values())
    if problem := too_fine((ends - first) / chosen, rows, chosen, str(record.path)):
        raise LogError(problem)
    count = int(np.floor((ends - first) / chosen + 1e-6)) + 1
    t: FloatArray = first + chosen * np.arange(count, dtype=np.float64)
    # A log that is uniform already keeps its own stamps, to the last bit.
    k = int(np.searchsorted(lead.t, first))
    if k + count <= len(lead.t) and np.abs(lead.t[k : k + count] - t).max() < 0.01 * chosen and chosen == own:
        t = np.array(lead.t[k : k + count])
    columns, bridged = {}, {}
    for name, one in series.items():
        driving = name in logged
        columns[name], filled = resampled(one, t, chosen, log_map.gap, keep_spikes=not driving)
        if filled:
            bridged[name] = filled
    start = columns["psi"][np.isfinite(columns["psi"])][:1]
    if len(start) and abs(start[0]) > np.pi:
        columns["psi"] = columns["psi"] - 2.0 * np.pi * np.round(start[0] / (2.0 * np.pi))
    for name, source in log_map.sources.items():
        if source.value is not None:
            columns[name] = np.full(len(t), source.value)
    return Grid(t, columns, chosen, bridged)


def resampled(one: Series, t: FloatArray, step: float, gap: float, keep_spikes: bool) -> tuple[FloatArray, int]:
    """A series at times ``t`` (n_samples,), uniform by ``step`` [s], and how many samples were bridged.

    gap          holes longer than this many steps become NaN
    keep_spikes  whether single missing samples stay NaN rather than being bridged
    """
    known = np.isfinite(one.values)
    times, values = one.t[known], one.values[known]
    own = one.step
    if len(times) < 2:
        return np.full(len(t), np.nan), 0
    if step > 1.5 * own:
        bins = np.round((times - t[0]) / step).astype(np.int64)
        inside = (bins >= 0) & (bins < len(t))
        number = np.bincount(bins[inside], minlength=len(t))
        total = np.bincount(bins[inside], weights=values[inside], minlength=len(t))
        moment = np.bincount(bins[inside], weights=times[inside], minlength=len(t))
        there = number > 0
        # A mean belongs to the mean time of its samples.
        times, values = moment[there] / number[there], total[there] / number[there]
    out = np.interp(t, times, values)
    if keep_spikes and step > 1.5 * own and len(times) > 1:
        # Only half a step of samples lies beside the first and the last time: their mean belongs further inside.
        for end, inner, outside in ((0, 1, t < times[0]), (-1, -2, t > times[-1])):
            if abs(times[inner] - times[end]) < 1.6 * step:
                slope = (values[inner] - values[end]) / (times[inner] - times[end])
                out[outside] += slope * (t[outside] - times[end])
    right = np.clip(np.searchsorted(times, t - 1e-6 * step), 0, len(times) - 1)
    left = np.clip(right - 1, 0, None)
    on_sample = np.abs(times[right] - t) < 0.01 * step
    hole = (times[right] - times[left] > gap * max(own, step) * (1.0 + 1e-6)) & ~on_sample
    hole |= (t < times[0] - 0.51 * max(own, step)) | (t > times[-1] + 0.51 * max(own, step))
    if keep_spikes and not known.all() and step <= 1.5 * own:
        missing = one.t[~known]
        nearest = np.clip(np.round((missing - t[0]) / step).astype(np.int64), 0, len(t) - 1)
        hole[nearest[np.abs(t[nearest] - missing) <= 0.5 * step]] = True
    out[hole] = np.nan
    bridged = int((~on_sample & ~hole & (times[right] - times[left] > 1.5 * max(own, step))).sum())
    return out, bridged


def stretches(columns: dict[str, FloatArray], inputs: Sequence[str], fewest: int = FEWEST) -> list[slice]:
    """Parts of a grid in which every input is known, each from its first complete sample; short ones left out."""
    good = np.all([np.isfinite(columns[name]) for name in inputs], axis=0)
    complete = good & np.all([np.isfinite(columns[name]) for name in MEASURED], axis=0)
    found = []
    for first, last in runs_of_true(good):
        rows = np.flatnonzero(complete[first:last])
        if len(rows) >= fewest:
            found.append(slice(first + int(rows[0]), first + int(rows[-1]) + 1))
    return found


def missing_between(t: FloatArray, columns: dict[str, FloatArray], inputs: Sequence[str], apart: slice) -> str:
    """Which inputs have no value between two stretches, where and for how long, as the end of "cut where ..."."""
    step = float(np.median(np.diff(t)))
    gone: dict[tuple[int, float], list[str]] = {}
    for name in inputs:
        rows = np.flatnonzero(~np.isfinite(columns[name][apart]))
        if len(rows):
            gone.setdefault((len(rows), float(t[apart][rows[0]])), []).append(name)
    said = [
        f"{listed(names)} {'is' if len(names) == 1 else 'are'} missing for {count * step:.4g} s "
        f"(from {first:.12g} s of the log)"
        for (count, first), names in gone.items()
    ]
    return " and ".join(said)


def _ends(one: Series) -> tuple[float, float]:
    """First and last time [s] with a value."""
    t = one.t[np.isfinite(one.values)]
    return (float(t[0]), float(t[-1])) if len(t) else (float("inf"), float("-inf"))
