"""How what moves an input follows its order."""

import numpy as np


def moved(value, ordered, low, high, most):
    """What an input has become that moves towards its order by at most ``most``, within its limits.

    All in the unit of the input; at a constant rate and order, steps one after the other are as one step.
    """
    goal = np.minimum(np.maximum(ordered, low), high)
    return value + np.minimum(np.maximum(goal - value, -most), most)
