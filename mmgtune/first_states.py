"""The state a trial begins with is measured with noise, and a simulation from a noisy state drifts away for good.

What that brings to J, and first states estimated instead: each trial has six unknowns more then, offsets of its first
measured state, which the noise of the sensors holds near zero.
"""

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
from .trial.schema import MOTION

MUCH = 0.5
"""Share of J from which what the noise of first samples alone would bring is worth a word."""

LARGEST = 5.0
"""Offsets are kept within this many standard deviations."""

ROUNDS = 12
"""Most times offsets are improved."""

STEP = 1e-3
"""Step of forward differences, in deviations of an offset."""

LITTLE = 1e-9
"""Fall of J, as a share of it, that is none."""


def deviations(trials: Sequence[Trial], scales: FloatArray) -> FloatArray:
    """Deviations (n_trials, 6) of the first states; never quite zero, so that they can be divided by.

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


def estimated(predictor: Predictor, trials: Sequence[Trial], objective: Objective) -> FloatArray:
    """Offsets (n_trials, 6) of the first measured states from which a predictor follows the trials best.

    J and what offsets cost (``prior_weight``) fall together, by Gauss-Newton steps, each trial keeping the best it
    met, beginning with none.  Several members share the offsets: there was one state, whatever is made of it.  A trial
    on which any of them diverges keeps none.  Raises OptionError where gaps leave a trial without a sample to compare.
    """
    sigma = deviations(trials, np.array([objective.scales[name] for name in STATES]))
    weights = weights_of(trials, objective)
    prior = np.array([prior_weight(own[None], one[None])[0] for own, one in zip(sigma, weights, strict=True)])
    best, least = np.zeros_like(sigma), np.full(len(trials), np.inf)
    tried, going = best.copy(), np.arange(len(trials))
    for _ in range(ROUNDS):
        some = [(trials[k], weights[k]) for k in going.tolist()]
        J, curvature, slope = _around(predictor, some, tried[going], sigma[going])
        curvature += prior[going][:, None] * np.eye(len(STATES))
        slope += prior[going] * tried[going]
        cost = J + np.sum(prior[going] * tried[going] ** 2, axis=1)
        better = cost < least[going] * (1.0 - LITTLE)
        going, curvature, slope = going[better], curvature[better], slope[better]
        best[going], least[going] = tried[going], cost[better]
        if not len(going):
            break
        step = np.linalg.solve(curvature, slope[..., None])[..., 0]
        limit = LARGEST * sigma[going]
        tried[going] = np.clip(best[going] - step, -limit, limit)
    return best


def _around(
    predictor: Predictor, trials: Sequence[tuple[Trial, FloatArray]], offsets: FloatArray, sigma: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """J (n_trials,) at offsets (n_trials, 6), the mean over the members, halves of its second derivatives (n_trials, 6,
    6) by these and of the first (n_trials, 6); inf and zeros for a trial on which a member diverges.

    trials  each with the weights (n_samples, 6) of its squared differences in J
    """
    n, of_one, n_members = len(trials), 1 + len(STATES), predictor.n_members
    moved = np.repeat(offsets[:, None], of_one, axis=1)
    for k in range(len(STATES)):
        moved[:, 1 + k, k] += STEP * sigma[:, k]
    J, curvature, slope = np.full(n, np.inf), np.zeros((n, 6, 6)), np.zeros((n, 6))
    several = motions(predictor, [one for one, _ in trials for _ in range(of_one)], moved.reshape(-1, len(STATES)))
    for i, (trial, weight) in enumerate(trials):
        runs = [[next(several) for _ in range(n_members)] for _ in range(of_one)]
        if any(run.diverged for group in runs for run in group):
            continue
        counts = weight > 0.0
        root = np.sqrt(weight[counts] / n_members)
        states = [np.concatenate([root * run.states[counts] for run in group]) for group in runs]
        left = states[0] - np.tile(root * trial.motion[counts], n_members)
        by_offset = (np.array(states[1:]) - states[0]) / (STEP * sigma[i, :, None])
        J[i], curvature[i], slope[i] = left @ left, by_offset @ by_offset.T, by_offset @ left
    return J, curvature, slope


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
