"""What filters the log, and what makes a ship answer late, put against what they say written out another way."""

import math
from dataclasses import replace
from itertools import accumulate, pairwise

import numpy as np
import pytest

from mmgtune.backends import Integrator, pad
from mmgtune.effects import FilterEffect, Visited, effects, find_effect
from mmgtune.fitting import fit
from mmgtune.model import Model
from mmgtune.options import FitOptions
from mmgtune.orders import TurningOrder, ZigzagOrder, run_manoeuvre
from mmgtune.physics.quantities import State
from mmgtune.profile import load_profile, parse_profile, with_effects
from mmgtune.units import DEG
from tests.hidden.plant import simulate
from tests.runs import states, turn

STEP = 0.02
"""Step of what is integrated here [s]."""


def way(seconds=60.0):
    """A turn that tightens while the ship slows down: samples a second apart, and as finely as it was integrated."""
    t = np.arange(0.0, seconds + 0.5 * STEP, STEP)
    u, v, r = 3.0 - 0.02 * t, -0.01 * t, 4e-4 * t
    psi = 0.7 + 2e-4 * t**2
    north, east = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi)

    def summed(rate):
        return np.concatenate([[0.0], np.cumsum(0.5 * STEP * (rate[1:] + rate[:-1]))])

    fine = State(summed(north), summed(east), psi, u, v, r)
    return t, fine, [State(*(column[k] for column in fine)) for k in range(0, len(t), round(1.0 / STEP))]


def logged(tag, samples, **values):
    """What an instrument logs, begun as settled."""
    effect = find_effect(tag)
    e = effect.params(*(values.get(name, parameter.null) for name, parameter in effect.fields.items()))
    state, held = effect.settled(samples[0], e)
    found = [state]
    for start, end in pairwise(samples):
        state, held = effect.function(start, end, held, 1.0, e)
        found.append(state)
    return State(*np.array(found).T)


def lagged(t, signal, T):
    """A first-order lag by small steps, settled at the first."""
    out = np.empty_like(signal)
    out[0] = signal[0]
    for k in range(1, len(t)):
        out[k] = out[k - 1] + STEP / T * (0.5 * (signal[k - 1] + signal[k]) - out[k - 1])
    return out


EVERY = slice(None, None, round(1.0 / STEP))


def test_positions_of_some_seconds_ago():
    t, fine, samples = way()
    found = logged("position-latency", samples, seconds=3.0)
    seen = t[EVERY] >= 5.0
    for shown, true in ((found.x, fine.x), (found.y, fine.y)):
        np.testing.assert_allclose(shown[seen], np.interp(t[EVERY] - 3.0, t, true)[seen], atol=0.01)
    np.testing.assert_array_equal(found.psi, fine.psi[EVERY])


def test_a_late_receiver_shows_how_the_ship_moved_then_in_the_axes_of_now():
    t, fine, samples = way()
    found = logged("position-latency", samples, seconds=1.0, with_velocity=2.0)
    seen = t[EVERY] >= 5.0
    for shown, true in ((found.x, fine.x), (found.y, fine.y)):
        np.testing.assert_allclose(shown[seen], np.interp(t[EVERY] - 3.0, t, true)[seen], atol=0.01)
    over_ground = (fine.u + 1j * fine.v_m) * np.exp(1j * fine.psi)
    then = np.interp(t[EVERY] - 2.0, t, over_ground) * np.exp(-1j * fine.psi[EVERY])
    np.testing.assert_allclose((found.u + 1j * found.v_m)[seen], then[seen], atol=2e-3)
    np.testing.assert_array_equal(found.r, fine.r[EVERY])


