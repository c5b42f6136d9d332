"""Logs of single runs that show another motion than all others: a sign turned, a sensor that stood, another scale."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...backends import STATES
from ...phrases import listed
from ...trial import Trial

MISREADABLE = {"u": "surge velocity", "v_m": "sway velocity", "r": "yaw rate"}
"""Channels whose log says nothing of another channel's, in words."""

FAR = 4.0
"""Times what is left in a channel of a run must exceed the white noise there, what is left in each other channel of the
run, and in the channel in most runs, for its log to be wrong."""

BY_FACTOR = 0.5
"""Share of that error which another factor leaves at most where the log is off by that."""

STANDS = 0.1
"""Factor below which a log stands still, and tells nothing of the beginning."""

NAMED = 3
"""Runs up to which each is named."""

OF_ALL_ELSE = "times the motion that all else shows"

Misread = Mapping[str, Mapping[str, float | None]]
"""By channel and run, how many times the motion its log shows; None where it is no factor that is off."""


def misread_in(trials: Sequence[Trial], residuals: Sequence[FloatArray], level: FloatArray) -> Misread:
    """The logs that are off in single runs.

    residuals  simulated less measured by trial, (n_samples, 6), NaN in gaps
    level      (6,) deviation of the white noise of the channels
    """
    left = np.array([slow(values, level) for values in residuals])
    found: dict[str, dict[str, float | None]] = {}
    for name in MISREADABLE:
        k = STATES.index(name)
        usual = float(np.median(left[:, k]))
        for trial, values, own in zip(trials, residuals, left, strict=True):
            if own[k] <= FAR * max(1.0, float(np.delete(own, k).max())):
                continue
            factor, rest = _by_factor(trial.motion[:, k], values[:, k])
            scaled = slow(rest[:, None], level[k : k + 1])[0] < BY_FACTOR * own[k]
            if scaled or own[k] > FAR * usual:
                found.setdefault(name, {})[trial.id] = factor if scaled else None
    return found


def is_of_few(misread: Misread, n_runs: int) -> bool:
    """Whether each of these logs is off in fewer than half of the runs: the others show what is right."""
    return bool(misread) and all(2 * len(runs) < n_runs for runs in misread.values())


def without(trial: Trial, misread: Misread) -> Trial:
    """The trial with gaps in place of what is misread; it begins with what a log shows then, put right where that is
    possible."""
    kept: dict[str, Any] = {}
    for name in (name for name, runs in misread.items() if trial.id in runs):
        first, factor = getattr(trial, name)[0], misread[name][trial.id]
        kept[name] = np.full(trial.n_samples, np.nan)
        kept[name][0] = first / factor if factor is not None and abs(factor) > STANDS else first
    return replace(trial, **kept) if kept else trial


def slow(values: FloatArray, level: FloatArray) -> FloatArray:
    """(n_channels,) deviation of residuals (n_samples, n_channels) beyond white noise of their own, over a level; 0 of
    what was not measured."""
    known = np.isfinite(values[1:])
    squares = np.where(known, values[1:], 0.0) ** 2
    bends = np.diff(values, n=2, axis=0)
    bent = np.where(np.isfinite(bends), bends, 0.0) ** 2
    counted, compared = np.maximum(known.sum(axis=0), 1), np.maximum(np.isfinite(bends).sum(axis=0), 1)
    beyond = squares.sum(axis=0) / counted - bent.sum(axis=0) / compared / 6.0
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.sqrt(np.maximum(beyond, 0.0)) / level
    return np.where(np.isfinite(found), found, 0.0)


def _by_factor(measured: FloatArray, off: FloatArray) -> tuple[float, FloatArray]:
    """How many times the motion a log shows (n_samples,), and what it is off by besides."""
    motion = measured + off
    known = np.isfinite(motion)
    factor = float(measured[known] @ motion[known]) / max(float(motion[known] @ motion[known]), 1e-300)
    return factor, measured - factor * motion


def in_words(misread: Misread) -> str:
    """What logs show in single runs as a sentence without its full stop; "" where none is off."""
    return "; ".join(_of_channel(MISREADABLE[name], runs) for name, runs in misread.items())


def _of_channel(log: str, runs: Mapping[str, float | None]) -> str:
    factors = {id: factor for id, factor in runs.items() if factor is not None}
    others = [id for id in runs if id not in factors]
    told = [f"{_times(factor)} {OF_ALL_ELSE} in {id}" for id, factor in factors.items()]
    if len(factors) > NAMED:
        least, most = min(factors.values()), max(factors.values())
        told = [f"{_times(least)} to {_times(most)} {OF_ALL_ELSE} in {len(factors)} runs"]
    if others:
        told.append(
            f"another motion than all else in {listed(others) if len(others) <= NAMED else f'{len(others)} runs'}"
        )
    return f"the log of the {log} shows {listed(told)}"


def _times(factor: float) -> str:
    """To two decimals, without a zero that is negative."""
    return f"{round(factor, 2) + 0.0:.2f}"
