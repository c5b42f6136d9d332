"""What must hold for any ship and state, whatever the numbers are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmgtune.backends import Integrator, get_backend, pad
from mmgtune.model import Model
from mmgtune.physics import prime
from mmgtune.physics.arrangements.single_propeller_single_rudder import Control, derivatives, forces
from mmgtune.physics.quantities import State
from mmgtune.profile import froude_scaled, load_profile
from tests.runs import states, turn

PROPELLER_SIDE = ["C_PY0", "C_PY1", "C_PY2", "C_PN0_low", "C_PN1_low", "C_PN0_high", "C_PN1_high"]
PROPELLER_SIDE += [f"{letter}_{i}" for letter in "AB" for i in range(1, 9)]
finite = st.floats(-1.0, 1.0)


CASES = {**{f"r_{4 * i + j}": f"r_{4 * (3 - i) + j}" for i in range(4) for j in range(1, 5)}, "C_1": "C_4"}
CASES |= {"C_2": "C_3", "C_3": "C_2", "C_4": "C_1", **{f"gamma_{i}": f"gamma_{5 - i}" for i in range(1, 5)}}
ODD = ["a_2", "a_4", "b_1", "b_2", *(f"{letter}_{k}" for letter in "eh" for k in (1, 2, 3))]
ODD += [f"r_{4 * i + j}" for i in range(4) for j in (3, 4)]


def mirrored_pair(model, theta):
    """A port rudder that is the starboard one in a mirror, a propeller that does not know the side, one thrust."""
    for symbol in model.profile.sections["rudder_stbd"].coefficients:
        own = theta[model.rows[f"rudder_stbd.{CASES.get(symbol, symbol)}"]]
        theta[model.rows[f"rudder_port.{symbol}"]] = -own if symbol in ODD else own
    for name in ("b_2", "d_2"):
        theta[model.rows[f"propulsion.{name}"]] = 0.0
    theta[model.rows["thruster.K_Tn"]] = theta[model.rows["thruster.K_Tp"]]
    return theta


def symmetric(model):
    """Coefficients of the same ship with port and starboard alike."""
    theta = model.matrix()
    for name in PROPELLER_SIDE:
        if f"propeller.{name}" in model.rows:
            theta[model.rows[f"propeller.{name}"]] = 0.0
    if "rudder_pair" in model.arrangement.kinds:
        return mirrored_pair(model, theta)
    theta[model.rows["rudder.gamma_Rn"]] = theta[model.rows["rudder.gamma_Rp"]]
    if "rudder.C_port" in model.rows:
        theta[model.rows["rudder.C_port"]] = theta[model.rows["rudder.C_stbd"]]
    if "wake.C_2n" in model.rows:
        theta[model.rows["wake.C_2n"]] = theta[model.rows["wake.C_2p"]]
    return theta


def test_mirror_symmetry(any_model):
    theta = symmetric(any_model)
    starboard = states(any_model, turn(any_model, 25.0), theta)[0, 0]
    port = states(any_model, turn(any_model, -25.0), theta)[0, 0]
    np.testing.assert_allclose(port * [1, -1, -1, 1, -1, -1], starboard, rtol=1e-10, atol=1e-9)


def test_the_real_ship_is_not_symmetric(suzaku):
    starboard = states(suzaku, turn(suzaku, 25.0))[0, 0]
    port = states(suzaku, turn(suzaku, -25.0))[0, 0]
    assert np.abs(port[-1] * [1, -1, -1, 1, -1, -1] - starboard[-1]).max() > 1.0


@settings(max_examples=20, deadline=None)
@given(heading=st.floats(-20.0, 20.0), north=st.floats(-1e4, 1e4), east=st.floats(-1e4, 1e4))
def test_heading_rotation_and_shift(heading, north, east):
    model = Model(load_profile("suzaku"))
    speed = model.profile.approach.speed
    straight = states(model, turn(model, 35.0, 300.0))[0, 0]
    rotated = states(model, turn(model, 35.0, 300.0, initial=[north, east, heading, speed, 0, 0]))[0, 0]
    c, s = np.cos(heading), np.sin(heading)
    expected = np.column_stack(
        [
            north + c * straight[:, 0] - s * straight[:, 1],
            east + s * straight[:, 0] + c * straight[:, 1],
            heading + straight[:, 2],
        ]
    )
    np.testing.assert_allclose(rotated[:, :3], expected, atol=1e-8)
    np.testing.assert_allclose(rotated[:, 3:], straight[:, 3:], atol=1e-10)


@pytest.mark.parametrize(("name", "order"), [("euler", 1), ("rk4", 4)])
def test_order_of_convergence(suzaku, name, order):
    """Errors against a fine run fall with the power of the step that the method promises, on smooth inputs.

    The state is kept in a turn to one side, where no component switches branches.
    """
    t = np.linspace(0.0, 64.0, 9)
    start = states(suzaku, turn(suzaku, 20.0, 200.0))[0, 0, -1]
    controls = np.column_stack([np.full(9, 106 / 60), np.radians(20.0) * np.ones(9)])
    cases = pad([t], [controls], [start])
    exact = states(suzaku, cases, integrator=Integrator("rk4", 256))[0, 0, -1]
    errors = [
        np.abs(states(suzaku, cases, integrator=Integrator(name, k))[0, 0, -1] - exact).max() for k in (8, 16, 32)
    ]
    slopes = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert slopes == pytest.approx(order, abs=0.35)


@given(
    L=st.floats(1.0, 400.0), d=st.floats(0.1, 30.0), U=st.floats(0.01, 20.0), rho=st.floats(900.0, 1100.0), value=finite
)
def test_prime_system_round_trip(L, d, U, rho, value):
    for unit in (
        prime.mass_unit(rho, L, d),
        prime.inertia_unit(rho, L, d),
        prime.force_unit(rho, L, d, U),
        prime.moment_unit(rho, L, d, U),
    ):
        assert unit > 0.0
        assert value * unit / unit == pytest.approx(value, rel=1e-14)
    assert prime.moment_unit(rho, L, d, U) == pytest.approx(prime.force_unit(rho, L, d, U) * L)
    assert prime.inertia_unit(rho, L, d) == pytest.approx(prime.mass_unit(rho, L, d) * L**2)


def test_froude_scaling(any_model):
    """A ship ten times as long moves alike: lengths times 10, times and speeds times the root of 10."""
    scale, root = 10.0, np.sqrt(10.0)
    larger = Model(froude_scaled(any_model.profile, scale, id="larger", name="ten times as long"))
    cases = turn(any_model, 30.0, 100.0)
    turns = [1.0 if one.role == "rudder" else 1.0 / root for one in any_model.arrangement.inputs]
    slow = pad([cases.t[0] * root], [cases.controls[0] * turns], [cases.initial[0] * [1, 1, 1, root, root, 1 / root]])
    a, b = states(any_model, cases)[0, 0], states(larger, slow)[0, 0]
    np.testing.assert_allclose(b / [scale, scale, 1, root, root, 1 / root], a, rtol=1e-9, atol=1e-9)


@settings(max_examples=200, deadline=None)
@given(
    name=st.sampled_from(["suzaku", "kvlcc2", "kvlcc2_l7"]),
    u=finite,
    v=finite,
    r=finite,
    n=finite,
    delta=st.floats(-3.2, 3.2),
)
def test_forces_are_finite_everywhere(name, u, v, r, n, delta):
    """Ahead, astern, sideways, at rest, with the propeller stopped or reversed, at any rudder angle."""
    model = Model(load_profile(name))
    p = model.coefficients(model.matrix())
    speed, turning = 10.0, 20.0 / model.L_pp
    state = State(0.0, 0.0, 0.0, *np.array([[u * speed], [v * speed], [r * turning]]))
    found = forces(state, Control(np.array([4 * n]), np.array([delta])), model.components, p)
    for part in found:
        for value in part:
            values = value if isinstance(value, tuple) else (value,)
            assert all(np.isfinite(v).all() for v in values)


@pytest.mark.parametrize("start", [[0, 0, 0], [-2, 0, 0], [0, 1, 0], [0, 0, 0.02], [1e-9, -1e-9, 0]])
@pytest.mark.parametrize("n", [0.0, -1.0, 1.0])
def test_standstill_and_reverse_do_not_blow_up(any_model, start, n):
    scale = np.sqrt(any_model.L_pp / 83.0)
    u, v, r = np.array(start) * [scale, scale, 1 / scale]
    cases = turn(any_model, 20.0, 600.0, dt=0.5 * scale, initial=[0, 0, 0, u, v, r], n=n / scale)
    result = get_backend().run(any_model, any_model.matrix(), cases, keep_states=True)
    assert not result.diverged.any()
    assert np.abs(result.states[..., 3:5]).max() < 10.0 * scale


def test_a_ship_at_rest_with_a_stopped_propeller_stays(any_model):
    run = states(any_model, turn(any_model, 20.0, 100.0, initial=[0] * 6, n=0.0))
    assert np.abs(run).max() == 0.0


def test_resistance_opposes_the_motion_either_way(any_model):
    p = any_model.coefficients(any_model.matrix())
    for u in (2.0, -2.0):
        state = State(0.0, 0.0, 0.0, np.array([u]), np.zeros(1), np.zeros(1))
        control = any_model.arrangement.control(*(np.zeros(1) for _ in any_model.inputs))
        assert any_model.arrangement.forces(state, control, any_model.components, p).hull.X * u < 0.0


def test_derivatives_of_position_are_velocities_in_the_earth_frame(suzaku):
    p = suzaku.coefficients(suzaku.matrix())
    one = np.ones(1)
    rate = derivatives(
        State(0 * one, 0 * one, 0.5 * np.pi * one, 3.0 * one, 0.5 * one, 0.01 * one),
        Control(one, 0 * one),
        suzaku.components,
        p,
    )
    assert float(rate.x[0]) == pytest.approx(-0.5)
    assert float(rate.y[0]) == pytest.approx(3.0)
    assert float(rate.psi[0]) == 0.01