def test_velocities_are_smoothed_over_ground_or_along_the_axes():
    t, fine, samples = way()
    T = 4.0
    over_ground = fine.u * np.exp(1j * fine.psi) + 1j * fine.v_m * np.exp(1j * fine.psi)
    smooth = (lagged(t, over_ground.real, T) + 1j * lagged(t, over_ground.imag, T)) * np.exp(-1j * fine.psi)
    found = logged("velocity-filter", samples, over_ground=T)
    np.testing.assert_allclose(found.u, smooth.real[EVERY], atol=2e-3)
    np.testing.assert_allclose(found.v_m, smooth.imag[EVERY], atol=2e-3)
    found = logged("velocity-filter", samples, along_axes=T, yaw_rate=2.0)
    np.testing.assert_allclose(found.u, lagged(t, fine.u, T)[EVERY], atol=5e-4)
    np.testing.assert_allclose(found.v_m, lagged(t, fine.v_m, T)[EVERY], atol=5e-4)
    np.testing.assert_allclose(found.r, lagged(t, fine.r, 2.0)[EVERY], atol=1e-5)
    found = logged("velocity-filter", samples, ahead=T)
    np.testing.assert_allclose(found.u, lagged(t, fine.u, T)[EVERY], atol=5e-4)
    np.testing.assert_array_equal(found.v_m, fine.v_m[EVERY])


@pytest.mark.parametrize("name", ["time_constant", "alone"])
def test_a_slow_compass_is_behind_and_may_turn_the_axes(name):
    t, fine, samples = way()
    found = logged("heading-filter", samples, **{name: 3.0})
    np.testing.assert_allclose(found.psi, lagged(t, fine.psi, 3.0)[EVERY], atol=2e-4)
    turned = found.psi - fine.psi[EVERY] if name == "time_constant" else 0.0
    expected = (fine.u + 1j * fine.v_m)[EVERY] * np.exp(-1j * turned)
    np.testing.assert_allclose(found.u + 1j * found.v_m, expected, atol=1e-9)


def test_a_gyro_drifts_from_the_first_sample_on():
    t, fine, samples = way()
    for name in ("heading", "heading_alone"):
        found = logged("gyro-drift", samples, **{name: 0.002})
        np.testing.assert_allclose(found.psi, (fine.psi + 0.002 * t)[EVERY], atol=1e-12)
        turned = 0.002 * t[EVERY] if name == "heading" else 0.0
        expected = (fine.u + 1j * fine.v_m)[EVERY] * np.exp(-1j * turned)
        np.testing.assert_allclose(found.u + 1j * found.v_m, expected, atol=1e-12)
    found = logged("gyro-drift", samples, yaw_rate=1e-5)
    np.testing.assert_allclose(found.r, (fine.r + 1e-5 * t)[EVERY], atol=1e-12)


def test_a_gyro_that_settles_comes_to_rest():
    t, fine, samples = way()
    found = logged("gyro-drift", samples, heading_alone=0.002, settles=40.0)
    np.testing.assert_allclose(found.psi, (fine.psi + 0.08 * (1.0 - np.exp(-t / 40.0)))[EVERY], atol=1e-12)
    even = logged("gyro-drift", samples, heading_alone=0.002, settles=1e9)
    np.testing.assert_allclose(even.psi, (fine.psi + 0.002 * t)[EVERY], atol=1e-7)


@pytest.mark.parametrize("settles", [np.inf, 1e9, 1e5, 1e3])
def test_how_soon_a_gyro_settles_shows_from_never_on(settles):
    """By the reciprocal, which searches use: nothing showed of it until a millionth of it had passed."""
    t, _, samples = way()
    step = 1e-8
    ends = [
        logged("gyro-drift", samples, heading_alone=1.0, settles=one) for one in (1.0 / (1.0 / settles + step), settles)
    ]
    t, past = t[EVERY], t[EVERY] / settles
    expected = -(t**2) / 2.0 * (1.0 - 2.0 * past / 3.0 + past**2 / 4.0)
    np.testing.assert_allclose((ends[0].psi - ends[1].psi) / step, expected, atol=1e-3 * np.abs(expected).max())


