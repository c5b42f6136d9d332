"""Linear hull derivatives from main dimensions: Inoue, Hirano & Kijima 1981, Int. Shipbuilding Progress 28, 112-125."""

from typing import NamedTuple

import numpy as np

from ..quantities import Lanes
from .formula import Formula

FORMULA = Formula(
    "Inoue, Hirano & Kijima 1981, Int. Shipbuilding Progress 28, 112-125; as used in published implementations",
    {"C_b": (0.5, 0.85), "C_b B/L": (0.07, 0.17), "2 d/L": (0.06, 0.16)},
    "limits of the charts, from memory",
)


class LinearDerivatives(NamedTuple):
    """Y_v, Y_r, N_v, N_r by 0.5 rho L d U and powers of L [-]; signs as in the MMG standard method."""

    Y_v: Lanes
    Y_r: Lanes
    N_v: Lanes
    N_r: Lanes


def linear_derivatives(L, B, d, C_b, trim):
    """Derivatives of a ship of length L, breadth B, mean draught d [m] and block coefficient C_b [-].

    trim  by the stern, over the draught [-]
    Floats or (n_lanes,) -> LinearDerivatives.
    """
    k = 2.0 * d / L
    lift = 0.5 * np.pi * k + 1.4 * C_b * B / L
    return LinearDerivatives(
        Y_v=-lift * (1.0 + 0.67 * trim),
        Y_r=0.25 * np.pi * k * (1.0 + 0.80 * trim),
        N_v=-k * (1.0 - 0.27 * trim * lift / k),
        N_r=-(0.54 * k - k * k) * (1.0 + 0.30 * trim),
    )
