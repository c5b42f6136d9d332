"""Thruster in a tunnel whose force fades with the speed of the ship."""

from typing import NamedTuple

import numpy as np

from ..constants import GRAVITY
from ..quantities import Force, Lanes

OFF = 0.1
"""Share of the speed at which the thruster has no force left over which that is lost [-]."""


class FadingThruster(NamedTuple):
    """Geometry, thrust, and what is left of it at speed; [-] unless a unit is given."""

    D: Lanes  # diameter [m]
    x: Lanes  # position, forward of midship [m]
    K_Tp: Lanes  # thrust coefficient, pushing to starboard
    K_Tn: Lanes  # and to port
    a_1: Lanes  # side force over thrust, less 1: a_1 + a_2 Fr + a_3 Fr^2
    a_2: Lanes
    a_3: Lanes
    b_1: Lanes  # moment over thrust and position likewise
    b_2: Lanes
    b_3: Lanes
    u_off: Lanes  # speed at which no force is left [m/s]


def fading_thruster(flow, n, ship, p):
    """Thruster force: Kobayashi 1988, as Wakita et al. give it (ensemble learning, eq. 36); no surge force.

    flow Flow, n [1/s] pushing to starboard, ship Ship, p FadingThruster: floats or (n_lanes,) -> Force.

    Y = (1 + a_1 + a_2 Fr + a_3 Fr^2) T and N = (1 + b_1 + b_2 Fr + b_3 Fr^2) T x with T = rho D^4 n|n| K_T and
    Fr = |u| / sqrt(g L_pp).  A thruster that is useless from u_off on loses its force over the last tenth before it
    (assumption; the source switches it off).
    """
    speed = np.abs(flow.u)
    Fr = speed / np.sqrt(GRAVITY * ship.L_pp)
    left = np.minimum(np.maximum((p.u_off - speed) / (OFF * p.u_off), 0.0), 1.0)
    D2 = p.D * p.D
    T = left * ship.rho * D2 * D2 * n * (np.maximum(n, 0.0) * p.K_Tp - np.minimum(n, 0.0) * p.K_Tn)
    Y = (1.0 + p.a_1 + (p.a_2 + p.a_3 * Fr) * Fr) * T
    return Force(X=0.0 * Y, Y=Y, N=(1.0 + p.b_1 + (p.b_2 + p.b_3 * Fr) * Fr) * T * p.x)