@pytest.mark.parametrize("effect", [e for e in effects() if isinstance(e, FilterEffect)], ids=lambda e: e.tag)
def test_what_is_logged_of_a_steady_motion_leads_back(effect):
    """And goes on as it began: a steady turn by small steps leaves the instrument where ``settled`` puts it."""
    from tests.effects.test_effects import STRONG

    e = effect.params(**{name: STRONG[effect.tag].get(name, 0.0) for name in effect.fields})
    state = State(3.0, -2.0, 0.4, 2.5, -0.3, 0.02)
    assert effect.inverse(effect.settled(state, e)[0], e) == pytest.approx(state, abs=1e-12)
    if effect.tag == "gyro-drift":  # which is never settled
        return
    h, velocity = 0.01, complex(state.u, state.v_m)
    now = state
    shown, held = effect.settled(state, e)
    for k in range(2000):
        psi = state.psi + state.r * h * (k + 1)
        moved = velocity * (np.exp(1j * psi) - np.exp(1j * state.psi)) / (1j * state.r)
        before, now = now, state._replace(x=state.x + moved.real, y=state.y + moved.imag, psi=psi)
        shown, held = effect.function(before, now, held, h, e)
    settled, _ = effect.settled(now, e)
    assert shown == pytest.approx(settled, abs=2e-3)


def test_deviation_of_a_compass():
    """Semicircular and quadrantal, each as a sine with a phase."""
    effect = find_effect("compass-deviation")
    state = State(0.0, 0.0, np.linspace(-7.0, 7.0, 50), 2.5, -0.3, 0.01)
    e = effect.params(0.1, -0.1, 0.05, 0.02, 0.05, 0.02, -0.03, 0.01, 0.0, 0.0)
    seen = effect.function(state, e)

    def harmonic(k, sine, cosine):
        return math.hypot(sine, cosine) * np.sin(k * state.psi + math.atan2(cosine, sine))

    turned = harmonic(1, 0.1, -0.1) + harmonic(2, 0.05, 0.02)
    alone = harmonic(1, 0.05, 0.02) + harmonic(2, -0.03, 0.01)
    np.testing.assert_allclose(seen.psi - state.psi, turned + alone, atol=1e-12)
    np.testing.assert_allclose(seen.u + 1j * seen.v_m, (2.5 - 0.3j) * np.exp(-1j * turned), atol=1e-12)
    np.testing.assert_allclose(effect.inverse(seen, e).psi, state.psi, atol=1e-12)


def test_play_is_taken_up_before_the_blade_follows():
    effect = find_effect("backlash")
    e = effect.params(4.0, 0.0, 0.0, 0.0)
    blade, found = 0.0, {}
    way = [*range(11), *range(9, -11, -1), *range(-9, 1)]
    for before, now in pairwise(way):
        blade = effect.function(before, now, blade, 1.0, e)
        found.setdefault(now, []).append(blade)
    assert found[10] == [8.0]
    assert found[6] == [4.0, 8.0]
    assert found[5] == [3.0, 7.0]
    assert found[-10] == [-8.0]
    assert found[0] == [2.0, -2.0]


@pytest.mark.parametrize(("begins", "stands"), [(0.0, 1.0), (1.0, 3.0), (-0.5, 0.0), (7.0, 3.0)])
def test_a_blade_begins_anywhere_in_its_play(begins, stands):
    """Beyond its end there is no play, and once the linkage has gone through it, it makes no difference."""
    effect = find_effect("backlash")
    e = effect.params(4.0, begins, 0.0, 0.0)
    blade = effect.function(1.0, 1.0, effect.rested(1.0, e), 1.0, e)
    assert blade == stands
    assert effect.function(1.0, 9.0, blade, 1.0, e) == 7.0
    assert effect.rested(1.0, effect.params(0.0, begins, 0.0, 0.0)) == 1.0


def test_a_loose_blade_is_pushed_back_to_amidships():
    effect = find_effect("backlash")
    e = effect.params(0.0, 0.0, 4.0, 0.0)
    found = [effect.function(at, at, 5.0, 1.0, e) for at in (-5.0, -1.0, 0.0, 2.0, 3.0)]
    assert found == [-3.0, 0.0, 0.0, 0.0, 1.0]


