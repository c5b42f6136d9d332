"""Hull force for any drift angle, from dead ahead to sideways and astern, at any speed down to rest."""

from typing import NamedTuple

import numpy as np

from ..elementary import arctan2, where
from ..quantities import Force, Lanes


class UnifiedHull(NamedTuple):
    """Coefficients in the prime system, and of the cross flow [-]."""

    X_0F: Lanes  # resistance ahead, a negative number
    X_0A: Lanes  # resistance astern, a negative number
    X_vr: Lanes
    Y_v: Lanes
    Y_r: Lanes
    N_v: Lanes
    N_r: Lanes
    C_D: Lanes  # cross-flow drag
    C_rY: Lanes  # weight of the yaw rate in the cross flow, for the side force
    C_rN: Lanes  # and for the moment


def cross_flow(a, b):
    """Integrals over x' from -1/2 to 1/2 of |a + b x'| (a + b x'), and of that times x': exact.

    a lateral velocity [m/s], b its growth along the ship [m/s]: floats or (n_lanes,) -> two of the same [m^2/s^2].
    Where the cross flow has one sign all along, they are polynomials; where it changes sign within the length
    (|a| < |b| / 2), fractions in which nothing cancels.
    """
    size_a = np.abs(a)
    size_b = np.abs(b)
    one_way = 2.0 * size_a >= size_b
    safe = where(one_way, 1.0, size_b)
    a2 = a * a
    b2 = b * b
    sign_a = where(a < 0.0, -1.0, 1.0)
    sign_b = where(b < 0.0, -1.0, 1.0)
    force = where(one_way, sign_a * (a2 + b2 / 12.0), a * (2.0 * a2 / (3.0 * safe) + 0.5 * safe))
    moment = where(one_way, size_a * b / 6.0, sign_b * (0.25 * a2 + safe * safe / 32.0 - a2 * a2 / (6.0 * safe * safe)))
    return force, moment


def unified_hull(flow, ship, p):
    """Hull force at midship: Yoshimura et al. 2009, unified model for ocean and harbour manoeuvring.

    flow Flow, ship Ship, p UnifiedHull: floats or (n_lanes,) -> Force [N, N, N m].

    The strip integrals of the cross flow are taken exactly.  X_vr excludes m_y' and Y_r excludes m_x', since the
    equations of motion carry those terms.
    """
    u, v_m, r_L = flow.u, flow.v_m, flow.r * ship.L_pp
    U = np.sqrt(u * u + v_m * v_m)
    astern = arctan2(np.abs(v_m), u) / np.pi
    I_Y, _ = cross_flow(v_m, p.C_rY * r_L)
    _, I_N = cross_flow(v_m, p.C_rN * r_L)
    X = (p.X_0F + (p.X_0A - p.X_0F) * astern) * u * U + p.X_vr * v_m * r_L
    Y = p.Y_v * v_m * np.abs(u) + p.Y_r * r_L * u - p.C_D * I_Y
    N = p.N_v * v_m * u + p.N_r * r_L * np.abs(u) - p.C_D * I_N
    area = 0.5 * ship.rho * ship.L_pp * ship.d
    return Force(X=area * X, Y=area * Y, N=area * ship.L_pp * N)
