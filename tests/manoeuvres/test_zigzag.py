"""Zigzag indices against half sines of heading of known height."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmgtune.manoeuvres import zigzag_indices
from mmgtune.manoeuvres.zigzag import heading_peak, usual_angle

from .made import AMPLITUDES, DEG, OMEGA, T_ORDER, L, U, cut, noisy, order_times, uneven, zigzag

FIRST = np.asarray(AMPLITUDES[:3])


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("t", [None, uneven(640.0)], ids=["even", "uneven"])
@pytest.mark.parametrize("psi_0", [0.0, 7.0])
def test_overshoots_times_and_distances(side, t, psi_0):
    indices = zigzag_indices(zigzag(side=side, t=t, psi_0=psi_0), L)
    assert indices.direction == ("starboard" if side > 0 else "port")
    assert (indices.rudder_angle, indices.heading_angle) == pytest.approx((10.0 * DEG, 10.0 * DEG))
    assert indices.overshoot[:3] == pytest.approx(FIRST - 10.0 * DEG, abs=1e-4)
    assert indices.execute_heading[:3] == pytest.approx([10.4 * DEG] * 3, abs=0.45 * DEG)
    assert indices.overshoot_from_execute[:3] == pytest.approx(FIRST - np.array(indices.execute_heading[:3]), abs=1e-4)
    orders = order_times(10.4 * DEG)
    assert indices.execute_time[:4] == pytest.approx([T_ORDER, *orders[:3]], abs=0.8)
    peaks = T_ORDER + (np.arange(3) + 0.5) * np.pi / OMEGA
    assert indices.time_to_check_yaw[:3] == pytest.approx(peaks - np.array(indices.execute_time[1:4]), abs=0.05)
    begin = np.arcsin(10.0 * DEG / AMPLITUDES[0]) / OMEGA
    assert indices.initial_turning_time == pytest.approx(begin, abs=1e-2)
    assert indices.initial_turning_distance == pytest.approx(U * begin, rel=1e-3)
    assert indices.reach == pytest.approx(np.pi / OMEGA, abs=0.1)
    assert indices.period == pytest.approx(2.0 * np.pi / OMEGA, abs=0.1)
    assert indices.approach_speed == pytest.approx(U)


def test_nominal_is_the_default_and_actual_is_smaller_by_the_late_execute():
    late = zigzag_indices(zigzag(actual=10.4 * DEG, t=np.arange(0.0, 640.0, 0.05)), L)
    difference = np.array(late.overshoot[:3]) - np.array(late.overshoot_from_execute[:3])
    assert difference == pytest.approx([0.4 * DEG] * 3, abs=0.03 * DEG)


def test_given_nominal_angles_are_taken():
    indices = zigzag_indices(zigzag(), L, nominal=(10.0 * DEG, 9.0 * DEG))
    assert indices.heading_angle == 9.0 * DEG
    assert indices.overshoot[0] == pytest.approx(8.0 * DEG, abs=1e-4)


def test_heading_angle_differs_from_rudder_angle():
    indices = zigzag_indices(zigzag(rudder=20.0 * DEG), L)
    assert (indices.rudder_angle, indices.heading_angle) == pytest.approx((20.0 * DEG, 10.0 * DEG))


@pytest.mark.parametrize("seed", range(6))
def test_noise_and_course_keeping(seed):
    indices = zigzag_indices(noisy(zigzag(keeping=-3.0 * DEG), seed, psi=0.17 * DEG, delta=0.2 * DEG), L)
    assert indices.overshoot[:3] == pytest.approx(FIRST - 10.0 * DEG, abs=0.35 * DEG)
    assert indices.execute_time[:4] == pytest.approx([T_ORDER, *order_times(10.4 * DEG)[:3]], abs=1.0)


def test_noise_is_not_taken_for_overshoot():
    raw, read = [], []
    for seed in range(20):
        track = noisy(zigzag(), seed, psi=0.17 * DEG)
        raw.append(np.max(track.psi[track.t < 200.0]) - AMPLITUDES[0])
        read.append(heading_peak(track.t, track.psi, 200, 400, open_end=False)[1] - AMPLITUDES[0])
    assert np.mean(raw) > 0.25 * DEG, "the highest sample lies above the peak"
    assert abs(np.mean(read)) < 0.03 * DEG
    assert np.std(read) < 0.08 * DEG


@settings(max_examples=25, deadline=None)
@given(st.floats(-12.0, 12.0), st.sampled_from([1, -1]))
def test_course_and_side_change_nothing(psi_0, side):
    indices = zigzag_indices(zigzag(side=side, psi_0=psi_0), L)
    assert indices.overshoot[:3] == pytest.approx(FIRST - 10.0 * DEG, abs=1e-4)
    assert indices.reach == pytest.approx(np.pi / OMEGA, abs=1e-2)


def test_records_too_short():
    orders = order_times(10.4 * DEG)
    before = zigzag_indices(cut(zigzag(), end=orders[0] - 2.0), L)
    assert (before.heading_angle, before.overshoot, before.reach, before.period) == (None, (), None, None)
    assert before.initial_turning_time is None
    given = zigzag_indices(cut(zigzag(), end=orders[0] - 0.5), L, nominal=(10.0 * DEG, 10.0 * DEG))
    assert given.initial_turning_time == pytest.approx(np.arcsin(10.0 / 17.0) / OMEGA, abs=1e-2)
    rising = zigzag_indices(cut(zigzag(), end=T_ORDER + 0.45 * np.pi / OMEGA), L)
    assert rising.overshoot == ()
    assert rising.heading_angle == pytest.approx(10.0 * DEG)
    once = zigzag_indices(cut(zigzag(), end=T_ORDER + 0.9 * np.pi / OMEGA), L)
    assert once.overshoot == pytest.approx([7.0 * DEG], abs=1e-4)
    assert once.reach is None
    returned = zigzag_indices(cut(zigzag(), end=T_ORDER + 1.1 * np.pi / OMEGA), L)
    assert returned.reach is not None
    assert returned.period is None


def test_dictionary_carries_units():
    found = zigzag_indices(zigzag(), L).to_dict()
    assert found["overshoot_1_deg"] == pytest.approx(7.0, abs=0.01)
    assert found["overshoot_2_deg"] == pytest.approx(16.0, abs=0.01)
    assert found["overshoot_from_execute_1_deg"] < found["overshoot_1_deg"]
    assert found["heading_angle_deg"] == pytest.approx(10.0)
    assert found["initial_turning_distance_over_L"] == pytest.approx(found["initial_turning_distance_m"] / L)
    assert {"reach_s", "period_s", "time_to_check_yaw_1_s", "execute_time_1_s"} <= set(found)


@pytest.mark.parametrize(
    ("measured", "late", "usual"),
    [
        (1.4, 0.0, 1), (4.7, 0.0, 5), (6.0, 0.0, 5), (10.5, 0.0, 10), (14.8, 0.0, 15), (21.1, 0.0, 20), (35.3, 0.0, 35),
        (12.4, 0.0, 12), (18.0, 0.0, 18), (45.2, 0.0, 45), (6.6, 0.0, 7), (6.6, 2.0, 5), (8.2, 2.0, 8), (9.2, 5.0, 10),
    ],
)  # fmt: skip
def test_usual_angles(measured, late, usual):
    assert usual_angle(measured * DEG, late * DEG) / DEG == pytest.approx(usual)


def test_peak_lies_between_the_samples():
    t = np.array([0.0, 1.0, 2.5, 3.0, 4.0])
    when, top = heading_peak(t, 3.0 - 0.5 * (t - 2.2) ** 2, 0, 4, open_end=False)
    assert (when, top) == pytest.approx((2.2, 3.0))
    assert heading_peak(t, t, 0, 4, open_end=True) is None
