"""Values of runs around a common mean, integrated out: against the likelihood written out, and against chance."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from mmgtune.diagnose.bench.runs import between, groupings, labels_of, spread_key
from mmgtune.diagnose.signatures.hierarchy import ROUGHLY, Hierarchy
from mmgtune.fitting.box import base_of, group_of
from mmgtune.trial import load_trials

N_GROUPS, N_PARAMETERS = 6, 2
N = 30


@pytest.fixture(scope="module")
def shown():
    """Signatures of values of six groups, of unlike strength, in thirty directions."""
    rng = np.random.default_rng(1)
    return rng.standard_normal((N, N_GROUPS * N_PARAMETERS)) * rng.uniform(2.0, 20.0, N_GROUPS * N_PARAMETERS)


def noise():
    rng = np.random.default_rng(2)
    A = rng.standard_normal((N, N))
    return np.eye(N) + 0.1 * A @ A.T


def log_likelihood(data, shown, mean, spread):
    """Of data, with the values integrated out, written out."""
    X = np.tile(np.eye(N_PARAMETERS), (N_GROUPS, 1))
    covariance = noise() + spread**2 * shown @ shown.T
    return multivariate_normal(-shown @ X @ mean, covariance).logpdf(data)


def test_the_gain_is_twice_the_logarithm_of_the_likelihood_ratio(shown):
    hierarchy = Hierarchy(shown, noise(), N_PARAMETERS)
    data = np.random.default_rng(3).standard_normal(N) * 5.0
    best = hierarchy.best(data)
    without = multivariate_normal(np.zeros(N), noise()).logpdf(data)
    tried = [
        2.0 * (log_likelihood(data, shown, best_mean, spread) - without)
        for spread in best.spread * np.array([0.5, 1.0, 2.0])
        for best_mean in (np.zeros(2), *np.random.default_rng(4).normal(0.0, 0.2, (200, 2)))
    ]
    assert best.gain >= max(tried) - 1e-6
    (at,) = hierarchy.gains(data[:, None], np.array([best.spread]))
    assert at[0] == pytest.approx(best.gain)


def test_values_are_found_and_drawn_to_their_mean_where_little_is_told(shown):
    rng = np.random.default_rng(5)
    truth = np.tile([1.0, -0.5], N_GROUPS) + 0.4 * rng.standard_normal(N_GROUPS * N_PARAMETERS)
    weak = shown.copy()
    weak[:, :2] *= 1e-3
    data = -weak @ truth
    found = Hierarchy(weak, noise(), N_PARAMETERS).best(data)
    assert found.spread == pytest.approx(0.4, rel=0.5)
    np.testing.assert_allclose(found.values[2:], truth[2:], atol=0.25)
    np.testing.assert_allclose(found.values[:2], found.values.reshape(-1, 2).mean(axis=0), atol=0.1)


def test_chance_earns_next_to_nothing_however_many_values_there_are(shown):
    hierarchy = Hierarchy(shown, noise(), N_PARAMETERS)
    drawn = np.linalg.cholesky(noise()) @ np.random.default_rng(6).standard_normal((N, 2000))
    gain = hierarchy.gains(drawn, hierarchy.spreads(ROUGHLY)).max(axis=0)
    assert np.quantile(gain, 0.95) < 9.0  # of twelve free values 21
    assert gain.min() >= 0.0


def test_what_a_log_leaves_open_without_measure_hides_the_rest_and_breaks_nothing(shown):
    """A run near its end of stability: other inputs would take it anywhere."""
    rng = np.random.default_rng(9)
    anywhere = 1e12 * rng.standard_normal((N, 3))
    wide = Hierarchy(shown, np.eye(N) + anywhere @ anywhere.T, N_PARAMETERS)
    found = wide.best(-shown @ rng.standard_normal(shown.shape[1]))
    assert np.isfinite([found.gain, found.spread, *found.values]).all()


def test_no_spread_is_one_value_for_all(shown):
    X = np.tile(np.eye(N_PARAMETERS), (N_GROUPS, 1))
    data = -shown @ X @ np.array([0.7, 0.2])
    found = Hierarchy(shown, noise(), N_PARAMETERS).best(data)
    assert found.spread * np.sqrt(np.linalg.eigvalsh(shown.T @ shown).max()) < 1.0
    np.testing.assert_allclose(found.values.reshape(-1, 2), np.tile([0.7, 0.2], (N_GROUPS, 1)), atol=1e-6)


def test_names_of_groups():
    name = "effects.current.north@trial:run@2"
    assert (base_of(name), group_of(name)) == ("effects.current.north", "trial:run@2")
    assert spread_key(name) == "effects.current.north@trial"
    assert between(("hull.R_0",), {}) is None
    names = ("hull.R_0", *(f"effects.current.north@trial:{k}" for k in range(3)))
    rows = between(names, {"effects.current.north@trial": 0.5})
    unit = np.array([0.3, 0.1, 0.2, 0.6])
    assert np.sum((rows @ unit) ** 2) == pytest.approx(np.sum((unit[1:] - 0.3) ** 2) / 0.25)


def test_trials_belong_together_by_what_they_say():
    (trial,) = list(load_trials("suzaku").trials.values())[:1]

    def grouped(*groups):
        return [dataclasses.replace(trial, id=f"run_{k}", group=group) for k, group in enumerate(groups)]

    assert list(groupings(grouped("", "", ""))) == ["trial"]
    assert list(groupings(grouped("", ""))) == []  # too few to differ
    days = groupings(grouped("a", "a", "b", "b", "c"))
    assert list(days) == ["trial", "group"]
    assert days["group"] == ("group:a", "group:b", "group:c")
    assert groupings(grouped("a", "a", "b", "b"))["group"] == ("group:a", "group:b")
    assert list(groupings(grouped("a", "b", "b"))) == ["trial"]  # no group of several but one
    window = dataclasses.replace(trial, id="run_1@100", part_of="run_1", group="a")
    assert {"trial:run_1", "group:a"} <= labels_of(window)
