"""Where the range of a sensor ends: a yaw rate that goes no further, however fast the heading turns, and a speed ahead
that goes no further, however fast the positions move."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...physics.frame import to_ship
from ..kinematics import Reading, halfway, middle, position_misfits, stretch_of
from ..model import Trial
from ..schema import ATTRIBUTES

STRETCHES, SHORTEST = 60, 5
"""Stretches that a record is cut into to hold a channel against another, and samples that one has at least."""

BEYOND, SO_MANY = 1.1, 4
"""How many times as fast as its log the ship goes where that has ended, and stretches in which she does."""

FASTEST = 5.0
"""How many times as fast she may go: more is a wrong unit."""

BETTER = 0.35
"""Error of a channel with an end, as a share of that of one with another scale, up to which it has an end."""

AGREES = 0.15
"""Deviation from what is told otherwise, as a share of its end, up to which a channel follows that until there."""

FROM = 4.0
"""Deviations below its end from which samples of a channel are taken to be at it."""

APPROACH = 20.0
"""Time [s] over which positions tell the speed that a run begins with."""


@dataclass(frozen=True)
class End:
    """The end of the range of a channel.

    value      largest that its log shows, of either sign [the channel's unit]
    deviation  of means over stretches there
    samples    of such a stretch
    """

    value: float
    deviation: float
    samples: float

    @property
    def begins(self) -> float:
        """Size from which samples of the channel are taken to be at its end."""
        return self.value - FROM * self.deviation * float(np.sqrt(self.samples))


def ends_of(trials: Iterable[Trial]) -> dict[str, End]:
    """Channels of the motion, "u" and "r", whose log ends somewhere, seen in all of these trials together.

    What the heading and the positions say is set beside the log in stretches of some seconds; a channel ends where a
    log that goes no further than a certain value misses far less of that than one with another scale.
    """
    every = list(trials)
    if not every:
        return {}
    samples = float(np.median([_stretch(one) for one in every]))
    ends: dict[str, End | None] = {}
    for name, by_stretch in (("u", _ways), ("r", _turns)):
        told, logged = (np.concatenate(parts) for parts in zip(*map(by_stretch, every), strict=True))
        ends[name] = _end(told, logged, samples)
    if ends["u"] is not None and 2 * sum(map(_stretched, every)) > len(every):
        del ends["u"]
    return {name: one for name, one in ends.items() if one is not None}


def without_ends(trial: Trial, ends: Mapping[str, End]) -> Trial:
    """The trial with gaps where its sensors are at their ends.

    A run that begins there begins with the speed that its positions tell.
    """
    kept: dict[str, Any] = {}
    for name, end in ends.items():
        values = trial.columns[name]
        at_end = np.abs(values) >= end.begins
        if at_end.any():
            kept[ATTRIBUTES[name]] = np.where(at_end, np.nan, values)
            if at_end[0]:
                kept[ATTRIBUTES[name]][0] = _at_first(trial) if name == "u" else values[0]
    return replace(trial, **kept) if kept else trial


def _at_first(trial: Trial) -> float:
    """The speed ahead [m/s] that a run begins with, by its positions."""
    rows = trial.t - trial.t[0] <= APPROACH
    rows &= np.isfinite(trial.x) & np.isfinite(trial.y)
    if rows.sum() < SHORTEST:
        return float(trial.u[0])
    t = trial.t[rows] - trial.t[0]
    degree = 1 if len(t) < 2 * SHORTEST else 2
    north, east = (np.polynomial.Polynomial.fit(t, of[rows], degree).deriv()(0.0) for of in (trial.x, trial.y))
    return float(to_ship(trial.psi[0], north, east)[0])


def _stretched(trial: Trial) -> bool:
    """Whether positions that are too long along one axis are why the ship seems to go faster than her log shows."""
    found, asked = stretch_of(trial.columns), position_misfits(trial.columns, among=(Reading.AS_ASKED,))
    return found is not None and found.explains(asked[Reading.AS_ASKED])


def _stretch(trial: Trial) -> int:
    """Samples of a stretch."""
    return max(SHORTEST, trial.n_samples // STRETCHES)


def _turns(trial: Trial) -> tuple[FloatArray, FloatArray]:
    """Mean yaw rates [rad/s] by heading and as logged, (n_stretches,) each, where both are known."""
    steps = middle(trial.r) * np.diff(trial.t)
    return _means(trial, np.diff(trial.psi), steps)


def _ways(trial: Trial) -> tuple[FloatArray, FloatArray]:
    """Mean speeds ahead [m/s] by positions and as logged, (n_stretches,) each, where both are known."""
    made = to_ship(halfway(trial.psi), np.diff(trial.x), np.diff(trial.y))[0]
    return _means(trial, made, middle(trial.u) * np.diff(trial.t))


def _means(trial: Trial, told: FloatArray, logged: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rates over stretches of increments (n_samples - 1,)."""
    n = _stretch(trial)
    first = np.arange(0, trial.n_samples - n, n)
    lasts = trial.t[first + n] - trial.t[first]
    known = np.isfinite(told) & np.isfinite(logged)
    sums = [np.array([of[k : k + n].sum() for k in first]) / lasts for of in (told, logged)]
    whole = np.array([known[k : k + n].all() for k in first], dtype=bool)
    return sums[0][whole], sums[1][whole]


def _end(told: FloatArray, logged: FloatArray, samples: float) -> End | None:
    """Where a log ends that goes as is told otherwise, by means over so many samples; None for nowhere."""
    way = float(told @ told)  # of numbers below 1e-160 it is none
    if len(told) < 2 * SO_MANY or not way > 0.0 or not np.any(logged):
        return None
    scale = float(told @ logged) / way
    ends = np.linspace(0.5, 1.05, 56) * np.abs(logged).max()
    left = np.sum((logged - np.clip(told, -ends[:, None], ends[:, None])) ** 2, axis=1)
    end = float(ends[int(np.argmin(left))])
    scaled = float(np.sum((logged - scale * told) ** 2))
    there = np.abs(told) > BEYOND * end
    most = min(BETTER**2 * scaled, len(told) * (AGREES * end) ** 2)
    far_beyond = float(np.max(np.abs(told))) > FASTEST * end
    if there.sum() < SO_MANY or far_beyond or float(left.min()) >= most:
        return None
    shown = np.abs(logged[there])
    return End(float(np.mean(shown)), float(np.std(shown)), samples)
