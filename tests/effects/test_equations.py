"""The equations of every effect, put against what they say written out another way."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.backends import LaneModel
from mmgtune.effects import find_effect
from mmgtune.effects.hull_term import TERMS
from mmgtune.effects.memory import STIFF
from mmgtune.model import Model
from mmgtune.physics.arrangements.single_propeller_single_rudder import Control, forces
from mmgtune.physics.frame import to_earth
from mmgtune.physics.quantities import UNKNOWN, Force, State, WindCoefficients
from mmgtune.physics.wind import wind_shape
from mmgtune.profile import load_profile, with_effects

L, D, RHO = 83.0, 3.8, 1025.0
STILL = UNKNOWN
STEERED = Control(1.7, 0.3)
MOVING = State(x=120.0, y=-40.0, psi=0.7, u=2.5, v_m=-0.4, r=0.012)


def blowing(north, east):
    """Measured wind, and nothing else."""
    return UNKNOWN._replace(wind_north=north, wind_east=east, wind_known=1.0)


def lanes(group):
    """The same with arrays of one lane."""
    return type(group)(*(np.array([float(value)]) for value in group))


@pytest.fixture(scope="module")
def suzaku():
    return Model(load_profile("suzaku"))


@pytest.fixture(scope="module")
def added(suzaku):
    """Force that an effect on forces adds to SUZAKU's, as three numbers."""
    p = suzaku.coefficients(suzaku.matrix())

    def force(tag, values, state=MOVING, air=STILL, control=STEERED):
        now = lanes(state)
        found = forces(now, lanes(control), suzaku.components, p)
        effect = find_effect(tag)
        defaults = {name: one.default for name, one in effect.parameters.items()}
        e = effect.params(**{name: np.array([float(value)]) for name, value in (defaults | values).items()})
        given = effect.function(now, lanes(air), found, suzaku.components, p, e)
        return np.array([np.ravel(axis)[0] for axis in given]), found

    return force


@pytest.mark.parametrize("term", TERMS)
@pytest.mark.parametrize(("u", "v_m", "r"), [(2.5, -0.4, 0.012), (2.0, 0.3, -0.02)])
def test_hull_terms(added, term, u, v_m, r):
    """A term named N_rrabsr is r' r' |r'| times its coefficient, and pushes along its own axis only."""
    U = math.hypot(u, v_m)
    prime = {"u": u / U, "v": v_m / U, "r": r * L / U}
    size = 1.0
    for absolute, symbol in re.findall(r"(abs)?([uvr])", term[2:].replace("one", "")):
        size *= abs(prime[symbol]) if absolute else prime[symbol]
    values = {**dict.fromkeys(TERMS, 0.0), term: 0.01}
    force, _ = added("hull-term", values, MOVING._replace(u=u, v_m=v_m, r=r))
    unit = 0.5 * RHO * L * D * U**2
    expected = {axis: 0.0 for axis in "XYN"} | {term[0]: 0.01 * size * unit * (L if term[0] == "N" else 1.0)}
    np.testing.assert_allclose(force, list(expected.values()), rtol=1e-12, atol=1e-9)


def bearing_forces(speed, come_from, profile):
    """Force of a true wind on the moving ship, by angles: Fujiwara et al. 1998 in words."""
    course = MOVING.psi
    towards = come_from + math.pi
    ahead = speed * math.cos(towards - course) - MOVING.u
    starboard = speed * math.sin(towards - course) - MOVING.v_m
    U2 = ahead**2 + starboard**2
    a = math.atan2(starboard, -ahead)  # of where it comes from, counterclockwise from the bow
    c = {name: profile.value(f"above_water.{name}") for name in WindCoefficients._fields}
    C_X = c["X_0"] + sum(c[f"X_{k}"] * math.cos(k * a) for k in (1, 3, 5))
    C_Y = sum(c[f"Y_{k}"] * math.sin(k * a) for k in (1, 3, 5))
    C_N = sum(c[f"N_{k}"] * math.sin(k * a) for k in (1, 2, 3))
    A_T, A_L = (profile.value(f"above_water.{name}") for name in ("A_T", "A_L"))
    return 0.5 * 1.225 * U2 * np.array([A_T * C_X, A_L * C_Y, A_L * L * C_N])


