"""The seven distance measures against numbers worked out by hand."""

import numpy as np
import pytest

import mmgtune
from mmgtune.errors import OptionError, TrialError
from mmgtune.measures import UNITS, Reference, distance_measures, reference_of

# Two samples; differences (3, 4, 0.1, 0.2, 0.3, 0.01) and zero.
MEASURED = np.array([[10.0, 20.0, 0.5, 2.0, 0.0, 0.02], [13.0, 24.0, 0.6, 2.0, 0.0, 0.02]])
SIMULATED = MEASURED + np.array([[3.0, -4.0, 0.1, -0.2, 0.3, -0.01], [0.0] * 6])
REFERENCE = Reference(length=5.0, speed=2.0, r_max=0.0314)


def test_without_a_reference_it_is_that_of_the_measured_one():
    own = mmgtune.distance_measures(MEASURED, SIMULATED)
    assert own == mmgtune.distance_measures(MEASURED, SIMULATED, mmgtune.reference_of(MEASURED))
    assert own["cVDM"] != distance_measures(MEASURED, SIMULATED, REFERENCE)["cVDM"]
    other = mmgtune.Reference(length=10.0, speed=4.0, r_max=0.04)
    assert mmgtune.distance_measures(MEASURED, SIMULATED, other)["MMD"] == own["MMD"]


def test_by_hand():
    found = distance_measures(MEASURED, SIMULATED, REFERENCE)
    squares = 9 + 16 + 0.01 + 0.04 + 0.09 + 1e-4
    assert found["MMD"] == pytest.approx(3.5)
    assert found["MED"] == pytest.approx(2.5)
    assert found["ASD"] == pytest.approx(7.61 / 2)
    assert found["MSD"] == pytest.approx(np.sqrt(squares) / 2)
    assert found["PMD"] == pytest.approx(50 * 7.3 / 32.5)
    assert found["PED"] == pytest.approx(50 * np.sqrt(25.05) / np.sqrt(100 + 400 + 0.25 + 4))
    assert found["cVDM"] == pytest.approx(50 * (7 / 5 + 0.1 / np.pi + 0.5 / 2 + 0.01 / 0.0314))
    assert set(found) == set(UNITS)


def test_reference_of_a_measured_track():
    assert reference_of(MEASURED) == Reference(length=5.0, speed=2.0, r_max=0.02)
    assert reference_of(MEASURED, r_max=0.0314).r_max == 0.0314


def test_equal_trajectories_have_no_distance():
    assert set(distance_measures(MEASURED, MEASURED, REFERENCE).values()) == {0.0}


def test_a_shift_of_the_origin_changes_the_percentages_of_position_only():
    shift = np.array([1000.0, 0, 0, 0, 0, 0])
    here, there = (distance_measures(MEASURED + s, SIMULATED + s, REFERENCE) for s in (0 * shift, shift))
    for name in ("MMD", "MED", "ASD", "MSD", "cVDM"):
        assert here[name] == pytest.approx(there[name])
    for name in ("PMD", "PED"):
        assert there[name] < 0.1 * here[name]


def test_gaps_do_not_count():
    gap = MEASURED.copy()
    gap[1, 3] = np.nan
    assert distance_measures(gap, SIMULATED, REFERENCE)["MMD"] == pytest.approx(7.0)


@pytest.mark.parametrize("wrong", [SIMULATED[:1], SIMULATED[:, :5]])
def test_shapes_must_agree(wrong):
    with pytest.raises(OptionError, match="shapes"):
        distance_measures(MEASURED, wrong, REFERENCE)


def test_what_is_no_track_has_no_distance():
    track = np.random.default_rng(1).normal(size=(9, 6))
    assert distance_measures(track.tolist(), track.tolist()) == distance_measures(track, track)
    infinite, texts = np.where(track == track.max(), np.inf, track), track.astype(str)
    for wrong, words in ((infinite, "infinite"), (texts, "no numbers"), (None, r"not \(\)"), (track[0], r"not \(6,\)")):
        with pytest.raises(OptionError, match=words):
            distance_measures(track, wrong)
        with pytest.raises(OptionError, match=words):
            reference_of(wrong)
    for given in ((np.nan, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, -1.0), (np.inf, 1.0, 1.0)):
        with pytest.raises(TrialError, match="does not move"):
            Reference(*given)


def test_who_gives_a_trial_is_told_what_of_it_is_wanted():
    trial = next(iter(mmgtune.load_trials("suzaku")))
    with pytest.raises(OptionError, match=r"\(measured\)[\s\S]*fix: measured has them: give \.motion"):
        reference_of(trial)


def test_a_ship_at_rest_has_no_relative_distance():
    with pytest.raises(TrialError, match="does not move"):
        reference_of(np.zeros((5, 6)))
    with pytest.raises(TrialError, match="complete"):
        reference_of(np.full((5, 6), np.nan))


