"""Components for either direction of ship and propeller, put against their sources written out with printed numbers."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from mmgtune.physics.arrangements.single_propeller_single_rudder import Control, forces
from mmgtune.physics.quantities import State

RHO, L, D, PITCH, H_R = 998.0, 3.0, 0.084, 0.7151, 0.1279
K = (0.3278, -0.3323, -0.156)
A = {1: -7.90e-5, 2: 7.99e-3, 3: -4.93e-3, 4: -5.87e-3, 5: -5.58e-4, 6: 5.08e-3, 7: 1.70e-3, 8: 9.16e-4}
B = {1: 3.50e-5, 2: -3.17e-3, 3: 1.96e-3, 4: 2.33e-3, 5: 2.25e-4, 6: -2.16e-3, 7: 6.27e-5, 8: 6.25e-5}


@pytest.fixture
def at(esso_osaka):
    """Forces of the 3 m model at u, v_m [m/s], r [rad/s], n [1/s] and delta [rad]."""

    def found(u, v_m, r, n, delta):
        state = State(*(np.array([q]) for q in (0.0, 0.0, 0.0, u, v_m, r)))
        control = Control(np.array([n]), np.array([delta]))
        return forces(state, control, esso_osaka.components, esso_osaka.coefficients(esso_osaka.matrix()))

    return found


@pytest.fixture
def draught(esso_osaka):
    return esso_osaka.profile.value("particulars.d")


@pytest.mark.parametrize(
    ("u", "v", "r"), [(0.3, 0.05, -0.1), (-0.2, 0.1, 0.06), (0.0, -0.08, 0.03), (-0.3, -0.01, 0.1)]
)
def test_unified_hull(at, draught, u, v, r):
    """Yoshimura et al. 2009 with the strip integrals done numerically."""
    U, r_L = math.hypot(u, v), r * L
    beta = abs(math.atan2(-v, u))

    def flow(C, arm):
        inside = [x for x in [-v / (C * r_L)] if abs(x) < 0.5]
        return quad(lambda x: abs(v + C * r_L * x) * (v + C * r_L * x) * x**arm, -0.5, 0.5, points=inside or None)[0]

    X = (-0.02139 + (-0.03189 + 0.02139) * beta / math.pi) * u * U - 0.0081 * v * r_L
    Y = -0.3728 * v * abs(u) + 0.1160 * r_L * u - 0.9665 * flow(2.217, 0)
    N = -0.1458 * v * u - 0.04849 * r_L * abs(u) - 0.9665 * flow(0.8097, 1)
    hull = at(u, v, r, 10.0, 0.0).hull
    q = 0.5 * RHO * L * draught
    np.testing.assert_allclose([hull.X[0], hull.Y[0], hull.N[0]], [q * X, q * Y, q * L * N], rtol=1e-9)


@pytest.mark.parametrize(("u", "v", "r"), [(0.3, 0.05, -0.02), (0.3, -0.06, 0.03), (-0.1, 0.05, 0.0)])
def test_quadratic_wake(at, u, v, r):
    U = math.hypot(u, v)
    v_P = v / U - 0.517 * r * L / U
    kept = 1.0 - 0.614 + 0.871 * abs(v_P) - 0.359 * v_P**2 if u > 0.0 else 1.0
    wake = at(u, v, r, 10.0, 0.0).wake
    assert wake.w_P[0] == pytest.approx(1.0 - kept)
    assert wake.u_P[0] == pytest.approx(kept * u)
    assert wake.beta_P[0] == pytest.approx(math.atan2(-v, u) + 0.517 * r * L / U)


@pytest.mark.parametrize("J_S", [0.25, -0.15, -0.4])
def test_propeller_ahead(at, draught, J_S):
    """Thrust by the polynomial; a side force after Ueno et al. only where the ship goes astern."""
    n = 10.0
    u = J_S * n * D
    J = (1.0 - 0.614) * J_S if u > 0.0 else J_S
    found = at(u, 0.0, 0.0, n, 0.0).propeller
    assert found.force.X[0] == pytest.approx(RHO * n**2 * D**4 * (1.0 - 0.22) * (K[0] + K[1] * J + K[2] * J**2))
    assert found.J[0] == pytest.approx(J)
    q = 0.5 * RHO * L * draught * (n * D * PITCH) ** 2 * (1.0 if J_S < 0.0 else 0.0)
    assert found.force.Y[0] == pytest.approx(q * (A[6] * J_S**2 + A[7] * J_S + A[8]))
    assert found.force.N[0] == pytest.approx(q * L * (B[6] * J_S**2 + B[7] * J_S + B[8]))


@pytest.mark.parametrize("J_S", [0.2, -0.02, -0.15, -0.3, -0.5])
def test_propeller_astern(at, draught, J_S):
    """Hachii 2004: surge in two pieces, side force and moment in three; J_S is negative with the ship ahead."""
    n = -10.0
    u = J_S * n * D
    found = at(u, 0.0, 0.0, n, 0.0).propeller
    assert found.J[0] == pytest.approx(J_S * (1.0 - 0.614) if u > 0.0 else J_S)
    K_T = -0.175 + 0.330 * J_S if J_S >= -0.233 else -0.251
    assert found.force.X[0] == pytest.approx(RHO * n**2 * D**4 * K_T)
    k = (5, None) if J_S > -0.06 else (3, 4) if J_S < -0.35 else (1, 2)
    Y, N = (of[k[0]] + (of[k[1]] * J_S if k[1] else 0.0) for of in (A, B))
    q = 0.5 * RHO * L * draught * (n * D) ** 2
    assert found.force.Y[0] == pytest.approx(q * Y)
    assert found.force.N[0] == pytest.approx(q * L * N)


def jet_of(found):
    return 8.0 / math.pi * found.propeller.K_T[0] * (10.0 * D) ** 2


@pytest.mark.parametrize(("v", "r"), [(0.08, 0.02), (-0.08, -0.02), (0.02, 0.04)])
@pytest.mark.parametrize("delta", [0.3, -0.2])
def test_rudder_ahead(at, esso_osaka, v, r, delta):
    u, n, eta = 0.35, 10.0, D / H_R
    found = at(u, v, r, n, delta)
    u_P, jet = found.wake.u_P[0], jet_of(found)
    race = u_P + 0.2028 * (math.sqrt(u_P**2 + jet) - u_P)
    u_R = 1.42 * math.sqrt(eta * race**2 + (1.0 - eta) * u_P**2)
    x_R = esso_osaka.profile.value("rudder.x_R_") * L
    gamma = 0.3506 if v + x_R * r >= 0.0 else 0.4406
    v_R = -gamma * (v - 1.08 * L * r)
    assert found.rudder.u_R[0] == pytest.approx(u_R, rel=1e-3)
    assert found.rudder.v_R[0] == pytest.approx(v_R, rel=1e-9)
    alpha = delta - math.atan2(v_R, u_R)
    assert found.rudder.alpha_R[0] == pytest.approx(alpha, abs=1e-6)
    area, slope = esso_osaka.profile.value("rudder.A_R"), esso_osaka.profile.value("rudder.f_alpha")
    F_N = 0.5 * RHO * area * slope * (u_R**2 + v_R**2) * math.sin(alpha)
    assert found.rudder.F_N[0] == pytest.approx(F_N, rel=1e-6)
    F_N, force = found.rudder.F_N[0], found.rudder.force
    assert force.X[0] == pytest.approx(-(1.0 - 0.19) * F_N * math.sin(delta))
    assert force.Y[0] == pytest.approx(-(1.0 + 0.393) * F_N * math.cos(delta))
    assert force.N[0] == pytest.approx(-(x_R + 0.393 * -0.45 * L) * F_N * math.cos(delta))


@pytest.mark.parametrize("u", [0.5, 0.15])
def test_rudder_behind_a_braking_propeller(at, u):
    """Kitagawa et al. 2015: the race against the motion may turn the inflow round."""
    eta = D / H_R
    found = at(u, 0.0, 0.0, -10.0, 0.2)
    K_T = found.propeller.K_T[0]
    assert K_T < -0.1
    u_2 = 1.42 * found.wake.u_P[0]
    u_1 = u_2 - 10.0 * D * 0.144 * math.sqrt(8.0 * abs(K_T) / math.pi)
    s = eta * math.copysign(u_1**2, u_1) + (1.0 - eta) * u_2**2 - 0.176 * u**2
    assert found.rudder.u_R[0] == pytest.approx(math.copysign(math.sqrt(abs(s)), s), rel=1e-3)


def test_rudder_of_a_ship_going_astern(at):
    assert at(-0.4, 0.0, 0.0, -10.0, 0.2).rudder.u_R[0] == pytest.approx(-0.4)
