"""What rudders of several kinds have in common of their inflow: the propeller race, and flow straightening."""

import numpy as np

from ..elementary import where


def gain_in_race(u_P, jet):
    """sqrt(u_P^2 + jet) - u_P: what the propeller adds far behind its disk, by momentum theory [m/s].

    u_P [m/s], jet [m^2/s^2] of PropellerOut: floats or (n_lanes,); a braking propeller takes all of u_P at most.
    """
    return np.sqrt(np.maximum(u_P * u_P + jet, 0.0)) - u_P


def signed_root(s):
    """Square root with the sign of s: a velocity [m/s] from a signed square."""
    return where(s < 0.0, -1.0, 1.0) * np.sqrt(np.abs(s))


def straightening_by_side(beta_R, gamma_Rp, gamma_Rn):
    """gamma_R [-]: one number for a positive effective drift angle beta_R [rad], another for the rest."""
    return where(beta_R > 0.0, gamma_Rp, gamma_Rn)
