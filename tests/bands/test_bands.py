"""Bands and scores of particles against closed forms."""

import math

import numpy as np
import pytest
from scipy.stats import norm

from mmgtune.bands import (
    LEVELS,
    covariances,
    covered,
    crps,
    fan,
    index_band,
    pooled,
    quantiles,
    score_window,
    squared_error,
    squared_mahalanobis,
    standardised_error,
    widest,
)

STATES = ("x", "y", "psi", "u", "v_m", "r")
ONE = dict.fromkeys(STATES, 1.0)


def normal(shape, seed=1):
    return np.random.default_rng(seed).standard_normal(shape)


def window(states, truth, name="a", diverged=None):
    lost = np.zeros(len(states), dtype=bool) if diverged is None else np.array(diverged)
    return score_window(name, name, name, "turning", states, lost, truth, np.array([0.5, 1.0, 2.0]))


def test_quantiles_by_hand():
    """Of 1 .. 9 the k-th stands at k / 10."""
    values = np.arange(9.0, 0.0, -1.0)
    np.testing.assert_allclose(quantiles(values, (0.1, 0.25, 0.5, 0.9)), [1.0, 2.5, 5.0, 9.0])
    np.testing.assert_allclose(quantiles(values, (0.01, 0.99)), [1.0, 9.0])  # none is made up
    several = np.stack([values, 10.0 * values], axis=1)[:, None]
    np.testing.assert_allclose(quantiles(several, (0.25,)), [[[2.5, 25.0]]])
    with pytest.raises(ValueError, match="no particle"):
        quantiles(values[:0], (0.5,))


def test_infinite_particles_lie_beyond_all_others():
    values = np.array([1.0, 2.0, np.inf])
    np.testing.assert_array_equal(quantiles(values, (0.25, 0.5, 0.7, 0.75)), [1.0, 2.0, np.inf, np.inf])
    assert quantiles(np.full(3, np.inf), (0.6,))[0] == np.inf


