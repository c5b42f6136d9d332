"""Hydrodynamic derivatives of Inoue's form: linear terms, and squares that keep their sign."""

from typing import NamedTuple

import numpy as np

from ..prime import force_from_prime
from ..quantities import Lanes
from .astern import resistance_ahead


class DerivativesHull(NamedTuple):
    """Hull derivatives, all in the prime system [-]; those a ship's source does not give are 0."""

    R_0: Lanes
    X_vr: Lanes
    Y_v: Lanes
    Y_r: Lanes
    Y_vv: Lanes  # of v'|v'|
    Y_vr: Lanes  # of v'|r'|
    Y_rr: Lanes  # of r'|r'|
    Y_vvr: Lanes
    Y_vrr: Lanes
    N_v: Lanes
    N_r: Lanes
    N_vv: Lanes  # of v'|v'|
    N_rr: Lanes  # of r'|r'|
    N_vvr: Lanes
    N_vrr: Lanes


def derivatives_hull(flow, ship, p):
    """Hull force at midship: Mathioudakis et al. 2024, eq. 2, after Inoue, Hirano & Kijima 1981.

    flow Flow, ship Ship, p DerivativesHull: floats or (n_lanes,) -> Force [N, N, N m].

    In the prime system the linear terms are those with U v and U r, and v^2 r, v r^2 those with 1/U.  The terms of
    Kijima et al. 1990, v|v| in N and the mixed ones in Y, are there as well.  X_vr excludes m_y' and Y_r excludes m_x',
    since the equations of motion carry those terms; of the source's added masses, those that couple sway and yaw are
    left out (assumption: they are small about midship).  Astern only the resistance changes sign (assumption).
    """
    v_ = flow.v_
    r_ = flow.r_
    av = np.abs(v_)
    ar = np.abs(r_)
    X_ = -resistance_ahead(p.R_0, flow) + p.X_vr * v_ * r_
    Y_ = v_ * (p.Y_v + p.Y_vv * av + p.Y_vr * ar + p.Y_vvr * v_ * r_ + p.Y_vrr * r_ * r_) + r_ * (p.Y_r + p.Y_rr * ar)
    N_ = v_ * (p.N_v + p.N_vv * av + p.N_vvr * v_ * r_ + p.N_vrr * r_ * r_) + r_ * (p.N_r + p.N_rr * ar)
    return force_from_prime(ship, flow.U, X_, Y_, N_)
