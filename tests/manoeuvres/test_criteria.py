"""Limits of IMO MSC.137(76) and the verdicts on them."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.manoeuvres import (
    StoppingIndices,
    check_stopping,
    check_turning,
    check_zigzag,
    first_overshoot_limit,
    second_overshoot_limit,
    turning_indices,
    zigzag_indices,
)

from .made import DEG, T_ORDER, L, R, U, circle, cut, zigzag

TURN = turning_indices(circle(), L)
ZIGZAG = zigzag_indices(zigzag(), L)


@pytest.mark.parametrize(
    ("ratio", "first", "second"),
    [
        (5.0, 10, 25),
        (9.999, 10, 25),
        (10.0, 10, 25),
        (10.5, 10.25, 25.375),
        (20.0, 15, 32.5),
        (29.8, 19.9, 39.85),
        (30.0, 20, 40),
        (60, 20, 40),
    ],
)
def test_overshoot_limits(ratio, first, second):
    assert first_overshoot_limit(ratio * 7.0, 7.0) == pytest.approx(first)
    assert second_overshoot_limit(ratio * 7.0, 7.0) == pytest.approx(second)


def test_turning_circle_passes():
    found = check_turning(TURN, L, U)
    assert [(c.name, c.limit, c.unit, c.passed) for c in found] == [
        ("advance", 4.5, "L", True),
        ("tactical diameter", 5.0, "L", True),
    ]
    assert found[1].value == pytest.approx(2.0 * R / L, rel=1e-3)
    assert all(c.source.startswith("IMO MSC.137(76)") and not c.reason for c in found)


@pytest.mark.parametrize(("advance", "diameter"), [(4.5, 5.0), (4.501, 5.001)])
def test_turning_at_the_limits(advance, diameter):
    verdicts = [
        c.passed for c in check_turning(replace(TURN, advance=advance * L, tactical_diameter=diameter * L), L, U)
    ]
    assert verdicts == [advance == 4.5] * 2


def test_turning_at_smaller_rudder_is_not_judged_unless_it_is_the_largest():
    smaller = replace(TURN, rudder_angle=25.0 * DEG)
    assert [c.passed for c in check_turning(smaller, L, U)] == [None, None]
    assert "25.0 deg" in check_turning(smaller, L, U)[0].reason
    assert [c.passed for c in check_turning(smaller, L, U, largest_rudder=25.0 * DEG)] == [True, True]


@pytest.mark.parametrize(("distance", "passed"), [(2.5, True), (2.51, False), (None, None)])
def test_initial_turning(distance, passed):
    metres = None if distance is None else distance * L
    found = check_turning(replace(TURN, rudder_angle=10.2 * DEG, initial_turning_distance=metres), L, U)
    assert (found[-1].name, found[-1].passed) == ("initial turning distance", passed)


@pytest.mark.parametrize("check", [lambda L, V: check_turning(TURN, L, V), lambda L, V: check_zigzag(ZIGZAG, L, V)])
def test_trial_at_another_speed_is_not_judged(check):
    assert {c.passed for c in check(L, U * 1.3)} == {None}
    assert all("approach at 5.00 m/s" in c.reason for c in check(L, U * 1.3))
    assert None not in {c.passed for c in check(L, U * 1.05)}


def test_what_was_not_reached_or_not_seen_is_not_judged():
    short = turning_indices(circle(end=T_ORDER + 30.0), L)
    assert {(c.value, c.passed, c.reason) for c in check_turning(short, L, U)} == {
        (None, None, "the record does not reach it")
    }
    late = turning_indices(cut(circle(), T_ORDER + 20.0), L)
    assert {c.passed for c in check_turning(late, L, U)} == {None}
    assert all("already over" in c.reason for c in check_turning(late, L, U))


def test_zigzag_10_10():
    """L/V = 20 s: limits 15 and 32.5 deg; the record has 7 and 16 deg."""
    found = {c.name: c for c in check_zigzag(ZIGZAG, L, U)}
    assert set(found) == {"initial turning distance", "first overshoot 10/10", "second overshoot 10/10"}
    assert found["first overshoot 10/10"].value == pytest.approx(7.0, abs=0.01)
    assert found["first overshoot 10/10"].limit == pytest.approx(15.0)
    assert found["second overshoot 10/10"].limit == pytest.approx(32.5)
    assert all(c.passed for c in found.values())
    worse = replace(ZIGZAG, overshoot=(15.1 * DEG, 32.4 * DEG))
    assert [c.passed for c in check_zigzag(worse, L, U)] == [True, False, True]
    once = replace(ZIGZAG, overshoot=(7.0 * DEG,))
    assert check_zigzag(once, L, U)[2].passed is None


@pytest.mark.parametrize(("overshoot", "passed"), [(24.9, True), (25.1, False)])
def test_zigzag_20_20(overshoot, passed):
    other = replace(ZIGZAG, rudder_angle=20.0 * DEG, heading_angle=20.0 * DEG, overshoot=(overshoot * DEG,))
    (found,) = check_zigzag(other, L, U)
    assert (found.limit, found.passed) == (25.0, passed)


def test_other_zigzags_have_no_criterion():
    assert check_zigzag(replace(ZIGZAG, heading_angle=5.0 * DEG), L, U) == ()
    assert check_zigzag(replace(ZIGZAG, heading_angle=None), L, U) == ()


def test_criterion_as_a_dictionary():
    found = check_turning(TURN, L, U)[0].to_dict()
    assert found["name"] == "advance"
    assert found["value"] == pytest.approx(2.5, rel=1e-3)
    assert isinstance(found["passed"], bool)
    assert not isinstance(found["passed"], np.bool_)


@pytest.mark.parametrize(("reach", "passed"), [(14.9 * L, True), (15.1 * L, False), (None, None)])
def test_a_stop_is_judged_by_its_track_reach(reach, passed):
    stop = StoppingIndices(
        L_pp=L, execute_time=0.0, approach_speed=U, track_reach=reach, head_reach=reach, lateral_deviation=0.0,
        stopping_time=600.0,
    )  # fmt: skip
    (found,) = check_stopping(stop, L, U)
    assert (found.name, found.unit, found.passed) == ("track reach", "L", passed)
    assert found.source == "IMO MSC.137(76), 5.3.4"
    assert check_stopping(replace(stop, approach_speed=0.5 * U), L, U)[0].passed is None


def test_a_ship_that_turns_away_from_her_rudder_fails():
    """A tactical diameter of -0.85 L was below 5 L, and passed."""
    advance, diameter = check_turning(replace(TURN, tactical_diameter=-0.85 * L), L, U)
    assert (advance.passed, diameter.passed) == (True, False)
    assert diameter.reason == "the ship went to the other side or astern"
