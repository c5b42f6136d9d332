"""Wake fraction that changes with the lateral velocity at the propeller and its square; none astern."""

from typing import NamedTuple

import numpy as np

from ..elementary import where
from ..quantities import Lanes, WakeOut

LEAST = 0.02
"""Smallest 1 - w_P [-]: the water at the propeller never quite moves along with the ship."""


class QuadraticWake(NamedTuple):
    """w_P0 [-], tau and C_P [-] of the lateral velocity v_m' + x_P' r', x_P_ propeller over L_pp [-]."""

    w_P0: Lanes
    tau: Lanes
    C_P: Lanes
    x_P_: Lanes


def quadratic_wake(flow, p):
    """Inflow to the propeller: Miyauchi et al. 2022, after Hirano and Kose.

    flow Flow, p QuadraticWake: floats or (n_lanes,) -> WakeOut.
    1 - w_P = (1 - w_P0) + tau |v_m' + x_P' r'| + C_P (v_m' + x_P' r')^2, kept within 0.02 and 1; going astern there
    is no wake.  u_P passes 0 without a jump.
    """
    v_P = flow.v_ + p.x_P_ * flow.r_
    ahead = np.minimum(np.maximum((1.0 - p.w_P0) + p.tau * np.abs(v_P) + p.C_P * v_P * v_P, LEAST), 1.0)
    one_minus_w_P = where(flow.u > 0.0, ahead, 1.0)
    return WakeOut(w_P=1.0 - one_minus_w_P, u_P=one_minus_w_P * flow.u, beta_P=flow.beta - p.x_P_ * flow.r_)
