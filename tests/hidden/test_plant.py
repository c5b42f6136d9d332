"""The plant agrees with the equations of the program, and each effect does what its name says."""

from __future__ import annotations

import numpy as np
import pytest

from mmgtune.effects import effects
from mmgtune.model import Model
from mmgtune.physics.arrangements.single_propeller_single_rudder import Control, derivatives
from mmgtune.physics.quantities import State
from mmgtune.profile import load_profile, with_all_effects
from mmgtune.trial import load_trials

from . import cases, plant
from .suzaku import GEAR_RATE, NULL, PROFILE, TARGETS, coefficients
from .unknown import UNKNOWN

X, Y, PSI, U, V, R, N, DELTA = range(1, 9)
"""Columns of what ``plant.sail`` gives."""

SEED = 7

SHORT = ("turn_p40", "zigzag_10")
"""Trials that stand for all where every effect is tried."""


@pytest.fixture(scope="module")
def still():
    """The ship of the profile without any effect."""
    return plant.sail({}, {}, SEED)


def sailed(tag, names=plant.NAMES, **parameters):
    return plant.sail({}, {tag: parameters}, SEED, names)


def test_numbers_are_those_of_the_profile():
    profile = load_profile("suzaku")
    numbers = {name: value for section in profile.sections.values() for name, value in section.numbers.items()}
    assert {name: numbers[name] for name in PROFILE} == pytest.approx(PROFILE)


def test_accelerations_agree_with_the_program():
    model = Model(load_profile("suzaku"))
    p = model.coefficients(model.matrix())
    ship = coefficients({}, {})
    rng = np.random.default_rng(SEED)
    u, v, r = rng.uniform(0.5, 4.0, 300), rng.uniform(-1.0, 1.0, 300), rng.uniform(-0.02, 0.02, 300)
    n, delta = rng.uniform(1.2, 1.9, 300), rng.uniform(-0.8, 0.8, 300)
    zero = np.zeros(300)
    expected = derivatives(State(zero, zero, zero, u, v, r), Control(n, delta), model.components, p)
    found = np.array([plant.accelerations(ship, *state) for state in zip(u, v, r, n, delta, strict=True)]).T
    np.testing.assert_allclose(found, [expected.u, expected.v_m, expected.r], rtol=1e-10, atol=1e-16)


def test_every_effect_of_the_registry_that_applies_to_the_ship_is_here():
    # The plant logs nothing of what is around the ship.
    of_measured = {e.tag for e in effects() if all(set(variant) <= set(e.of_measured) for variant in e.variants)}
    applying = {effect.tag for effect in Model(with_all_effects(load_profile("suzaku"))).effects}
    assert applying - of_measured == set(NULL) - set(UNKNOWN) == set(cases.LADDER)
    assert len(UNKNOWN) >= 24


@pytest.mark.parametrize("tag", NULL)
def test_an_effect_at_its_null_is_none(tag, still):
    found = sailed(tag, SHORT, **NULL[tag])
    for name in SHORT:
        np.testing.assert_array_equal(found[name], still[name])


@pytest.mark.parametrize("tag", cases.LADDER)
def test_levels_begin_low_and_leave_a_ship_that_turns(tag, still):
    scale = np.array([*vars(plant.WHITE).values()][:8])
    shown = []
    for level in (0, cases.TYPICAL, 4):
        hidden = {tag: cases.LADDER[tag](level, np.random.default_rng(3))}
        rows = plant.sail({}, hidden, SEED, SHORT)["turn_p40"]
        shown.append(np.sqrt((((rows - still["turn_p40"])[:, 1:] / scale) ** 2).mean()))
        assert rows[-1, PSI] - rows[0, PSI] > np.pi
    if tag != "steering-lag":  # its log may hold the order
        assert shown[0] < min(shown[1:])
    assert shown[1] > 0.2


@pytest.mark.parametrize("tag", UNKNOWN)
def test_an_unknown_effect_is_visible_and_plausible(tag, still):
    scale = np.array([*vars(plant.WHITE).values()][:8])
    names = ("turn_m20", "turn_m40")
    for magnitude in UNKNOWN[tag].magnitudes:
        found = sailed(tag, names, magnitude=magnitude)
        moved = [(found[name] - still[name])[:, X:] / scale for name in names]
        assert np.abs(np.concatenate(moved)).max() > 2.0
        assert all(rows[:, U].min() > 0.0 for rows in found.values())
        assert all(np.abs(rows[:, R]).max() < 0.05 for rows in found.values())


