"""Wind forces from the geometry above the water: Fujiwara, Ueno & Nimura 1998, J. Soc. Naval Archit. Japan 183."""

from ..quantities import WindCoefficients


def wind_harmonics(L, B, above):
    """Harmonics of the wind force, by regression over models of merchant ships.

    L, B   length and breadth [m]; L_pp stands for the length over all
    above  has A_T, A_L, A_OD [m^2], C, C_BR, H_BR, H_C [m] (see the profile's section above_water)
    Floats or (n_lanes,) -> WindCoefficients.
    """
    A_T, A_L, A_OD = above.A_T, above.A_L, above.A_OD
    C, C_BR, H_BR, H_C = above.C, above.C_BR, above.H_BR, above.H_C
    lateral = A_L / (L * B)
    front = A_T / (B * H_BR)
    X_0 = -0.330 + 0.293 * B * H_BR / A_T + 0.0193 * C / H_C + 0.6820 * A_OD / (L * L)
    X_1 = (
        -1.353
        + 1.700 * lateral
        + 2.8700 * L * H_C / A_L
        - 0.4630 * L * H_BR / A_L
        - 0.570 * A_OD / A_L
        - 6.640 * A_T / (L * B)
        - 0.0123 * L * L / A_T
        + 0.0202 * L / H_C
    )
    X_3 = (
        0.830
        - 0.413 * A_L / (L * H_BR)
        - 0.0827 * A_L / A_T
        - 0.5630 * L * H_C / A_L
        + 0.804 * A_OD / A_L
        - 5.670 * A_OD / (L * L)
        + 0.0401 * C / H_C
        - 0.1320 * C_BR / L
    )
    X_5 = 0.0372 - 0.0075 * A_L / A_OD - 0.1030 * C_BR / L + 0.0921 * lateral
    Y_1 = 0.684 + 0.717 * C_BR / L - 3.2200 * C / L + 0.0281 * A_L / A_OD + 0.0661 * C / H_C + 0.2980 * front
    Y_3 = (
        -0.400
        + 0.282 * lateral
        + 0.3070 * L * H_C / A_L
        + 0.0519 * C_BR / L
        + 0.0526 * B / H_BR
        - 0.0814 * A_OD / A_L
        + 0.0582 * front
    )
    Y_5 = (
        0.122
        - 0.166 * lateral
        - 0.0054 * L / H_BR
        - 0.0481 * C_BR / L
        - 0.0136 * B * B / A_T
        + 0.0864 * C / L
        - 0.0297 * C * H_C / A_L
    )
    N_1 = (
        0.2990
        + 1.710 * C / L
        + 0.183 * L * H_C / A_L
        - 1.09 * A_T / A_L
        - 0.0442 * C / H_C
        - 0.289 * lateral
        + 4.24 * A_T / (L * L)
        - 0.0646 * B * B / A_T
        + 0.0306 * C_BR / L
    )
    N_2 = (
        0.1170
        + 0.123 * C_BR / L
        - 0.323 * C / L
        + 0.0041 * A_L / A_OD
        - 0.166 * A_T / (B * B)
        - 0.0109 * L / H_BR
        + 0.174 * front
        + 0.214 * lateral
        - 1.06 * A_L / (L * L)
    )
    N_3 = 0.0230 + 0.0385 * C_BR / L - 0.0339 * front + 0.0023 * A_L / A_T
    return WindCoefficients(X_0, X_1, X_3, X_5, Y_1, Y_3, Y_5, N_1, N_2, N_3)
