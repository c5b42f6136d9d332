"""The prime system of the MMG standard method: the only copy of its denominators.

Mass by 0.5 rho L^2 d, moment of inertia by 0.5 rho L^4 d, force by 0.5 rho L d U^2, moment by
0.5 rho L^2 d U^2, length by L, velocity by U, yaw rate by U / L (Suyama et al. 2023, section 3;
Yasukawa & Yoshimura 2015).
"""

from .quantities import Force


def mass_unit(rho, L, d):
    """Denominator of masses [kg]."""
    return 0.5 * rho * L * L * d


def inertia_unit(rho, L, d):
    """Denominator of moments of inertia [kg m^2]."""
    return 0.5 * rho * L * L * L * L * d


def force_unit(rho, L, d, U):
    """Denominator of forces [N] at the reference speed U [m/s]."""
    return 0.5 * rho * L * d * U * U


def moment_unit(rho, L, d, U):
    """Denominator of moments [N m] at the reference speed U [m/s]."""
    return 0.5 * rho * L * L * d * U * U


def force_from_prime(ship, U, X_, Y_, N_):
    """Force [N, N, N m] of what it is in the prime system [-] at the reference speed U [m/s].

    ship Ship, U and X_, Y_, N_: floats or (n_lanes,) -> Force of the same shape.
    """
    force = force_unit(ship.rho, ship.L_pp, ship.d, U)
    moment = moment_unit(ship.rho, ship.L_pp, ship.d, U)
    return Force(X=force * X_, Y=force * Y_, N=moment * N_)
