"""Two rudders behind one propeller, which see each other: fishtail rudders that turn far enough to hover."""

from typing import NamedTuple

import numpy as np

from ..elementary import arctan2, cos, sin, where
from ..quantities import Lanes, RudderOut
from .inflow import gain_in_race, signed_root
from .reaction import rudder_reaction

STARBOARD, PORT = 1.0, -1.0
"""Sign of the angles by which a rudder turns outward, away from the other."""

AMIDSHIPS = 0.05
"""Angle off neutral [rad] within which flow straightening passes from one side of the rudder to the other."""


class RudderPair(NamedTuple):
    """What both rudders share; letters and numbers of the coefficients are those of the source, [-] but for lengths."""

    A_R: Lanes  # area of each [m^2]
    H_R: Lanes  # span [m]
    x_R_: Lanes  # position over L_pp
    k_x: Lanes  # gain of the propeller race
    e_1: Lanes  # t_R = e_1 + e_2 J + e_3 J^2
    e_2: Lanes
    e_3: Lanes
    f_1: Lanes  # a_H likewise, within a_H_low and a_H_high
    f_2: Lanes
    f_3: Lanes
    a_H_low: Lanes
    a_H_high: Lanes
    g_1: Lanes  # x_H' likewise, within x_H_low and x_H_high
    g_2: Lanes
    g_3: Lanes
    x_H_low: Lanes
    x_H_high: Lanes
    C_N1: Lanes  # normal force over sin(alpha), before stall
    C_N2: Lanes  # in stall C_N2 + C_N3 alpha + C_N4 alpha^2
    C_N3: Lanes
    C_N4: Lanes


class OneOfTwo(NamedTuple):
    """One rudder of a pair; letters and numbers of the coefficients are those of the source, angles in rad.

    Flow straightening has four cases: drift angle positive and rudder to port 1, negative and to port 2, positive and
    to starboard 3, negative and to starboard 4, with the coefficients r_1-4, r_5-8, r_9-12 and r_13-16.
    """

    a_1: Lanes  # 1 - w_R = a_1 + a_2 delta + a_3 delta^2 + a_4 delta^3
    a_2: Lanes
    a_3: Lanes
    a_4: Lanes
    b_1: Lanes  # neutral angle b_1 + b_2 s
    b_2: Lanes
    d_1: Lanes  # what the other rudder's angle does: d_1 + d_2 s + d_3 s^2
    d_2: Lanes
    d_3: Lanes
    e_1: Lanes  # and its square
    e_2: Lanes
    e_3: Lanes
    g_1: Lanes  # inflow kept when turned outward: g_1 + g_2 s + g_3 s^2
    g_2: Lanes
    g_3: Lanes
    h_1: Lanes  # times the angle
    h_2: Lanes
    h_3: Lanes
    k_1: Lanes  # times its square
    k_2: Lanes
    k_3: Lanes
    r_1: Lanes
    r_2: Lanes
    r_3: Lanes
    r_4: Lanes
    r_5: Lanes
    r_6: Lanes
    r_7: Lanes
    r_8: Lanes
    r_9: Lanes
    r_10: Lanes
    r_11: Lanes
    r_12: Lanes
    r_13: Lanes
    r_14: Lanes
    r_15: Lanes
    r_16: Lanes
    gamma_1: Lanes  # largest flow straightening, by case
    gamma_2: Lanes
    gamma_3: Lanes
    gamma_4: Lanes
    C_1: Lanes  # effective position in yaw over x_R: turning to starboard, rudder to starboard
    C_2: Lanes  # turning to starboard, rudder to port
    C_3: Lanes  # turning to port, rudder to starboard
    C_4: Lanes  # turning to port, rudder to port


def quadratic(x, c_1, c_2, c_3):
    """c_1 + c_2 x + c_3 x^2."""
    return c_1 + (c_2 + c_3 * x) * x


def straightening(drift, angle, c_1, c_2, c_3, c_4, most):
    """gamma = (c_1 + c_2 |beta| + (c_3 + c_4 |beta|) delta_2) |beta|, within 0 and ``most`` [-]; drift is |beta|."""
    gamma = (c_1 + c_2 * drift + (c_3 + c_4 * drift) * angle) * drift
    return np.minimum(np.maximum(gamma, 0.0), most)


def stalling_normal_force(alpha, pair):
    """C_N over the inflow angle [rad], odd: C_N1 sin(alpha), then C_N2 + C_N3 alpha + C_N4 alpha^2; never below 0.

    The source changes at 37.5 deg, with a step of 0.03; here the lesser of the two counts, from 39 deg on.
    """
    size = np.abs(alpha)
    least = np.minimum(pair.C_N1 * sin(size), quadratic(size, pair.C_N2, pair.C_N3, pair.C_N4))
    return where(alpha < 0.0, -1.0, 1.0) * np.maximum(least, 0.0)


class HullReaction(NamedTuple):
    """How the hull answers the force of rudders, [-]; x_H_ over L_pp."""

    t_R: Lanes
    a_H: Lanes
    x_H_: Lanes