@pytest.mark.parametrize("come_from", [0.2, 2.0, 3.9, 5.5])
def test_wind(added, suzaku, come_from):
    shape = {name: suzaku.profile.value(f"above_water.{name}") for name in ("A_T", "A_L", *WindCoefficients._fields)}
    expected = bearing_forces(9.0, come_from, suzaku.profile)
    steady, _ = added("wind", {"speed": 9.0, "direction": come_from, "measured": 1.0, **shape})
    np.testing.assert_allclose(steady, expected, rtol=1e-3)
    flow = blowing(-9.0 * math.cos(come_from), -9.0 * math.sin(come_from))
    measured, _ = added("wind", {"speed": 3.0, "direction": 0.0, "measured": 1.0, **shape}, air=flow)
    np.testing.assert_allclose(measured, steady, rtol=1e-9)
    # A vane that shows it further clockwise.
    a = 0.4
    logged = blowing(-9.0 * math.cos(come_from + a), -9.0 * math.sin(come_from + a))
    turned, _ = added("wind", {"measured": 1.0, "turned": a, **shape}, air=logged)
    np.testing.assert_allclose(turned, steady, rtol=1e-9)
    # Wind from starboard pushes to port.
    from_starboard, _ = added("wind", {"speed": 20.0, "direction": MOVING.psi + 1.5, "measured": 1.0, **shape})
    assert from_starboard[1] < 0.0
    nothing, _ = added("wind", {"speed": 0.0, "direction": 0.0, "measured": 1.0, **shape})
    assert not nothing.any()
    # A ship whose force is off the formulas.
    other = {"ahead": 0.8, "across": 1.2, "turning": 2.0, "arm": 0.05}
    off, _ = added("wind", {"speed": 9.0, "direction": come_from, **shape, **other})
    L = suzaku.profile.L_pp
    X, Y, N = steady
    np.testing.assert_allclose(off, [0.8 * X, 1.2 * Y, 2.4 * N + 0.05 * L * 1.2 * Y], rtol=1e-12)


@pytest.mark.parametrize("a", np.linspace(-3.0, 3.0, 7))
def test_harmonics_of_wind(a):
    """Multiples of the angle are made by addition theorems; starboard is a negative angle."""
    c = WindCoefficients(*np.linspace(0.1, 1.0, 10))
    X, Y, N = wind_shape(math.cos(a), -math.sin(a), c)
    assert pytest.approx(c.X_0 + sum(getattr(c, f"X_{k}") * math.cos(k * a) for k in (1, 3, 5))) == X
    assert pytest.approx(sum(getattr(c, f"Y_{k}") * math.sin(k * a) for k in (1, 3, 5))) == Y
    assert pytest.approx(sum(getattr(c, f"N_{k}") * math.sin(k * a) for k in (1, 2, 3))) == N


def test_waves_push_where_they_go(added):
    force, _ = added("wave-drift", {"force": 4000.0, "direction": 2.0})
    towards = 2.0 + math.pi - MOVING.psi
    np.testing.assert_allclose(force, [4000.0 * math.cos(towards), 4000.0 * math.sin(towards), 0.0], atol=1e-9)