def test_a_trial_is_as_ordered(still):
    assert list(still) == [name for name, *_ in plant.TRIALS]
    turn = still["turn_m35"]
    assert turn[0, U] == plant.SPEED
    assert np.all(turn[turn[:, 0] <= plant.ORDER_AT, DELTA] == 0.0)
    assert np.degrees(-turn[25, DELTA]) == pytest.approx(5 * 2.32)
    assert np.degrees(turn[-1, DELTA]) == pytest.approx(-35.0)
    for name in ("zigzag_10", "zigzag_20"):
        held = still[name][:, DELTA]
        legs = np.sign(held[np.isclose(np.abs(held), np.abs(held).max())])
        assert 1 + np.count_nonzero(np.diff(legs)) >= 5
        assert len(held) <= 901


def test_effects_on_the_rudder(still):
    """Blade = factor x logged: of 20 deg logged with 1.75 as of 35 deg (from where the gear has arrived)."""
    gained = coefficients({}, {"rudder-gain": {"factor": 1.75}, "rudder-offset": {"angle": 0.01}})
    assert plant.blade_angle(gained, np.radians(20.0), np.radians(20.0)) == pytest.approx(np.radians(35.0) + 0.01)
    lagging = sailed("steering-lag", time_constant=4.0)["turn_p35"]
    np.testing.assert_array_equal(lagging[:, DELTA], still["turn_p35"][:, DELTA])
    assert lagging[40, R] < still["turn_p35"][40, R]
    ordered = sailed("steering-lag", rate_limit=GEAR_RATE)["turn_p35"]
    np.testing.assert_array_equal(ordered[:, X:N], still["turn_p35"][:, X:N])
    assert np.degrees(ordered[20, DELTA]) == pytest.approx(35.0)


def test_a_late_clock_only_moves_the_controls(still):
    for seconds in (3, -3):
        found = sailed("clock-offset", seconds=float(seconds))["turn_p10"]
        np.testing.assert_array_equal(found[:, X:N], still["turn_p10"][:, X:N])
        shifted = found[5 + seconds : 795 + seconds, N:]
        np.testing.assert_allclose(shifted, still["turn_p10"][5:795, N:], atol=1e-12)


def test_a_current_carries_circles_along(still):
    north, east = 0.2, -0.1
    found = sailed("current", north=north, east=east)["turn_p20"]
    t = found[:, 0]
    np.testing.assert_allclose(found[:, X], still["turn_p20"][:, X] + north * t, atol=1e-6)
    np.testing.assert_allclose(found[:, Y], still["turn_p20"][:, Y] + east * t, atol=1e-6)
    np.testing.assert_allclose(found[:, [PSI, R]], still["turn_p20"][:, [PSI, R]], atol=1e-12)
    carried = found[:, U] * np.cos(found[:, PSI]) - found[:, V] * np.sin(found[:, PSI])
    np.testing.assert_allclose(carried[1:-1], (found[2:, X] - found[:-2, X]) / 2.0, atol=0.02)


def test_signs_of_wind_and_waves():
    s = coefficients({}, {"wave-drift": {"force": 1e4, "direction": 0.5}})
    ahead = plant.wind_force(s, 10.0, 0.7, 0.7, 0.0, 0.0)
    starboard = plant.wind_force(s, 10.0, 0.7 + np.pi / 2.0, 0.7, 0.0, 0.0)
    own = plant.wind_force(s, 0.0, 0.0, 0.7, 3.0, 0.0)
    assert ahead[0] < 0.0
    assert ahead[1:] == pytest.approx((0.0, 0.0), abs=1e-6)
    assert starboard[1] < 0.0
    assert own == pytest.approx(np.array(ahead) * 0.09, abs=1e-6)
    assert plant.outside(s, 0.0, 0.0, 0.5, 3.0, 0.0) == pytest.approx((-1e4, 0.0, 0.0))
    assert plant.outside(s, 0.0, 0.0, 0.5 - np.pi / 2.0, 3.0, 0.0) == pytest.approx((0.0, -1e4, 0.0), abs=1e-9)


def test_a_steady_force_stays_with_the_ship_whatever_she_does():
    s = coefficients({}, {"steady-force": {"ahead": -2e3, "side": 3e3, "moment": -9e4}})
    for psi, u in ((0.0, 3.0), (2.0, 1.0), (-1.0, -0.5)):
        assert plant.outside(s, 40.0, 0.0, psi, u, 0.0) == pytest.approx((-2e3, 3e3, -9e4))


def test_a_hull_that_is_not_alike_on_both_sides_is_pushed_by_the_square_of_the_speed():
    half = 0.5 * 1025.0 * 83.0 * 3.8
    for speed in (1.0, 3.0):
        skew = plant.hull(coefficients({}, {"hull-asymmetry": {"Y_0": 2e-3, "N_0": -4e-4}}), 0.0, speed, 0.0, 0.0)
        alike = plant.hull(coefficients({}, {}), 0.0, speed, 0.0, 0.0)
        added = np.subtract(skew, alike) / (half * speed**2)
        assert added == pytest.approx((0.0, 2e-3, -4e-4 * 83.0))