def test_a_trajectory_of_three_by_hand():
    """Every measure of a trajectory that differs in one state at a time."""
    measured = np.array([[100.0, 50.0, 1.0, 4.0, 0.0, 0.0]] * 3) + np.arange(3.0)[:, None] * [3.0, 4.0, 0, 0, 0, 0]
    for k, size, cVDM in (
        (0, 6.0, 600.0 / 10.0),
        (1, -6.0, 600.0 / 10.0),
        (2, 0.3, 30.0 / np.pi),
        (3, 0.2, 20.0 / 4.0),
        (4, -0.4, 40.0 / 4.0),
        (5, 0.0157, 50.0),
    ):
        apart = np.zeros((3, 6))
        apart[:, k] = size
        found = distance_measures(measured, measured + apart, Reference(10.0, 4.0, 0.0314))
        position = abs(size) if k < 2 else 0.0
        assert found["MMD"] == pytest.approx(position)
        assert found["MED"] == pytest.approx(position)
        assert found["ASD"] == pytest.approx(abs(size))
        assert found["MSD"] == pytest.approx(abs(size))
        pose = abs(size) if k < 4 else 0.0
        assert found["PMD"] == pytest.approx(100.0 * pose * np.mean(1.0 / np.abs(measured[:, :4]).sum(axis=1)))
        assert found["PED"] == pytest.approx(100.0 * pose * np.mean(1.0 / np.linalg.norm(measured[:, :4], axis=1)))
        assert found["cVDM"] == pytest.approx(cVDM)


TABLE_1 = {
    1: {"MMD": 3.0, "MED": 2.4, "ASD": 3.1, "MSD": 2.5, "PMD": 1.6, "PED": 1.5, "cVDM": 1.0},
    2: {"MMD": 16.9, "MED": 12.1, "ASD": 17.5, "MSD": 15.4, "PMD": 3.1, "PED": 2.7, "cVDM": 4.5},
    3: {"MMD": 42.6, "MED": 30.2, "ASD": 43.3, "MSD": 34.6, "PMD": 5.4, "PED": 4.8, "cVDM": 6.3},
    4: {"MMD": 61.5, "MED": 50.0, "ASD": 62.6, "MSD": 55.7, "PMD": 10.7, "PED": 8.0, "cVDM": 9.9},
}
"""Table 1 of Mathioudakis et al.: 120 s at 1 Hz, four kinds of trajectories."""


def case_study(kind: int) -> dict[str, float]:
    """Measures of a trajectory of one of the four kinds, made with a path of 1000 m and r_max of the paper.

    1 all close; 2 position close, heading and yaw rate off; 3 good at first, off at the end; 4 diverged.  The paper
    does not say where the origin is; its PMD and PED say that it is near in case 1, and further away in case 3.
    """
    t = np.arange(120.0)
    share = t / t[-1]
    start = {1: 10.0, 2: 100.0, 3: 250.0, 4: 100.0}[kind]
    measured = np.column_stack([start + 6.0 * t, start + 6.0 * t, *np.tile([[0.785], [8.5], [0.0], [0.0]], 120)])
    ramp, late = {1: (share, share**0.25), 2: (share, share), 3: (share, share**3), 4: (share, share**1.5)}[kind]
    size = {
        1: (1.7, 2.0, 0.008, 0.02, 0.02, 1e-4),
        2: (15.0, 18.0, 0.08, 0.05, 0.08, 6e-4),
        3: (80.0, 90.0, 0.03, 0.1, 0.08, 2e-4),
        4: (65.0, 90.0, 0.07, 0.25, 0.2, 4e-4),
    }[kind]
    apart = np.stack([late * size[0], -late * size[1], *(ramp * one for one in size[2:])], axis=1)
    return distance_measures(measured, measured + apart, reference_of(measured, 0.0314))


def test_the_pattern_of_the_papers_table():
    """Measures of position alone put case 3 far behind case 2; cVDM, which sees the heading, puts them close."""
    found = {kind: case_study(kind) for kind in TABLE_1}
    for kind, row in TABLE_1.items():
        for name, value in row.items():
            assert 0.3 * value < found[kind][name] < 3.0 * value, (kind, name, found[kind][name], value)
    for name in UNITS:  # the order of every column
        assert sorted(found, key=lambda kind: found[kind][name]) == [1, 2, 3, 4], name
    for name in ("MMD", "MED", "ASD", "MSD"):
        assert found[3][name] > 2.0 * found[2][name]
    assert found[3]["cVDM"] < 1.7 * found[2]["cVDM"]


def test_position_alone_does_not_see_a_heading():
    """The same positions with the heading 5 deg and the yaw rate 0.1 deg/s off: only cVDM changes much."""
    t = np.arange(120.0)
    measured = np.column_stack([4.2 * t + 300.0, 4.2 * t, *np.tile([[0.785], [5.9], [0.0], [0.0]], 120)])
    close = measured + np.array([2.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    turned = close + np.array([0.0, 0.0, np.radians(5.0), 0.0, 0.0, np.radians(0.1)])
    reference = reference_of(measured, 0.0314)
    near, far = distance_measures(measured, close, reference), distance_measures(measured, turned, reference)
    assert far["MMD"] == near["MMD"]
    assert far["MED"] == near["MED"]
    for name in ("ASD", "MSD", "PMD", "PED"):
        assert far[name] < 1.1 * near[name]
    assert far["cVDM"] > 10.0 * near["cVDM"]
