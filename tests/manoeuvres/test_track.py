"""Records, rudder orders and the helpers on channels."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.errors import TrialError
from mmgtune.manoeuvres import Track, find_execute, find_executes, manoeuvre_kind
from mmgtune.manoeuvres.track import first_crossing, integral, noise_level, value_at

from .made import DEG, T_ORDER, circle, cut, noisy, order_times, ramp, uneven, zigzag


def test_a_record_names_every_channel_that_is_wrong():
    t = np.array([0.0, 1.0, 1.0])
    good = np.zeros(3)
    with pytest.raises(TrialError) as caught:
        Track(t=t, x=good[:2], y=good, psi=np.array([0.0, 0.0, 4.0]), u=good * np.nan, v_m=good, delta=good)
    assert {problem.where for problem in caught.value.problems} == {"t", "x", "psi", "u"}


@pytest.mark.parametrize("wrong", ["", 1 + 2j, np.zeros(3, dtype=complex), 10**400, [[1.0, 2.0], [3.0]], ["1", "2"]])
def test_a_channel_without_numbers_is_named(wrong):
    channels = dict.fromkeys(("t", "x", "y", "psi", "u", "v_m", "delta"), np.arange(20.0) / 10.0)
    for name in ("t", "delta"):
        with pytest.raises(TrialError, match=rf"no number \({name}\)"):
            Track(**{**channels, name: wrong})


@pytest.mark.parametrize("rate", [1.0 * DEG, 2.3 * DEG, 20.0 * DEG, 1000.0 * DEG])
@pytest.mark.parametrize("side", [1, -1])
def test_execute_is_the_last_sample_before_the_rudder_moves(rate, side):
    track = circle(side=side, rate=rate)
    order = find_execute(track)
    assert track.t[order.index] == T_ORDER
    assert (order.side, order.at_start) == (side, False)
    assert order.angle == pytest.approx(35.0 * DEG)


@pytest.mark.parametrize("seed", range(8))
def test_execute_under_rudder_noise(seed):
    track = noisy(circle(), seed, delta=0.3 * DEG)
    assert track.t[find_execute(track).index] == pytest.approx(T_ORDER, abs=0.5)


@pytest.mark.parametrize("amplitude", [1.0, 3.0, -3.0, -8.0, -14.0])
@pytest.mark.parametrize("make", [circle, zigzag])
def test_course_keeping_is_not_the_order(make, amplitude):
    """Negative: the rudder moves away from the order's side when the order comes; 14 deg is more than is ordered."""
    track = make(keeping=amplitude * DEG)
    assert np.sum(np.diff(np.sign(track.delta[track.t < T_ORDER])) != 0) > 3
    assert track.t[find_execute(track).index] == pytest.approx(T_ORDER, abs=1.0)


@pytest.mark.parametrize("amplitude", [5.0, 8.0, 14.0])
@pytest.mark.parametrize("make", [circle, zigzag])
def test_course_keeping_that_runs_into_the_order(make, amplitude):
    """At half the rudder's rate or more no corner is left: the order lies after the last turning point."""
    index = find_execute(make(keeping=amplitude * DEG)).index
    assert T_ORDER - 25.0 / 4.0 <= make().t[index] <= T_ORDER + 1.0


def test_rudder_at_its_angle_for_a_moment_is_not_the_order():
    track = circle()
    delta = np.where((track.t > 10.0) & (track.t < 14.0), 35.0 * DEG, track.delta)
    assert track.t[find_execute(replace(track, delta=delta)).index] == T_ORDER


def test_rudder_at_its_angle_for_a_moment_is_not_the_order_though_the_ship_yaws():
    track = circle()
    delta = np.where((track.t > 10.0) & (track.t < 14.0), 35.0 * DEG, track.delta)
    psi = track.psi + 1.0 * DEG * np.exp(-(((track.t - 14.0) / 4.0) ** 2))
    assert track.t[find_execute(replace(track, delta=delta, psi=psi)).index] == T_ORDER