def reaction_of_pair(propeller, p):
    """Reaction of the hull to both rudders: Kang et al. 2008; propeller PropellerOut, p RudderPair -> HullReaction."""
    J = propeller.J
    a_H = np.minimum(np.maximum(quadratic(J, p.f_1, p.f_2, p.f_3), p.a_H_low), p.a_H_high)
    x_H_ = np.minimum(np.maximum(quadratic(J, p.g_1, p.g_2, p.g_3), p.x_H_low), p.x_H_high)
    return HullReaction(t_R=quadratic(J, p.e_1, p.e_2, p.e_3), a_H=a_H, x_H_=x_H_)


def one_of_two(side, flow, ship, behind, reaction, delta, other, pair, p):
    """Force of one rudder of a pair with the hull's reaction: Kang et al. 2008.

    side STARBOARD or PORT; flow Flow, ship Ship, behind Propulsion, reaction HullReaction, delta and the angle of
    the other rudder [rad], pair RudderPair, p OneOfTwo: floats or (n_lanes,) -> RudderOut.

    delta_1 is the angle off neutral, delta_2 that less what the other rudder deflects.  The race does not reach the
    rudder with revolutions astern.  Assumptions of this program: where coefficients differ by the side of delta_2
    they pass into each other within 0.05 rad; squares in the inflow keep their sign.
    """
    L = ship.L_pp
    wake, propeller, s = behind.wake, behind.propeller, behind.slip
    delta_1 = delta - (p.b_1 + p.b_2 * s)
    deflected = (quadratic(s, p.d_1, p.d_2, p.d_3) + quadratic(s, p.e_1, p.e_2, p.e_3) * other) * other
    delta_2 = delta_1 - deflected * where(side * delta_1 > 0.0, np.abs(cos(delta_1)), 1.0)

    one_minus_w_R = p.a_1 + (p.a_2 + (p.a_3 + p.a_4 * delta) * delta) * delta
    u_P = wake.u_P
    u_w = one_minus_w_R / (1.0 - wake.w_P) * u_P
    u_jet = u_w + pair.k_x * gain_in_race(u_P, propeller.jet)
    eta = propeller.D_P / pair.H_R
    race = signed_root(eta * u_jet * np.abs(u_jet) + (1.0 - eta) * u_w * np.abs(u_w))
    kept = quadratic(
        delta_2,
        quadratic(s, p.g_1, p.g_2, p.g_3),
        quadratic(s, p.h_1, p.h_2, p.h_3),
        quadratic(s, p.k_1, p.k_2, p.k_3),
    )
    kept = where(side * delta_2 > 0.0, np.minimum(np.maximum(kept, 0.0), 1.0), 1.0)
    u_R = where(propeller.n >= 0.0, kept * race, 0.0)

    drift = np.abs(flow.beta)
    positive = flow.beta >= 0.0
    to_port = where(
        positive,
        straightening(drift, delta_2, p.r_1, p.r_2, p.r_3, p.r_4, p.gamma_1),
        straightening(drift, delta_2, p.r_5, p.r_6, p.r_7, p.r_8, p.gamma_2),
    )
    to_stbd = where(
        positive,
        straightening(drift, delta_2, p.r_9, p.r_10, p.r_11, p.r_12, p.gamma_3),
        straightening(drift, delta_2, p.r_13, p.r_14, p.r_15, p.r_16, p.gamma_4),
    )
    share = np.minimum(np.maximum(0.5 + 0.5 * delta_2 / AMIDSHIPS, 0.0), 1.0)
    gamma_R = to_port + share * (to_stbd - to_port)
    turning = flow.r >= 0.0
    C_port, C_stbd = where(turning, p.C_2, p.C_4), where(turning, p.C_1, p.C_3)
    l_R = (C_port + share * (C_stbd - C_port)) * pair.x_R_ * L
    v_R = -gamma_R * flow.v_m - l_R * flow.r

    alpha_R = delta_2 - arctan2(v_R, u_R)
    C_N = stalling_normal_force(alpha_R, pair)
    F_N = 0.5 * ship.rho * pair.A_R * (u_R * u_R + v_R * v_R) * C_N
    t_R, a_H, x_H = reaction.t_R, reaction.a_H, reaction.x_H_ * L
    return RudderOut(
        force=rudder_reaction(F_N, sin(delta), cos(delta), t_R, a_H, pair.x_R_ * L, x_H),
        u_R=u_R,
        v_R=v_R,
        alpha_R=alpha_R,
        beta_R=flow.beta,
        F_N=F_N,
        delta=delta,
    )


def rudder_of_pair_to_port(flow, ship, behind, reaction, delta, other, pair, p):
    """Force of the port rudder: Kang et al. 2008; arguments as for ``one_of_two``."""
    return one_of_two(PORT, flow, ship, behind, reaction, delta, other, pair, p)


def rudder_of_pair_to_starboard(flow, ship, behind, reaction, delta, other, pair, p):
    """Force of the starboard rudder: Kang et al. 2008; arguments as for ``one_of_two``."""
    return one_of_two(STARBOARD, flow, ship, behind, reaction, delta, other, pair, p)