def test_waves_turn_a_ship_away_from_them_and_drift_her_less_ahead(added, suzaku):
    """Waves from 45 deg to port push her to starboard and astern, and turn her to starboard."""
    from_port = {"force": 4000.0, "direction": MOVING.psi - math.radians(45.0), "ahead": 0.5, "turning": 0.02}
    force, _ = added("wave-drift", from_port)
    side = 4000.0 * math.sqrt(0.5)
    np.testing.assert_allclose(force, [-0.5 * side, side, 0.02 * 4000.0 * suzaku.profile.L_pp], rtol=1e-12)
    from_starboard, _ = added("wave-drift", {**from_port, "direction": MOVING.psi + math.radians(45.0)})
    np.testing.assert_allclose(from_starboard, force * [1.0, -1.0, -1.0], rtol=1e-12)


def test_resistance(added, suzaku):
    force, found = added("resistance", {"factor": 1.2, "slope": 2.0, "pivot": 1.5})
    U = found.flow.U[0]
    Fn = (U - 1.5) / math.sqrt(9.81 * L)
    R = suzaku.profile.value("hull.R_0") * 0.5 * RHO * L * D * U**2
    np.testing.assert_allclose(force, [-(0.2 + 2.0 * Fn) * R, 0.0, 0.0], rtol=2e-3, atol=1e-9)


@pytest.mark.parametrize("delta", [0.5, -0.5])
def test_a_stalled_rudder_keeps_the_force_of_the_angle_it_stalled_at(added, delta):
    force, found = added("rudder-stall", {"angle": 0.2}, control=Control(1.7, delta))
    alpha = found.rudder.alpha_R[0]
    assert abs(alpha) > 0.2
    left = math.sin(0.2) / abs(math.sin(alpha))
    np.testing.assert_allclose(force, [(left - 1.0) * axis[0] for axis in found.rudder.force])
    unchanged, _ = added("rudder-stall", {"angle": 1.5}, control=Control(1.7, delta))
    assert not unchanged.any()


@pytest.mark.parametrize("delta", [0.5, -0.5])
@pytest.mark.parametrize("slope", [0.4, -0.8])
def test_beyond_its_stall_the_force_of_a_rudder_grows_less_or_falls(added, delta, slope):
    force, found = added("rudder-stall", {"angle": 0.2, "slope": slope}, control=Control(1.7, delta))
    alpha = abs(found.rudder.alpha_R[0])
    left = math.sin(0.2 + slope * (alpha - 0.2)) / math.sin(alpha)
    assert left < 1.0
    np.testing.assert_allclose(force, [(left - 1.0) * axis[0] for axis in found.rudder.force])
    unchanged, _ = added("rudder-stall", {"slope": slope}, control=Control(1.7, delta))
    assert not unchanged.any()


def test_a_rudder_may_stall_over_a_width(added):
    """Half a width beneath the angle it has lost a sixteenth of the width already."""
    control, width = Control(1.7, 0.5), 0.1
    _, found = added("rudder-stall", {"angle": 0.2}, control=control)
    alpha = abs(found.rudder.alpha_R[0])
    for over in (-0.5 * width, 0.0, 0.5 * width):
        force, found = added("rudder-stall", {"angle": alpha - over, "width": width}, control=control)
        felt = alpha - (over + width) ** 2 / (4.0 * width)
        left = math.sin(felt) / math.sin(alpha)
        np.testing.assert_allclose(force, [(left - 1.0) * axis[0] for axis in found.rudder.force])
    for over in (-1.01 * width, 1.01 * width):
        wide, sharp = (
            added("rudder-stall", {"angle": alpha - over, "width": w}, control=control)[0] for w in (width, 0.0)
        )
        np.testing.assert_allclose(wide, sharp)


