"""What follows a signal with a time constant: the exact step of a first-order lag."""

import numpy as np

from .elementary import exp, where

INSTANT = 1e-3
"""Time constant [s] up to which something counts as following at once."""


def followed(start, end, before, h, T):
    """What follows a signal after a step of h [s] over which that goes linearly from start to end.

    T dy/dt = signal - y, from y = before: once transients have gone, y trails a signal of slope a by a T.
    """
    slow = T > INSTANT
    lag = np.maximum(T, INSTANT)
    left = where(slow, exp(-h / lag), 0.0)
    trail = where(slow, (end - start) / np.maximum(h, INSTANT) * lag, 0.0)
    return end - trail + (before - start + trail) * left
