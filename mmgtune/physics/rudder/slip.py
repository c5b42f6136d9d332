"""Rudder in a slipstream counted by the slip of the propeller, with generic lift and drag."""

from typing import NamedTuple

import numpy as np

from ..elementary import arctan2, cos, sin, where
from ..quantities import Lanes, RudderOut
from .inflow import signed_root, straightening_by_side
from .lift_drag import lift_and_drag
from .reaction import rudder_reaction


class SlipRudder(NamedTuple):
    """Rudder geometry, inflow, lift and drag, hull reaction; [-] unless a unit is given."""

    A_R: Lanes  # area [m^2]
    H_R: Lanes  # span [m]
    x_R_: Lanes  # position over L_pp
    t_R: Lanes
    a_H: Lanes
    x_H_: Lanes
    eps: Lanes  # (1 - w_R) / (1 - w_P)
    kappa: Lanes
    pitch_: Lanes  # of the propeller, over its diameter
    C_port: Lanes  # gain of the slipstream, rudder to port
    C_stbd: Lanes  # and to starboard
    l_R_: Lanes
    gamma_Rp: Lanes
    gamma_Rn: Lanes
    C_Q: Lanes
    C_D0: Lanes
    alpha_stall: Lanes  # [rad]
    stall_loss: Lanes


def slip_rudder(flow, ship, wake, propeller, delta, p):
    """Rudder force: Mathioudakis et al., eq. 3, with the inflow of Kijima et al. 1990 and 2002.

    flow Flow, ship Ship, wake WakeOut, propeller PropellerOut, delta [rad], p SlipRudder: floats or (n_lanes,)
    -> RudderOut.

    u_R^2 = (1 - w_R)^2 u^2 [1 + C g(s)] with the slip s = 1 - u_P / (n P), g(s) = eta K [2 - (2 - K) s] s / (1 - s)^2
    and K = kappa / eps; C differs between rudder to port and to starboard.  (1 - s)^2 is multiplied out, so that
    nothing is divided by u_P.  1 - w_R is eps (1 - w_P), where the source lets the wake at the rudder fade in
    proportion to that at the propeller.  Without revolutions ahead, or with negative slip, there is no slipstream
    (assumption).  F_N = L cos(alpha_R) + D sin(alpha_R).
    """
    L = ship.L_pp
    eta = propeller.D_P / p.H_R
    K = p.kappa / p.eps
    u_P = wake.u_P
    ideal = propeller.n * p.pitch_ * propeller.D_P
    excess = np.maximum(ideal - np.maximum(u_P, 0.0), 0.0)  # n P s
    race = eta * K * (K * ideal + (2.0 - K) * np.maximum(u_P, 0.0)) * excess
    C = where(delta > 0.0, p.C_stbd, p.C_port)
    squared = u_P * np.abs(u_P) + C * where(propeller.n > 0.0, race, 0.0)
    u_R = p.eps * signed_root(squared)
    beta_R = flow.beta - p.l_R_ * flow.r_
    gamma_R = straightening_by_side(beta_R, p.gamma_Rp, p.gamma_Rn)
    v_R = flow.U * gamma_R * beta_R
    alpha_R = delta - arctan2(v_R, u_R)
    C_L, C_D = lift_and_drag(alpha_R, p.H_R * p.H_R / p.A_R, p.C_Q, p.C_D0, p.alpha_stall, p.stall_loss)
    lift_part = C_L * cos(alpha_R)
    F_N = 0.5 * ship.rho * p.A_R * (u_R * u_R + v_R * v_R) * (lift_part + C_D * sin(alpha_R))
    sin_delta = sin(delta)
    cos_delta = cos(delta)
    return RudderOut(
        force=rudder_reaction(F_N, sin_delta, cos_delta, p.t_R, p.a_H, p.x_R_ * L, p.x_H_ * L),
        u_R=u_R,
        v_R=v_R,
        alpha_R=alpha_R,
        beta_R=beta_R,
        F_N=F_N,
        delta=delta,
    )
