"""Motion of the ship in the earth frame and through the water."""

import numpy as np

from .elementary import arctan2
from .frame import to_earth
from .quantities import Flow

R_PRIME_MAX = 5.0
"""Largest r' the prime system is asked for [-].

A turning ship has r' near 1.  Towards rest r' = r L / U would grow without limit, so the reference speed
is kept at |r| L / R_PRIME_MAX or more: hull forces then stay proportional to r|r| down to standstill.
An assumption of this program, without effect on any state with r' below the limit.
"""

U_FLOOR = 1e-6
"""Smallest reference speed [m/s]; keeps a ship at complete rest free of divisions by zero."""


def flow(u, v_m, r, L_pp):
    """Motion through the water.

    u, v_m [m/s], r [rad/s], L_pp [m]: floats or (n_lanes,) -> Flow of the same shape.
    Suyama et al. 2023, section 3: U = sqrt(u^2 + v_m^2), beta = arctan(-v_m / u).
    """
    U = np.sqrt(u * u + v_m * v_m)
    U = np.maximum(np.maximum(U, np.abs(r) * L_pp / R_PRIME_MAX), U_FLOOR)
    return Flow(u=u, v_m=v_m, r=r, U=U, beta=arctan2(-v_m, u), v_=v_m / U, r_=r * L_pp / U)


def pose_rate(psi, u, v_m, r):
    """Rates of north [m/s], east [m/s] and heading [rad/s] over ground (eq. 5-6)."""
    north, east = to_earth(psi, u, v_m)
    return north, east, r