@pytest.mark.parametrize("control", [STEERED, Control(-1.2, 0.3)])
def test_an_engine_under_load_turns_the_propeller_slower_than_the_log_says(suzaku, added, control):
    """As if the log had said so; none astern, and none where the ship makes more way a turn than at the approach."""
    loaded = MOVING._replace(u=1.0)
    force, found = added("engine-droop", {"share": 0.3, "pivot": 1.75}, loaded, control=control)
    n = control.n * (1.0 - 0.3 * (1.0 - 1.0 / control.n / 1.75)) if control.n > 0.0 else control.n
    slower = forces(
        lanes(loaded), lanes(Control(n, control.delta)), suzaku.components, suzaku.coefficients(suzaku.matrix())
    )
    expected = [after[0] - before[0] for after, before in zip(slower.total, found.total, strict=True)]
    np.testing.assert_allclose(force, expected, atol=1e-6)
    light, _ = added("engine-droop", {"share": 0.3, "pivot": 1.75}, MOVING._replace(u=3.5), control=control)
    assert not light.any()
    farther, _ = added("engine-droop", {"share": 0.3, "pivot": 1.4, "way": 1.25}, loaded, control=control)
    np.testing.assert_allclose(farther, force, atol=1e-6)  # the way is a factor on the pivot


def test_a_propeller_pushes_the_stern_aside_by_a_share_of_its_thrust(added):
    force, found = added("propeller-walk", {"share": 0.05}, control=Control(1.7, 0.3))
    n, D_P, K_T = (float(np.squeeze(getattr(found.propeller, name))) for name in ("n", "D_P", "K_T"))
    thrust = RHO * n**2 * D_P**4 * K_T
    assert thrust > 0.0
    np.testing.assert_allclose(force, [0.0, 0.05 * thrust, -0.05 * thrust * L / 2.0])


@pytest.mark.parametrize("n", [1.7, -1.2])
def test_a_part_of_that_force_follows_the_revolutions_whatever_the_speed(added, n):
    def side(u, revolutions):
        values = {"share": 0.05, "revolutions": revolutions}
        force, found = added("propeller-walk", values, MOVING._replace(u=u), control=Control(n, 0.3))
        return force[1], float(np.squeeze(found.propeller.D_P))

    (slow, D_P), (fast, _) = side(1.0, 1.0), side(3.0, 1.0)
    np.testing.assert_allclose([slow, fast], 0.05 * RHO * n * abs(n) * D_P**4 * 0.2)
    farther, _ = added("propeller-walk", {"share": 0.05, "ahead": 0.1}, control=Control(n, 0.3))
    np.testing.assert_allclose(farther[2], (-0.5 + 0.1) * L * farther[1])
    by_thrust, half = side(1.0, 0.0)[0], side(1.0, 0.5)[0]
    np.testing.assert_allclose(half, 0.5 * (by_thrust + slow))


def test_a_steady_force_is_the_same_at_any_speed_and_heading(added):
    for state in (MOVING, MOVING._replace(u=0.5, psi=2.0), MOVING._replace(u=-1.0, r=0.0)):
        force, _ = added("steady-force", {"side": 3000.0, "moment": -4e4}, state)
        np.testing.assert_allclose(force, [0.0, 3000.0, -4e4], atol=1e-6)
        force, _ = added("steady-force", {"ahead": -5000.0}, state)
        np.testing.assert_allclose(force, [-5000.0, 0.0, 0.0], atol=1e-6)


def test_a_hull_that_is_not_alike_on_both_sides_is_pushed_by_the_square_of_the_speed(added):
    for state in (MOVING, MOVING._replace(u=0.5, v_m=0.0)):
        force, _ = added("hull-asymmetry", {"Y_0": 0.002, "N_0": -4e-4}, state)
        half = 0.5 * RHO * L * D * (state.u**2 + state.v_m**2)
        np.testing.assert_allclose(force, [0.0, 0.002 * half, -4e-4 * half * L], rtol=1e-9, atol=1e-9)


