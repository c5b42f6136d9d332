"""The arithmetic forms of elementary functions keep the errors their module states."""

import numpy as np
import pytest
from numba import njit

from mmgtune.backends import vector_math


def over(function, *columns):
    """A scalar compiled function over arrays."""

    @njit
    def loop(a, b, out):
        for i in range(len(a)):
            out[i] = function(a[i])
        return out

    @njit
    def loop2(a, b, out):
        for i in range(len(a)):
            out[i] = function(a[i], b[i])
        return out

    first = columns[0]
    return (loop if len(columns) == 1 else loop2)(first, columns[-1], np.empty_like(first))


def test_exp():
    x = np.concatenate([np.linspace(-700.0, 700.0, 200_001), np.random.default_rng(0).uniform(-3, 3, 100_000)])
    assert np.max(np.abs(over(vector_math.vector_exp, x) / np.exp(x) - 1.0)) < 4e-16


def test_log():
    x = np.concatenate([np.geomspace(1e-300, 1e300, 200_001), np.random.default_rng(0).uniform(0.01, 3.0, 300_000)])
    ours, theirs = over(vector_math.vector_log, x), np.log(x)
    assert np.max(np.abs(ours - theirs) / np.maximum(np.abs(theirs), 1e-300)) < 4e-16
    assert over(vector_math.vector_log, np.ones(1))[0] == 0.0
    assert np.isnan(over(vector_math.vector_log, np.array([-1.0, 0.0]))).all()


@pytest.mark.parametrize(("ours", "theirs"), [(vector_math.vector_sin, np.sin), (vector_math.vector_cos, np.cos)])
def test_sine_and_cosine(ours, theirs):
    x = np.concatenate([np.linspace(-1e5, 1e5, 300_001), np.random.default_rng(0).uniform(-7, 7, 200_000)])
    assert np.max(np.abs(over(ours, x) - theirs(x))) < 4e-16


def test_arctan2():
    rng = np.random.default_rng(0)
    y, x = rng.standard_normal((2, 400_000)) * 10.0 ** rng.uniform(-8, 8, (2, 400_000))
    assert np.max(np.abs(over(vector_math.vector_arctan2, y, x) - np.arctan2(y, x))) < 8e-16


def test_arctan2_on_the_axes():
    y = np.array([0.0, -0.0, 1.0, -1.0, 0.0, -0.0, 2.0, -2.0])
    x = np.array([1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 2.0, 2.0])
    np.testing.assert_allclose(over(vector_math.vector_arctan2, y, x), np.arctan2(y, x), atol=1e-15)


@pytest.mark.parametrize("name", ["vector_exp", "vector_log", "vector_sin", "vector_cos"])
def test_nan_stays_nan(name):
    assert np.isnan(over(getattr(vector_math, name), np.array([np.nan]))[0])
