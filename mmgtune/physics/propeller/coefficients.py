"""What is reported of a propeller whatever its model: advance ratio and thrust coefficient."""

import numpy as np

from ..elementary import where

N_FLOOR = 1e-9
"""Revolutions [1/s] below which a propeller stands still and has no advance ratio."""


def advance_and_thrust(u_P, n, D_P, jet):
    """J = u_P / (n D_P) and K_T from jet = 8 K_T n^2 D_P^2 / pi; both 0 for a propeller that stands still.

    u_P [m/s], n [1/s], D_P [m], jet [m^2/s^2]: floats or (n_lanes,) -> two of the same shape [-].
    """
    turning = np.abs(n) > N_FLOOR
    n_D = where(turning, n * D_P, 1.0)
    return where(turning, u_P / n_D, 0.0), where(turning, (np.pi / 8.0) * jet / (n_D * n_D), 0.0)
