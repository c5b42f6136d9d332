"""Intervals of numbers over few things."""

import numpy as np
import pytest

from mmgtune.drawing_anew import interval_of


def test_the_interval_of_a_mean_is_that_of_its_standard_error():
    values = np.random.default_rng(3).standard_normal(400)
    low, high = interval_of(lambda drawn: float(values[drawn].mean()), len(values), 0)
    error = float(values.std()) / 400**0.5
    assert 0.5 * (low + high) == pytest.approx(values.mean(), abs=0.2 * error)  # 0.05 from 2000 draws, and their ends
    assert high - low == pytest.approx(2.0 * 1.96 * error, rel=0.1)  # its own deviation is 4 % with 2000 draws
    assert interval_of(lambda drawn: float(values[drawn].mean()), len(values), 0) == (low, high)
    assert interval_of(lambda drawn: float(values[drawn].mean()), len(values), 1) != (low, high)


def test_what_is_alike_has_no_width():
    assert interval_of(lambda drawn: float(np.ones(3)[drawn].mean()), 3, 0) == (1.0, 1.0)
