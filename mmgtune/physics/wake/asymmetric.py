"""Wake fraction with a different value for inflow from either side."""

from typing import NamedTuple

import numpy as np

from ..elementary import exp, where
from ..quantities import Lanes, WakeOut


class AsymmetricWake(NamedTuple):
    """w_P0 [-], C_1 [1/rad], C_2p and C_2n [-] for inflow angles above and below 0, x_P_ propeller over L_pp [-]."""

    w_P0: Lanes
    C_1: Lanes
    C_2p: Lanes
    C_2n: Lanes
    x_P_: Lanes


def asymmetric_wake(flow, p):
    """Inflow to the propeller: Yasukawa & Yoshimura 2015, the C_1, C_2 form.

    flow Flow, p AsymmetricWake: floats or (n_lanes,) -> WakeOut.
    (1 - w_P) / (1 - w_P0) = 1 + (1 - exp(-C_1 |beta_P|)) (C_2 - 1).
    """
    beta_P = flow.beta - p.x_P_ * flow.r_
    C_2 = where(beta_P > 0.0, p.C_2p, p.C_2n)
    one_minus_w_P = (1.0 - p.w_P0) * (1.0 + (1.0 - exp(-p.C_1 * np.abs(beta_P))) * (C_2 - 1.0))
    return WakeOut(w_P=1.0 - one_minus_w_P, u_P=one_minus_w_P * flow.u, beta_P=beta_P)