def test_memory_is_a_lag_of_first_order():
    e = find_effect("memory").params(6.0, 0.0, 0.0, 1.0)
    found = SimpleNamespace(hull=Force(1.0, 10.0, 100.0))
    assert find_effect("memory").start(found, e) == (10.0, 100.0)
    force, (Y_dot, N_dot) = find_effect("memory").function(found, (4.0, 130.0), 0.1, e)
    assert force == pytest.approx((0.0, -6.0, 30.0))
    assert (Y_dot, N_dot) == pytest.approx((1.0, -5.0))
    half, rates = find_effect("memory").function(found, (4.0, 130.0), 0.1, e._replace(share=0.5))
    assert half == pytest.approx((0.0, -3.0, 15.0))
    assert rates == pytest.approx((1.0, -5.0))
    # A lag shorter than the step can follow acts in part.
    short = find_effect("memory").params(0.25 * STIFF * 0.1, 0.0, 0.0, 1.0)
    force, _ = find_effect("memory").function(found, (4.0, 130.0), 0.1, short)
    assert force == pytest.approx((0.0, -1.5, 7.5))


def test_flow_effects_are_velocities_over_ground_seen_from_the_ship():
    north, east = 0.3, -0.2
    current = find_effect("current")
    u, v = current.function(MOVING, STILL, current.params(north, east, 0.0, 0.0, 1.0, 0.0, 1.0))
    towards = math.atan2(east, north) - MOVING.psi
    speed = math.hypot(north, east)
    assert (u, v) == pytest.approx((speed * math.cos(towards), speed * math.sin(towards)))
    # A log half as fast as the water, 0.4 rad clockwise of where it sets to; then one of where it comes from.
    logged = 0.5 * speed * np.exp(1j * (math.atan2(east, north) + 0.4))
    rates = {"current_north_rate": 1e-3 * logged.real, "current_east_rate": 1e-3 * logged.imag}
    water = STILL._replace(current_known=1.0, current_north=logged.real, current_east=logged.imag, **rates)
    e = current.params(9.0, 9.0, 9.0, 9.0, 2.0, 0.4, 1.0)
    assert current.function(MOVING, water, e) == pytest.approx((u, v))
    assert current.rate(MOVING, water, e) == pytest.approx((1e-3 * u, 1e-3 * v))
    assert current.rate(MOVING, water, e._replace(carried=0.3)) == pytest.approx((3e-4 * u, 3e-4 * v))
    assert current.function(MOVING, water, e._replace(measured=-2.0)) == pytest.approx((-u, -v))
    # A share of the wind along it and to its right.
    effect, air = find_effect("wind-drift"), blowing(-4.0, 3.0)
    u, v = effect.function(MOVING, air, effect.params(0.03, 0.01))
    wind = complex(air.wind_north, air.wind_east)
    drift = wind * complex(0.03, 0.01) * np.exp(-1j * MOVING.psi)
    assert (u, v) == pytest.approx((drift.real, drift.imag))
    assert effect.function(MOVING, air._replace(wind_known=0.0), effect.params(0.03, 0.01)) == pytest.approx((0.0, 0.0))


def earth(state):
    """Velocity over ground, north + i east."""
    return complex(state.u, state.v_m) * np.exp(1j * state.psi)


def test_an_antenna_sees_its_own_way():
    effect = find_effect("antenna")
    e = effect.params(-20.0, 3.0, 0.0, 0.0)
    seen = effect.function(MOVING, e)
    arm = complex(-20.0, 3.0)
    assert complex(seen.x, seen.y) == pytest.approx(complex(MOVING.x, MOVING.y) + arm * np.exp(1j * MOVING.psi))
    assert complex(seen.u, seen.v_m) == pytest.approx(complex(MOVING.u, MOVING.v_m) + 1j * MOVING.r * arm)
    assert effect.inverse(seen, e) == pytest.approx(MOVING)
    alone = effect.function(MOVING, effect.params(0.0, 0.0, -20.0, 3.0))
    assert alone == pytest.approx(MOVING._replace(x=seen.x, y=seen.y))


