"""Hull derivatives in shallow water: Kijima et al. 1990, J. Society of Naval Architects of Japan 168, 247-256."""

from typing import NamedTuple

from ..elementary import exp, log
from ..quantities import Lanes


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
