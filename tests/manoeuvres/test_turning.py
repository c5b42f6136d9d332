"""Turning indices against circles known in closed form."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mmgtune.errors import TrialError
from mmgtune.manoeuvres import turning_indices

from .made import DEG, T_ORDER, L, R, U, circle, cut, noisy, uneven

BETA = 12.0 * DEG
TURN = 2.0 * np.pi * R / U
"""Time of a full turn [s]."""


def known(beta):
    """Closed form of a circle begun at once: along R (sin(phi - beta) + sin beta), across R (cos beta - cos(...))."""
    sin, cos = np.sin(beta), np.cos(beta)
    return {
        "rudder_angle": 35.0 * DEG,
        "approach_speed": U,
        "advance": R * (cos + sin),
        "transfer": R * (cos - sin),
        "tactical_diameter": 2.0 * R * cos,
        "max_advance": R * (1.0 + sin),
        "max_transfer": R * (1.0 + cos),
        "time_90": TURN / 4.0,
        "time_180": TURN / 2.0,
        "time_270": TURN * 0.75,
        "time_360": TURN,
        "speed_ratio_90": 1.0,
        "speed_ratio_360": 1.0,
        "initial_turning_distance": R * 10.0 * DEG,
        "steady_heading_change": 2.0 * np.pi,
        "steady_speed": U,
        "steady_yaw_rate": U / R,
        "steady_diameter": 2.0 * R,
        "steady_drift_angle": beta,
    }


def assert_same(indices, expected, rel=1e-3):
    for name, value in expected.items():
        assert getattr(indices, name) == pytest.approx(value, rel=rel, abs=1e-9), name


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("beta", [0.0, BETA])
@pytest.mark.parametrize("t", [None, uneven(700.0)], ids=["even", "uneven"])
def test_circle(side, beta, t):
    indices = turning_indices(circle(side=side, beta=beta, t=t), L)
    assert_same(indices, known(beta), rel=2e-4)
    assert indices.direction == ("starboard" if side > 0 else "port")
    assert indices.execute_time == T_ORDER
    assert not indices.execute_at_start
    assert indices.drift_north == pytest.approx(0.0, abs=1e-3)
    assert indices.residual_rate is None


def test_port_is_the_mirror_of_starboard():
    starboard, port = (turning_indices(circle(side=s, beta=BETA, keeping=s * 3.0 * DEG), L) for s in (1, -1))
    for name, value in asdict(starboard).items():
        if name != "direction" and not name.startswith("drift"):
            assert getattr(port, name) == (value if value is None else pytest.approx(value, rel=1e-9)), name


@settings(max_examples=25, deadline=None)
@given(
    psi_0=st.floats(-12.0, 12.0),
    north=st.floats(-1e5, 1e5),
    east=st.floats(-1e5, 1e5),
    late=st.floats(-1e3, 1e3),
    side=st.sampled_from([1, -1]),
)
def test_rotation_and_translation_change_nothing(psi_0, north, east, late, side):
    track = circle(side=side, beta=BETA, psi_0=psi_0, end=600.0)
    track = replace(track, x=track.x + north, y=track.y + east, t=track.t + late)
    assert_same(turning_indices(track, L), known(BETA), rel=2e-4)


@pytest.mark.parametrize("residual", [0.0, 0.1 * U / R])
def test_pull_out_does_not_spoil_the_steady_turn(residual):
    track = circle(beta=BETA, pull_out=T_ORDER + 1.7 * TURN, residual=residual, end=1100.0)
    indices = turning_indices(track, L)
    assert_same(indices, known(BETA))
    assert indices.residual_rate == pytest.approx(residual, abs=2e-5)
    assert turning_indices(cut(track, end=T_ORDER + 1.7 * TURN + 30.0), L).residual_rate is None


def test_rudder_used_again_is_no_pull_out():
    track = circle(beta=BETA, pull_out=T_ORDER + 1.7 * TURN, end=1100.0)
    delta = np.where(track.t > 650.0, -20.0 * DEG, track.delta)
    assert turning_indices(replace(track, delta=delta), L).residual_rate is None


def test_headings_only_reached_after_a_pull_out_are_not_reached():
    indices = turning_indices(circle(pull_out=T_ORDER + 0.4 * TURN, residual=0.5 * U / R, end=900.0), L)
    assert indices.advance == pytest.approx(R, rel=1e-3)
    assert indices.tactical_diameter is None
    assert indices.steady_diameter is None


@pytest.mark.parametrize("side", [1, -1])
def test_drift_is_found_and_only_subtracted_if_asked(side):
    drift = (0.3, -0.2)
    track = circle(side=side, beta=BETA, drift=drift, psi_0=1.0)
    reported = turning_indices(track, L)
    assert (reported.drift_north, reported.drift_east) == pytest.approx(drift, abs=1e-3)
    assert reported.drift_pairs > 10
    assert not reported.drift_subtracted
    assert abs(reported.tactical_diameter - 2.0 * R * np.cos(BETA)) > 10.0
    subtracted = turning_indices(track, L, subtract_drift=True)
    assert subtracted.drift_subtracted
    assert (subtracted.drift_north, subtracted.drift_east) == pytest.approx(drift, abs=1e-3)
    assert_same(subtracted, known(BETA), rel=2e-3)


def test_drift_that_cannot_be_estimated_is_not_silently_left_in():
    with pytest.raises(TrialError, match="540 deg"):
        turning_indices(circle(end=T_ORDER + 1.4 * TURN), L, subtract_drift=True)


@pytest.mark.parametrize(
    ("turns", "missing"),
    [
        (0.02, ["initial_turning_distance", "advance"]),
        (0.2, ["advance", "transfer", "max_advance", "time_90", "speed_ratio_90", "tactical_diameter"]),
        (0.4, ["tactical_diameter", "max_transfer", "time_180", "speed_ratio_180"]),
        (0.6, ["time_270", "time_360"]),
        (0.9, ["time_360", "speed_ratio_360", "steady_diameter", "steady_speed", "steady_drift_angle"]),
        (1.4, ["drift_north", "drift_east"]),
    ],
)
def test_what_the_record_does_not_reach_is_none(turns, missing):
    indices = turning_indices(circle(beta=BETA, end=T_ORDER + turns * TURN, rate=20.0 * DEG), L)
    assert [name for name in missing if getattr(indices, name) is not None] == []
    assert all(value is None or value == value for value in asdict(indices).values())


def test_steady_values_of_a_record_between_360_and_540_deg():
    indices = turning_indices(circle(beta=BETA, end=T_ORDER + 1.25 * TURN), L)
    assert indices.steady_heading_change == pytest.approx(0.75 * 2.0 * np.pi, rel=1e-2)
    assert indices.steady_diameter == pytest.approx(2.0 * R, rel=1e-3)


def test_largest_distance_still_growing_is_none():
    """At 95 deg of heading and 12 deg of drift the course has turned 83 deg: the ship still goes along."""
    indices = turning_indices(circle(beta=BETA, end=T_ORDER + 95.0 / 360.0 * TURN), L)
    assert indices.advance is not None
    assert indices.max_advance is None


@pytest.mark.parametrize("seed", range(5))
def test_noise_and_course_keeping(seed):
    track = noisy(circle(beta=BETA, keeping=-4.0 * DEG), seed, psi=0.15 * DEG, delta=0.3 * DEG)
    indices = turning_indices(track, L)
    assert_same(indices, {k: v for k, v in known(BETA).items() if not k.startswith("initial")}, rel=0.015)


def test_heading_at_the_order_is_read_through_the_noise():
    """1 deg turns the tactical diameter's axes by 1 deg; a line through the samples before leaves less."""
    errors = [turning_indices(noisy(circle(), seed, psi=1.0 * DEG), 4.0 * L).transfer / R - 1.0 for seed in range(20)]
    assert np.std(errors) < 0.6 * 2.0 * DEG


