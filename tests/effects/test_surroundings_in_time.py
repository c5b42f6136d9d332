"""Effects that act on what was measured around the ship: waves and depth, and what is said where it is missing."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import Integrator, pad
from mmgtune.circumstances import notes_on
from mmgtune.effects import FactorsEffect, effects, find_effect
from mmgtune.model import Model
from mmgtune.motions import simulate_trials
from mmgtune.physics.quantities import UNKNOWN, State
from mmgtune.physics.regressions.stawave1 import added_resistance, from_ahead, height_limit
from mmgtune.profile import load_profile, parse_profile, with_effects
from mmgtune.trial import load_trials, windows
from tests.backends.test_agree import zigzag_like
from tests.runs import measured, states
from tests.trial.made import made

HEADING = 0.7
R = 1025.0 * 9.81 / 16.0 * 1.5**2 * 13.5 * math.sqrt(13.5 / (0.25 * 83.0))
"""Resistance of SUZAKU in waves of 1.5 m [N], FAM eq. 8."""


@pytest.fixture(scope="module")
def force():
    """Force of waves on SUZAKU, three numbers, from parameters and surroundings."""
    model = Model(load_profile("suzaku"))
    p = model.coefficients(model.matrix()[:, 0])
    effect = find_effect("waves")

    def of(around=UNKNOWN, **values):
        e = effect.params(
            **{"height": 0.0, "direction": 0.0, "measured": 1.0, "L_BWL_": 0.25, "outside": 0.0, **values}
        )
        return tuple(map(float, effect.function(State(0.0, 0.0, HEADING, 2.5, 0.1, 0.0), around, None, None, p, e)))

    return of


def seen(height, direction):
    return UNKNOWN._replace(
        wave_north=height * math.cos(direction), wave_east=height * math.sin(direction), wave_known=1.0
    )


def test_stawave_1():
    assert added_resistance(1025.0, 13.5, 0.25 * 83.0, 1.5) == pytest.approx(R)
    assert height_limit(100.0) == pytest.approx(2.25)
    assert height_limit(83.0) == pytest.approx(2.25 * math.sqrt(0.83))


@pytest.mark.parametrize("degrees", [0.0, 30.0, -44.9, 45.1, -60.0, 89.0, 91.0, 135.0, 180.0])
def test_waves_count_within_45_degrees_of_the_bow(degrees):
    ahead, starboard = 2.0 * math.cos(math.radians(degrees)), 2.0 * math.sin(math.radians(degrees))
    inside = abs(degrees) < 45.0
    assert from_ahead(ahead, starboard, 0.0) == (1.0 if inside else 0.0)
    off = math.radians(abs(degrees))
    taper = 1.0 if inside else 0.5 * (1.0 + math.cos(4.0 * (off - math.pi / 4.0))) if abs(degrees) < 90.0 else 0.0
    assert from_ahead(ahead, starboard, 1.0) == pytest.approx(taper, abs=1e-12)


def test_a_current_that_grows_is_one_measured_to_grow():
    """Linear in time from the beginning of the run, which a window is a part of."""
    trial = load_trials("suzaku").trials["turn_p35"]
    north, east, gain = 0.2, -0.1, np.array([1e-4, 4e-4])
    logged = np.array([[north], [east]]) + gain[:, None] * trial.t
    noted = {"current_speed": np.hypot(*logged), "current_dir": np.arctan2(logged[1], logged[0])}
    tide = {"north": north, "east": east, "north_rate": gain[0], "east_rate": gain[1]}
    ship = load_profile("suzaku")
    by_log = with_effects(ship, {"current": {"measured": 1.0}}, "test")
    measured = replace(trial, extra=noted)
    logs = {one.id: one.extra for one in (measured, *windows(measured, 100.0))}
    for part in (trial, windows(trial, 100.0)[2]):
        (expected,) = simulate_trials(by_log, [replace(part, extra=logs[part.id])], integrator=Integrator("rk4"))
        (found,) = simulate_trials(with_effects(ship, {"current": tide}, "test"), [part], integrator=Integrator("rk4"))
        np.testing.assert_allclose(found.states, expected.states, rtol=1e-6, atol=1e-6)


def test_head_waves_hold_back_and_do_nothing_else(force):
    assert force(height=1.5, direction=HEADING) == pytest.approx((-R, 0.0, 0.0))
    assert force(height=1.5, direction=HEADING + math.pi) == (0.0, 0.0, 0.0)
    assert force(height=1.5, direction=HEADING + 1.2) == (0.0, 0.0, 0.0)
    assert -R < force(height=1.5, direction=HEADING + 1.2, outside=1.0)[0] < 0.0
    assert force() == (0.0, 0.0, 0.0)


def test_measured_waves_count_where_there_are_some(force):
    around = seen(1.5, HEADING - 0.3)
    assert force(around, height=9.0, direction=HEADING) == pytest.approx((-R, 0.0, 0.0))
    assert force(around, measured=2.0) == pytest.approx((-4.0 * R, 0.0, 0.0))
    assert force(around, measured=0.0) == (0.0, 0.0, 0.0)
    assert force(around, measured=0.0, height=1.0, direction=HEADING) == pytest.approx((-R / 2.25, 0.0, 0.0))
    assert force(around, L_BWL_=1.0) == pytest.approx((-R / 2.0, 0.0, 0.0))


def test_waves_in_a_profile():
    text = load_profile("suzaku").text
    read = parse_profile(text + '\n[effects.waves]\nheight = "1.5 m"\ndirection = "40 deg"\noutside = "taper"\n')
    assert read.value("effects.waves.outside") == 1.0
    assert read.value("effects.waves.measured") == 1.0
    assert parse_profile(read.text).value("effects.waves.outside") == 1.0
    assert 'outside = "taper"' in with_effects(read, {"waves": {"height": 1.0}}, "a test").text


def test_a_head_sea_slows_the_ship_down():
    ship = load_profile("suzaku")
    wavy = Model(with_effects(ship, {"waves": {"measured": 1.0}}, "a test"))
    t = np.arange(201.0)
    straight = np.column_stack([np.full(len(t), ship.approach.n), 0.0 * t])
    start = np.array([0.0, 0.0, 0.0, ship.approach.speed, 0.0, 0.0])

    def speed(come_from):
        around = measured(t, wave=(1.5 * np.cos(come_from), 1.5 * np.sin(come_from)))
        cases = pad([t], [straight], [start], around=[around])
        return states(wavy, cases, backend="numpy")[0, 0, -1, 3]

    assert speed(0.2) < speed(np.pi) - 0.1
    assert speed(0.2) == pytest.approx(speed(-0.5), abs=1e-3)


@pytest.mark.parametrize("profile", ["suzaku", pytest.param("esso_osaka_3m", marks=pytest.mark.long)])
def test_depth_along_the_track_changes_the_linear_derivatives(profile):
    """Of either hull and in both back ends: a measured depth that does not change is the steady depth, to rounding; one
    that does lies between deep and shallow."""
    ship = load_profile(profile)
    d = ship.value("particulars.d")
    by_log = Model(with_effects(ship, {"shallow-water": {"measured": 1.0}}, "a test"))
    cases = zigzag_like(by_log, 200)
    t = cases.t[0]

    def run(model, depth=None, backend="compiled"):
        around = None if depth is None else [measured(t, depth=depth)]
        logged = pad([t], [cases.controls[0]], [cases.initial[0]], around=around)
        return states(model, logged, backend=backend, integrator=Integrator("rk4"))[0, 0]

    deep = run(by_log)
    steady = run(Model(with_effects(ship, {"shallow-water": {"depth": 1.5 * d}}, "a test")))
    assert np.allclose(run(by_log, np.full(len(t), 1.5 * d)), steady, rtol=1e-9, atol=1e-9)
    assert np.array_equal(deep, run(Model(ship)))
    shoaling = np.linspace(20.0, 1.5, len(t)) * d
    on_the_way, reference = (run(by_log, shoaling, backend) for backend in ("compiled", "numpy"))
    assert np.max(np.abs(on_the_way - reference) / (1.0 + np.abs(reference))) < 1e-12
    assert 0.05 * np.abs(steady - deep).max() < np.abs(on_the_way - deep).max() < np.abs(steady - deep).max()


def test_factors_are_on_coefficients_of_the_hull_alone():
    (effect,) = [effect for effect in effects() if isinstance(effect, FactorsEffect)]
    with pytest.raises(TypeError, match="particulars"):
        replace(effect, changes=("particulars.d",) * 4)
    with pytest.raises(TypeError, match="is not one of"):
        replace(effect, of_measured={"measured": "tide"})


def test_what_is_missing_is_still_and_said_once():
    ship = load_profile("suzaku")
    n = made().n_samples
    wind = {"wind_speed": np.full(n, 5.0), "wind_dir": np.full(n, 1.0)}
    waves = {"wave_height": np.full(n, 3.0), "wave_dir": np.full(n, 1.0)}
    trials = [made("a", extra=wind), made("b"), made("c"), made("c2", part_of="c")]

    def notes(of, trials=trials, **how):
        return notes_on(Model(with_effects(ship, of, "a test")), trials, **how)

    assert notes({"wind": {"measured": 1.0}}) == ["2 of 3 trials have no measured wind: still air there"]
    assert notes({"wind": {"measured": 1.0}}, trials[:1]) == []
    assert notes({"wind": {"measured": 0.0}}) == []
    assert notes({"wind": {}}, free=["effects.wind.measured"]) != []
    assert notes({"wind": {"measured": 1.0, "speed": 3.0}}) == [
        "2 of 3 trials have no measured wind: the steady wind of [effects.wind] there"
    ]
    assert notes({"current": {"measured": 1.0}}) == ["no trial has measured current: still water throughout"]
    assert notes({"current": {"measured": 1.0, "north": 0.2}}) == []
    assert notes({"shallow-water": {"measured": 1.0}}) == ["no trial has measured depth: deep water throughout"]
    assert notes({"shallow-water": {"measured": 1.0, "depth": 9.0}}) == []
    # Beyond what formulas hold for.
    high = [made("a", extra=waves)]
    assert notes({"waves": {"measured": 1.0}}, high) == [
        "waves are up to 3 m high, and STAWAVE-1 holds up to 2.05 m for this ship"
    ]
    assert notes({"waves": {"measured": 0.5}}, high) == []
    (shallow,) = notes({"shallow-water": {"measured": 1.0}}, [made("a", extra={"depth": np.full(n, 4.18)})])
    assert shallow.startswith("water is down to 1.1 draughts deep")
