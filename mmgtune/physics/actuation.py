"""How what moves an input follows its order."""

import numpy as np


def moved(value, ordered, low, high, most):
    """What an input has become that moves towards its order by at most ``most``, within its limits.

    All in the unit of the input; at a constant rate and order, steps one after the other are as one step.
    """
    goal = np.minimum(np.maximum(ordered, low), high)
    return value + np.minimum(np.maximum(goal - value, -most), most)


def approach_rate(value, ordered, rate, zone):
    """Rate of an input on its way to its order: Wakita et al., ensemble learning, eq. 39-40.

    Constant beyond what it moves in ``zone`` [s] at that rate [unit/s], in proportion within it.  The source writes
    the width of that zone as the time step alone; times the rate it does what it is for: no Euler step overshoots.
    """
    return rate * np.minimum(np.maximum((ordered - value) / (rate * zone), -1.0), 1.0)


def actuated(value, ordered, rate, zone, h):
    """What an input has become after a step of h [s] towards a constant order, by fourth-order Runge-Kutta."""
    k_1 = approach_rate(value, ordered, rate, zone)
    k_2 = approach_rate(value + 0.5 * h * k_1, ordered, rate, zone)
    k_3 = approach_rate(value + 0.5 * h * k_2, ordered, rate, zone)
    k_4 = approach_rate(value + h * k_3, ordered, rate, zone)
    return value + h / 6.0 * (k_1 + 2.0 * k_2 + 2.0 * k_3 + k_4)
