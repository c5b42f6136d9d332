"""The distribution about the mode against what is known of linear problems."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from mmgtune.posterior.local import find_mode
from mmgtune.posterior.sizing import BASE, draws, own_variance


class Straight:
    """Residuals A z - b, as ``Windowed`` gives them."""

    def __init__(self, A, b, n_series=1):
        self.A, self.b, self.room, self.n_series = A, b, np.zeros(A.shape[1]), n_series

    def residuals(self, z):
        return self.A @ z - self.b[:, None]

    def linearised(self, z):
        return self.A @ z - self.b, self.A


@pytest.fixture
def straight():
    rng = np.random.default_rng(3)
    A = rng.normal(size=(40, 6))
    A[:, 4] = 0.0  # no trial tells this one
    A[:, 5] = A[:, 3]  # nor these two apart
    return Straight(A, rng.normal(size=40))


@pytest.mark.parametrize("temper", [1.0, 7.0])
def test_it_is_the_posterior_of_a_linear_problem(straight, temper):
    mode = find_mode(straight, 1.0)
    assert mode.converged
    mean, covariance = mode.gaussian(temper)
    A, b = straight.A, straight.b
    known = np.linalg.inv(A.T @ A / temper + np.eye(6))  # Bishop 2006, eq. 3.50-3.51
    assert np.allclose(covariance, known, atol=1e-12)
    assert np.allclose(mean, known @ A.T @ b / temper, atol=1e-9)


def test_where_no_trial_tells_particles_are_those_of_the_room(straight):
    z = draws(find_mode(straight), 1.0, 20_000, seed=5)
    assert z[4].mean() == pytest.approx(0.0, abs=0.03)
    assert z[4].std() == pytest.approx(1.0, abs=0.03)
    apart = (z[3] - z[5]) / np.sqrt(2.0)
    assert apart.std() == pytest.approx(1.0, abs=0.03)
    assert z[0].std() < 0.3
    assert find_mode(straight).learnt(1.0) == pytest.approx(4.0, abs=0.3)


def test_the_same_seed_draws_the_same(straight):
    mode = find_mode(straight)
    assert np.array_equal(draws(mode, 2.0, 5, seed=1), draws(mode, 2.0, 5, seed=1))
    assert not np.array_equal(draws(mode, 2.0, 5, seed=1), draws(mode, 2.0, 5, seed=2))


def test_a_misfit_counts_as_one_number_a_series():
    right = SimpleNamespace(residual=np.ones(200), misfit=1.0)
    wrong = SimpleNamespace(residual=np.full(200, 2.0**0.5), misfit=2.0)
    data = SimpleNamespace(n_series=4)
    assert own_variance(data, right) == BASE
    above = 1.0 - 0.1
    assert own_variance(data, wrong) == pytest.approx(BASE + 2.0 * above * 50.0)