def test_yawing_to_and_fro_on_course_is_no_turning():
    """5 deg of rudder to either side on course: more heading is covered there than in the turn, to no side."""
    track = cut(circle(), end=T_ORDER + 50.0)
    early = np.arange(-500.0, 0.0, 0.5)
    phase = 2.0 * np.pi * early / 40.0
    channels = {
        name: np.r_[np.full(early.size, getattr(track, name)[0]), getattr(track, name)] for name in ("x", "y", "v_m")
    }
    psi = np.r_[2.0 * DEG * np.sin(phase), track.psi]
    delta = np.r_[5.0 * DEG * np.sign(np.sin(phase + 0.1)), track.delta]
    u = np.full(psi.size, 5.0)
    order = find_execute(Track(t=np.r_[early, track.t], psi=psi, delta=delta, u=u, **channels))
    assert order.angle == pytest.approx(35.0 * DEG)


def test_counter_order_is_not_the_zero_crossing():
    track = zigzag()
    for order, time in zip(find_executes(track)[1:], order_times(10.4 * DEG), strict=True):
        assert track.t[order.index] == pytest.approx(time, abs=0.5)
        assert abs(track.delta[order.index]) == pytest.approx(10.0 * DEG, abs=0.3 * DEG)


@pytest.mark.parametrize("begin", [T_ORDER + 5.0, T_ORDER + 40.0])
def test_record_that_begins_with_the_rudder_over_says_so(begin):
    order = find_execute(cut(circle(), begin))
    assert (order.index, order.at_start) == (0, True)


def test_record_that_begins_at_the_order_is_complete():
    order = find_execute(cut(circle(), T_ORDER))
    assert (order.index, order.at_start) == (0, False)


@pytest.mark.parametrize("seed", range(4))
def test_record_that_begins_at_the_order_under_noise(seed):
    order = find_execute(noisy(cut(circle(), T_ORDER), seed, delta=0.2 * DEG))
    assert (order.index, order.at_start) == (0, False)


def test_no_order_at_all():
    track = cut(circle(keeping=5.0 * DEG), end=T_ORDER)
    with pytest.raises(TrialError, match="no rudder order"):
        find_execute(track)
    assert manoeuvre_kind(track) == "other"


@pytest.mark.parametrize(
    ("track", "kind"),
    [
        (circle(keeping=5.0 * DEG), "turning"),
        (circle(side=-1, pull_out=400.0), "turning"),
        (cut(circle(), T_ORDER + 20.0, 300.0), "turning"),
        (cut(circle(), end=T_ORDER + 40.0), "other"),
        (zigzag(), "zigzag"),
        (noisy(zigzag(side=-1, t=uneven(640.0)), psi=0.1 * DEG, delta=0.2 * DEG), "zigzag"),
    ],
)
def test_kind(track, kind):
    assert manoeuvre_kind(track) == kind


def test_wandering_rudder_is_no_standard_manoeuvre():
    track = circle()
    wandering = 20.0 * DEG * np.sin(2.0 * np.pi * track.t / 100.0)
    heading = 0.5 * np.sin(2.0 * np.pi * (track.t - 20.0) / 100.0)
    assert manoeuvre_kind(replace(track, delta=wandering, psi=heading)) == "other"


def test_noise_level_sees_noise_and_neither_slope_nor_steps():
    t = uneven(1000.0)
    smooth = ramp(t, 100.0, 0.0, 1.0, rate=0.01) + 5.0 * (t > 500.0)
    assert noise_level(t, smooth) < 1e-12
    rng = np.random.default_rng(2)
    assert noise_level(t, smooth + 0.1 * rng.standard_normal(t.size)) == pytest.approx(0.1, rel=0.1)


def test_crossing_value_and_integral_between_samples():
    t, y = np.array([0.0, 1.0, 3.0, 4.0]), np.array([0.0, 2.0, 6.0, 5.0])
    position = first_crossing(y, 3.0, 0, 3)
    assert position == pytest.approx(1.25)
    assert value_at(t, position) == pytest.approx(1.5)
    assert integral(t, y, 0.0, position) == pytest.approx(1.5**2)
    assert integral(t, y, 1.25, 1.5) == pytest.approx(0.5 * 3.5)
    assert first_crossing(y, 7.0, 0, 3) is None
    assert first_crossing(y, 6.0, 0, 1) is None
    assert first_crossing(y, 1.0, 2, 3) == 2.0
