"""Wake fraction that fades with the square of the inflow angle."""

from typing import NamedTuple

from ..elementary import exp
from ..quantities import Lanes, WakeOut


class ExponentialWake(NamedTuple):
    """w_P0 [-], C_w [1/rad^2], l_P_ longitudinal position of the propeller over L_pp [-]."""

    w_P0: Lanes
    C_w: Lanes
    l_P_: Lanes


def exponential_wake(flow, p):
    """Inflow to the propeller: Suyama et al. 2023, eq. 23-24.

    flow Flow, p ExponentialWake: floats or (n_lanes,) -> WakeOut.
    """
    beta_P = flow.beta - p.l_P_ * flow.r_
    w_P = p.w_P0 * exp(p.C_w * beta_P * beta_P)
    return WakeOut(w_P=w_P, u_P=(1.0 - w_P) * flow.u, beta_P=beta_P)
