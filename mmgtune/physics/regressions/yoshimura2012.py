"""Cubic hull polynomial from main dimensions: Yoshimura & Masumoto 2012, J. JASNAOE 14, 63-73."""

from typing import NamedTuple

import numpy as np

from ..quantities import Lanes
from .formula import Formula

FORMULA = Formula(
    "Yoshimura & Masumoto 2012, J. JASNAOE 14, 63-73; as used in published implementations",
    {"L/B": (3.5, 7.5), "B/d": (2.0, 4.5), "C_b": (0.48, 0.85)},
    "limits of the ships in the data base, from memory",
)


class CubicDerivatives(NamedTuple):
    """Derivatives of the MMG standard method [prime]; X_vr excludes m_y', Y_r excludes m_x'."""

    X_vv: Lanes
    X_vr: Lanes
    X_rr: Lanes
    X_vvvv: Lanes
    Y_v: Lanes
    Y_r: Lanes
    Y_vvv: Lanes
    Y_vvr: Lanes
    Y_vrr: Lanes
    Y_rrr: Lanes
    N_v: Lanes
    N_r: Lanes
    N_vvv: Lanes
    N_vvr: Lanes
    N_vrr: Lanes
    N_rrr: Lanes


def cubic_derivatives(L, B, d, C_b, x_G, m_x_, m_y_):
    """Hull derivatives; L, B, d, x_G [m], C_b [-], added masses m_x_, m_y_ [prime].

    Floats or (n_lanes,) -> CubicDerivatives.  X_vr is the measured value less m_y', as in the MMG standard method.
    """
    k, c = 2.0 * d / L, C_b * B / L
    slender = L / B
    return CubicDerivatives(
        X_vv=1.15 * c - 0.18,
        X_vr=m_y_ - 1.91 * c + 0.08,
        X_rr=-0.085 * c + 0.008 - x_G / L * m_y_,
        X_vvvv=-6.68 * c + 1.1,
        Y_v=-(0.5 * np.pi * k + 1.4 * c),
        Y_r=m_x_ + 0.5 * c,
        Y_vvv=-0.185 * slender + 0.48,
        Y_vvr=-0.75 + 0.0 * c,
        Y_vrr=-(0.26 * (1.0 - C_b) * slender + 0.11),
        Y_rrr=-0.051 + 0.0 * c,
        N_v=-k,
        N_r=-0.54 * k + k * k,
        N_vvv=-(-0.69 * C_b + 0.66),
        N_vvr=1.55 * c - 0.76,
        N_vrr=-0.075 * (1.0 - C_b) * slender - 0.098,
        N_rrr=0.25 * c - 0.056,
    )


class RudderInteraction(NamedTuple):
    """How hull and rudder act on each other, and where the rudder feels a turn [-]."""

    t_R: Lanes
    a_H: Lanes
    x_H_: Lanes
    l_R_: Lanes


def rudder_interaction(L, B, C_b):
    """Rudder behind the hull; L, B [m], C_b [-]: floats or (n_lanes,) -> RudderInteraction."""
    c = C_b * B / L
    return RudderInteraction(t_R=0.39 + 0.0 * c, a_H=3.6 * c, x_H_=-0.4 + 0.0 * c, l_R_=-0.9 + 0.0 * c)
