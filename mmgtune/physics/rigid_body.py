"""Equations of motion in three degrees of freedom about midship."""

from .prime import inertia_unit, mass_unit


def accelerations(u, v_m, r, X, Y, N, ship):
    """Accelerations in the ship's axes: Suyama et al. 2023, eq. 7 and 10-11.

    u, v_m [m/s], r [rad/s]; X, Y [N], N [N m]; all floats or (n_lanes,)
    -> u_dot, v_m_dot [m/s^2], r_dot [rad/s^2].

    The moment of inertia is taken about the centre of gravity: eq. 7 itself adds x_G^2 m to it.
    """
    m = ship.rho * ship.L_pp * ship.B * ship.d * ship.C_b
    unit_m = mass_unit(ship.rho, ship.L_pp, ship.d)
    unit_I = inertia_unit(ship.rho, ship.L_pp, ship.d)
    k_zz = ship.k_zz_ * ship.L_pp
    x_G = ship.x_G
    M_x = m + ship.m_x_ * unit_m
    M_y = m + ship.m_y_ * unit_m
    I_z = m * k_zz * k_zz + x_G * x_G * m + ship.J_zz_ * unit_I

    F_x = X + M_y * v_m * r + x_G * m * r * r
    F_y = Y - M_x * u * r
    M_z = N - x_G * m * u * r
    determinant = M_y * I_z - x_G * m * x_G * m
    u_dot = F_x / M_x
    v_m_dot = (I_z * F_y - x_G * m * M_z) / determinant
    r_dot = (M_y * M_z - x_G * m * F_y) / determinant
    return u_dot, v_m_dot, r_dot