def test_velocities_of_one_point_and_positions_of_another_are_told_in_one_sentence():
    said = find_effect("antenna").sentence({"x": "-99.2 m", "y": "0.1 m", "x_alone": "100.1 m", "y_alone": "-0.2 m"})
    assert said == (
        "Velocities are those of a point 99.2 m aft of midship and 0.1 m to starboard, and positions those of one "
        "100.1 m forward of that and 0.2 m to port"
    )


def test_a_biased_compass_turns_the_axes_and_not_the_track():
    effect = find_effect("heading-bias")
    e = effect.params(0.05, 0.0, 0.0, 0.0)
    seen = effect.function(MOVING, e)
    assert seen.psi == pytest.approx(MOVING.psi + 0.05)
    assert earth(seen) == pytest.approx(earth(MOVING))
    assert effect.inverse(seen, e) == pytest.approx(MOVING)
    alone = effect.function(MOVING, effect.params(0.0, 0.05, 0.0, 0.0))
    assert alone == pytest.approx(MOVING._replace(psi=MOVING.psi + 0.05))


@pytest.mark.parametrize(
    ("tag", "values"),
    [
        ("heading-bias", {"angle": 0.05}),
        ("heading-bias", {"alone": 0.05}),
        ("compass-deviation", {"sine": 0.03, "cosine_alone": -0.02}),
    ],
)
def test_positions_of_an_antenna_are_moved_along_the_heading_shown(tag, values):
    """120 m ahead by a compass 3 deg off, midship is 6.3 m to the side: that was an antenna to starboard."""
    effect, ahead, abeam = find_effect(tag), -120.0, 4.0
    null = {name: one.null for name, one in effect.parameters.items()}
    e = effect.params(**null | values | {"antenna_ahead": ahead, "antenna_abeam": abeam})
    seen = effect.function(MOVING, e)
    antenna = np.array([MOVING.x, MOVING.y]) + to_earth(MOVING.psi, ahead, abeam)
    assert np.array([seen.x, seen.y]) == pytest.approx(antenna - to_earth(seen.psi, ahead, abeam))
    assert effect.inverse(seen, e) == pytest.approx(MOVING)


@pytest.mark.parametrize(
    ("tag", "value", "seen"),
    [
        ("gyro-bias", 0.001, {"r": MOVING.r + 0.001}),
        ("gyro-scale", (1.1, 0.0, 20.0), {"r": MOVING.r * 1.1}),
        ("gyro-scale", (1.1, -0.2, 20.0), {"r": MOVING.r * 1.1 * (1.0 - 0.2 * abs(MOVING.r) * 20.0)}),
        ("speed-scale", (1.1, 1.0, 0.0, 3.0), {"u": MOVING.u * 1.1}),
        ("speed-scale", (1.0, 1.1, 0.0, 3.0), {"u": MOVING.u * 1.1, "v_m": MOVING.v_m * 1.1}),
        ("speed-scale", (1.1, 1.0, 0.05, 3.0), {"u": MOVING.u * 1.1 * (1.0 + 0.05 * (MOVING.u - 3.0))}),
        ("log-zero", (0.1, -0.2), {"u": MOVING.u + 0.1, "v_m": MOVING.v_m - 0.2}),
        (
            "water-log",
            (0.3, -0.1),
            {
                "u": MOVING.u - 0.3 * np.cos(0.7) + 0.1 * np.sin(0.7),
                "v_m": MOVING.v_m + 0.3 * np.sin(0.7) + 0.1 * np.cos(0.7),
            },
        ),
        ("log-misalignment", np.pi / 2.0, {"u": MOVING.v_m, "v_m": -MOVING.u}),
    ],
)
def test_sensors_with_a_number_or_two(tag, value, seen):
    effect = find_effect(tag)
    e = effect.params(*np.atleast_1d(value))
    assert effect.function(MOVING, e) == pytest.approx(MOVING._replace(**seen))
    assert effect.inverse(effect.function(MOVING, e), e) == pytest.approx(MOVING)


