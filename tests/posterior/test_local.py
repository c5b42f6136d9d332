"""The distribution about the mode against what is known of linear problems."""

from __future__ import annotations

from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest

from mmgtune.backends import get_backend
from mmgtune.posterior.local import find_mode, make_windowed, particles_about
from mmgtune.posterior.room import make_room
from mmgtune.posterior.sizing import BASE, own_variance
from mmgtune.profile import load_profile
from tests.hidden.cases import null
from tests.hidden.plant import SILENT, simulate


class Open(NamedTuple):
    """A room of so many numbers, with an end where ``far`` says so."""

    n: int
    far: float = np.inf

    def __len__(self):
        return self.n

    @property
    def box(self):
        return np.full(self.n, -self.far), np.full(self.n, self.far)


class Straight:
    """Residuals A z - b, as ``Windowed`` gives them."""

    def __init__(self, A, b, n_series=1):
        self.A, self.b, self.room, self.n_series = A, b, Open(A.shape[1]), n_series

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
    z = particles_about(straight, find_mode(straight), 1.0, 20_000, seed=5)
    assert z[4].mean() == pytest.approx(0.0, abs=0.03)
    assert z[4].std() == pytest.approx(1.0, abs=0.03)
    apart = (z[3] - z[5]) / np.sqrt(2.0)
    assert apart.std() == pytest.approx(1.0, abs=0.03)
    assert z[0].std() < 0.3
    assert find_mode(straight).learnt(1.0) == pytest.approx(4.0, abs=0.3)


def test_the_same_seed_draws_the_same(straight):
    mode = find_mode(straight, 2.0)
    once, again, other = (particles_about(straight, mode, 2.0, 5, seed) for seed in (1, 1, 2))
    assert np.array_equal(once, again)
    assert not np.array_equal(once, other)


class Bent(Straight):
    """Residuals that bend in the first number."""

    def residuals(self, z):
        return super().residuals(z) + 2.0 * z[0] ** 2

    def linearised(self, z):
        J = self.A.copy()
        J[:, 0] += 4.0 * z[0]
        return self.residuals(z[:, None])[:, 0], J


def test_where_residuals_bend_particles_fit_as_well_as_they_should():
    rng = np.random.default_rng(4)
    data = Bent(0.3 * rng.normal(size=(40, 6)), rng.normal(size=40) + 2.0)
    mode = find_mode(data, 3.0)
    assert mode.converged
    z = particles_about(data, mode, 3.0, 4000, seed=1)
    above = np.median(np.sum(data.residuals(z) ** 2, axis=0)) - np.sum(mode.residual**2)
    assert above / 3.0 == pytest.approx(mode.learnt(3.0), rel=0.35)


def test_a_search_that_is_stuck_has_not_converged(straight):
    class Wrong(Straight):
        def linearised(self, z):
            r, J = super().linearised(z)
            return r, -1e4 * J  # slopes that lead uphill

    assert find_mode(straight).converged
    assert not find_mode(Wrong(straight.A, straight.b + 30.0)).converged


def test_a_mode_is_found_from_anywhere(straight):
    there = find_mode(straight, 5.0, np.full(6, 2.0))
    assert np.allclose(there.z, find_mode(straight, 5.0).z, atol=1e-9)


class Valley:
    """A curved valley between steep sides: slopes hold for a small share of a deviation."""

    room = Open(2)

    def residuals(self, z):
        return np.array([300.0 * (z[1] - z[0] ** 2), 100.0 * (1.5 - z[0])])

    def linearised(self, z):
        return self.residuals(z[:, None])[:, 0], np.array([[-600.0 * z[0], 300.0], [-100.0, 0.0]])


def test_where_every_step_leads_uphill_shorter_ones_are_taken():
    mode = find_mode(Valley())  # each of the usual steps from the centre, of cost 22500, leads uphill
    assert mode.converged
    assert np.sum(mode.residual**2) + np.sum(mode.z**2) == pytest.approx(1.5**2 + 1.5**4, rel=1e-3)


def test_a_search_stays_within_the_room():
    rng = np.random.default_rng(5)
    A = rng.normal(size=(40, 3))
    data = Straight(A, A @ [3.0, 0.5, -0.5])
    data.room = Open(3, 1.0)
    mode = find_mode(data)
    others = np.linalg.solve(A[:, 1:].T @ A[:, 1:] + np.eye(2), A[:, 1:].T @ (data.b - A[:, 0]))
    assert mode.converged
    assert np.allclose(mode.z, [1.0, *others], atol=1e-9)


@pytest.mark.daily("1005-2.0")
@pytest.mark.parametrize(
    ("seed", "size", "sailed", "stuck_at", "found_at"),
    [
        (1005, 2.0, "zigzag_20", 201.1, 151.6),
        (1005, 2.5, "turn_p35", 5883.0, 775.0),
        (1006, 2.5, "zigzag_20", 733280.0, 1738.0),
    ],
)
def test_the_mode_of_a_ship_far_from_her_profile_is_found(seed, size, sailed, stuck_at, found_at):
    """Her twelve targets are twice and more those of the profile; ``stuck_at`` without short steps and the edge."""
    case = null(seed)
    ship = {name: size * value for name, value in case.ship.items()}
    trials = [one for one in simulate(ship, case.effects, case.seed, SILENT) if one.id == sailed]
    data = make_windowed(make_room(load_profile("suzaku")), trials, get_backend("compiled"))
    mode = find_mode(data)
    cost = np.sum(mode.residual**2) + np.sum(mode.z**2)
    low, high = data.room.box
    assert np.all((mode.z >= low) & (mode.z <= high))
    assert cost < found_at + 0.3 * (stuck_at - found_at)  # a path of many steps hangs on the last digits
    assert mode.converged or size > 2.0  # farther off, 30 steps do not always do


def test_a_misfit_counts_as_one_number_a_series():
    right = SimpleNamespace(residual=np.ones(200), misfit=1.0)
    wrong = SimpleNamespace(residual=np.full(200, 2.0**0.5), misfit=2.0)
    data = SimpleNamespace(n_series=4)
    assert own_variance(data, right) == BASE
    above = 1.0 - 0.1
    assert own_variance(data, wrong) == pytest.approx(BASE + 2.0 * above * 50.0)
