"""Rudder with a linked flap behind one propeller."""

from typing import NamedTuple

import numpy as np

from ..elementary import arctan2, cos, sin, where
from ..quantities import Lanes, RudderOut
from .inflow import gain_in_race, straightening_by_side
from .reaction import rudder_reaction


class FlappedRudder(NamedTuple):
    """Rudder geometry, inflow, flap and hull reaction; [-] unless a unit is given."""

    A_R: Lanes  # area [m^2]
    H_R: Lanes  # span [m]
    x_R_: Lanes  # position over L_pp
    t_R: Lanes
    a_H: Lanes
    x_H_: Lanes
    eps: Lanes
    kappa: Lanes
    u_R0: Lanes
    l_R_: Lanes
    gamma_Rp: Lanes
    gamma_Rn: Lanes
    f_a0: Lanes  # [1/rad]
    f_a2: Lanes  # [1/rad^3]
    c_l01: Lanes  # [1/rad]
    c_l03: Lanes  # [1/rad^3]
    flap_step: Lanes  # spacing of the flap table [rad]
    flap: tuple[Lanes, ...]  # flap angle at 0, 1, 2, ... flap_step of rudder angle [rad]


def flap_angle(delta, step, table):
    """Flap angle [rad] at rudder angle delta [rad]: linear between the table's values, odd, constant beyond its end.

    Written as a sum of hinges, so that lanes with different rudder angles need no look-up; the first has no bend at 0,
    where derivatives are taken as well.
    """
    size = where(delta < 0.0, -delta, delta) / step
    angle = table[0] + 0.0 * size + (table[1] - table[0]) * np.minimum(size, 1.0)
    for k in range(1, len(table) - 1):
        angle = angle + (table[k + 1] - table[k]) * np.minimum(np.maximum(size - k, 0.0), 1.0)
    return where(delta < 0.0, -angle, angle)


def flapped_rudder(flow, ship, wake, propeller, delta, p):
    """Rudder force: Suyama et al. 2023, eq. 25-36 (after Okuda et al. 2023).

    flow Flow, ship Ship, wake WakeOut, propeller PropellerOut, delta [rad], p FlappedRudder: floats or (n_lanes,)
    -> RudderOut.

    sin(alpha_R) with alpha_R = delta - atan2(v_R, u_R) is taken algebraically.  For u_P > 0 the inflow is eq. 30
    multiplied out, which stays finite at u_P = 0.
    """
    L = ship.L_pp
    eta = propeller.D_P / p.H_R
    u_P = wake.u_P
    u_star = p.eps * (eta * p.kappa * gain_in_race(u_P, propeller.jet) + u_P)
    u_bollard = 0.7 * np.pi * propeller.n * propeller.D_P * p.u_R0
    u_R = np.maximum(u_star, u_bollard)
    beta_R = flow.beta - p.l_R_ * flow.r_
    gamma_R = straightening_by_side(beta_R, p.gamma_Rp, p.gamma_Rn)
    v_R = -gamma_R * (flow.v_m + p.l_R_ * L * flow.r)

    delta_f = flap_angle(delta, p.flap_step, p.flap)
    f_alpha = p.f_a0 + p.f_a2 * delta_f * delta_f
    C_l0 = (p.c_l01 + p.c_l03 * delta_f * delta_f) * delta_f
    sin_delta = sin(delta)
    cos_delta = cos(delta)
    U_R2 = u_R * u_R + v_R * v_R
    F_N = 0.5 * ship.rho * p.A_R * (f_alpha * np.sqrt(U_R2) * (sin_delta * u_R - cos_delta * v_R) + C_l0 * U_R2)
    return RudderOut(
        force=rudder_reaction(F_N, sin_delta, cos_delta, p.t_R, p.a_H, p.x_R_ * L, p.x_H_ * L),
        u_R=u_R,
        v_R=v_R,
        alpha_R=delta - arctan2(v_R, u_R),
        beta_R=beta_R,
        F_N=F_N,
        delta=delta,
    )