@pytest.mark.parametrize(
    ("tag", "value", "left"),
    [
        ("rudder-offset", 0.02, Control(1.7, 0.32)),
        # of both sides, of starboard, and as it changes with the angle
        ("rudder-gain", 0.9, Control(1.7, 0.3 * 0.9 * 0.9 * (1.0 + 0.9 * (0.3 / np.radians(35.0)) ** 2))),
        ("rudder-limit", 0.25, Control(1.7, 0.25)),
        ("rudder-limit", 0.35, Control(1.7, 0.3)),
        ("backlash", 0.1, Control(1.7, 0.3 + 0.1 * 0.05 - 0.05)),  # from near the middle, and back
        ("governor-lag", 5.0, Control(1.7, 0.3)),  # settled
        ("rpm-scale", 1.1, Control(1.87, 0.3)),
    ],
)
def test_actuators_with_one_number(tag, value, left):
    model = Model(with_effects(load_profile("suzaku"), {tag: dict.fromkeys(find_effect(tag).fields, value)}, "test"))
    ship = LaneModel(model, model.matrix())
    assert ship.moved([], Control(1.7, 0.3), None, 1.0)[-1] == pytest.approx(left)


@pytest.mark.parametrize(("start", "end", "before"), [(0.0, 0.3, -0.1), (0.2, -0.1, 0.25)])
def test_steering_lag(start, end, before):
    """Against the same response integrated finely; then the rate limit, of either side or of one."""
    effect, T, h = find_effect("steering-lag"), 2.5, 1.0

    def of(**values):
        return effect.params(**{name: one.null for name, one in effect.parameters.items()} | values)

    blade, n = before, 20000
    for k in range(n):
        order = start + (end - start) * (k + 0.5) / n
        blade += h / n * (order - blade) / T
    assert effect.function(start, end, before, h, of(time_constant=T)) == pytest.approx(blade, abs=1e-5)
    limited = pytest.approx(before + math.copysign(0.04, end - before))
    assert effect.function(start, end, before, h, of(rate_limit=0.04)) == limited
    this, other = ("to_starboard", "to_port") if end > before else ("to_port", "to_starboard")
    assert effect.function(start, end, before, h, of(**{this: 0.04})) == limited
    assert effect.function(start, end, before, h, of(**{other: 0.04})) == pytest.approx(end)
    assert effect.function(start, end, before, h, of()) == pytest.approx(end)


@pytest.fixture(scope="module")
def numbers(suzaku):
    return suzaku.numbers()


def test_shallow_water(numbers):
    """Kijima et al. 1990, with the numbers of SUZAKU at a depth of 8 m."""
    effect = find_effect("shallow-water")
    ship = {name: numbers[f"particulars.{name}"] for name in ("L_pp", "B", "d", "C_b")}
    h, b = 3.8 / 8.0, 0.737 * 13.5 / 3.8

    def of(around, depth, measured, **powers):
        beside = {"Y_v": 0.0, "Y_r": 0.0, "N_v": 0.0, "N_r": 0.0, "cross": 0.0, "inertia": 0.0}
        return effect.function(around, effect.params(depth=depth, measured=measured, **beside | powers, **ship))

    def deep(n):
        return 1.0 / (1.0 - h) ** n - h

    found = of(STILL, 8.0, 1.0)
    cubic = 1.0 + (-5.5 * b**2 + 26.0 * b - 31.5) * h
    cubic += (37.0 * b**2 - 185.0 * b + 230.0) * h**2 + (-38.0 * b**2 + 197.0 * b - 250.0) * h**3
    factors = {"Y_v": deep(0.40 * b), "N_v": deep(0.425 * b), "N_r": deep(1.5 - 14.28 * 3.8 / 83.0), "Y_r": cubic}
    for name, factor in found._asdict().items():
        assert factor == pytest.approx(factors.get(name, 1.0)), name
    inertia = ("m_y_", "J_zz_")
    assert effect.changes == tuple(f"{'particulars' if name in inertia else 'hull'}.{name}" for name in found._fields)
    logged = UNKNOWN._replace(depth=8.0, depth_known=1.0)
    assert of(logged, math.inf, 1.0) == pytest.approx(found)
    # Half of the draught over the depth is twice the depth; none of it is deep water.
    assert of(logged, 5.0, 0.5) == pytest.approx(of(STILL, 16.0, 1.0))
    assert set(of(logged, math.inf, 0.0)) == {1.0}
    assert of(logged._replace(depth=1.0), math.inf, 1.0) == pytest.approx(of(STILL, 1.05 * 3.8, 1.0))

    # What grows otherwise than the formulas have it does so with the depth, and not in deep water.
    powers = {"Y_v": -0.2, "Y_r": 0.3, "N_v": 0.25, "N_r": -0.1, "cross": 0.5, "inertia": 0.3}
    powers_of = powers | {"m_y_": powers["inertia"], "J_zz_": powers["inertia"]}
    for name, factor in of(STILL, 8.0, 1.0, **powers)._asdict().items():
        grown = deep(0.40 * b) ** powers_of.get(name, powers["cross"])
        assert factor == pytest.approx(factors.get(name, 1.0) * grown), name
    assert set(of(STILL, math.inf, 1.0, **powers)) == {1.0}


