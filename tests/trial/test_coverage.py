"""What trials visit: known motions, whose extremes anyone can write down."""

import json
import warnings
from dataclasses import replace

import numpy as np
import pytest

from mmgtune.effects import Visited
from mmgtune.trial import Coverage, load_trials, visited_by
from mmgtune.units import DEG

L = 83.0


@pytest.fixture(scope="module")
def turn():
    """A made turn to starboard: 200 s, 2 m/s ahead, 35 deg of rudder from 20 s on, then r L / U = 0.5."""
    trial = load_trials("suzaku").trials["turn_p35"]
    n = 201
    t = np.arange(n, dtype=float)
    turning = t >= 20.0
    zero = np.zeros(n)
    return replace(
        trial,
        t=t,
        x=zero,
        y=zero,
        psi=zero,
        u=np.full(n, 2.0),
        v_m=np.where(turning, -0.2, 0.0),
        r=np.where(turning, 0.5 * np.hypot(2.0, 0.2) / L, 0.0),
        n=np.full(n, 1.7),
        delta=np.where(turning, 35.0 * DEG, 0.0),
        extra={},
    )


def mirrored(trial):
    return replace(trial, v_m=-trial.v_m, r=-trial.r, delta=-trial.delta)


def test_one_turn_visits_one_side(turn):
    seen = Coverage.of([turn], L)
    assert seen.sides == ("starboard",)
    assert seen.unseen_side == "port"
    assert seen.rudder == pytest.approx((0.0, 35.0 * DEG))
    assert seen.rate == pytest.approx((0.0, 0.5))
    assert seen.drift[1] == pytest.approx(np.arctan2(0.2, 2.0))
    assert not seen.astern
    assert "turns to starboard only" in seen.sentence


def test_its_mirror_image_visits_the_other_and_both_both(turn):
    assert Coverage.of([mirrored(turn)], L).sides == ("port",)
    both = Coverage.of([turn, mirrored(turn)], L)
    assert both.sides == ("port", "starboard")
    assert both.unseen_side == ""
    assert "both sides" in both.sentence


def test_what_lasts_a_moment_is_not_visited(turn):
    delta = turn.delta.copy()
    delta[100:103] = -40.0 * DEG  # a spike of three seconds
    assert Coverage.of([replace(turn, delta=delta)], L).rudder == pytest.approx((0.0, 35.0 * DEG))


def test_a_rudder_that_keeps_a_course_visits_no_side(turn):
    wobble = 1.5 * DEG * np.sin(turn.t)
    still = replace(turn, delta=wobble, r=0.001 * np.sin(turn.t), v_m=np.zeros(len(turn.t)))
    assert Coverage.of([still], L).sides == ()


def test_gaps_and_a_ship_at_rest_do_no_harm(turn):
    u = turn.u.copy()
    u[:30] = 0.0
    u[40:60] = np.nan
    gappy = replace(turn, u=u, r=np.where(turn.t < 90.0, np.nan, turn.r), v_m=np.where(turn.t < 30.0, 0.0, turn.v_m))
    seen = Coverage.of([gappy], L)
    assert np.isfinite([*seen.rudder, *seen.rate, *seen.speed]).all()
    assert seen.speed[0] == 0.0
    assert Coverage.of([], L).to_dict() == {}


def test_spinning_near_rest_hides_no_side(turn):
    """After a turn to port the ship is nearly stopped and still turns to starboard: r L / U is 100 there."""
    port = mirrored(turn)
    stopping = turn.t >= 150.0
    u = np.where(stopping, 0.01, port.u)
    spun = replace(port, u=u, v_m=np.where(stopping, 0.0, port.v_m), r=np.where(stopping, 1.0 / L, port.r))
    assert Coverage.of([spun], L).sides == ("port",)
    assert Coverage.of([spun, turn], L).sides == ("port", "starboard")


def test_what_a_run_goes_to_beyond_is_told(turn):
    seen = Coverage.of([turn], L)
    port = Coverage.of([mirrored(turn)], L)
    assert [text.partition(":")[0] for text in seen.unvisited_by(port)] == ["rudder of 35 deg to port"]
    assert seen.unvisited_by(seen) == []
    fast = Coverage.of([replace(turn, u=2.0 * turn.u)], L)
    assert any("a speed of 4" in text for text in seen.unvisited_by(fast))
    astern = Coverage.of([replace(turn, u=-turn.u)], L)
    assert "going astern: they never do" in seen.unvisited_by(astern)
    less = Coverage.of([replace(turn, delta=0.9 * turn.delta)], L)
    assert less.unvisited_by(seen) == []  # within 15 %


def test_sides_and_speeds_are_told_without_yaw_rate_and_sway(turn):
    """The first sample alone is there, from which a run begins."""
    port = replace(turn, delta=-turn.delta, psi=-0.01 * np.maximum(turn.t - 20.0, 0.0), r=-turn.r)
    first = np.where(turn.t > 0.0, np.nan, 0.0)
    bare = replace(port, r=first, v_m=first)
    seen = Coverage.of([bare], L)
    assert seen.sides == Coverage.of([port], L).sides == ("port",)
    assert seen.rate == pytest.approx((-0.01 * L / 2.0, 0.0))
    assert seen.speed == pytest.approx((2.0, 2.0))
    assert "drift_deg" not in seen.to_dict()
    assert Coverage.from_dict(json.loads(json.dumps(seen.to_dict()))).to_dict() == seen.to_dict()
    assert "cannot be told" in Coverage.of([replace(bare, u=first)], L).sentence


def test_a_trial_without_samples_visits_nothing_without_a_word(turn):
    none = np.zeros(0)
    columns = dict.fromkeys(("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta"), none)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        seen = Coverage.of([replace(turn, **columns)], L)
    assert seen.to_dict() == {}


def test_it_survives_json(turn):
    seen = Coverage.of([turn, mirrored(turn)], L)
    again = Coverage.from_dict(json.loads(json.dumps(seen.to_dict())))
    assert again is not None
    assert again.to_dict() == seen.to_dict()
    assert Coverage.from_dict({"rudder_deg": [1]}) is None


def test_bundled_trials_visit_both_sides():
    trials = load_trials("suzaku").trials.values()
    seen = Coverage.of(trials, L)
    assert seen.sides == ("port", "starboard")
    assert visited_by(trials, L).largest_rudder == pytest.approx(40.0 * DEG, abs=0.5 * DEG)


def test_noise_of_the_rudder_is_told_from_its_motion():
    rng = np.random.default_rng(2)
    t = np.arange(400.0)
    noise = 0.1 * rng.standard_normal(400)
    for still in (20.0 * (t % 80 > 40), np.clip(2.0 * (t - 100.0), 0.0, 35.0), 15.0 * np.sin(t / 8.0)):
        assert seen(still).rudder_noise < 0.02
        assert seen(still + noise).rudder_noise == pytest.approx(0.1, rel=0.2)
    assert seen(np.round(20.0 * (t % 80 > 40) + noise)).rudder_noise == 0.0  # a log in steps hides what it has
    assert seen(noise[:19]).rudder_noise == 0.0
    gaps = np.where(t % 7 == 0, np.nan, noise)
    assert seen(gaps).rudder_noise == pytest.approx(0.1, rel=0.2)


def seen(rudder):
    """What is visited, of which nothing but the rudder matters."""
    return Visited(np.ones(len(rudder)), rudder, *np.zeros((5, len(rudder))))
