"""Motions as the sensors of most ships would log them."""

from dataclasses import replace

import numpy as np

from mmgtune.backends import STATES

NOISE = np.array([0.4, 0.4, 0.003, 0.02, 0.02, 0.0005])
"""Standard deviations of white noise: x, y [m], psi [rad], u, v_m [m/s], r [rad/s]."""


def logged(trial, motion, rng, noise=NOISE):
    """A trial with a motion in place of its own, and noise."""
    states = motion.states + noise * rng.standard_normal(motion.states.shape)
    return replace(trial, **dict(zip(STATES, states.T, strict=True)))