@pytest.mark.daily("[19]", "[5]", "[2]")
@pytest.mark.parametrize("n", [2, 5, 19, 100])
def test_a_band_holds_what_it_says_with_few_particles_too(n):
    """A further draw from the same distribution lies in the band as often as the band says, whatever the number."""
    draws = normal((n + 1, 40_000, 1), seed=n)
    exact = [1.0 - 2.0 * k / (n + 1) for k in range(1, n // 2 + 1)]  # between two particles each
    inside, _ = covered(draws[1:], draws[0], exact)
    np.testing.assert_allclose(inside.mean(axis=(1, 2)), exact, atol=4.0 * 0.5 / math.sqrt(40_000))
    inside, _ = covered(draws[1:], draws[0], LEVELS)  # between these nearly, beyond them no more than there is
    np.testing.assert_allclose(inside.mean(axis=(1, 2)), np.minimum(LEVELS, widest(n)), atol=0.06)


def test_widths_of_bands_are_those_of_the_normal_distribution():
    _, width = covered(normal((20_000, 3, 1)), np.zeros((3, 1)), (0.5, 0.9))
    np.testing.assert_allclose(width[:, :, 0].mean(axis=1), 2.0 * norm.ppf([0.75, 0.95]), rtol=0.02)


def test_a_fan():
    found = fan(normal((20_000, 2)), 0.9)
    expected = {"mean": 0.0, "low": -1.645, "q25": -0.674, "median": 0.0, "q75": 0.674, "high": 1.645}
    assert list(found) == list(expected)
    for name, value in expected.items():
        np.testing.assert_allclose(found[name], value, atol=0.04)


@pytest.mark.parametrize("truth", [-1.0, 0.0, 0.3, 2.5])
def test_crps_of_a_normal_distribution(truth):
    """Gneiting & Raftery 2007, eq. 22."""
    mean, sigma = 0.4, 1.7
    z = (truth - mean) / sigma
    expected = sigma * (z * (2.0 * norm.cdf(z) - 1.0) + 2.0 * norm.pdf(z) - 1.0 / math.sqrt(math.pi))
    found = crps(mean + sigma * normal((100_000, 1, 1)), np.array([[truth]]))
    assert found[0, 0] == pytest.approx(expected, rel=0.02)


def test_crps_by_its_definition():
    particles, truth = normal((7, 4, 2)), normal((4, 2), seed=2)
    pairs = np.abs(particles[:, None] - particles[None]).mean(axis=(0, 1))
    np.testing.assert_allclose(crps(particles, truth), np.abs(particles - truth).mean(axis=0) - 0.5 * pairs)
    np.testing.assert_allclose(crps(particles[:1], truth), np.abs(particles[0] - truth))  # one: the error itself


def test_distances_of_a_known_covariance():
    """The squared Mahalanobis distance by the inverse matrix; on average the number of channels."""
    shape = np.array([[1.0, 0.6, 0.0], [0.0, 0.5, 0.2], [0.0, 0.0, 0.01]])
    particles = normal((50_000, 1, 3)) @ shape + np.array([3.0, -1.0, 0.2])
    truth = np.array([[3.4, -1.3, 0.21]])
    off = truth[0] - [3.0, -1.0, 0.2]
    expected = off @ np.linalg.inv(shape.T @ shape) @ off
    assert squared_mahalanobis(particles, truth)[0] == pytest.approx(expected, rel=0.03)
    assert squared_error(particles, truth)[0] == pytest.approx(off @ off, rel=0.05)
    mean, covariance = covariances(particles)
    np.testing.assert_allclose(covariance[0], shape.T @ shape, atol=0.02)
    np.testing.assert_allclose(covariance[0], np.cov(particles[:, 0].T, ddof=0), rtol=1e-9)
    drawn = normal((2000, 3), seed=3) @ shape + mean[0]
    many = squared_mahalanobis(np.repeat(particles[:4000], 2000, axis=1), drawn)
    assert many.mean() == pytest.approx(3.0, abs=0.25)


def test_a_singular_covariance_has_no_distance():
    truth = np.zeros((2, 3))
    assert np.isnan(squared_mahalanobis(normal((3, 2, 3)), truth)).all()  # three particles span a plane
    assert np.isfinite(squared_mahalanobis(normal((4, 2, 3)), truth)).all()
    flat = normal((50, 2, 3))
    flat[:, 0, 2] = flat[:, 0, 0] - 2.0 * flat[:, 0, 1]
    flat[:, 1, 1] = 7.0
    assert np.isnan(squared_mahalanobis(flat, truth)).all()
    gap = truth.copy()
    gap[0, 1] = np.nan
    assert np.isnan(squared_mahalanobis(normal((50, 2, 3)), gap)).tolist() == [True, False]


def test_fit_error_by_hand():
    truth, sigma = np.zeros((2, 3)), np.array([0.01, 0.02, np.inf])
    states = np.array([[0.01, 0.0, 5.0], [0.02, 0.04, 0.0]])
    np.testing.assert_allclose(standardised_error(states, truth, sigma), [1.0, 8.0])


def test_a_band_on_an_index():
    values = np.arange(1.0, 100.0)  # the k-th at k / 100
    found = index_band(values, 0.9)
    assert (found.mean, found.low, found.median, found.high) == pytest.approx((50.0, 5.0, 50.0, 95.0))
    assert found.half == pytest.approx(45.0)
    assert (found.reached, found.particles) == (99, 99)
    assert found.times(2.0).high == pytest.approx(190.0)


def test_particles_that_never_reach_it_are_counted_and_lie_above():
    values = np.arange(1.0, 100.0)
    values[[0, 20, 40]] = np.nan
    found = index_band(values, 0.9)
    assert (found.reached, found.particles) == (96, 99)
    assert found.high == pytest.approx(98.0)
    assert found.median > 50.0
    values[::8] = np.nan  # more than one in twenty: there is no upper end
    found = index_band(values, 0.9)
    assert found.high is None
    assert found.half is None
    assert found.low is not None
    assert found.mean == pytest.approx(np.nanmean(values))
    unknown = index_band(values, 0.9, endless=False)  # on which side they lie, nobody knows
    assert (unknown.low, unknown.high) == (None, None)
    none = index_band(np.full(4, np.nan), 0.9)
    assert (none.mean, none.median, none.reached) == (None, None, 0)
    alone = index_band(np.array([2.5]), 0.9)
    assert (alone.mean, alone.deviation, alone.half) == (2.5, None, None)


def test_windows_together_are_the_mean_over_their_samples():
    long, short = normal((40, 30, 6)), normal((40, 10, 6), seed=2)
    truths = normal((30, 6), seed=3), normal((10, 6), seed=4)
    found = pooled([window(long, truths[0], "a"), window(short, truths[1], "b")], ONE)
    joined, truth = np.concatenate([long, short], axis=1), np.concatenate(truths)
    whole = pooled([window(joined, truth)], ONE)
    for name in ("L_fit", "L_Eucl", "L_Maha", "CRPS", "sharpness", "coverage"):
        assert getattr(found, name) == pytest.approx(getattr(whole, name))
    assert found.windows == 2
    assert (found.correlation, found.singular, found.lost) == (None, 0, 0)
    assert found.to_dict()["coverage_90"] == found.covers(0.9)


def test_what_never_changes_is_counted_in_nothing():
    found = window(normal((40, 30, 6)), normal((30, 6), seed=3))
    still = pooled([found], {**ONE, "v_m": 0.0})
    others = [of for name, of in still.CRPS_by_state.items() if name != "v_m"]
    assert pytest.approx(np.mean(others)) == still.CRPS
    assert still.sharpness is not None
    assert np.isfinite(still.sharpness)
    nothing = pooled([found], dict.fromkeys(ONE, 0.0))
    assert (nothing.CRPS, nothing.sharpness) == (None, None)


def test_bands_that_are_right_are_found_right():
    found = pooled([window(normal((99, 3000, 6)), normal((3000, 6), seed=2))], ONE)
    np.testing.assert_allclose(found.coverage, LEVELS, atol=0.02)
    assert found.L_fit == pytest.approx(2.0 * (4.0 + 1.0 + 0.25), rel=0.03)  # of two draws, each over the noise
    assert found.L_Maha == pytest.approx(3.0, rel=0.1)
    assert found.sharpness == pytest.approx(2.0 * 1.645, rel=0.03)
    assert found.widest == pytest.approx(0.98)


def test_bands_that_are_too_narrow_are_found_so():
    found = pooled([window(0.5 * normal((99, 3000, 6)), normal((3000, 6), seed=2))], ONE)
    assert found.covers(0.9) == pytest.approx(2.0 * norm.cdf(0.5 * 1.645) - 1.0, abs=0.02)
    assert found.L_Maha == pytest.approx(12.0, rel=0.1)


def test_correlation_tells_bands_that_know_from_those_that_do_not():
    """Windows are more or less far off; the band follows that, or it does not."""
    sizes = np.geomspace(0.1, 10.0, 12)
    truths = [size * normal((40, 6), seed=k) for k, size in enumerate(sizes)]
    same = pooled([window(normal((60, 40, 6), k), truth, str(k)) for k, truth in enumerate(truths)], ONE)
    knows = pooled(
        [window(sizes[k] * normal((60, 40, 6), 99 + k), truth, str(k)) for k, truth in enumerate(truths)], ONE
    )
    assert same.correlation > 0.99
    assert knows.correlation < 0.7


def test_gaps_diverged_particles_and_single_ones():
    states, truth = normal((30, 20, 6)), normal((20, 6), seed=2)
    truth[:5, 0] = np.nan
    truth[:, 4] = np.nan
    lost = np.zeros(30, dtype=bool)
    lost[:3] = True
    found = pooled([window(np.where(lost[:, None, None], np.inf, states), truth, diverged=lost)], ONE)
    assert (found.particles, found.diverged, found.lost) == (30, 3, 0)
    assert "v_m" not in found.CRPS_by_state
    assert (found.L_Eucl, found.L_Maha) == (None, None)  # no sample has all velocities
    np.testing.assert_allclose(found.CRPS_by_state["x"], crps(states[3:], truth)[5:, 0].mean())
    gone = pooled([window(states, truth, diverged=np.arange(30) > 0)], ONE)
    assert (gone.lost, gone.CRPS, gone.covers(0.5)) == (1, None, None)
    single = pooled([window(states[:1], truth)], ONE)
    assert (single.covers(0.9), single.sharpness, single.L_Maha) == (None, None, None)
    off = np.nanmean(np.abs(states[0] - truth)[:, [0, 1, 2, 3, 5]], axis=0)
    assert single.to_dict()["CRPS"] == pytest.approx(off.mean())
