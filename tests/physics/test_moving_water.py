"""A ship in water that moves, against the equations of motion written over ground, where Newton wrote them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mmgtune.backends import Integrator, pad
from mmgtune.model import Model
from mmgtune.motions import as_trial, simulate_trials
from mmgtune.physics.frame import to_ship
from mmgtune.physics.mmg import carried, rates
from mmgtune.physics.quantities import Force, State
from mmgtune.profile import load_profile, with_effects
from mmgtune.trial import Trial, load_trials
from tests.runs import measured, states, turn

FINE = Integrator("rk4", 40)
TIDE = 12.42 * 3600.0


@pytest.fixture(scope="module")
def ship():
    return load_profile("suzaku")


@pytest.fixture(scope="module")
def following(ship):
    """SUZAKU in the current measured in the trial."""
    return Model(with_effects(ship, {"current": {"measured": 1.0}}, "a test"))


def tidal(t, period, speed=0.5):
    """A current that turns through every direction, stronger north and south [m/s]."""
    phase = 2.0 * np.pi * t / period + 0.4
    return speed * np.cos(phase), 0.6 * speed * np.sin(phase)


def turning_in(model, t, north, east, degrees=20.0):
    """A turn that begins at the approach speed through the water."""
    still = turn(model, degrees, t[-1], dt=t[1] - t[0])
    start = still.initial[0] + np.array([0.0, 0.0, 0.0, north[0], east[0], 0.0])  # heading north
    return still, pad([t], [still.controls[0]], [start], around=[measured(t, current=(north, east))])


def test_a_steady_current_changes_nothing_but_the_velocity_over_ground(suzaku):
    """Of any motion, to rounding: what the ship gains through the water is what she gains without it."""
    rng = np.random.default_rng(1)
    p = suzaku.coefficients(suzaku.matrix()).ship
    motion = State(*rng.uniform(-3.0, 3.0, (6, 50)))
    force = Force(*rng.uniform(-1e5, 1e5, (3, 50)))
    u_c, v_c = to_ship(motion.psi, 0.7, -0.4)
    still = rates(motion, 0.0, 0.0, force, p)
    over = rates(motion._replace(u=motion.u + u_c, v_m=motion.v_m + v_c), u_c, v_c, force, p)
    assert over.u - motion.r * v_c == pytest.approx(still.u, abs=1e-14)
    assert over.v_m + motion.r * u_c == pytest.approx(still.v_m, abs=1e-14)
    assert over.r == pytest.approx(still.r, abs=1e-16)
    assert over.x - still.x == pytest.approx(0.7, abs=1e-14)
    assert over.y - still.y == pytest.approx(-0.4, abs=1e-14)
    assert carried(still, 0.2, -0.3).u == pytest.approx(still.u + 0.2)


@pytest.mark.parametrize("how", ["measured", "parameter"])
def test_a_constant_current_is_a_translation(ship, following, how):
    """The error of the integration is of fourth order, so that fine steps leave rounding only."""
    t = np.arange(301.0)
    north, east = np.full(len(t), 0.4), np.full(len(t), -0.3)
    model = following
    if how == "parameter":
        model = Model(with_effects(ship, {"current": {"north": 0.4, "east": -0.3}}, "a test"))
    still, moved = turning_in(model, t, north, east)
    if how == "parameter":
        moved = pad([t], [moved.controls[0]], [moved.initial[0]])
    off = {}
    for n in (1, 8, 40):
        integrator = Integrator("rk4", n)
        base = states(Model(ship), still, integrator=integrator)[0, 0]
        flown = states(model, moved, integrator=integrator)[0, 0]
        u_c, v_c = to_ship(flown[:, 2], 0.4, -0.3)
        carried_along = np.column_stack([0.4 * t, -0.3 * t, 0.0 * t, u_c, v_c, 0.0 * t])
        off[n] = np.abs(flown - carried_along - base).max()
    assert off[1] > 500.0 * off[8]
    assert off[40] < 2e-9


def over_ground(model, t, north, east, start):
    """The same motion from Newton's law over ground, by an integrator of its own; (n_samples, 6).

    Mass and inertia are accelerated over ground, added masses through the water, and water that speeds up presses on
    the ship as on the mass it would have in her place, at the centre of her buoyancy, which is below that of gravity.
    """
    p = model.coefficients(model.matrix()[:, 0])
    s = p.ship
    controls = model.arrangement.control(model.profile.approach.n, np.radians(20.0))
    m = s.rho * s.L_pp * s.B * s.d * s.C_b
    unit = 0.5 * s.rho * s.L_pp**2 * s.d
    m_x, m_y, J = s.m_x_ * unit, s.m_y_ * unit, s.J_zz_ * unit * s.L_pp**2
    I_G = m * (s.k_zz_ * s.L_pp) ** 2
    # Acceleration over ground of u, v_m and r; columns of the matrix in this order.
    M = np.array(
        [
            [m + m_x, 0.0, 0.0],
            [0.0, m + m_y, m * s.x_G],
            [0.0, m * s.x_G, I_G + m * s.x_G**2 + J],
        ]
    )
    slopes = np.diff(north) / np.diff(t), np.diff(east) / np.diff(t)

    def rate(now, z, k):
        psi, u, v, r = z[2:]
        C = np.array([np.interp(now, t, north), np.interp(now, t, east)])
        R = np.array([[np.cos(psi), np.sin(psi)], [-np.sin(psi), np.cos(psi)]])
        u_c, v_c = R @ C
        a_x, a_y = R @ [slopes[0][k], slopes[1][k]]
        through = State(z[0], z[1], psi, u - u_c, v - v_c, r)
        force = model.arrangement.forces(through, controls, model.components, p).total
        u_c_dot, v_c_dot = r * v_c + a_x, a_y - r * u_c  # in axes that turn
        X = force.X + m * (v * r + s.x_G * r * r) + m_x * u_c_dot + m_y * through.v_m * r + m * a_x
        Y = force.Y - m * u * r + m_y * v_c_dot - m_x * through.u * r + m * a_y
        N = force.N - m * s.x_G * u * r + m * a_y * s.x_G
        return [*(R.T @ [u, v]), r, *np.linalg.solve(M, [X, Y, N])]

    found = [start]
    for k in range(len(t) - 1):
        ended = solve_ivp(rate, (t[k], t[k + 1]), found[-1], args=(k,), method="DOP853", rtol=1e-11, atol=1e-11)
        found.append(ended.y[:, -1])
    return np.array(found)


@pytest.mark.parametrize("period", [TIDE, 240.0], ids=["tide", "minutes"])
def test_a_current_that_turns_is_what_newton_says(following, ship, period):
    t = np.arange(0.0, 301.0, 5.0)
    north, east = tidal(t, period)
    _, cases = turning_in(following, t, north, east)
    expected = over_ground(Model(ship), t, north, east, cases.initial[0])
    scale = 1.0 + np.abs(expected).max(axis=0)
    integrator = Integrator("rk4", 200)
    compiled = states(following, cases, integrator=integrator)[0, 0]
    assert np.abs((compiled - expected) / scale).max() < 1e-11

    # Without the water's own acceleration the ship is left behind, by more than any trial would forgive.
    section = following.profile.sections["effects.current"]
    idle = replace(section, component=replace(section.component, rate=None))
    steady = Model(replace(following.profile, sections={**following.profile.sections, "effects.current": idle}))
    left = states(steady, cases, backend="numpy", integrator=Integrator("rk4", 10))[0, 0]
    assert np.hypot(*(left - expected)[:, :2].T).max() > (0.2 if period == TIDE else 20.0)


def test_back_ends_agree_in_a_current_that_turns(following):
    """In steps too few for the rounding of elementary functions to grow."""
    t = np.arange(0.0, 31.0)
    _, cases = turning_in(following, t, *tidal(t, 60.0))
    compiled, reference = (
        states(following, cases, backend=name, integrator=Integrator("rk4", 2)) for name in ("compiled", "numpy")
    )
    assert np.max(np.abs(compiled - reference) / (1.0 + np.abs(reference))) < 1e-12


def test_a_trial_with_columns_of_the_current(following, ship):
    """Speed, and direction it sets towards: the ship drifts that way; a steady current stands in where they are not."""
    t = np.arange(201.0)
    approach = ship.approach
    still = np.zeros(len(t))
    trial = Trial(
        id="drift", ship="suzaku", manoeuvre="", source="generated", t=t, x=still, y=still, psi=still,
        u=np.full(len(t), approach.speed), v_m=still, r=still, n=np.full(len(t), approach.n), delta=still,
    )  # fmt: skip
    east = {"current_speed": np.full(len(t), 0.5), "current_dir": np.full(len(t), np.pi / 2.0)}
    flowing = replace(trial, v_m=still + 0.5, extra=east)
    (drifted,) = simulate_trials(following, [flowing], backend="numpy")
    (straight,) = simulate_trials(Model(ship), [trial], backend="numpy")
    assert drifted.channel("y") - straight.channel("y") == pytest.approx(0.5 * t, abs=1e-3)
    both = Model(with_effects(ship, {"current": {"north": 0.2, "measured": 1.0}}, "a test"))
    (measured_counts,) = simulate_trials(both, [flowing], backend="numpy")
    assert np.array_equal(measured_counts.states, drifted.states)
    (stands_in,) = simulate_trials(both, [trial], backend="numpy")
    (alone,) = simulate_trials(with_effects(ship, {"current": {"north": 0.2}}, "a test"), [trial], backend="numpy")
    assert np.array_equal(stands_in.states, alone.states)


def test_forces_along_a_run_are_those_through_the_water(following, ship):
    """A measured current that is steady and a steady current of the profile give the same columns."""
    trial = load_trials("suzaku").trials["turn_p35"]
    n = trial.n_samples
    flowing = replace(trial, extra={"current_speed": np.full(n, 0.8), "current_dir": np.full(n, 2.0)})
    steady = with_effects(ship, {"current": {"north": 0.8 * np.cos(2.0), "east": 0.8 * np.sin(2.0)}}, "a test")
    written = []
    for model, run in ((following, flowing), (Model(steady), trial)):
        (motion,) = simulate_trials(model, [run], backend="numpy")
        written.append(as_trial(model.profile, motion, with_forces=True))
    assert written[0].extra["hull_Y"] == pytest.approx(written[1].extra["hull_Y"], rel=1e-9, abs=1e-6)
    assert written[0].extra["hull_N"] == pytest.approx(written[1].extra["hull_N"], rel=1e-9, abs=1e-6)
