"""What the noise of first samples brings to simulations that begin at them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .arrays import FloatArray
from .backends import STATES
from .motions import motions
from .objective import Objective, weights_of
from .predictor import Predictor
from .trial import Trial
from .trial.noise import noise_of

MUCH = 0.5
"""Share of J from which what the noise of first samples alone would bring is worth a word."""


def J_of_noise(predictor: Predictor, trials: Sequence[Trial], objective: Objective) -> FloatArray:
    """J (n_trials,) to be expected of a model without any fault that begins at noisy first samples.

    To first order: each state of the first sample in turn is off by the deviation of its noise, and what that changes
    in the course of the trial is squared and added up.  Of several members the first; NaN where a run diverges.
    """
    first = _states(predictor, trials, None)
    noise = np.array([noise_of(trial) for trial in trials]).reshape(-1, len(STATES))
    weights = weights_of(trials, objective)
    found = np.zeros(len(trials))
    for k in range(len(STATES)):
        offsets = np.zeros_like(noise)
        offsets[:, k] = noise[:, k]
        for i, states in enumerate(_states(predictor, trials, offsets)):
            found[i] += np.sum(np.where(weights[i] > 0.0, weights[i] * (states - first[i]) ** 2, 0.0))
    return found


def _states(predictor: Predictor, trials: Sequence[Trial], offsets: FloatArray | None) -> list[FloatArray]:
    """States (n_samples, 6) of the first member on each trial, NaN where it diverges."""
    of_first = [motion for motion in motions(predictor, trials, offsets) if motion.member == 0]
    return [np.full_like(motion.states, np.nan) if motion.diverged else motion.states for motion in of_first]


def in_words(J: float, of_noise: float, where: str) -> str:
    """What the noise of first samples alone brings J to, where that is much of it; "" where not, or where not known.

    where  trials J is counted over, as "on the tune trials"
    """
    if not of_noise > MUCH * J:
        return ""
    return (
        f"trials start at their noisy first samples, which alone would bring a model without any fault to "
        f"J = {of_noise:.3g} {where}, where J is {J:.4g}"
    )
