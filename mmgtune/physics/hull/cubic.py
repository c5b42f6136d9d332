"""Hull polynomial of the MMG standard method."""

from typing import NamedTuple

from ..prime import force_from_prime
from ..quantities import Lanes
from .astern import resistance_ahead


class CubicHull(NamedTuple):
    """Hull derivatives, all in the prime system [-]; those a ship's source does not give are 0."""

    R_0: Lanes
    X_vv: Lanes
    X_vr: Lanes
    X_rr: Lanes
    X_vvvr: Lanes
    X_vvvv: Lanes
    Y_v: Lanes
    Y_r: Lanes
    Y_vvv: Lanes
    Y_vvr: Lanes
    Y_vrr: Lanes
    Y_rrr: Lanes
    N_v: Lanes
    N_r: Lanes
    N_vvv: Lanes
    N_vvr: Lanes
    N_vrr: Lanes
    N_rrr: Lanes


def cubic_hull(flow, ship, p):
    """Hull force at midship: Suyama et al. 2023, eq. 14-15; Yasukawa & Yoshimura 2015 without X_vvvr.

    flow Flow, ship Ship, p CubicHull: floats or (n_lanes,) -> Force [N, N, N m].

    X_vr excludes m_y' and Y_r excludes m_x', since the equations of motion carry those terms.  Fitted to
    ahead motion; astern only the resistance changes sign (assumption), the rest is not validated.
    """
    v_ = flow.v_
    r_ = flow.r_
    v2 = v_ * v_
    r2 = r_ * r_
    R_ = resistance_ahead(p.R_0, flow)
    X_ = -R_ + p.X_vv * v2 + p.X_vr * v_ * r_ + p.X_rr * r2 + p.X_vvvr * v2 * v_ * r_ + p.X_vvvv * v2 * v2
    Y_ = p.Y_v * v_ + p.Y_r * r_ + p.Y_vvv * v2 * v_ + p.Y_vvr * v2 * r_ + p.Y_vrr * v_ * r2 + p.Y_rrr * r2 * r_
    N_ = p.N_v * v_ + p.N_r * r_ + p.N_vvv * v2 * v_ + p.N_vvr * v2 * r_ + p.N_vrr * v_ * r2 + p.N_rrr * r2 * r_
    return force_from_prime(ship, flow.U, X_, Y_, N_)
