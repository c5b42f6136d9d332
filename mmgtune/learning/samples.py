"""Trials as a trainer reads them: on one time step, end to end in one table, with the places windows may begin at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..errors import OptionError, Problem, TrialError
from ..limits import too_fine
from ..networks.marching import WIND
from ..physics.quantities import HELD, Surroundings
from ..trial import Trial, surroundings

GAP = 2.5
"""Longest distance between measured samples that is interpolated over, in steps or in the trial's own samples."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Rows of all trials, one behind the other.

    states    (n_rows, 6), NaN where nothing was measured near
    controls  (n_rows, n_inputs)
    around    (n_rows, n_surroundings) in the order of ``Surroundings``; 0 where nothing was measured
    first     (n_trials + 1,) row at which each trial begins, and the end
    step      [s] between rows
    """

    trials: tuple[Trial, ...]
    states: FloatArray
    controls: FloatArray
    around: FloatArray
    first: IntArray
    step: float

    @property
    def whole(self) -> BoolArray:
        """(n_rows,) whether a row has all its states."""
        return np.asarray(np.isfinite(self.states).all(axis=1))

    @property
    def wind(self) -> FloatArray:
        """(n_rows, 2) velocity of the air over ground, north and east [m/s]."""
        return self.around[:, WIND]

    def starts(self, length: int) -> IntArray:
        """Rows at which ``length`` steps of complete rows of one trial begin."""
        found = []
        for begin, end in zip(self.first[:-1], self.first[1:], strict=True):
            whole = np.concatenate([[0], np.cumsum(self.whole[begin:end])])
            n = end - begin - length
            if n > 0:
                there = whole[length + 1 :] - whole[: -length - 1] == length + 1
                found.append(begin + np.flatnonzero(there))
        return np.concatenate(found) if found else np.zeros(0, dtype=np.int64)

    def kinds(self, rows: IntArray) -> list[str]:
        """Kind of manoeuvre of the trials that rows belong to."""
        of = np.searchsorted(self.first, rows, side="right") - 1
        return [self.trials[k].manoeuvre for k in of.tolist()]

    def spread(self) -> FloatArray:
        """(6,) standard deviation of each state over all rows: sigma of eq. 24."""
        return np.asarray(np.nanstd(self.states, axis=0))


def samples_of(trials: Sequence[Trial], inputs: Sequence[str], step: float, draught: float | None = None) -> Samples:
    """Trials on a common step [s], interpolated linearly.

    draught  of the ship [m], as for ``surroundings``
    Raises TrialError for a trial without one of the inputs, or too long for so short a step, OptionError where nothing
    can be learned from them.
    """
    states, controls, beside = [], [], []
    held = np.array([name in HELD for name in Surroundings._fields])
    first = [0]
    require_grids(trials, step)
    for trial in trials:
        grid = trial.t[0] + step * np.arange(int(trial.duration / step + 1e-6) + 1)
        states.append(np.column_stack([_measured(grid, trial.t, column, step) for column in trial.motion.T]))
        driven = trial.inputs(inputs)
        controls.append(np.column_stack([np.interp(grid, trial.t, column) for column in driven.T]))
        around = surroundings(trial, draught)
        linear = np.column_stack([np.interp(grid, trial.t, column) for column in around.T])
        last = np.clip(np.searchsorted(trial.t, grid, side="right") - 1, 0, None)
        beside.append(np.where(held, around[last], linear))
        first.append(first[-1] + len(grid))
    found = Samples(
        tuple(trials),
        np.vstack(states) if states else np.zeros((0, 6)),
        np.vstack(controls) if controls else np.zeros((0, len(inputs))),
        np.vstack(beside) if beside else np.zeros((0, len(held))),
        np.array(first),
        step,
    )
    spread = found.spread() if found.whole.any() else np.zeros(6)
    if not (spread > 0.0).all():
        raise OptionError(
            Problem(
                "there is nothing to learn from these trials",
                ", ".join(trial.id for trial in trials)[:200],
                "some state never varies, or is never measured",
                "give trials in which the ship speeds up, slows down and turns",
            )
        )
    return found


def require_grids(trials: Sequence[Trial], step: float) -> None:
    """Raises TrialError for trials of which far more samples would be made than they have, as by a time that jumps."""
    fix = "cut the trial where its time jumps, or give a longer step"
    found = (
        too_fine(trial.duration / step, trial.n_samples, step, str(trial.path or trial.id), fix) for trial in trials
    )
    if problems := [problem for problem in found if problem]:
        raise TrialError(*problems)


def own_step(trials: Sequence[Trial]) -> float:
    """Time between samples that most trials have [s]."""
    return float(np.median([np.median(np.diff(trial.t)) for trial in trials]))


def _measured(grid: FloatArray, t: FloatArray, values: FloatArray, step: float) -> FloatArray:
    """A channel on the grid; NaN where the measured samples about it are too far apart."""
    there = np.flatnonzero(np.isfinite(values))
    if len(there) < 2:
        return np.full(len(grid), np.nan)
    times = t[there]
    found = np.interp(grid, times, values[there], left=np.nan, right=np.nan)
    allowed = GAP * max(step, float(np.median(np.diff(t))))
    after = np.clip(np.searchsorted(times, grid), 1, len(times) - 1)
    exact = np.isclose(times[after], grid, rtol=0.0, atol=1e-9) | np.isclose(
        times[after - 1], grid, rtol=0.0, atol=1e-9
    )
    return np.where((times[after] - times[after - 1] <= allowed) | exact, found, np.nan)