def test_noise_of_the_log_moves_no_blade_and_hides_no_play():
    """The blade comes to rest where it does without noise, though the largest of many samples carried it along."""
    effect, rng = find_effect("backlash"), np.random.default_rng(3)
    ordered = np.repeat([0.0, 10.0, -10.0, 0.0], 100)
    noisy = ordered + 0.2 * rng.standard_normal(400)

    def moved(logged, e):
        return list(accumulate(logged, lambda blade, now: effect.function(now, now, blade, 1.0, e), initial=0.0))[
            100::100
        ]

    still = moved(ordered, effect.params(2.0, 0.0, 0.0, 0.0))
    assert still == [0.0, 9.0, -9.0, -1.0]
    assert np.max(np.abs(np.subtract(moved(noisy, effect.params(2.0, 0.0, 0.0, 0.0)), still))) > 0.4
    assert np.max(np.abs(np.subtract(moved(noisy, effect.params(2.0, 0.0, 0.0, 0.5)), still))) < 0.2
    assert moved(noisy, effect.params(0.0, 0.0, 0.0, 0.5)) == moved(noisy, effect.params(0.0, 0.0, 0.0, 0.0))  # absent


@pytest.mark.parametrize("engine", [None, lambda _: 1.5], ids=["order by order", "step by step"])
def test_orders_are_no_log(ship, engine):
    """A play read off noisy logs is one of a clean order."""

    def zigzag(**values):
        put_in = with_effects(ship, {"backlash": {"play": 2.0 * DEG, **values}}, "a test")
        return run_manoeuvre(put_in, ZigzagOrder(10.0 * DEG, 10.0 * DEG, legs=2), engine=engine, longest=300.0)

    np.testing.assert_array_equal(zigzag(noise=0.5 * DEG).states, zigzag().states)


def test_a_rudder_moved_by_hand_between_samples_is_no_noise_without_end():
    angles = 10.0 * DEG * np.random.default_rng(1).standard_normal(100)
    seen = Visited(np.full(100, 10.0), angles, *np.zeros((5, 100)))
    assert find_effect("backlash").read_off["noise"](seen) == pytest.approx(0.5 * DEG)


@pytest.mark.long
def test_play_is_found_as_it_is_though_the_log_of_the_rudder_is_noisy():
    """Without ``noise`` it would be found 0.6 deg too large."""
    rng = np.random.default_rng(1)
    sailed = simulate({}, {"backlash": {"play": 2.0 * DEG}}, seed=1)
    noisy = [replace(one, delta=one.delta + 0.1 * DEG * rng.standard_normal(one.n_samples)) for one in sailed]
    options = FitOptions(
        method="least-squares", starts=4, initial="estimated", targets=("hull.R_0", "hull.N_v", "hull.N_r"),
        with_effects=("backlash",),
    )  # fmt: skip
    found = fit("suzaku", noisy, options).tuned_profile()
    assert found.value("effects.backlash.noise") == pytest.approx(0.25 * DEG, rel=0.2)
    assert found.value("effects.backlash.play") == pytest.approx(2.0 * DEG, abs=0.1 * DEG)


def test_the_rudder_may_move_more_to_one_side_and_less_the_farther():
    effect = find_effect("rudder-gain")
    e = effect.params(1.1, 1.2, 0.9, 0.0)
    for angle, factor in ((0.3, 1.32), (-0.3, 0.99), (0.0, 1.0)):
        assert effect.function(0.0, angle, 0.0, 1.0, e) == pytest.approx(factor * angle)
    e = effect.params(1.1, 1.0, 1.0, -0.2)
    for angle, factor in ((35.0, 0.8), (-35.0, 0.8), (17.5, 0.95), (70.0, 0.2), (105.0, 0.2), (-105.0, 0.2)):
        assert effect.function(0.0, angle * DEG, 0.0, 1.0, e) == pytest.approx(1.1 * factor * angle * DEG)


def test_a_shaft_follows_the_telegraph():
    effect = find_effect("governor-lag")
    e = effect.params(20.0)
    n = 1.0
    for _ in range(30):
        n = effect.function(2.0, 2.0, n, 1.0, e)
    assert n == pytest.approx(2.0 - math.exp(-1.5))