def test_a_symmetric_ship_turns_alike_to_both_sides():
    """Without side force of the propeller and with one gamma_R: the mirror image, also of a rudder offset."""
    ship = {"rudder.gamma_Rn": PROFILE["rudder.gamma_Rp"]}
    nothing = {"propeller-side-force": {"force": 0.0, "moment": 0.0}}
    s = coefficients(ship, nothing)
    for state in ((3.0, -0.4, 0.01, 1.7, 0.4), (2.0, 0.3, 0.015, 1.6, -0.3)):
        du, dv, dr = plant.accelerations(s, *state)
        u, v, r, n, delta = state
        assert plant.accelerations(s, u, -v, -r, n, -delta) == pytest.approx((du, -dv, -dr), rel=1e-12)
    offset = [
        plant.sail(ship, {**nothing, "rudder-offset": {"angle": angle}}, SEED)[name][:, R]
        for angle, name in ((0.02, "turn_p35"), (-0.02, "turn_m35"))
    ]
    np.testing.assert_allclose(offset[0], -offset[1], rtol=0.05, atol=2e-4)  # their revolutions differ a little


def test_memory_delays_and_keeps_the_steady_turn(still):
    found = sailed("memory", time_constant=8.0)["turn_p10"]
    assert found[-1, R] == pytest.approx(still["turn_p10"][-1, R], rel=0.02)
    assert np.abs(found[20:60, R] - still["turn_p10"][20:60, R]).max() > 5e-4


def test_a_stalled_rudder_turns_less(still):
    found = sailed("rudder-stall", angle=np.radians(20.0))
    assert found["turn_p40"][40, R] < still["turn_p40"][40, R]
    np.testing.assert_array_equal(found["turn_p10"], still["turn_p10"])


def test_a_hull_term_adds_its_monomial():
    u, v, r = 2.0, -0.5, 0.012
    speed = np.hypot(u, v)
    v_, r_ = v / speed, r * 83.0 / speed
    monomials = {"N_rabsr": r_ * abs(r_), "Y_vabsv": v_ * abs(v_), "N_rrabsr": r_**2 * abs(r_), "X_vv": v_**2}
    plain = plant.hull(coefficients({}, {}), 0.0, speed, v_, r_)
    half = 0.5 * 1025.0 * 83.0 * 3.8 * speed**2
    for term, monomial in monomials.items():
        found = plant.hull(coefficients({}, {"hull-term": {term: 0.02}}), 0.0, speed, v_, r_)
        added = np.subtract(found, plain) / (half, half, half * 83.0)
        assert added["XYN".index(term[0])] == pytest.approx(0.02 * monomial)
        assert np.count_nonzero(added) == 1


def test_sensors(still):
    turn = still["turn_p35"]
    psi, r = turn[:, PSI], turn[:, R]
    arm = sailed("antenna", x=10.0, y=-4.0)["turn_p35"]
    np.testing.assert_allclose(arm[:, X] - turn[:, X], 10.0 * np.cos(psi) + 4.0 * np.sin(psi), atol=1e-9)
    np.testing.assert_allclose(arm[:, U] - turn[:, U], 4.0 * r, atol=1e-12)
    np.testing.assert_allclose(arm[:, V] - turn[:, V], 10.0 * r, atol=1e-12)
    far = sailed("antenna", x_alone=10.0, y_alone=-4.0)["turn_p35"]
    np.testing.assert_array_equal(far[:, [X, Y]], arm[:, [X, Y]])
    np.testing.assert_array_equal(far[:, [U, V]], turn[:, [U, V]])
    biased = sailed("heading-bias", angle=0.03)["turn_p35"]
    np.testing.assert_allclose(biased[:, PSI], psi + 0.03, atol=1e-12)
    assert biased[10, V] == pytest.approx(turn[10, V] * np.cos(0.03) - turn[10, U] * np.sin(0.03))
    np.testing.assert_allclose(sailed("gyro-scale", factor=1.05)["turn_p35"][:, R], 1.05 * r, atol=1e-15)
    curved = sailed("gyro-scale", curve=-0.1)["turn_p35"][:, R]
    np.testing.assert_allclose(curved, r * (1.0 - 0.1 * np.abs(r) * 83.0 / plant.SPEED), atol=1e-15)
    np.testing.assert_allclose(sailed("gyro-bias", rate=1e-3)["turn_p35"][:, R], r + 1e-3, atol=1e-15)
    np.testing.assert_allclose(sailed("speed-scale", factor=0.9)["turn_p35"][:, U], 0.9 * turn[:, U], atol=1e-12)
    scaled = sailed("speed-scale", both=0.9)["turn_p35"]
    np.testing.assert_allclose(scaled[:, [U, V]], 0.9 * turn[:, [U, V]], atol=1e-12)
    grown = sailed("speed-scale", grows=0.1)["turn_p35"]
    np.testing.assert_allclose(grown[:, U], turn[:, U] * (1.0 + 0.1 * (turn[:, U] - plant.SPEED)), atol=1e-12)
    zero = sailed("log-zero", ahead=0.1, abeam=-0.2)["turn_p35"]
    np.testing.assert_allclose(zero[:, [U, V]], turn[:, [U, V]] + [0.1, -0.2], atol=1e-12)
    wet = sailed("water-log", north=0.3, east=-0.1)["turn_p35"]
    ahead = 0.3 * np.cos(psi) - 0.1 * np.sin(psi)
    np.testing.assert_allclose(wet[:, U], turn[:, U] - ahead, atol=1e-12)
    turned = sailed("log-misalignment", angle=0.5 * np.pi)["turn_p35"]
    np.testing.assert_allclose(turned[:, [U, V]], np.column_stack([turn[:, V], -turn[:, U]]), atol=1e-12)
    for one in (grown, zero, turned, wet):
        np.testing.assert_array_equal(one[:, [X, Y, PSI, R]], turn[:, [X, Y, PSI, R]])


