"""Propeller as polynomials of the hydrodynamic pitch angle, with side force and moment."""

from typing import NamedTuple

import numpy as np

from ..elementary import arctan2, where
from ..quantities import Force, Lanes, PropellerOut
from .coefficients import advance_and_thrust

PASSING = 2.0
"""Range of phi_P [deg] over which one polynomial of C_PN passes into the other."""


class FourQuadrantPropeller(NamedTuple):
    """Coefficients of the polynomials in phi_P [deg]: all [-] per power of a degree."""

    D_P: Lanes  # diameter [m]
    t_P: Lanes  # thrust deduction [-]
    K_T0: Lanes
    K_T1: Lanes
    K_T2: Lanes
    K_T3: Lanes
    C_PY0: Lanes
    C_PY1: Lanes
    C_PY2: Lanes
    C_PN0_low: Lanes  # below phi_switch, less half of PASSING
    C_PN1_low: Lanes
    C_PN0_high: Lanes  # above phi_switch, and half of PASSING
    C_PN1_high: Lanes
    phi_switch: Lanes  # [deg]
    phi_min: Lanes  # range in which the polynomials may be used [deg]
    phi_max: Lanes
    slipstream_kt: Lanes  # 0: K_T of eq. 30 converted from eq. 16; 1: the printed polynomial taken literally


def four_quadrant_propeller(flow, wake, n, ship, p):
    """Propeller force: Suyama et al. 2023, eq. 16-22.

    flow Flow, wake WakeOut, n [1/s], ship Ship, p FourQuadrantPropeller: floats or (n_lanes,) -> PropellerOut.

    In eq. 16 K_T multiplies V_r^2, so it is the four-quadrant coefficient C_T*; the K_T of eq. 30 follows from
    it as (pi/8) C_T* (J^2 + (0.7 pi)^2), which makes 8 K_T n^2 D_P^2 / pi simply C_T* V_r^2: finite as u_P -> 0.
    Outside phi_min..phi_max the coefficients keep their end values (assumption; the source covers ahead only).
    The source has C_PN jump at phi_switch.  Here one polynomial passes into the other evenly, about there: a run that
    comes to a jump earlier or later as coefficients change makes an objective of steps, which no search can follow.
    """
    u_P = wake.u_P
    v_tip = 0.7 * np.pi * n * p.D_P
    V_r2 = u_P * u_P + v_tip * v_tip
    phi = np.minimum(np.maximum(arctan2(u_P, v_tip) * (180.0 / np.pi), p.phi_min), p.phi_max)
    C_T = ((p.K_T3 * phi + p.K_T2) * phi + p.K_T1) * phi + p.K_T0
    C_PY = (p.C_PY2 * phi + p.C_PY1) * phi + p.C_PY0
    low, high = p.C_PN1_low * phi + p.C_PN0_low, p.C_PN1_high * phi + p.C_PN0_high
    C_PN = low + np.minimum(np.maximum(0.5 + (phi - p.phi_switch) / PASSING, 0.0), 1.0) * (high - low)
    S_P = 0.25 * np.pi * p.D_P * p.D_P
    q = 0.5 * ship.rho * S_P * V_r2
    force = Force(X=q * (1.0 - p.t_P) * C_T, Y=q * C_PY, N=q * ship.L_pp * C_PN)
    n_D = n * p.D_P
    jet = where(p.slipstream_kt > 0.5, (8.0 / np.pi) * C_T * n_D * n_D, C_T * V_r2)
    J, K_T = advance_and_thrust(u_P, n, p.D_P, jet)
    return PropellerOut(force=force, J=J, K_T=K_T, jet=jet, D_P=p.D_P, n=n)
