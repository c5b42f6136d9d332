"""Linear derivatives and added masses from dimensions: Clarke, Gedling & Hine 1982, Trans. RINA 125, 45-68."""

import numpy as np

from .formula import Formula
from .inoue1981 import LinearDerivatives
from .zhou1983 import AddedMasses

FORMULA = Formula(
    "Clarke, Gedling & Hine 1982, Trans. RINA 125, 45-68; as used in published implementations",
    {"L/B": (5.0, 8.5), "B/d": (2.1, 5.0), "C_b": (0.5, 0.85)},
    "limits of the models in the regression, from memory",
)


def _by_draught(L, d):
    """From Clarke's denominators, with L^2, to those of the MMG standard method, with L d: times L/d; and his factor
    -pi (d/L)^2 of every derivative."""
    return -np.pi * (d / L) ** 2 * (L / d)


def linear_derivatives(L, B, d, C_b):
    """Linear hull derivatives; L, B, d [m], C_b [-]: floats or (n_lanes,) -> LinearDerivatives."""
    s = _by_draught(L, d)
    return LinearDerivatives(
        Y_v=s * (1.0 + 0.40 * C_b * B / d),
        Y_r=s * (-0.5 + 2.2 * B / L - 0.08 * B / d),
        N_v=s * (0.5 + 2.4 * d / L),
        N_r=s * (0.25 + 0.039 * B / d - 0.56 * B / L),
    )


def added_masses(L, B, d, C_b):
    """Added masses; L, B, d [m], C_b [-]: floats or (n_lanes,) -> AddedMasses.

    Sway and yaw by Clarke; surge by m / (pi sqrt(L^3 / volume) - 14), Soding in Brix 1993.
    """
    s = _by_draught(L, d)
    m = 2.0 * C_b * B / L
    return AddedMasses(
        m_x_=m / (np.pi * np.sqrt(L * L / (B * d * C_b)) - 14.0),
        m_y_=-s * (1.0 + 0.16 * C_b * B / d - 5.1 * (B / L) ** 2),
        J_zz_=-s * (1.0 / 12.0 + 0.017 * C_b * B / d - 0.33 * B / L),
    )
