"""Logs of single runs that show another motion than all others: a sign turned, a sensor that stood, another scale."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...backends import STATES
from ...phrases import listed
from ...trial import Trial
from ..bench.noise import white_level
from .logged import LOGGED

MISREADABLE = ("u", "v_m", "r")
"""Channels whose log says nothing of another channel's."""

FAR = 4.0
"""Times what is left in a channel of a run must exceed the white noise there, what is left in each other channel of the
run, and in the channel in most runs, for its log to be wrong."""

BY_FACTOR = 0.5
"""Share of that error which the run's own factor leaves at most where the log is off by that."""

MOST_RUNS = 0.7
"""Share of the runs of which one zero error must leave that little to be one of the sensor."""

STANDS = 0.1
"""Factor below which a log stands still, and tells nothing of the beginning."""

NAMED = 3
"""Runs up to which each is named."""

RUDDER, POSITION = "delta", "position"
"""What stands for the rudders of a run where their log is off, and for its positions."""

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
        shown = [_by_factor(trial.motion[:, k], values[:, k]) for trial, values in zip(trials, residuals, strict=True)]
        known = [factor for factor, _ in shown if factor is not None]
        usual, most = float(np.median(known)) if known else 1.0, float(np.median(left[:, k]))
        by_zero = _by_one_zero(trials, [motion for _, motion in shown], k, level[k])
        less = float(np.mean(by_zero < BY_FACTOR * left[:, k]))
        of_sensor = by_zero if less > MOST_RUNS else np.full(len(trials), np.inf)
        for trial, (factor, motion), values, alike in zip(trials, shown, left, of_sensor, strict=True):
            least = FAR * max(1.0, float(np.delete(values, k).max()))
            # What is the same in all runs is an error of the sensor, and may be a cause.
            own = min(values[k], alike, _slow(trial.motion[:, k] - usual * motion, level[k]))
            if factor is None or own <= least:
                continue
            scaled = _slow(trial.motion[:, k] - factor * motion, level[k]) < BY_FACTOR * own
            if scaled or own > FAR * most:
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


def both(one: Misread, other: Misread) -> Misread:
    """What one of two says is misread, and the other besides."""
    names = [name for name in (RUDDER, POSITION, *MISREADABLE) if name in one or name in other]
    return {name: {**one.get(name, {}), **other.get(name, {})} for name in names}


@dataclass(frozen=True, eq=False)
class LeftOut:
    """Logs that are misread, and the trials as logged by their ids."""

    misread: Misread
    trials: Mapping[str, Trial]

    def beside(self, others: LeftOut | None) -> LeftOut:
        """These and others, which were left out before."""
        if others is None:
            return self
        return LeftOut(both(self.misread, others.misread), {**self.trials, **others.trials})

    def as_all_else_shows(self, motions: Mapping[str, FloatArray]) -> Misread:
        """The logs with factors by the motion (n_samples, 6) of runs that a model shows which was fitted to all else;
        unchanged of runs that were not looked at whole."""
        return {name: {id: self._shown(name, id, motions) for id in runs} for name, runs in self.misread.items()}

    def _shown(self, name: str, id: str, motions: Mapping[str, FloatArray]) -> float | None:
        factor, logged, motion = self.misread[name][id], getattr(self.trials[id], name), motions.get(id)
        if factor is None or motion is None or len(motion) != len(logged):
            return factor
        return _by_factor(logged, motion[:, STATES.index(name)] - logged)[0]


def slow(values: FloatArray, level: FloatArray) -> FloatArray:
    """(n_channels,) deviation of residuals (n_samples, n_channels) beyond white noise of their own, over a level; 0 of
    what was not measured."""
    known = np.isfinite(values[1:])
    squares = np.where(known, values[1:], 0.0) ** 2
    beyond = squares.sum(axis=0) / np.maximum(known.sum(axis=0), 1) - white_level([values]) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.sqrt(np.maximum(beyond, 0.0)) / level
    return np.where(np.isfinite(found), found, 0.0)


def _slow(values: FloatArray, level: float) -> float:
    """Likewise of one channel (n_samples,)."""
    return float(slow(values[:, None], np.array([level]))[0])


def _by_one_zero(trials: Sequence[Trial], motions: Sequence[FloatArray], k: int, level: float) -> FloatArray:
    """(n_runs,) what is left in channel k of each run with one zero error for all, as ``slow`` has it."""
    off = [trial.motion[:, k] - motion for trial, motion in zip(trials, motions, strict=True)]
    zeros = [float(np.mean(one[np.isfinite(one)])) for one in off if np.isfinite(one).any()]
    zero = float(np.median(zeros)) if zeros else 0.0
    return np.array([_slow(one - zero, level) for one in off])


def _by_factor(measured: FloatArray, off: FloatArray) -> tuple[float | None, FloatArray]:
    """How many times the motion a log shows, None where there is no motion, and that motion (n_samples,)."""
    motion = measured + off
    known = np.isfinite(motion)
    whole = float(motion[known] @ motion[known])
    return (float(measured[known] @ motion[known]) / whole if whole > 0.0 else None), motion


def in_words(misread: Misread) -> str:
    """What logs show in single runs as a sentence without its full stop; "" where none is off."""
    logs = {**LOGGED, POSITION: POSITION}
    return "; ".join(
        _of_rudders(list(runs)) if name == RUDDER else _of_channel(logs[name], runs) for name, runs in misread.items()
    )


def _of_rudders(runs: Sequence[str]) -> str:
    """That a sign is turned, and was put right."""
    told = listed(runs) if len(runs) <= NAMED else f"{len(runs)} runs"
    return f"the rudder angle is logged with the other sign in {told}, and taken with that of all other runs"


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
