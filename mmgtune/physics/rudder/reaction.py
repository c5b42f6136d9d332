"""Normal force of a rudder without a flap, and the force any rudder puts on the ship with the hull's reaction."""

import numpy as np

from ..quantities import Force


def plain_normal_force(u_R, v_R, sin_delta, cos_delta, rho, A_R, f_alpha):
    """F_N = 0.5 rho A_R f_alpha U_R^2 sin(alpha_R) [N], the sine taken algebraically: Yasukawa & Yoshimura 2015.

    u_R, v_R inflow [m/s]; sine and cosine of the rudder angle [-]; rho [kg/m^3]; A_R [m^2]; f_alpha [1/rad]: floats or
    (n_lanes,).
    """
    U_R2 = u_R * u_R + v_R * v_R
    return 0.5 * rho * A_R * f_alpha * np.sqrt(U_R2) * (sin_delta * u_R - cos_delta * v_R)


def rudder_reaction(F_N, sin_delta, cos_delta, t_R, a_H, x_R, x_H):
    """Rudder force at midship: Suyama et al. 2023, eq. 25; Yasukawa & Yoshimura 2015.

    F_N [N]; sine and cosine of the rudder angle [-]; t_R, a_H [-]; x_R, x_H [m]: floats or (n_lanes,) -> Force.
    """
    return Force(
        X=-(1.0 - t_R) * F_N * sin_delta,
        Y=-(1.0 + a_H) * F_N * cos_delta,
        N=-(x_R + a_H * x_H) * F_N * cos_delta,
    )
