"""The state a trial starts from is measured with noise, and a simulation from a noisy state drifts away for good.

Where initial states are estimated, each trial has six unknowns more: offsets of its first measured state, which the
noise of the sensors holds near zero.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..trial import Trial
from ..trial.noise import noise_of
from ..trial.schema import MOTION

LARGEST = 5.0
"""Offsets are kept within this many standard deviations."""


def deviations(trials: Sequence[Trial], scales: FloatArray) -> FloatArray:
    """Deviations (n_trials, 6) of the initial states; never quite zero, so that they can be divided by.

    scales  (6,) what the objective divides each channel by
    """
    return np.array([np.maximum(noise_of(trial), 1e-9 * scales) for trial in trials]).reshape(-1, len(MOTION))


def prior_weight(sigma: FloatArray, weight: FloatArray) -> FloatArray:
    """Weight (n_cases, 6) of squared offsets in J, such that noise counts alike in the first state and in all others.

    sigma   (n_cases, 6) deviations of the noise
    weight  (n_cases, T, 6) weights of squared differences in J
    """
    counted = weight > 0.0
    noise = np.sum(weight * sigma[:, None] ** 2, axis=(1, 2)) / np.maximum(counted.sum(axis=(1, 2)), 1)
    return np.asarray(noise[:, None] / sigma**2)
