"""The VecTwin ship: Kang's twin rudders against a reference with branches, and what each actuator does to her."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mmgtune.backends import Integrator, pad
from mmgtune.model import Model
from mmgtune.motions import breakdown
from mmgtune.physics.actuation import actuated, approach_rate, moved
from mmgtune.physics.rudder.kang import AMIDSHIPS, stalling_normal_force
from mmgtune.physics.stochastic_wind import deviation, sigma_of, wind_step
from mmgtune.profile import load_profile
from mmgtune.units import DEG
from tests.runs import states


@pytest.fixture(scope="module")
def ship():
    return Model(load_profile("vectwin_3m"))


def at(ship, u=0.0, v=0.0, r=0.0, port=0.0, stbd=0.0, bow=0.0):
    """Breakdown at one state, or along arrays; angles in degrees, revolutions of the profile."""
    u, v, r, port, stbd, bow = np.broadcast_arrays(*map(np.atleast_1d, (u, v, r, port, stbd, bow)))
    none = 0.0 * u
    state = np.column_stack([none, none, none, u, v, r]).astype(float)
    controls = np.column_stack([none + ship.profile.approach.n, port * DEG, stbd * DEG, bow])
    return breakdown(ship, state, controls)


# ------------------------------------------------------------------------------------------- a reference with branches


def clip(x, low, high):
    return min(max(x, low), high)


def reference(ship, u, v, r, port, stbd):
    """Normal forces of both rudders [N] and thrust on the ship [N] as the source has them, revolutions ahead."""
    value = ship.profile.value

    def p(name):
        return value(name)

    rho, L, n = p("particulars.rho"), p("particulars.L_pp"), ship.profile.approach.n
    D, pitch = p("propulsion.D_P"), p("propulsion.pitch_")
    U = math.hypot(u, v)
    beta, v_, r_ = math.atan2(-v, u), v / U, r * L / U

    def three(section, letter):
        return [p(f"{section}.{letter}_{k}") for k in (1, 2, 3)]

    a, b, c, d = (three("propulsion", letter) for letter in "abcd")
    v_P = v_ + p("propulsion.x_P_") * r_
    J_s = u / (n * D)
    w_P = 0.0
    if u > 0.0:
        w_P0 = 1.0 - (a[0] + a[1] * J_s + a[2] * J_s**2)
        w_P = w_P0 - b[0] * (b[1] * v_P + (v_P + b[2] * v_P * abs(v_P)) ** 2)
        w_P = 1.0 - clip(1.0 - w_P, 0.02, 1.0)
    u_P = (1.0 - w_P) * u
    J = u_P / (n * D)
    if -0.1 < J < 0.0:
        return math.nan, math.nan, math.nan  # where the polynomials of the thrust were joined
    t_P0 = 1.0 - (c[0] + c[1] * J + c[2] * J**2)
    t_P = t_P0 - d[0] * (d[1] * v_P + (v_P + d[2] * v_P * abs(v_P)) ** 2)
    t_P = 1.0 - clip(1.0 - t_P, 0.02, 1.0)
    k = [p(f"propulsion.k_{i}{'' if J >= 0.0 else 'n'}") for i in (0, 1, 2)]
    K_T = k[0] + k[1] * J + k[2] * J**2
    s = clip(1.0 - u_P / (n * pitch * D), 0.0, 1.2)
    forces = []
    for side, kind, delta, other in ((-1.0, "rudder_port", port, stbd), (1.0, "rudder_stbd", stbd, port)):

        def in_slip(letter, kind=kind):
            return sum(x * s**i for i, x in enumerate(three(kind, letter)))

        delta_1 = delta - (p(f"{kind}.b_1") + p(f"{kind}.b_2") * s)
        factor = abs(math.cos(delta_1)) if side * delta_1 > 0.0 else 1.0
        delta_2 = delta_1 - (in_slip("d") * other + in_slip("e") * other**2) * factor
        one_minus_w_R = sum(p(f"{kind}.a_{i + 1}") * delta**i for i in range(4))
        eps = one_minus_w_R / (1.0 - w_P)
        kappa = p("rudder_pair.k_x") / eps
        eta = D / p("rudder_pair.H_R")
        behind = u_P + kappa * (math.sqrt(u_P**2 + 8.0 * K_T * n**2 * D**2 / math.pi) - u_P)
        u_R = eps * math.sqrt(eta * behind**2 + (1.0 - eta) * u_P * abs(u_P))  # astern outside the race: the sign kept
        if side * delta_2 > 0.0:
            u_R *= min(1.0, in_slip("g") + in_slip("h") * delta_2 + in_slip("k") * delta_2**2)
        case = {(True, False): 1, (False, False): 2, (True, True): 3, (False, True): 4}[beta >= 0.0, delta_2 >= 0.0]
        r_a, r_b, r_c, r_d = (p(f"{kind}.r_{4 * (case - 1) + i}") for i in (1, 2, 3, 4))
        gamma = (r_a + r_b * abs(beta) + (r_c + r_d * abs(beta)) * delta_2) * abs(beta)
        gamma = clip(gamma, 0.0, p(f"{kind}.gamma_{case}"))
        j = {(True, True): 1, (True, False): 2, (False, True): 3, (False, False): 4}[r >= 0.0, delta_2 >= 0.0]
        v_R = -gamma * v - p(f"{kind}.C_{j}") * p("rudder_pair.x_R_") * L * r
        alpha = delta_2 - math.atan2(v_R, u_R)
        size = abs(alpha)
        C_N = 2.6252 * math.sin(size) if size <= 0.6545 else -0.8449 * size**2 + 2.0621 * size + 0.6387
        forces.append(math.copysign(0.5 * rho * p("rudder_pair.A_R") * (u_R**2 + v_R**2) * C_N, alpha))
        if abs(delta_2) < AMIDSHIPS or 0.6545 < size < 0.69 or size > 2.7:
            forces[-1] = math.nan  # where pieces of the source were joined
    thrust = (1.0 - t_P) * rho * n**2 * D**4 * K_T
    return (*forces, thrust)


def test_forces_are_those_of_the_source(ship):
    rng = np.random.default_rng(3)
    compared = 0
    for _ in range(300):
        u, v, r = rng.uniform(-0.3, 0.6), rng.uniform(-0.15, 0.15), rng.uniform(-0.08, 0.08)
        port, stbd = rng.uniform(-105.0, 35.0), rng.uniform(-35.0, 105.0)
        found = at(ship, u, v, r, port, stbd)
        expected = reference(ship, u, v, r, port * DEG, stbd * DEG)
        values = found.rudder_port.F_N[0], found.rudder_stbd.F_N[0], found.propeller.force.X[0]
        for one, right in zip(values, expected, strict=True):
            if not math.isnan(right):
                compared += 1
                assert one == pytest.approx(right, rel=1e-9, abs=1e-12)
    assert compared > 600


def test_the_bollard_by_hand(ship):
    """Rudders at 75 deg outward on a ship at rest: worked out with a pocket calculator."""
    found = at(ship, port=-75.0, stbd=75.0)
    assert found.propeller.force.X[0] == pytest.approx(2.721, abs=2e-3)  # 0.972 * 998 * 100 * 0.1001^4 * 0.2794
    assert found.rudder_stbd.u_R[0] == pytest.approx(0.4138, abs=1e-3)
    assert found.rudder_stbd.F_N[0] == pytest.approx(1.264, abs=4e-3)
    assert found.rudder_port.F_N[0] == pytest.approx(-1.501, abs=4e-3)


# --------------------------------------------------------------------------------------------- what the actuators do


def test_hovering_leaves_next_to_no_thrust(ship):
    ahead = at(ship).total.X[0]
    assert abs(at(ship, port=-75.0, stbd=75.0).total.X[0]) < 0.1 * ahead
    assert at(ship, port=-105.0, stbd=105.0).total.X[0] < -0.1 * ahead  # and more of it backs


def test_both_rudders_together_turn_the_ship_to_their_side(ship):
    for angle in (10.0, 20.0, 35.0):
        to_stbd, to_port = at(ship, 0.5, port=angle, stbd=angle).total, at(ship, 0.5, port=-angle, stbd=-angle).total
        assert to_stbd.N[0] > 0.0 > to_port.N[0]
        assert to_stbd.Y[0] < 0.0 < to_port.Y[0]


def test_one_rudder_over_turns_the_ship_at_rest(ship):
    """The starboard rudder at 40 deg with the port one far over throws the race to starboard, and the reverse."""
    to_stbd, to_port = at(ship, port=-105.0, stbd=40.0).total, at(ship, port=-40.0, stbd=105.0).total
    assert to_stbd.N[0] > 1.0
    assert to_port.N[0] < -1.0


def test_thruster_pushes_to_its_side_and_fades(ship):
    speed = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
    to_stbd = at(ship, speed, bow=20.0).thruster
    assert (to_stbd.Y > 0.0).all()
    assert (to_stbd.N > 0.0).all()
    assert (np.diff(to_stbd.Y) < 0.0).all()
    assert to_stbd.Y[-1] < 0.6 * to_stbd.Y[0]
    to_port = at(ship, speed, bow=-20.0).thruster
    np.testing.assert_allclose(to_port.Y, -to_stbd.Y * 0.2213 / 0.16684)
    assert at(ship, 0.66, bow=30.0).thruster.Y[0] == 0.0
    assert at(ship, -0.66, bow=30.0).thruster.N[0] == 0.0
    # Kobayashi's factor at rest, eq. 36 of Wakita et al.
    at_rest = 998.0 * 0.039**4 * 20.0**2 * 0.16684
    assert to_stbd.Y[0] == pytest.approx(1.2352 * at_rest)
    assert to_stbd.N[0] == pytest.approx(1.2231 * at_rest * 1.3564)


def sailed(ship, port, stbd, bow, initial=(0.0, 0.0, 0.0), seconds=30.0):
    """Last state of a run with constant inputs (angles in degrees)."""
    t = np.arange(0.0, seconds + 0.1, 0.2)
    inputs = np.tile([ship.profile.approach.n, port * DEG, stbd * DEG, bow], (len(t), 1))
    return states(ship, pad([t], [inputs], [np.array([0.0, 0.0, 0.0, *initial])]))[0, 0, -1]


def test_motions_of_a_vectwin_ship(ship):
    """Ahead, hovering, astern, swinging, and sideways with the thruster: all with the propeller turning ahead."""
    ahead = sailed(ship, 0.0, 0.0, 0.0)[3]
    assert ahead > 0.15
    assert abs(sailed(ship, -75.0, 75.0, 0.0)[3]) < 0.3 * ahead
    assert sailed(ship, -105.0, 105.0, 0.0)[3] < -0.02
    assert sailed(ship, -105.0, 40.0, 0.0)[5] > 0.01
    assert sailed(ship, -40.0, 105.0, 0.0)[5] < -0.01
    assert sailed(ship, -75.0, 75.0, 25.0)[4] > sailed(ship, -75.0, 75.0, 0.0)[4]
    stopping = sailed(ship, -90.0, 90.0, 0.0, (0.5, 0.0, 0.0))
    assert stopping[3] < 0.1


# ------------------------------------------------------------------------------------------------------ no kicks


def test_nothing_jumps_at_rest_amidships_or_at_the_stall(ship):
    fine = np.linspace(-0.02, 0.02, 4001)
    for swept in (
        at(ship, fine, 0.0, 0.0, -20.0, 30.0),
        at(ship, 0.3, 0.05, fine, -20.0, 30.0),
        at(ship, 0.3, -0.05, 0.03, np.linspace(-20.0, 20.0, 4001), 30.0),
        at(ship, 0.3, -0.05, 0.03, -30.0, np.linspace(-20.0, 20.0, 4001)),
        at(ship, np.linspace(0.5, 0.7, 4001), bow=30.0),
    ):
        for values in swept.total:
            steps = np.abs(np.diff(values))
            assert steps.max() < 0.01 * max(np.ptp(values), 0.05)


def test_normal_force_is_odd_and_continuous(ship):
    pair = ship.coefficients(ship.matrix()[:, 0]).rudder_pair
    alpha = np.linspace(-3.6, 3.6, 20001)
    C_N = stalling_normal_force(alpha, pair)
    np.testing.assert_allclose(C_N, -C_N[::-1], atol=1e-12)
    assert np.abs(np.diff(C_N)).max() < 1.5e-3
    assert (C_N * alpha >= 0.0).all()


@pytest.mark.parametrize(("name", "order"), [("euler", 1), ("rk4", 4)])
def test_order_of_convergence(ship, name, order):
    """Errors against a fine run fall with the power of the step, in a turn that stays on one side of every branch."""
    t = np.linspace(0.0, 12.0, 7)
    turning = sailed(ship, 20.0, 20.0, 5.0, (0.5, 0.0, 0.0), 120.0)
    controls = np.tile([ship.profile.approach.n, 20.0 * DEG, 20.0 * DEG, 10.0], (7, 1))
    cases = pad([t], [controls], [turning])
    exact = states(ship, cases, integrator=Integrator("rk4", 256))[0, 0, -1]
    errors = [np.abs(states(ship, cases, integrator=Integrator(name, k))[0, 0, -1] - exact).max() for k in (4, 8, 16)]
    slopes = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert slopes == pytest.approx(order, abs=0.35)


# ------------------------------------------------------------------------------------------- actuators and the wind


def test_actuators_move_at_their_rate_and_settle():
    """Eq. 39-40: constant rate outside the zone, in proportion inside; never beyond the order."""
    rate, zone = 20.0, 0.1
    assert approach_rate(0.0, 50.0, rate, zone) == rate
    assert approach_rate(0.0, -50.0, rate, zone) == -rate
    assert approach_rate(0.0, 1.0, rate, zone) == pytest.approx(10.0)  # half of the 2 deg that 0.1 s takes
    value, way = 0.0, []
    for _ in range(40):
        value = actuated(value, 50.0, rate, zone, 0.1)
        way.append(value)
    assert way[9] == pytest.approx(20.0)
    assert np.max(way) <= 50.0
    assert way[-1] == pytest.approx(50.0, abs=1e-4)
    # An Euler step of the zone's own length arrives exactly, as the limiter of standard manoeuvres does.
    assert 49.3 + 0.1 * approach_rate(49.3, 50.0, rate, zone) == pytest.approx(moved(49.3, 50.0, -99.0, 99.0, 2.0))


def test_wind_settles_at_its_stationary_statistics():
    """Mean, deviation and time of decay of a long process, eq. 41, against the exact values."""
    rng = np.random.default_rng(7)
    alpha, mean, settled, h = -0.2, 1.3, 0.16, 0.1
    sigma = sigma_of(settled, alpha)
    assert deviation(alpha, sigma) == pytest.approx(settled)
    assert deviation(alpha, sigma, h) == pytest.approx(settled * (1.0 + alpha * h / 2.0) ** -0.5)
    wind = np.full(2000, mean)
    kept = []
    for k in range(1500):
        wind = wind_step(wind, mean, alpha, sigma, h, rng.standard_normal(2000))
        if k >= 400 and k % 50 == 0:
            kept.append(wind)
    kept = np.array(kept)
    assert kept.mean() == pytest.approx(mean, abs=0.005)
    assert kept.std() == pytest.approx(deviation(alpha, sigma, h), rel=0.02)
    off = kept - mean
    assert (off[1:] * off[:-1]).mean() / (off**2).mean() == pytest.approx((1.0 + alpha * h) ** 50, abs=0.03)
