"""Change points: found where they are, with intervals that hold them, and seldom where there are none."""

from __future__ import annotations

import numpy as np
import pytest

from mmgtune.fleet.changes import course

MONTHS = np.arange(24.0) / 12.0
UNKNOWN = np.full(24, np.nan)


def drawn(n: int, truth: np.ndarray, noise: float, seed: int = 1) -> np.ndarray:
    """Series (n, 24) about a truth."""
    return truth + noise * np.random.default_rng(seed).standard_normal((n, 24))


def test_noise_and_lines_alone_seldom_look_like_a_change() -> None:
    alarms = {}
    for name, truth in (("level", 0.0 * MONTHS), ("line", 1.5 * MONTHS)):
        found = [course(MONTHS, y, UNKNOWN) for y in drawn(100, truth, 0.5)]
        alarms[name] = sum(bool(one.changes) for one in found if one)
    # Binomial with LEVEL at most: more than 12 of 100 has a probability below 0.002.
    assert max(alarms.values()) <= 12, alarms
    over_many = [course(MONTHS, y, UNKNOWN, looked_at=100) for y in drawn(100, 0.0 * MONTHS, 0.5)]
    # At most one of all, but in LEVEL of such fleets.
    assert sum(bool(one.changes) for one in over_many if one) <= 1


def test_a_step_is_found_in_its_month_and_the_interval_holds_it() -> None:
    truth = 2.0 * (np.arange(24) >= 15)
    held, sizes = 0, []
    for y in drawn(50, truth, 0.4, seed=2):
        found = course(MONTHS, y, UNKNOWN)
        assert found is not None
        if len(found.changes) == 1:
            (change,) = found.changes
            held += change.first < 15 <= change.last
            sizes.append(abs(change.size - 2.0) < change.error)
    assert len(sizes) >= 45
    # 95 % intervals, of those that were found: fewer than nine of ten has a probability below 0.05.
    assert held >= 0.9 * len(sizes)
    assert sum(sizes) >= 0.9 * len(sizes)


def test_fouling_that_is_cleaned_off_twice() -> None:
    truth = 1.0 + 0.15 * MONTHS
    truth = truth - 0.2 * (np.arange(24) >= 9) - 0.1 * (np.arange(24) >= 18)
    found = course(MONTHS, drawn(1, truth, 0.008, seed=3)[0], UNKNOWN)
    assert found is not None
    assert [change.after for change in found.changes] == [9, 18]
    assert found.grows
    assert found.slope == pytest.approx(0.15, abs=3 * found.slope_error / 1.96)


def test_what_comes_and_goes_is_found_as_a_pair() -> None:
    truth = 1.0 * ((np.arange(24) >= 10) & (np.arange(24) < 13))
    found = course(MONTHS, drawn(1, truth, 0.1, seed=4)[0], UNKNOWN)
    assert found is not None
    assert [change.after for change in found.changes] == [10, 13]
    one_date = 1.0 * (np.arange(24) == 10)
    assert not course(MONTHS, drawn(1, one_date, 0.1, seed=4)[0], UNKNOWN).changes  # type: ignore[union-attr]


def test_uncertain_dates_count_less_and_short_series_not_at_all() -> None:
    y = drawn(1, 0.0 * MONTHS, 0.05, seed=5)[0]
    y[12:15] += 3.0
    errors = np.full(24, 0.05)
    assert course(MONTHS, y, errors).changes  # type: ignore[union-attr]
    errors[12:15] = 3.0
    assert not course(MONTHS, y, errors).changes  # type: ignore[union-attr]
    assert course(MONTHS[:5], y[:5], errors[:5]) is None
    assert course(MONTHS, 0.0 * MONTHS + 2.0, errors) is None


def test_of_logarithms_sizes_are_told_as_they_stand() -> None:
    truth = np.where(np.arange(24) >= 12, 6.0, 2.0)
    found = course(MONTHS, np.log(truth) + drawn(1, 0.0 * MONTHS, 0.01)[0], UNKNOWN)
    assert found is not None
    (change,) = found.exponential().changes
    assert change.size == pytest.approx(4.0, abs=0.1)
