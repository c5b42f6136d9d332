"""Propeller with a thrust coefficient quadratic in the advance ratio."""

from typing import NamedTuple

import numpy as np

from ..quantities import Force, Lanes, PropellerOut
from .coefficients import advance_and_thrust


class OpenWaterPropeller(NamedTuple):
    """D_P [m], t_P thrust deduction [-], K_T = k_0 + k_1 J + k_2 J^2 [-]."""

    D_P: Lanes
    t_P: Lanes
    k_0: Lanes
    k_1: Lanes
    k_2: Lanes


def open_water_propeller(flow, wake, n, ship, p):
    """Propeller force: Yasukawa & Yoshimura 2015, X_P = (1 - t_P) rho n^2 D_P^4 K_T(J); no side force.

    flow Flow, wake WakeOut, n [1/s], ship Ship, p OpenWaterPropeller: floats or (n_lanes,) -> PropellerOut.

    n^2 K_T is written out in n and u_P / D_P, so that nothing is divided by n.  With n < 0 the bollard thrust
    changes sign (assumption; the source covers ahead only).
    """
    u_P = wake.u_P
    s = u_P / p.D_P
    n2_K_T = p.k_0 * n * np.abs(n) + p.k_1 * np.abs(n) * s + p.k_2 * s * s
    D2 = p.D_P * p.D_P
    X = (1.0 - p.t_P) * ship.rho * D2 * D2 * n2_K_T
    jet = (8.0 / np.pi) * n2_K_T * D2
    J, K_T = advance_and_thrust(u_P, n, p.D_P, jet)
    return PropellerOut(force=Force(X=X, Y=0.0 * X, N=0.0 * X), J=J, K_T=K_T, jet=jet, D_P=p.D_P, n=n)
