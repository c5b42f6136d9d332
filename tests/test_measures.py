"""The seven distance measures against numbers worked out by hand."""

import numpy as np
import pytest

from mmgtune.measures import UNITS, Reference, distance_measures, reference_of

# Two samples; differences (3, 4, 0.1, 0.2, 0.3, 0.01) and zero.
MEASURED = np.array([[10.0, 20.0, 0.5, 2.0, 0.0, 0.02], [13.0, 24.0, 0.6, 2.0, 0.0, 0.02]])
SIMULATED = MEASURED + np.array([[3.0, -4.0, 0.1, -0.2, 0.3, -0.01], [0.0] * 6])
REFERENCE = Reference(length=5.0, speed=2.0, r_max=0.0314)


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
    with pytest.raises(ValueError, match="shapes"):
        distance_measures(MEASURED, wrong, REFERENCE)


def test_a_ship_at_rest_has_no_relative_distance():
    with pytest.raises(ValueError, match="does not move"):
        reference_of(np.zeros((5, 6)))
    with pytest.raises(ValueError, match="complete"):
        reference_of(np.full((5, 6), np.nan))
