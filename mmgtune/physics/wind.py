"""Wind on the part of a ship above the water."""


def wind_shape(ahead, starboard, c):
    """Coefficients of wind force on frontal area, lateral area, and lateral area times L: (C_X, C_Y, C_N) [-].

    ahead, starboard  unit vector [-] towards where the apparent wind comes from, in the ship's axes
    c                 has the fields of WindCoefficients
    Floats or (n_lanes,).  Fujiwara, Ueno & Nimura 1998: head wind gives C_X < 0, wind from starboard C_Y < 0.
    """
    # The regression counts the angle a counterclockwise from the bow: cos a = ahead, sin a = -starboard.
    c_1, s_1 = ahead, -starboard
    c_2, s_2 = c_1 * c_1 - s_1 * s_1, 2.0 * s_1 * c_1
    c_3, s_3 = c_2 * c_1 - s_2 * s_1, s_2 * c_1 + c_2 * s_1
    c_5, s_5 = c_3 * c_2 - s_3 * s_2, s_3 * c_2 + c_3 * s_2
    C_X = c.X_0 + c.X_1 * c_1 + c.X_3 * c_3 + c.X_5 * c_5
    C_Y = c.Y_1 * s_1 + c.Y_3 * s_3 + c.Y_5 * s_5
    C_N = c.N_1 * s_1 + c.N_2 * s_2 + c.N_3 * s_3
    return C_X, C_Y, C_N
