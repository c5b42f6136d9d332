"""Recursions along series: as SciPy's filter has them, compiled and not, wherever the values lie."""

import numpy as np
import pytest
from scipy.signal import lfilter

from mmgtune.backends import filtering
from mmgtune.backends.filtering import Recursion, Series

ROWS = [np.arange(0, 90, 3), np.arange(1, 91, 3), np.array([2, 5, 8, 11, 89])]
RECURSIONS = [Recursion(0.5, -0.45, -0.4), Recursion(2.0, 0.0, 0.0), Recursion(1.0, 0.3, 0.95)]


@pytest.fixture(params=["compiled", "stepped"])
def way(request, monkeypatch):
    if request.param == "stepped":  # as where the environment keeps numba from compiling
        monkeypatch.setattr(filtering, "_kernel", lambda: None)


@pytest.mark.parametrize("shape", [(), (1,), (7,), (130,), (4, 3)])
def test_each_series_has_a_recursion_of_its_own(shape, way):
    values = np.random.default_rng(0).standard_normal((91, *shape))
    series, out = Series.of(ROWS), np.zeros_like(values)
    series.filtered(values, RECURSIONS, out)
    for rows, one in zip(ROWS, RECURSIONS, strict=True):
        expected = lfilter([one.now, one.earlier], [1.0, -one.kept], values[rows], axis=0)
        np.testing.assert_allclose(out[rows], expected, rtol=1e-12, atol=1e-14)
    elsewhere = np.setdiff1d(np.arange(91), np.concatenate(ROWS))
    assert len(elsewhere)
    assert not out[elsewhere].any()


@pytest.mark.parametrize("order", ["C", "F"])
def test_values_may_be_overwritten(order, way):
    values = np.random.default_rng(1).standard_normal((91, 5))
    series = Series.of([np.arange(91)])
    expected = series.filtered(values, RECURSIONS[2:])
    own = np.array(values, order=order)
    assert series.filtered(own, RECURSIONS[2:], own) is own
    np.testing.assert_array_equal(own, expected)
    assert series.firsts.tolist() == [0]


def test_no_series_at_all(way):
    assert Series.of([]).filtered(np.zeros((0, 2)), []).shape == (0, 2)
