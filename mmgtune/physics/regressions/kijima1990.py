"""Hull and rudder from main dimensions: Kijima et al. 1990, J. Society of Naval Architects of Japan 168, 247-256."""

from typing import NamedTuple

import numpy as np

from ..elementary import exp, log
from ..quantities import Lanes
from .formula import Formula

FORMULA = Formula(
    "Kijima et al. 1990, J. Society of Naval Architects of Japan 168, 247-256; as used in published implementations",
    {"L/B": (5.0, 7.3), "B/d": (2.3, 4.1), "C_b": (0.5, 0.85)},
    "limits of the models tested, from memory",
)


class HullDerivatives(NamedTuple):
    """Derivatives of Y' and N' in drift angle and yaw rate, turned to v' = -beta and r' [prime].

    Y_r and N_r exclude the added masses, as in the MMG standard method.
    """

    Y_v: Lanes
    Y_r: Lanes
    Y_vv: Lanes  # of v|v|
    Y_rr: Lanes  # of r|r|
    Y_vvr: Lanes
    Y_vrr: Lanes
    N_v: Lanes
    N_r: Lanes
    N_vv: Lanes  # of v|v|
    N_rr: Lanes  # of r|r|
    N_vvr: Lanes
    N_vrr: Lanes


def hull_derivatives(L, B, d, C_b, m_x_):
    """Derivatives in deep water, even keel; L, B, d [m], C_b [-], m_x_ added mass in surge [prime].

    Floats or (n_lanes,) -> HullDerivatives.  The source has Y' and N' in beta, about v' = -sin(beta): odd powers of
    beta change sign.  Y_r comes with m' + m_x' in it there, which the equations of motion carry here.  The sign of
    N_brr differs between sources; that of two of three is taken.
    """
    k, c = 2.0 * d / L, C_b * B / L
    q, deep = (1.0 - C_b) * d / B, C_b * d / B
    m = 2.0 * c
    return HullDerivatives(
        Y_v=-(0.5 * np.pi * k + 1.4 * c),
        Y_r=m + m_x_ - 1.5 * c,
        Y_vv=-(2.5 * q + 0.5),
        Y_rr=0.343 * deep - 0.07,
        Y_vvr=1.5 * deep - 0.65,
        Y_vrr=-5.95 * q,
        N_v=-k,
        N_r=-0.54 * k + k * k,
        N_vv=-(-0.96 * q + 0.066),
        N_rr=0.5 * c - 0.09,
        N_vvr=-(57.5 * c * c - 18.4 * c + 1.6),
        N_vrr=0.5 * deep - 0.05,
    )


class RudderInteraction(NamedTuple):
    """How hull, propeller and rudder act on each other [-]."""

    t_R: Lanes
    a_H: Lanes
    eps: Lanes  # (1 - w_R) / (1 - w_P)
    kappa: Lanes  # of the propeller race, times eps
    gamma_R: Lanes


def rudder_interaction(L, B, C_b):
    """Rudder behind hull and propeller; L, B [m], C_b [-]: floats or (n_lanes,) -> RudderInteraction.

    a_H by the straight line that is used for the source's chart (Quadvlieg 2013, from memory).  eps is a parabola that
    falls off on either side; beyond 0.1 to 0.17 of C_b B / L it keeps its value there (assumption).
    """
    c = C_b * B / L
    inside = np.minimum(np.maximum(c, 0.1), 0.17)
    return RudderInteraction(
        t_R=0.45 - 0.28 * C_b,
        a_H=0.627 * C_b - 0.153,
        eps=-156.5 * inside * inside + 41.6 * inside - 1.76,
        kappa=0.55 - 0.8 * c,
        gamma_R=2.06 * c + 0.14,
    )


class ShallowRatios(NamedTuple):
    """Linear hull derivatives over those in deep water [-]."""

    Y_v: Lanes
    Y_r: Lanes
    N_v: Lanes
    N_r: Lanes


LEAST = 1.2
"""Depth over draught [-] below which nobody validated the formulas."""


def shallow_ratios(L, B, d, C_b, h):
    """What water makes of the linear derivatives where the draught is ``h`` [-] of its depth; L, B, d [m], C_b [-].

    Y_v, N_v, N_r times (1 - h)^-n - h with n = 0.40, 0.425 C_b B/d and 1.5 - 14.28 d/L; Y_r times a cubic in h.  In
    deep water, h = 0, all four are exactly 1.  The exponent of N_v is from memory of the paper.  Not validated below
    depth / draught = 1.2.
    Floats or (n_lanes,) -> ShallowRatios.
    """
    fullness = C_b * B / d
    a_1 = -5.5 * fullness**2 + 26.0 * fullness - 31.5
    a_2 = 37.0 * fullness**2 - 185.0 * fullness + 230.0
    a_3 = -38.0 * fullness**2 + 197.0 * fullness - 250.0

    gap = log(1.0 - h)

    def ratio(n):
        return exp(-n * gap) - h

    return ShallowRatios(
        Y_v=ratio(0.40 * fullness),
        Y_r=1.0 + h * (a_1 + h * (a_2 + h * a_3)),
        N_v=ratio(0.425 * fullness),
        N_r=ratio(1.5 - 14.28 * d / L),
    )