def test_record_beginning_with_the_rudder_over_is_marked():
    indices = turning_indices(cut(circle(), T_ORDER + 20.0), L)
    assert indices.execute_at_start
    assert indices.execute_time == T_ORDER + 20.0


def test_dictionary_carries_units():
    found = turning_indices(circle(side=-1, end=T_ORDER + 0.4 * TURN), L).to_dict()
    assert found["direction"] == "port"
    assert found["rudder_angle_deg"] == pytest.approx(35.0)
    assert found["advance_m"] == pytest.approx(R, rel=1e-3)
    assert found["advance_over_L"] == pytest.approx(R / L, rel=1e-3)
    assert found["tactical_diameter_m"] is None
    assert found["tactical_diameter_over_L"] is None
    assert {"steady_yaw_rate_deg_per_s", "approach_speed_m_per_s", "time_90_s", "speed_ratio_90"} <= set(found)


def test_a_turn_from_rest_has_no_speed_ratios():
    track = circle()
    resting = track.t <= T_ORDER
    indices = turning_indices(replace(track, u=np.where(resting, 0.0, track.u)), L)
    assert indices.approach_speed == 0.0
    assert (indices.speed_ratio_90, indices.speed_ratio_180, indices.speed_ratio_360) == (None, None, None)
    assert indices.advance is not None