def test_unknown_names_are_refused():
    with pytest.raises(KeyError):
        plant.sail({}, {"antena": {"x": 1.0}}, SEED)
    with pytest.raises(KeyError):
        plant.sail({}, {"antenna": {"z": 1.0}}, SEED)
    with pytest.raises(KeyError):
        plant.sail({"hull.R0": 0.02}, {}, SEED)


def test_noise_has_its_size_and_its_memory(still):
    rows = still["turn_p10"]
    for noise, correlation in ((plant.WHITE, 0.0), (plant.AUTOCORRELATED, np.exp(-1.0 / 30.0))):
        errors = np.concatenate(
            [plant.noisy(rows, noise, np.random.default_rng(k))[:, 1:] - rows[:, 1:] for k in range(40)]
        )
        np.testing.assert_allclose(errors.std(0), [*vars(noise).values()][:8], rtol=0.1)
        assert np.corrcoef(errors[1:, 0], errors[:-1, 0])[0, 1] == pytest.approx(correlation, abs=0.02)
        assert np.corrcoef(errors[1:, 7], errors[:-1, 7])[0, 1] == pytest.approx(0.0, abs=0.02)


def test_files_load(tmp_path):
    case = cases.single("current", cases.TYPICAL, SEED)
    trials = plant.simulate(case.ship, case.effects, case.seed, case.noise)
    plant.write(trials, tmp_path)
    loaded = load_trials(tmp_path)
    assert (len(loaded.tune), len(loaded.test), loaded.others, loaded.ship) == (5, 5, (), "suzaku")
    for trial in trials:
        found = loaded.trials[trial.id]
        assert (found.source, found.note) == ("generated", "")
        np.testing.assert_array_equal(found.psi, trial.psi)


def test_cases_are_drawn_again_the_same():
    assert cases.pair(3) == cases.pair(3) != cases.pair(4)
    assert len(cases.pair(3).effects) == 2
    assert cases.single("wind", 1, 3).ship == cases.single("wind", 4, 3).ship == cases.null(3).ship
    assert (
        cases.single("wind", 1, 3).effects["wind"]["direction"]
        == cases.single("wind", 4, 3).effects["wind"]["direction"]
    )
    assert [cases.unknown(k, 0).name for k in range(len(UNKNOWN))] == [f"{tag}-0" for tag in UNKNOWN]
    for name, value in cases.null(3).ship.items():
        assert name in TARGETS
        assert abs(value / PROFILE[name] - 1.0) <= cases.SPREAD


@pytest.mark.long
def test_cases_measured_otherwise_vary_in_programme_sampling_and_noise(tmp_path):
    drawn = [
        cases.otherwise(tag, seed) for tag in ("current", "flap", "antenna", "memory", "wind") for seed in (1, 2, 3)
    ]
    assert len({case.seed for case in drawn}) == len(drawn)  # a noise of its own each
    assert {case.programme.every for case in drawn} == {1, 5, 10}
    assert {case.programme.told for case in drawn} == {True, False}
    assert {len(case.programme.tuning) for case in drawn} == {4, 5, 10}
    assert len({round(case.noise.x, 3) for case in drawn}) == 3
    case = next(case for case in drawn if case.programme.trials == cases.FOUR)
    kept = case.programme.kept(plant.simulate(case.ship, case.effects, case.seed, case.noise))
    plant.write(kept, tmp_path, case.programme.tuning)
    read = load_trials(tmp_path)
    assert (set(read.tune), read.test) == (set(cases.FOUR), ())
    for trial in read.trials.values():
        assert np.diff(trial.t) == pytest.approx(float(case.programme.every), abs=0.02)
        assert bool(trial.noise) == case.programme.told
