"""The force a rudder of normal force F_N puts on the ship, with the hull's reaction."""

from ..quantities import Force


def rudder_reaction(F_N, sin_delta, cos_delta, t_R, a_H, x_R, x_H):
    """Rudder force at midship: Suyama et al. 2023, eq. 25; Yasukawa & Yoshimura 2015.

    F_N [N]; sine and cosine of the rudder angle [-]; t_R, a_H [-]; x_R, x_H [m]: floats or (n_lanes,) -> Force.
    """
    return Force(
        X=-(1.0 - t_R) * F_N * sin_delta,
        Y=-(1.0 + a_H) * F_N * cos_delta,
        N=-(x_R + a_H * x_H) * F_N * cos_delta,
    )
