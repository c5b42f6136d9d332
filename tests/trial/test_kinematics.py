"""Noise of a channel of the motion, white and of rounding."""

import numpy as np
import pytest

from mmgtune.trial.kinematics import motion_noise, rounding_noise

T = np.arange(600.0)
SPEED = 5.0 - 0.8 * np.sin(T / 90.0)


@pytest.mark.parametrize("step", [0.05, 0.1, 0.2 * 1852.0 / 3600.0])
def test_noise_of_rounding_is_that_of_its_step_where_the_motion_hardly_changes(step):
    rounded = step * np.round(SPEED / step)
    assert rounding_noise(rounded) == pytest.approx(step / np.sqrt(12.0), rel=1e-6)
    assert motion_noise(rounded) == pytest.approx(np.std(rounded - SPEED), rel=0.2)
    rounded[50:80] = np.nan
    assert motion_noise(rounded) == pytest.approx(step / np.sqrt(12.0), rel=1e-6)


def test_noise_beyond_the_step_counts():
    rng = np.random.default_rng(1)
    noisy = 0.1 * np.round((SPEED + rng.normal(0.0, 0.3, len(T))) / 0.1)
    assert motion_noise(noisy) == pytest.approx(0.3, rel=0.1)


def test_what_is_not_rounded_is_not_taken_for_it():
    rng = np.random.default_rng(1)
    assert rounding_noise(SPEED) < 1e-4
    assert rounding_noise(SPEED + rng.normal(0.0, 0.1, len(T))) < 1e-4
    assert rounding_noise(np.full(600, 5.0)) == 0.0
    assert rounding_noise(np.array([0.0, 1.0, 2.0])) == 0.0  # three values, each once
    assert rounding_noise(np.full(3, np.nan)) == 0.0
