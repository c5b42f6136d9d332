"""The 3 m Esso Osaka with captive-test coefficients: sums, speeds and the crash stop of independent computations."""

import numpy as np
import pytest
from scipy.integrate import quad

from mmgtune.backends import Integrator, pad
from mmgtune.physics.arrangements.single_propeller_single_rudder import Control, forces
from mmgtune.physics.hull.unified import cross_flow
from mmgtune.physics.kinematics import flow
from mmgtune.physics.quantities import State
from tests.runs import states, turn


def test_mass_and_inertia(esso_osaka):
    value = esso_osaka.profile.value
    L, d = 3.0, value("particulars.d")
    mass = 998.0 * L * value("particulars.B") * d * value("particulars.C_b")
    assert mass == pytest.approx(244.6, abs=0.1)
    m_ = mass / (0.5 * 998.0 * L**2 * d)
    assert m_ == pytest.approx(0.27078, abs=1e-4)
    assert m_ * value("particulars.k_zz_") ** 2 + value("particulars.J_zz_") == pytest.approx(0.0286, abs=2e-5)


@pytest.mark.parametrize(("n", "speed"), [(8.0, 0.315), (10.0, 0.396), (12.0, 0.476), (16.67, 0.662)])
def test_speed_straight_ahead(esso_osaka, n, speed):
    cases = turn(esso_osaka, 0.0, seconds=900.0, dt=0.5, n=n, initial=[0, 0, 0, 0.4, 0, 0])
    assert states(esso_osaka, cases)[0, 0, -1, 3] == pytest.approx(speed, abs=0.003)


def test_ten_coefficients_of_wind(esso_osaka):
    """Published for this ship independently of the regression."""
    published = {
        "X_0": -0.010466, "X_1": -0.821992, "X_3": 0.060274, "X_5": 0.044558,
        "Y_1": 1.058172, "Y_3": 0.002321, "Y_5": -0.015293,
        "N_1": -0.030728, "N_2": 0.104116, "N_3": -0.000880,
    }  # fmt: skip
    for name, value in published.items():
        assert esso_osaka.profile.value(f"above_water.{name}") == pytest.approx(value, abs=1e-6)


def test_crash_stop_swings_to_starboard(esso_osaka):
    """From 0.3 m/s with ten revolutions astern: at rest after about a minute, bow to starboard by 1.3 deg/s."""
    t = np.arange(0.0, 120.0, 0.1)
    controls = np.column_stack([np.full(len(t), -10.0), np.zeros(len(t))])
    cases = pad([t], [controls], [np.array([0.0, 0.0, 0.0, 0.3, 0.0, 0.0])])
    motion = states(esso_osaka, cases, integrator=Integrator("rk4"))[0, 0]
    stops = t[np.argmax(motion[:, 3] < 0.0)]
    assert 45.0 < stops < 75.0
    assert np.degrees(motion[:, 5].max()) == pytest.approx(1.3, abs=0.3)
    assert motion[:, 5].min() > -1e-3


@pytest.mark.parametrize("a", [0.0, 1e-9, 0.03, -0.2, 0.5, 0.7, -2.0])
@pytest.mark.parametrize("b", [0.0, 1e-9, 0.4, -1.0, 1.4])
def test_cross_flow_integrals_are_exact(a, b):
    inside = [-a / b] if b and abs(a / b) < 0.5 else None
    force = quad(lambda x: abs(a + b * x) * (a + b * x), -0.5, 0.5, points=inside, epsabs=1e-13)[0]
    moment = quad(lambda x: abs(a + b * x) * (a + b * x) * x, -0.5, 0.5, points=inside, epsabs=1e-13)[0]
    np.testing.assert_allclose(cross_flow(np.array([a]), np.array([b])), [[force], [moment]], atol=1e-12)


def _total(model, u, v_m, r, n, delta):
    """Total force (3, n_lanes) with each quantity a lane array."""
    lanes = np.broadcast_arrays(*(np.asarray(q, dtype=float) for q in (u, v_m, r, n, delta)))
    theta = np.repeat(model.matrix(), lanes[0].size, axis=1)
    zero = np.zeros(lanes[0].size)
    state = State(zero, zero, zero, *lanes[:3])
    return np.array(forces(state, Control(*lanes[3:]), model.components, model.coefficients(theta)).total)


@pytest.mark.parametrize("n", [10.0, 0.0, -10.0])
@pytest.mark.parametrize("v_m", [0.0, 0.03, -0.1])
def test_nothing_jumps_while_the_ship_passes_through_rest(esso_osaka, n, v_m):
    """Steps of 0.1 mm/s change the force by a small share of the thrust, through u = 0 and all pieces around it."""
    u = np.arange(-0.3, 0.3, 1e-4)
    found = _total(esso_osaka, u, v_m, 0.01, n, np.radians(20.0))
    thrust = 998.0 * 10.0**2 * 0.084**4 * 0.33
    assert np.abs(np.diff(found, axis=1)).max() < 0.01 * thrust
    assert np.isfinite(_total(esso_osaka, 0.0, 0.0, 0.0, n, 0.3)).all()


@pytest.mark.parametrize("u", [0.3, -0.2])
def test_thrust_fades_through_no_revolutions(esso_osaka, u):
    n = np.array([-1e-3, -1e-6, 0.0, 1e-6, 1e-3])
    lanes = np.full(5, u)
    p = esso_osaka.coefficients(np.repeat(esso_osaka.matrix(), 5, axis=1))
    found = forces(
        State(0 * n, 0 * n, 0 * n, lanes, 0 * n, 0 * n), Control(n, 0 * n), esso_osaka.components, p
    ).propeller
    assert np.abs(found.force.X).max() < 1e-3


def test_wake_is_kept_within_its_limits(esso_osaka):
    p = esso_osaka.coefficients(np.repeat(esso_osaka.matrix(), 200, axis=1))
    angle = np.linspace(-np.pi, np.pi, 200)
    water = flow(np.cos(angle), -np.sin(angle), np.full(200, 0.5), 3.0)
    w_P = esso_osaka.components.wake(water, p.wake).w_P
    assert w_P.min() >= 0.0
    assert w_P.max() < 1.0
    assert np.all(w_P[np.cos(angle) < 0.0] == 0.0)


def test_cross_flow_resists_sway_and_turning(esso_osaka):
    p = esso_osaka.coefficients(np.repeat(esso_osaka.matrix(), 2, axis=1))
    sideways = esso_osaka.components.hull(flow(np.zeros(2), np.array([0.1, -0.1]), np.zeros(2), 3.0), p.ship, p.hull)
    assert sideways.Y[0] < 0.0 < sideways.Y[1]
    turning = esso_osaka.components.hull(flow(np.zeros(2), np.zeros(2), np.array([0.05, -0.05]), 3.0), p.ship, p.hull)
    assert turning.N[0] < 0.0 < turning.N[1]


def test_a_propeller_against_the_motion_takes_flow_from_the_rudder(esso_osaka):
    p = esso_osaka.coefficients(np.repeat(esso_osaka.matrix(), 3, axis=1))
    zero, n = np.zeros(3), np.array([10.0, -5.0, -10.0])
    state = State(zero, zero, zero, np.full(3, 0.3), zero, zero)
    u_R = forces(state, Control(n, zero), esso_osaka.components, p).rudder.u_R
    assert u_R[0] > u_R[1] > u_R[2]