@pytest.fixture(scope="module")
def ship():
    return load_profile("suzaku")


def test_a_dead_time_is_of_the_rudder_alone(ship):
    late = Model(with_effects(ship, {"dead-time": {"seconds": 3.0}}, "test"))
    cases = turn(late, 20.0, 60.0)
    controls = cases.controls[0].copy()
    delta = late.inputs.index("delta")
    controls[:, 1 - delta] *= np.linspace(1.0, 0.8, len(controls))
    given = pad([cases.t[0]], [controls], [cases.initial[0]])
    acted = controls.copy()
    acted[3:, delta], acted[:3, delta] = controls[:-3, delta], controls[0, delta]
    shifted = pad([cases.t[0]], [acted], [cases.initial[0]])
    for backend in ("compiled", "numpy"):
        found = states(late, given, backend=backend)
        np.testing.assert_allclose(found, states(Model(ship), shifted, backend=backend), atol=1e-9)


def test_a_ship_with_dead_time_is_steered_as_her_log_says(ship):
    """What a helmsman's run logs gives the run back; and an order acts when the dead time is over."""
    slow = with_effects(ship, {"dead-time": {"seconds": 4.0}}, "test")
    run = run_manoeuvre(slow, TurningOrder(0.5), longest=120.0)
    prompt = run_manoeuvre(ship, TurningOrder(0.5), longest=120.0)
    np.testing.assert_array_equal(run.controls, prompt.controls[: len(run.controls)])
    delta = run.controls[:, 1 - run.inputs.index("n")]
    ordered = int(np.argmax(delta > 0.0)) - 1  # the last sample with the rudder amidships
    np.testing.assert_allclose(run.states[: ordered + 4, 5], 0.0, atol=5e-4)
    assert prompt.states[ordered + 4, 5] > run.states[ordered + 4, 5] + 1e-3
    cases = pad([run.t], [run.controls], [run.states[0]])
    again = states(Model(slow), cases, integrator=Integrator("rk4", 2))[0, 0]
    np.testing.assert_allclose(again[:, :2], run.states[:, :2], atol=0.3)
    np.testing.assert_allclose(again[:, 2], run.states[:, 2], atol=5e-3)


def test_a_slope_of_resistance_leaves_the_level_at_its_pivot(ship):
    put_in = with_effects(ship, {"resistance": {"slope": 5.0}}, "test")
    assert put_in.value("effects.resistance.pivot") == pytest.approx(ship.approach.speed)
    assert parse_profile(put_in.text).value("effects.resistance.pivot") == pytest.approx(ship.approach.speed)
    assert ship.value("particulars.L_pp") == 83.0
    low, high = find_effect("resistance").parameters["slope"].bounds(scale())
    per_speed = 0.25 * math.sqrt(9.81 * 83.0)  # 25 % per m/s at 3.1 m/s
    assert low < -per_speed
    assert high > per_speed
    # Written before there were pivots, a slope grows from rest.
    old = parse_profile(ship.text + "\n[effects.resistance]\nslope = 2.0\n")
    assert old.value("effects.resistance.pivot") == 0.0


def scale():
    from mmgtune.profile import scale_of

    return scale_of(load_profile("suzaku"))


@pytest.mark.parametrize(
    ("tag", "parameters", "logs"),
    [
        ("gyro-bias", ["rate"], ("r",)),
        ("gyro-scale", ["factor"], ("r",)),
        ("gyro-scale", ["curve"], ("r",)),
        ("log-zero", ["ahead"], ("u",)),
        ("log-zero", ["abeam"], ("v_m",)),
        ("log-misalignment", ["angle"], ("u", "v_m")),
        ("heading-bias", ["alone"], ("psi",)),
        ("compass-deviation", ["sine_alone", "cosine_alone"], ("psi",)),
        ("antenna", ["x", "y"], ("x", "y", "u", "v_m")),
        ("antenna", ["x_alone"], ("x", "y")),
    ],
)
def test_logs_in_which_an_error_of_a_sensor_shows(tag, parameters, logs):
    assert find_effect(tag).shown_in(parameters) == logs
