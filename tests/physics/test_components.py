"""Each component against numbers worked out by hand or printed in its source."""

import re

import numpy as np
import pytest

from mmgtune.components import COMPONENTS
from mmgtune.model import Model
from mmgtune.physics.arrangements.single_propeller_single_rudder import Control, forces
from mmgtune.physics.kinematics import R_PRIME_MAX, flow
from mmgtune.physics.propeller.four_quadrant import four_quadrant_propeller
from mmgtune.physics.quantities import State, WakeOut
from mmgtune.physics.rigid_body import accelerations
from mmgtune.physics.rudder.flapped import flap_angle
from mmgtune.profile import load_profile

FLAP = np.radians([0, 10, 18, 25, 30, 34.5, 38, 41, 43.5, 45])


def coefficients(model):
    return model.coefficients(model.matrix())


@pytest.mark.parametrize("component", COMPONENTS, ids=lambda c: f"{c.kind}-{c.tag}")
def test_every_component_says_what_it_is(component):
    assert component.title
    assert component.cites
    assert component.function is None or re.search(r"(19|20)\d\d", component.function.__doc__ or "")
    for symbol, field in component.fields.items():
        assert field.label, symbol
        assert field.unit, symbol


def test_flap_table_is_interpolated_and_odd():
    delta = np.radians(np.linspace(-60.0, 60.0, 1201))
    expected = np.sign(delta) * np.interp(np.abs(delta), np.radians(np.arange(0, 50, 5)), FLAP)
    np.testing.assert_allclose(flap_angle(delta, np.radians(5.0), tuple(FLAP)), expected, atol=1e-14)


def test_converted_thrust_coefficient(suzaku):
    """K_T of the converted four-quadrant polynomial at J = 0, 0.1, ..., 0.7: a normal open-water curve."""
    p = coefficients(suzaku)
    n, D = 106 / 60, 2.80
    J = np.arange(0.0, 0.75, 0.1)
    lanes = type(p.propeller)(*(np.repeat(v, len(J)) for v in p.propeller))
    found = four_quadrant_propeller(None, WakeOut(0 * J, J * n * D, 0 * J), np.full(len(J), n), p.ship, lanes)
    np.testing.assert_allclose(found.K_T, [0.317, 0.300, 0.276, 0.244, 0.205, 0.159, 0.107, 0.049], atol=1e-3)
    np.testing.assert_allclose(found.J, J, atol=1e-12)
    np.testing.assert_allclose(found.jet, 8 / np.pi * found.K_T * (n * D) ** 2)


def test_thrust_and_resistance_at_six_knots(suzaku):
    """At 3.086 m/s and 106 rpm, going straight: X_P = 39.9 kN, X_H = -26.2 kN."""
    state = State(*(np.array([v]) for v in (0.0, 0.0, 0.0, 3.086, 0.0, 0.0)))
    found = forces(state, Control(np.array([106 / 60]), np.array([0.0])), suzaku.components, coefficients(suzaku))
    assert found.propeller.force.X[0] == pytest.approx(39.9e3, abs=100.0)
    assert found.hull.X[0] == pytest.approx(-26.2e3, abs=100.0)


def test_slipstream_of_the_rudder_by_both_readings(suzaku):
    """u_R of eq. 30 at the same state: 3.45 m/s converted, 2.99 m/s with the printed polynomial taken literally."""
    state = State(*(np.array([v]) for v in (0.0, 0.0, 0.0, 3.086, 0.0, 0.0)))
    control = Control(np.array([106 / 60]), np.array([0.0]))
    for reading, u_R in ((0.0, 3.45), (1.0, 2.99)):
        p = suzaku.coefficients(suzaku.matrix(["propeller.slipstream_kt"], [[reading]]))
        assert forces(state, control, suzaku.components, p).rudder.u_R[0] == pytest.approx(u_R, abs=0.02)


def test_hull_by_hand(suzaku):
    """v' = -0.1 and r' = 0.3 put into eq. 15."""
    L, d, rho = 83.0, 3.8, 1025.0
    u, v = np.sqrt(9.0 - 0.09), -0.3  # U = 3 m/s
    state = State(*(np.array([q]) for q in (0.0, 0.0, 0.0, u, v, 0.3 * 3.0 / L)))
    hull = forces(state, Control(np.array([1.0]), np.array([0.0])), suzaku.components, coefficients(suzaku)).hull
    X = -0.017 + 0.009 * 0.01 - 0.008 * -0.03 - 0.0164 * 0.09 - 0.824 * (-0.001 * 0.3) - 0.114 * 1e-4
    Y = -0.329 * -0.1 + 0.1 * 0.3 - 0.787 * -0.001 - 0.022 * 0.003 - 0.206 * -0.009 + 0.001 * 0.027
    N = -0.106 * -0.1 - 0.057 * 0.3 - 0.037 * -0.001 - 0.105 * 0.003 + 0.012 * -0.009 - 0.008 * 0.027
    q = 0.5 * rho * L * d * 9.0
    assert hull.X[0] == pytest.approx(q * X, rel=1e-12)
    assert hull.Y[0] == pytest.approx(q * Y, rel=1e-12)
    assert hull.N[0] == pytest.approx(q * L * N, rel=1e-12)


@pytest.mark.parametrize("u", [2.0, -1.0])
def test_drift_angle_has_the_sign_of_the_paper(u):
    found = flow(np.array([u]), np.array([-0.5]), np.array([0.01]), 83.0)
    assert found.beta[0] == pytest.approx(np.arctan2(0.5, u))
    assert found.v_[0] < 0.0 < found.r_[0]


