"""Inputs whose log was updated less often than written, and holds each value until the next update.

A log of orders looks the same, and is not: whether what is held was measured, the motion tells.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..inputs import INPUTS
from .kinematics import white_noise
from .model import Trial
from .schema import ATTRIBUTES

FEWEST = 4
"""Times between changes of a value that tell how often it is updated."""

ALIKE = 0.25
"""Share by which they may differ; a sample more or less does not count."""

UNEVEN = 3.0
"""Times the least of them that they may be where no usual one shows: a network passes messages on as it can."""

MOSTLY = 0.5
"""Share of them that must be alike: a rudder that stands still is logged as before for any time."""

CLEAR = 8.0
"""Deviations of the noise that a value changes by at an update: noise may have come in after the holding."""

REPEATED = 0.3
"""Share of samples that are those before to the last digit where no noise came in after the holding."""

LONGEST = 15.0
"""Time [s] between updates beyond which values that change are orders, one by one."""


@dataclass(frozen=True)
class Held:
    """How often inputs of a set of trials were updated, where that is less often than they were written.

    samples  from one update to the next, by input
    seconds  the same [s]
    """

    samples: Mapping[str, int]
    seconds: Mapping[str, float]

    @classmethod
    def of(cls, trials: Sequence[Trial]) -> Held | None:
        """What looks held in any input of these trials; None where nothing does."""
        samples, seconds = {}, {}
        for name in INPUTS:
            have = [trial for trial in trials if name in trial.columns]
            apart = [np.diff(_changes(trial.columns[name])) for trial in have]
            usual = _usual(np.concatenate(apart)) if apart else 0
            step = float(np.median(np.concatenate([np.diff(trial.t) for trial in have]))) if usual else 0.0
            if usual and usual * step <= LONGEST:
                samples[name], seconds[name] = usual, usual * step
        return cls(samples, seconds) if samples else None

    def updates(self, trial: Trial, name: str) -> IntArray:
        """Samples of a trial at which an input was updated, the first and the last among them.

        A value that did not change was updated too: as long before the next change as usual, and again before that.
        """
        if name not in self.samples:
            return np.arange(trial.n_samples)
        usual, last = self.samples[name], trial.n_samples - 1
        found = [0]
        for change in [*_changes(trial.columns[name]).tolist(), last]:
            between = np.arange(change - usual, found[-1] + usual // 2, -usual)[::-1]
            found += [*between.tolist(), change]
        return np.unique(found)

    def evenly(self, trial: Trial) -> Trial:
        """The trial with inputs that change evenly from one update to the next, not at once."""
        columns = trial.columns
        own: dict[str, FloatArray] = {}
        for name in self.samples:
            if name in columns:
                at = self.updates(trial, name)
                counts = np.diff(np.append(at, trial.n_samples))
                means = np.add.reduceat(columns[name], at) / counts
                means[-1] = means[-1] if at[-1] in _changes(columns[name]) else means[-2]
                own[name] = np.interp(trial.t, trial.t[at], means)
        extra = {name: own.get(name, values) for name, values in trial.extra.items()}
        main: dict[str, Any] = {ATTRIBUTES[name]: values for name, values in own.items() if name in ATTRIBUTES}
        return replace(trial, extra=extra, **main)

    @property
    def sentence(self) -> str:
        """What is held, in words."""
        names = " and ".join(f"{INPUTS[name].words} every {seconds:.3g} s" for name, seconds in self.seconds.items())
        return f"The log was updated less often than written, and holds old values in between: {names}"


def _changes(values: FloatArray) -> IntArray:
    """Samples at which a value differs from the one before by more than noise."""
    steps = np.abs(np.diff(values))
    noise = white_noise(values) if np.mean(steps == 0.0) < REPEATED else 0.0
    return np.flatnonzero(steps > CLEAR * noise) + 1


def _usual(apart: IntArray) -> int:
    """The usual number of samples between changes where it is more than one and most are alike; else 0."""
    if len(apart) < FEWEST:
        return 0
    low = float(np.quantile(apart, 0.1))
    if low < 2.0:
        return 0
    for alike in (np.abs(apart - low) <= max(1.0, ALIKE * low), apart <= UNEVEN * low):
        if alike.mean() >= MOSTLY:
            return int(np.median(apart[alike]))
    return 0