def test_loading(numbers):
    """Ratios of the formulas of Inoue, Hirano & Kijima 1981."""
    effect = find_effect("loading")
    of = effect.params(1.1, 0.2, 0.95, *[0.0] * 5)
    found = effect.function(numbers, of)
    c = 0.737 * 13.5 / 83.0

    def derivatives(d, tau):
        k = 2.0 * d / 83.0
        lift = math.pi / 2.0 * k + 1.4 * c
        return {
            "Y_v": lift * (1.0 + 2.0 / 3.0 * tau),
            "Y_r": k * (1.0 + 0.80 * tau),
            "N_v": k * (1.0 - 0.27 * tau * lift / k),
            "N_r": (0.54 * k - k**2) * (1.0 + 0.30 * tau),
        }

    new, old = derivatives(1.1 * 3.8, 0.2), derivatives(3.8, 0.0)
    for name in new:
        assert found[f"hull.{name}"] == pytest.approx(numbers[f"hull.{name}"] * new[name] / old[name], rel=1e-3), name
    assert found["particulars.d"] == pytest.approx(1.1 * 3.8)
    assert found["particulars.C_b"] == pytest.approx(0.95 * 0.737)
    assert found["particulars.m_y_"] == numbers["particulars.m_y_"]
    change = math.log(1.1) + 0.2
    more = effect.function(numbers, of._replace(N_v=0.5, inertia=-1.0))
    assert more["hull.N_v"] == pytest.approx(found["hull.N_v"] * math.exp(0.5 * change))
    assert more["particulars.m_y_"] == pytest.approx(numbers["particulars.m_y_"] * math.exp(-change))
    assert more["hull.Y_v"] == found["hull.Y_v"]


def test_factors_on_polynomials(numbers):
    side = find_effect("propeller-side-force")
    found = side.function(numbers, side.params(1.4, 0.7))
    assert {name[10:14] for name in found} == {"C_PY", "C_PN"}
    for name, value in found.items():
        assert value == pytest.approx(numbers[name] * (1.4 if "C_PY" in name else 0.7))
    thrust = find_effect("thrust")
    found = thrust.function(numbers, thrust.params(0.9))
    assert {name: value / numbers[name] for name, value in found.items()} == pytest.approx(
        {f"propeller.K_T{power}": 0.9 for power in range(4)}
    )
    flap = find_effect("flap")
    for name, value in flap.function(numbers, flap.params(0.8)).items():
        assert name.startswith("rudder.flap[")
        assert value == pytest.approx(0.8 * numbers[name])
