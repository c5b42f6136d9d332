"""Noise of sensors, estimated from what a fit of many numbers leaves of it."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.diagnose.bench.inputs import _rounded_off
from mmgtune.diagnose.bench.noise import ChannelNoise, NoiseModel, estimate
from mmgtune.diagnose.bench.workbench import noise_levels
from mmgtune.trial import load_trials

CHANNELS, RUNS, SAMPLES = 6, 4, 400
TRUE = ChannelNoise(phi=0.96, fading=0.8, white=0.4)


class Cases:
    """Rows of runs whose channels are all measured all along."""

    rows = np.arange(RUNS * SAMPLES * CHANNELS).reshape(RUNS, SAMPLES, CHANNELS)

    def __len__(self):
        return RUNS


def fit_of_slow_changes(per_run):
    """What a fit of so many slow changes of every channel of every run leaves."""
    t = np.linspace(0.0, 1.0, SAMPLES)
    basis, _ = np.linalg.qr(np.column_stack([np.cos(np.pi * k * t) for k in range(per_run)]))

    def fitted(values):
        left = values.reshape(RUNS, SAMPLES, -1)
        return (left - basis @ (basis.T @ left)).reshape(values.shape)

    return fitted


def mean(model, of):
    return np.mean([getattr(noise, of) for noise in model.channels.values()])


@pytest.mark.parametrize("seed", [1, 2])
def test_slow_noise_is_seen_whole_through_what_was_fitted_to_it(seed):
    """Noise that faded over 40 s went into the fit by half, and chance passed for a wind."""
    true = NoiseModel(Cases(), dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), TRUE))
    fitted = fit_of_slow_changes(5)
    left = fitted(true.restore(np.random.default_rng(seed).standard_normal(Cases.rows.size)))
    found, naive = estimate(Cases(), left, fitted), estimate(Cases(), left)
    assert mean(found, "fading") == pytest.approx(TRUE.fading, rel=0.3)
    assert mean(found, "phi") == pytest.approx(TRUE.phi, abs=0.02)
    assert mean(found, "white") == pytest.approx(TRUE.white, rel=0.1)
    assert mean(naive, "fading") < 0.6 * TRUE.fading


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_faint_slow_noise_is_seen_though_a_fit_took_most_of_it(seed):
    """What a fit leaves of white noise alternates, which hid receivers that wandered by 15 cm in short runs."""
    true = NoiseModel(Cases(), dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), ChannelNoise(0.97, 0.3, 1.0)))
    fitted = fit_of_slow_changes(8)
    left = fitted(true.restore(np.random.default_rng(seed).standard_normal(Cases.rows.size)))
    found, naive = estimate(Cases(), left, fitted), estimate(Cases(), left)
    assert mean(found, "fading") > 3.0 * mean(naive, "fading")


@pytest.mark.parametrize(("phi", "least", "most"), [(0.975, 0.89, 0.98), (0.9, 0.8, 0.96), (0.6, 0.4, 0.82)])
def test_how_slowly_noise_fades_is_told_though_a_fit_took_most_of_it(phi, least, most):
    """By the first lags noise that fades in 40 samples faded in 5, and what it did passed for an error of a log."""
    true = NoiseModel(Cases(), dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), ChannelNoise(phi, 0.4, 1.0)))
    fitted = fit_of_slow_changes(8)
    for seed in (5, 6):
        left = fitted(true.restore(np.random.default_rng(seed).standard_normal(Cases.rows.size)))
        seen = [one for one in estimate(Cases(), left, fitted).channels.values() if one.fading > 0.0]
        assert len(seen) >= 4
        assert all(least < one.phi < most for one in seen)
        assert np.mean([one.fading for one in seen]) == pytest.approx(0.4, abs=0.2)


@pytest.mark.parametrize(
    "noise", [ChannelNoise(0.9, 2.0, 0.5), ChannelNoise(0.967, 40.0, 0.0), ChannelNoise(white=4.0)]
)
def test_noise_is_freed_of_its_memory_and_gets_it_back(noise):
    others = dict.fromkeys(("y", "psi", "u", "v_m", "r"), TRUE)
    model = NoiseModel(Cases(), {"x": noise, **others})
    white = np.random.default_rng(5).standard_normal((Cases.rows.size, 40))
    np.testing.assert_allclose(model.apply(model.restore(white)), white, atol=1e-9)
    np.testing.assert_allclose(model.restore(model.apply(white)), white, atol=1e-9)


def test_white_noise_stays_as_it_is():
    white = np.random.default_rng(1).standard_normal(Cases.rows.size)
    fitted = fit_of_slow_changes(3)
    found, naive = estimate(Cases(), fitted(white), fitted), estimate(Cases(), fitted(white))
    assert found.channels == naive.channels


@pytest.mark.parametrize(("channel", "whole"), [("x", True), ("psi", False)])
def test_positions_may_wander_far_beyond_their_white_noise_where_the_rest_does_not(channel, whole):
    """Of a receiver that wandered by half a metre a third was seen, and a compass was blamed.  An error of the model
    shows in other channels than the position."""
    far = ChannelNoise(phi=0.96, fading=12.0, white=1.0)
    names = ("x", "y", "psi", "u", "v_m", "r")
    true = NoiseModel(Cases(), {name: far if name == channel else ChannelNoise() for name in names})
    fitted = fit_of_slow_changes(5)
    left = fitted(true.restore(np.random.default_rng(1).standard_normal(Cases.rows.size)))
    found, naive = estimate(Cases(), left, fitted).channels, estimate(Cases(), left).channels
    if whole:
        assert found[channel].fading > 1.2 * naive[channel].fading
        assert found[channel].phi > naive[channel].phi
    else:
        assert found == naive


def shapes():
    """Residuals of one channel far beyond its white noise, (RUNS, SAMPLES), by what they are, and how rough that is."""
    drawn = np.random.default_rng(2)
    t = np.arange(float(SAMPLES))
    error = 6.0 * np.sin(t / 40.0 + np.arange(RUNS)[:, None]) + np.abs(t % 150.0 - 75.0) / 20.0
    fades = NoiseModel(Cases(), dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), ChannelNoise(0.967, 40.0, 0.0)))
    memory = fades.restore(drawn.standard_normal(Cases.rows.size)).reshape(RUNS, SAMPLES, CHANNELS)[:, :, 0]
    white = drawn.standard_normal((RUNS, SAMPLES))
    return {
        "noise that fades": (memory, True),
        "noise that fades, and white noise beside": (memory + 3.0 * white, False),
        "an error of the model": (error, False),
        "an error of the model in white noise": (error + white, False),
        "an error of the model, hardly any noise": (error + 0.01 * white, False),
    }


@pytest.mark.parametrize("what", shapes())
def test_noise_of_which_all_fades_is_told_from_an_error_of_the_model(what):
    """Of sensors that wandered, with nothing white in it, "35 times the noise" was left that no cause explained."""
    values, rough = shapes()[what]
    residuals = np.random.default_rng(3).standard_normal(Cases.rows.shape)
    residuals[:, :, 5] = values
    fitted = fit_of_slow_changes(5)
    left = fitted(residuals.reshape(-1))
    found = estimate(Cases(), left, fitted)
    assert found.channels["r"].rough == rough
    assert found.may_be_error != rough
    if rough:  # what was fitted to it is put back
        assert found.channels["r"].variance > 1.2 * estimate(Cases(), left).channels["r"].variance


def test_a_rudder_logged_in_whole_degrees_may_have_been_anywhere_between():
    """For as long as it shows the same; orders of a few angles are not taken for that."""
    drawn = np.random.default_rng(3).standard_normal((4, 400))
    angle = 12.0 * np.sin(0.05 * np.arange(400.0)) + np.repeat([0.0, 3.0, -4.0, 7.0], 100)
    rounded = np.round(angle)
    left_out = _rounded_off(rounded, rounded, drawn)
    stands = np.diff(rounded) == 0.0
    assert np.all(np.diff(left_out)[:, stands] == 0.0)
    assert np.std(left_out) == pytest.approx(1.0 / np.sqrt(12.0), rel=0.2)
    for exact in (angle, np.where(angle > 0.0, 35.0, -35.0)):
        assert not _rounded_off(exact, exact, drawn).any()


def test_where_a_track_lies_and_whence_a_heading_counts_is_no_noise():
    """Tracks on a national grid of millions of metres passed for noisy ones, by metres."""
    here = list(load_trials("suzaku"))
    there = [replace(one, x=one.x + 5.7e6, y=one.y + 4.2e5, psi=one.psi + 6.0 * np.pi) for one in here]
    np.testing.assert_allclose(noise_levels(there), noise_levels(here), rtol=1e-3)
