"""Plain rudder whose inflow is known for either direction of ship and propeller."""

from typing import NamedTuple

import numpy as np

from ..elementary import arctan2, cos, sin, where
from ..propeller.coefficients import N_FLOOR
from ..quantities import Lanes, RudderOut
from .inflow import gain_in_race, signed_root
from .reaction import plain_normal_force, rudder_reaction

ASIDE = 0.05
"""Lateral velocity at the rudder over the ship's speed within which flow straightening changes sides [-]."""

FADE = 0.1
"""Share of a thrust coefficient of one, and of the tip speed, over which one inflow passes into another [-]."""


class ReversibleRudder(NamedTuple):
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
    k_reverse: Lanes  # propeller race against the ship's motion
    C_PR: Lanes  # loss of inflow behind a propeller that brakes
    f_alpha: Lanes  # gradient of the normal force [1/rad]


def reversible_rudder(flow, ship, wake, propeller, delta, p):
    """Rudder force: Yasukawa & Yoshimura 2015 ahead, Kitagawa et al. 2015 with the propeller braking.

    flow Flow, ship Ship, wake WakeOut, propeller PropellerOut, delta [rad], p ReversibleRudder: floats or (n_lanes,)
    -> RudderOut.  As put together for the Esso Osaka model by Miyauchi et al. 2022.

    Ship ahead, or propeller pushing: u_R = eps sqrt(eta (u_P + kappa (sqrt(u_P^2 + jet) - u_P))^2 + (1 - eta) u_P^2).
    Propeller braking: u_R = sgn(s) sqrt|s|, s = eta sgn(u_1) u_1^2 + (1 - eta) u_2^2 + C_PR u^2 with u_2 = eps u_P,
    u_1 = u_2 - k_reverse sqrt|jet|; once the ship goes astern, u_R = u.
    Assumptions: squares keep their signs, so that a ship that drifts astern with an idling propeller does not steer
    as if ahead; where pieces of the source meet with a jump they pass into each other instead, C_PR with the thrust,
    the inflow astern with the speed, and gamma over a small angle.
    """
    L = ship.L_pp
    u, u_P, jet = flow.u, wake.u_P, propeller.jet
    eta = propeller.D_P / p.H_R
    n_D = np.maximum(np.abs(propeller.n), N_FLOOR) * propeller.D_P

    u_jet = u_P + p.kappa * gain_in_race(u_P, jet)
    pushing = p.eps * signed_root(eta * u_jet * np.abs(u_jet) + (1.0 - eta) * u_P * np.abs(u_P))

    u_2 = p.eps * u_P
    u_1 = u_2 - p.k_reverse * np.sqrt(np.maximum(-jet, 0.0))
    loss = p.C_PR * np.minimum(np.maximum(-propeller.K_T / FADE, 0.0), 1.0)
    s = eta * u_1 * np.abs(u_1) + (1.0 - eta) * u_2 * np.abs(u_2) + loss * u * np.abs(u)
    braking = signed_root(s)
    astern = np.minimum(np.maximum(-u / (FADE * n_D), 0.0), 1.0)
    braking = braking + astern * (u - braking)
    u_R = where(jet > 0.0, pushing, braking)

    v_there = flow.v_m + p.x_R_ * L * flow.r
    side = np.minimum(np.maximum(v_there / (ASIDE * flow.U), -1.0), 1.0)
    gamma_R = 0.5 * (p.gamma_Rp + p.gamma_Rn) - 0.5 * (p.gamma_Rp - p.gamma_Rn) * side
    v_R = -gamma_R * (flow.v_m + p.l_R_ * L * flow.r)

    sin_delta = sin(delta)
    cos_delta = cos(delta)
    F_N = plain_normal_force(u_R, v_R, sin_delta, cos_delta, ship.rho, p.A_R, p.f_alpha)
    return RudderOut(
        force=rudder_reaction(F_N, sin_delta, cos_delta, p.t_R, p.a_H, p.x_R_ * L, p.x_H_ * L),
        u_R=u_R,
        v_R=v_R,
        alpha_R=delta - arctan2(v_R, u_R),
        beta_R=flow.beta - p.l_R_ * flow.r_,
        F_N=F_N,
        delta=delta,
    )
