"""Plain rudder behind one propeller."""

from typing import NamedTuple

import numpy as np

from ..elementary import arctan2, cos, sin
from ..quantities import Lanes, RudderOut
from .inflow import gain_in_race, straightening_by_side
from .reaction import plain_normal_force, rudder_reaction


class PlainRudder(NamedTuple):
    """Rudder geometry, inflow and hull reaction; [-] unless a unit is given."""

    A_R: Lanes  # area [m^2]
    H_R: Lanes  # span [m]
    x_R_: Lanes  # position over L_pp
    t_R: Lanes
    a_H: Lanes
    x_H_: Lanes
    eps: Lanes
    kappa: Lanes
    l_R_: Lanes
    gamma_Rp: Lanes
    gamma_Rn: Lanes
    f_alpha: Lanes  # gradient of the normal force [1/rad]


def plain_rudder(flow, ship, wake, propeller, delta, p):
    """Rudder force: Yasukawa & Yoshimura 2015, sections on rudder force and inflow.

    flow Flow, ship Ship, wake WakeOut, propeller PropellerOut, delta [rad], p PlainRudder: floats or (n_lanes,)
    -> RudderOut.

    u_R is multiplied out in u_P, so that it stays finite at u_P = 0; for u_P < 0 not validated.
    """
    L = ship.L_pp
    eta = propeller.D_P / p.H_R
    u_P = wake.u_P
    u_jet = u_P + p.kappa * gain_in_race(u_P, propeller.jet)
    u_R = p.eps * np.sqrt(np.maximum(eta * u_jet * u_jet + (1.0 - eta) * u_P * u_P, 0.0))
    beta_R = flow.beta - p.l_R_ * flow.r_
    gamma_R = straightening_by_side(beta_R, p.gamma_Rp, p.gamma_Rn)
    v_R = flow.U * gamma_R * beta_R

    sin_delta = sin(delta)
    cos_delta = cos(delta)
    F_N = plain_normal_force(u_R, v_R, sin_delta, cos_delta, ship.rho, p.A_R, p.f_alpha)
    return RudderOut(
        force=rudder_reaction(F_N, sin_delta, cos_delta, p.t_R, p.a_H, p.x_R_ * L, p.x_H_ * L),
        u_R=u_R,
        v_R=v_R,
        alpha_R=delta - arctan2(v_R, u_R),
        beta_R=beta_R,
        F_N=F_N,
        delta=delta,
    )
