"""Thrust of Wageningen B-series propellers: Oosterveld & van Oossanen 1975, Int. Shipbuilding Progress 22."""

import numpy as np

from .formula import Formula

FORMULA = Formula(
    "Oosterveld & van Oossanen 1975, Int. Shipbuilding Progress 22, 251-262, at a Reynolds number of 2e6",
    {"P/D": (0.5, 1.4), "A_E/A_0": (0.3, 1.05), "blades": (2.0, 7.0)},
    "limits of the series",
)

# Coefficient and powers of J, P/D, A_E/A_0 and the number of blades.
_TERMS = (
    (0.00880496, 0, 0, 0, 0),
    (-0.204554, 1, 0, 0, 0),
    (0.166351, 0, 1, 0, 0),
    (0.158114, 0, 2, 0, 0),
    (-0.147581, 2, 0, 1, 0),
    (-0.481497, 1, 1, 1, 0),
    (0.415437, 0, 2, 1, 0),
    (0.0144043, 0, 0, 0, 1),
    (-0.0530054, 2, 0, 0, 1),
    (0.0143481, 0, 1, 0, 1),
    (0.0606826, 1, 1, 0, 1),
    (-0.0125894, 0, 0, 1, 1),
    (0.0109689, 1, 0, 1, 1),
    (-0.133698, 0, 3, 0, 0),
    (0.00638407, 0, 6, 0, 0),
    (-0.00132718, 2, 6, 0, 0),
    (0.168496, 3, 0, 1, 0),
    (-0.0507214, 0, 0, 2, 0),
    (0.0854559, 2, 0, 2, 0),
    (-0.0504475, 3, 0, 2, 0),
    (0.010465, 1, 6, 2, 0),
    (-0.00648272, 2, 6, 2, 0),
    (-0.00841728, 0, 3, 0, 1),
    (0.0168424, 1, 3, 0, 1),
    (-0.00102296, 3, 3, 0, 1),
    (-0.0317791, 0, 3, 1, 1),
    (0.018604, 1, 0, 2, 1),
    (-0.00410798, 0, 2, 2, 1),
    (-0.000606848, 0, 0, 0, 2),
    (-0.0049819, 1, 0, 0, 2),
    (0.0025983, 2, 0, 0, 2),
    (-0.000560528, 3, 0, 0, 2),
    (-0.00163652, 1, 2, 0, 2),
    (-0.000328787, 1, 6, 0, 2),
    (0.000116502, 2, 6, 0, 2),
    (0.000690904, 0, 0, 1, 2),
    (0.00421749, 0, 3, 1, 2),
    (0.0000565229, 3, 6, 1, 2),
    (-0.00146564, 0, 3, 2, 2),
)


def thrust_coefficient(J, pitch, area, blades):
    """K_T of a B-series propeller.

    J advance ratio, pitch P/D, area A_E/A_0 (expanded blade area over disk area), blades [-]: floats or (n_lanes,).
    """
    total = 0.0 * J
    for coefficient, *powers in _TERMS:
        j, p, a, z = powers
        total = total + coefficient * J**j * pitch**p * area**a * blades**z
    return total


def quadratic_through(J, K_T):
    """k_0, k_1, k_2 of K_T = k_0 + k_1 J + k_2 J^2 through open-water points (n,), by least squares, and the largest
    difference from them [-]."""
    powers = np.stack([np.ones_like(J), J, J * J], axis=1)
    k = np.linalg.lstsq(powers, K_T, rcond=None)[0]
    return k, float(np.abs(powers @ k - K_T).max())
