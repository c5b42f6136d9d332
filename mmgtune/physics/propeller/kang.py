"""Propeller of a ship with two rudders behind it, with the wake it works in."""

from typing import NamedTuple

import numpy as np

from ..elementary import where
from ..quantities import Force, Lanes, PropellerOut, WakeOut
from .coefficients import N_FLOOR

LEAST = 0.02
"""Smallest 1 - w_P and 1 - t_P [-]: as in the other wakes, the water never quite moves along with the ship."""

FADE = 0.1
"""Advance ratio astern over which one polynomial of the thrust passes into the other [-]."""

MOST_SLIP = 1.2
"""Slip [-] beyond which nothing was measured; it is kept within 0 and this."""


class KangPropeller(NamedTuple):
    """Propeller and wake; letters and numbers of the coefficients are those of the source, [-] but for D_P [m]."""

    D_P: Lanes
    pitch_: Lanes  # over diameter
    k_0: Lanes  # K_T = k_0 + k_1 J + k_2 J^2, ship ahead
    k_1: Lanes
    k_2: Lanes
    k_0n: Lanes  # ship astern
    k_1n: Lanes
    k_2n: Lanes
    J_max: Lanes  # advance ratios beyond +-J_max count as that
    x_P_: Lanes  # position over L_pp
    a_1: Lanes  # 1 - w_P0 = a_1 + a_2 J_S + a_3 J_S^2
    a_2: Lanes
    a_3: Lanes
    b_1: Lanes  # gain of 1 - w_P by lateral velocity at the propeller
    b_2: Lanes
    b_3: Lanes
    c_1: Lanes  # 1 - t_P0 = c_1 + c_2 J + c_3 J^2
    c_2: Lanes
    c_3: Lanes
    d_1: Lanes  # gain of 1 - t_P by lateral velocity at the propeller
    d_2: Lanes
    d_3: Lanes


class Propulsion(NamedTuple):
    """What the rudders need to know."""

    wake: WakeOut
    propeller: PropellerOut
    slip: Lanes  # 1 - u_P / (n P), within 0 and MOST_SLIP [-]


def gain_aside(v_P, c_1, c_2, c_3):
    """What lateral velocity v_P [-] at the propeller adds to 1 - w_P or 1 - t_P: Kang et al. 2008."""
    bent = v_P + c_3 * v_P * np.abs(v_P)
    return c_1 * (c_2 * v_P + bent * bent)


def kang_propeller(flow, n, ship, p):
    """Propeller force and the wake before it: Kang et al. 2008, ship ahead and astern with the propeller ahead.

    flow Flow, n [1/s], ship Ship, p KangPropeller: floats or (n_lanes,) -> Propulsion.

    1 - w_P = a_1 + a_2 J_S + a_3 J_S^2 + b_1 (b_2 v_P' + (v_P' + b_3 v_P'|v_P'|)^2) with J_S = u / (n D_P) and the
    lateral velocity at the propeller v_P' = v_m' + x_P' r'; there is no wake astern.  1 - t_P likewise in J.

    Assumptions of this program: the two polynomials of K_T, which differ at J = 0, pass into each other over 0.1 of J
    astern; advance ratios are kept within +-J_max, with which all forces vanish with n.  The source covers revolutions
    ahead only: astern the bollard thrust changes sign, without thrust deduction.
    """
    forward = n >= 0.0
    n_D = np.maximum(np.abs(n), N_FLOOR) * p.D_P
    v_P = flow.v_ + p.x_P_ * flow.r_
    J_S = np.minimum(np.maximum(flow.u / n_D, -p.J_max), p.J_max)
    inflow = p.a_1 + (p.a_2 + p.a_3 * J_S) * J_S + gain_aside(v_P, p.b_1, p.b_2, p.b_3)
    one_minus_w_P = where(flow.u > 0.0, np.minimum(np.maximum(inflow, LEAST), 1.0), 1.0)
    u_P = one_minus_w_P * flow.u

    J = np.minimum(np.maximum(u_P / n_D, -p.J_max), p.J_max)
    ahead = p.k_0 + (p.k_1 + p.k_2 * J) * J
    astern = p.k_0n + (p.k_1n + p.k_2n * J) * J
    share = np.minimum(np.maximum(-J / FADE, 0.0), 1.0)
    K_T = where(forward, ahead + share * (astern - ahead), -p.k_0)
    thrust = p.c_1 + (p.c_2 + p.c_3 * J) * J + gain_aside(v_P, p.d_1, p.d_2, p.d_3)
    one_minus_t_P = where(forward, np.minimum(np.maximum(thrust, LEAST), 1.0), 1.0)
    n_D2 = n * n * p.D_P * p.D_P
    X = one_minus_t_P * ship.rho * n_D2 * p.D_P * p.D_P * K_T

    wake = WakeOut(w_P=1.0 - one_minus_w_P, u_P=u_P, beta_P=flow.beta - p.x_P_ * flow.r_)
    jet = (8.0 / np.pi) * K_T * n_D2
    force = Force(X=X, Y=0.0 * X, N=0.0 * X)
    propeller = PropellerOut(force=force, J=where(forward, J, -J), K_T=K_T, jet=jet, D_P=p.D_P, n=n)
    return Propulsion(wake=wake, propeller=propeller, slip=np.minimum(np.maximum(1.0 - J / p.pitch_, 0.0), MOST_SLIP))
