"""Windows scored many at a time: the numbers of ``evaluation`` and ``measures`` without a record for each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..backends import STATES, Cases
from ..measures import distances
from ..objective import make_objective
from ..predictor import Predictor, cases_from, predicted
from ..trial import Trial
from .features import features_of, padded

SIX = ("MMD", "MED", "ASD", "MSD", "PMD", "PED")
"""Measures that need no reference."""


@dataclass(frozen=True, eq=False)
class Windows:
    """Windows to be scored together.

    t       (n_windows, T) time [s], NaN behind the end of each
    motion  (n_windows, T, 6) as measured, NaN in gaps and behind the end
    """

    trials: Sequence[Trial]
    t: FloatArray
    motion: FloatArray

    def features(self) -> dict[str, FloatArray]:
        """What ``features_of`` says, (n_windows,) each."""
        return features_of(self.trials, self.motion, self.t)

    @property
    def counts(self) -> FloatArray:
        """(n_windows, 6) samples of each state that count: those after the first at which it was measured."""
        counts: FloatArray = np.isfinite(self.motion[:, 1:]).sum(axis=1).astype(float)
        return counts


def windows_of(trials: Sequence[Trial]) -> Windows:
    """Trials side by side."""
    longest = max(trial.n_samples for trial in trials)
    t = padded([trial.t for trial in trials], longest)
    return Windows(trials, t, padded([trial.motion for trial in trials], longest))


@dataclass(frozen=True, eq=False)
class Scores:
    """One model on windows, (n_windows,) and more each; of several members the means over them.

    diverged  whether a member's simulation left the world of ships; its distances are infinite
    measures  the six that need no reference, by name
    mean      (n_windows, 6) mean absolute difference of each state
    squares   (n_windows, 6) sum of squared differences of each state over samples that count, in SI units
    J         sum of squared residuals in position and heading, each over its scale
    """

    diverged: BoolArray
    measures: dict[str, FloatArray]
    mean: FloatArray
    squares: FloatArray
    J: FloatArray


def cases_for(windows: Windows, inputs: Sequence[str], draught: float | None) -> Cases:
    """Windows as cases, driven by these inputs, for a ship of that draught [m].

    Raises TrialError for an input that was not logged.
    """
    return cases_from(windows.trials, inputs, draught)


def score_windows(predictor: Predictor, windows: Windows, cases: Cases) -> tuple[Scores, FloatArray]:
    """The scores of a model, and its states (n_windows, T, 6) as the first member has them.

    Each sample of each channel after the first counts where it was measured, as in ``evaluation``.
    """
    found = predicted(predictor, cases)
    members = [_score(predictor, windows, found.states[:, k], found.diverged[:, k]) for k in range(predictor.n_members)]
    return _mean_over(members), found.states[:, 0]


def _score(predictor: Predictor, windows: Windows, states: FloatArray, diverged: BoolArray) -> Scores:
    measured = windows.motion
    inside = np.isfinite(windows.t)
    lost = diverged | ~(np.isfinite(states).all(axis=2) | ~inside).all(axis=1)
    simulated = np.where(lost[:, None, None] | ~inside[:, :, None], 0.0, states)
    near = distances(measured, simulated)
    there = np.isfinite(measured[:, 1:])
    difference = np.where(there, simulated[:, 1:] - measured[:, 1:], 0.0)
    squares = np.einsum("ijk,ijk->ik", difference, difference)
    squares = np.where(lost[:, None] & there.any(axis=1), np.inf, squares)
    objective = make_objective(predictor.L_pp)
    J = np.sum([squares[:, STATES.index(name)] / objective.scales[name] ** 2 for name in objective.channels], axis=0)
    measures = {name: np.where(lost, np.inf, values) for name, values in near.measures.items()}
    return Scores(lost, measures, np.where(lost[:, None], np.inf, near.mean), squares, J)


def _mean_over(members: Sequence[Scores]) -> Scores:
    if len(members) == 1:
        return members[0]
    return Scores(
        np.any([one.diverged for one in members], axis=0),
        {name: np.mean([one.measures[name] for one in members], axis=0) for name in SIX},
        np.mean([one.mean for one in members], axis=0),
        np.mean([one.squares for one in members], axis=0),
        np.mean([one.J for one in members], axis=0),
    )
