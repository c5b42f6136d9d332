"""Charts as formulas: nonlinear hull derivatives of Inoue's, added masses of Motora's; Zhou, Sheng & Feng 1983."""

from typing import NamedTuple

from ..quantities import Lanes
from .formula import Formula

DERIVATIVES = Formula(
    "Inoue, Hirano & Kijima 1981, Int. Shipbuilding Progress 28, 112-125, charts as fitted by Zhou, Sheng & Feng 1983; "
    "as used in published implementations",
    {"C_b B/L": (0.07, 0.17), "2 d/L": (0.06, 0.16), "C_b": (0.5, 0.85)},
    "limits from memory of the charts",
)
ADDED_MASSES = Formula(
    "Motora 1959, charts as fitted by Zhou, Sheng & Feng 1983; as used in published implementations",
    {"L/B": (4.0, 10.0), "B/d": (2.0, 4.0), "C_b": (0.5, 0.85)},
    "limits from memory of the charts",
)


class NonlinearDerivatives(NamedTuple):
    """Coefficients of v|v|, v|r|, r|r| in Y', of r|r|, v^2 r, v r^2 in N' [prime]."""

    Y_vv: Lanes
    Y_vr: Lanes
    Y_rr: Lanes
    N_rr: Lanes
    N_vvr: Lanes
    N_vrr: Lanes


def nonlinear_derivatives(L, B, d, C_b):
    """Nonlinear hull derivatives of a ship; L, B, d [m], C_b [-]: floats or (n_lanes,) -> NonlinearDerivatives.

    The quadratic coefficient of N_vvr is printed as 1029.514 by two sources and 1039.514 by one; N_vrr is taken with
    C_b d / B, as by two sources (one has C_b B / L).
    """
    c = C_b * B / L
    q = (1.0 - C_b) * d / B
    return NonlinearDerivatives(
        Y_vv=0.048265 - 6.293 * q,
        Y_vr=-0.3791 + 1.28 * q,
        Y_rr=0.0045 - 0.445 * q,
        N_rr=-0.0805 + 8.6092 * c**2 - 36.9816 * c**3,
        N_vvr=-6.0856 + 137.4735 * c - 1029.514 * c**2 + 2480.6082 * c**3,
        N_vrr=-0.0635 + 0.04414 * C_b * d / B,
    )


class AddedMasses(NamedTuple):
    """Added mass in surge and sway, added moment of inertia in yaw about midship [prime]."""

    m_x_: Lanes
    m_y_: Lanes
    J_zz_: Lanes


def added_masses(L, B, d, C_b):
    """Added masses of a ship; L, B, d [m], C_b [-]: floats or (n_lanes,) -> AddedMasses.

    The surge value is the usual twentieth of the mass.
    """
    m = 2.0 * C_b * B / L
    slender, deep = L / B, d / B
    sway = (
        0.882
        - 0.54 * C_b * (1.0 - 1.6 * deep)
        - 0.156 * (1.0 - 0.673 * C_b) * slender
        + 0.826 * deep * slender * (1.0 - 0.678 * deep)
        - 0.638 * C_b * deep * slender * (1.0 - 0.669 * deep)
    )
    lever = 0.01 * (33.0 - 76.85 * C_b * (1.0 - 0.784 * C_b) + 3.43 * slender * (1.0 - 0.63 * C_b))
    return AddedMasses(m_x_=0.05 * m, m_y_=m * sway, J_zz_=m * lever * lever)