def test_reference_speed_keeps_r_prime_bounded_and_nothing_else_changes():
    usual = flow(np.array([3.0]), np.array([0.4]), np.array([0.02]), 83.0)
    assert usual.U[0] == np.hypot(3.0, 0.4)
    spinning = flow(np.array([0.0]), np.array([0.0]), np.array([0.02]), 83.0)
    assert spinning.r_[0] == pytest.approx(R_PRIME_MAX)


def test_equations_of_motion_balance(suzaku):
    """The accelerations put back into eq. 7 give the forces."""
    p = coefficients(suzaku).ship
    u, v, r, X, Y, N = (np.array([q]) for q in (2.5, -0.4, 0.012, 3e4, -5e4, 8e5))
    u_dot, v_dot, r_dot = accelerations(u, v, r, X, Y, N, p)
    L, d, rho = 83.0, 3.8, 1025.0
    m = rho * L * 13.5 * d * 0.737
    m_x, m_y, J_zz = 0.010 * 0.5 * rho * L**2 * d, 0.168 * 0.5 * rho * L**2 * d, 0.010 * 0.5 * rho * L**4 * d
    I_G, x_G = m * (0.25 * L) ** 2, 0.93
    assert m == pytest.approx(3.217e6, rel=1e-3)
    assert (m + m_x) * u_dot - (m + m_y) * v * r - x_G * m * r**2 == pytest.approx(X)
    assert (m + m_y) * v_dot + (m + m_x) * u * r + x_G * m * r_dot == pytest.approx(Y)
    assert (I_G + x_G**2 * m + J_zz) * r_dot + x_G * m * (v_dot + u * r) == pytest.approx(N)


def test_wake_is_largest_at_zero_inflow_angle_and_fades(suzaku):
    p = coefficients(suzaku)
    for beta in (0.0, 0.3, -0.3):
        water = flow(np.array([np.cos(beta)]), np.array([-np.sin(beta)]), np.array([0.0]), 83.0)
        found = suzaku.components.wake(water, p.wake)
        assert found.w_P[0] == pytest.approx(0.422 * np.exp(-2.0 * beta**2))
        assert found.u_P[0] == pytest.approx((1 - found.w_P[0]) * np.cos(beta))


def test_asymmetric_wake_by_hand():
    model = Model(load_profile("kvlcc2_l7"))
    p = coefficients(model)
    for beta, C_2 in ((0.2, 1.6), (-0.2, 1.1)):
        water = flow(np.array([np.cos(beta)]), np.array([-np.sin(beta)]), np.array([0.0]), 7.0)
        w_P = model.components.wake(water, p.wake).w_P[0]
        assert (1 - w_P) / (1 - 0.40) == pytest.approx(1 + (1 - np.exp(-2.0 * 0.2)) * (C_2 - 1))


@pytest.mark.parametrize("phi", [3.0, 19.0, 21.0, 35.0])
def test_side_force_and_moment_of_the_four_quadrant_propeller(suzaku, phi):
    """C_PY and the two pieces of C_PN printed beside eq. 16-22, at an inflow angle in degrees."""
    p = coefficients(suzaku)
    n, D_P = 1.5, 2.8
    u_P = 0.7 * np.pi * n * D_P * np.tan(np.radians(phi))
    found = four_quadrant_propeller(
        None, WakeOut(*(np.array([v]) for v in (0.0, u_P, 0.0))), np.array([n]), p.ship, p.propeller
    ).force
    q = 0.5 * 1025.0 * 0.25 * np.pi * D_P**2 * (u_P**2 + (0.7 * np.pi * n * D_P) ** 2)
    C_PN = -2.48e-4 * phi - 1.70e-3 if phi < 20.0 else -1.86e-4 * phi + 4.03e-3
    assert found.Y[0] == pytest.approx(q * (-2.83e-5 * phi**2 + 6.04e-4 * phi - 1.28e-2))
    assert found.N[0] == pytest.approx(q * 83.0 * C_PN)


def test_no_force_of_the_four_quadrant_propeller_jumps(suzaku):
    """As printed C_PN jumps at 20 deg, and searches for other coefficients ended on the steps that this makes of J."""
    p = coefficients(suzaku)
    n, phi = 1.5, np.linspace(15.0, 25.0, 10_001)
    u_P = 0.7 * np.pi * n * p.propeller.D_P * np.tan(np.radians(phi))
    wake = WakeOut(0.0 * u_P, u_P, 0.0 * u_P)
    for force in four_quadrant_propeller(None, wake, np.full_like(u_P, n), p.ship, p.propeller).force:
        assert np.abs(np.diff(force)).max() < 1e-3 * np.ptp(force)


@pytest.mark.parametrize("name", ["suzaku", "kvlcc2_l7", "esso_osaka_3m"])
def test_angle_of_attack_of_the_rudder(name):
    """alpha_R is the rudder angle less that of the inflow; beta_R the drift at the place that l_R' stands for."""
    model = Model(load_profile(name))
    state = State(*(np.array([q]) for q in (0.0, 0.0, 0.0, 0.5, -0.1, 0.01)))
    found = forces(state, Control(np.array([8.0]), np.array([0.2])), model.components, coefficients(model)).rudder
    assert found.v_R[0] != 0.0
    assert found.alpha_R[0] == pytest.approx(0.2 - np.arctan2(found.v_R[0], found.u_R[0]))
    beta, r_ = np.arctan2(0.1, 0.5), 0.01 * model.L_pp / np.hypot(0.5, 0.1)
    assert found.beta_R[0] == pytest.approx(beta - model.profile.value("rudder.l_R_") * r_)
