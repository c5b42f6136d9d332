"""Wind that wanders about a mean: an Ornstein-Uhlenbeck process for its speed and one for its direction."""

import numpy as np


def wind_step(value, mean, alpha, sigma, h, drawn):
    """A step of h [s] of d value = alpha (value - mean) dt + sigma dW, by Euler and Maruyama.

    Wakita et al., ensemble learning, eq. 41.  alpha [1/s] below 0, sigma [unit / s^0.5], drawn from the standard normal
    distribution: floats or (n_lanes,) -> the value after the step.
    """
    return value + alpha * (value - mean) * h + sigma * np.sqrt(h) * drawn


def deviation(alpha, sigma, h=0.0):
    """Standard deviation that the process settles at; with steps of h [s], that of the steps themselves."""
    return sigma / np.sqrt(-alpha * (2.0 + alpha * h))


def sigma_of(settled, alpha):
    """The sigma of a process that settles at a standard deviation."""
    return settled * np.sqrt(-2.0 * alpha)
