"""Restarted simulations: noise for the true model, and where a wrong one is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.diagnose.evidence import short_horizon
from mmgtune.motions import simulate_trials

RK4 = Integrator("rk4")


def test_the_true_model_is_within_the_noise(suzaku, plain):
    found = short_horizon(suzaku, plain, integrator=RK4)
    assert found.diverged == 0
    assert [len(values) for values in found.residuals] == [trial.n_samples for trial in plain]
    # 1 by the measurement alone; the noise of restarts is carried on, most into heading and position.
    assert np.all(found.pooled_rms_in_noise > 0.9)
    assert np.all(found.pooled_rms_in_noise < [1.6, 1.6, 2.0, 1.3, 1.3, 1.3])


def test_a_wrong_model_is_wrong_in_yaw_first(damped, plain):
    found = short_horizon(damped, plain, integrator=RK4)
    worst = found.pooled_rms_in_noise
    assert worst[2] > 5.0
    assert worst[5] > 2.0
    assert worst.max() == worst[2]
    psi = np.concatenate([values[:, 2] for values in found.residuals])
    since = np.concatenate(found.since)
    late, early = (np.sqrt(np.nanmean(psi[part] ** 2)) for part in (since > 45.0, since < 15.0))
    assert late > 3.0 * early  # it grows from each restart


def test_windows_cover_every_sample_but_the_first(suzaku, plain):
    found = short_horizon(suzaku, plain, window=50.0)
    for since, residuals in zip(found.since, found.residuals, strict=True):
        assert np.isnan(since[0])
        np.testing.assert_array_equal(since[1:], (np.arange(420.0) % 50.0) + 1.0)
        assert np.isfinite(residuals[1:]).all()


def test_one_long_window_is_a_simulation_from_the_smoothed_state(suzaku, plain):
    found = short_horizon(suzaku, plain[:1], window=1e4)
    whole = simulate_trials(suzaku, plain[:1])[0].states - plain[0].motion
    # Both run through the whole trial; they differ by the noise of the first sample and what grows of it.
    assert np.sqrt(np.mean((found.residuals[0] - whole)[1:, 3:] ** 2)) < 0.05


def test_gaps_are_tolerated(suzaku, plain):
    trial = plain[2]
    motion = {name: getattr(trial, name).copy() for name in ("x", "y", "psi", "u", "v_m", "r")}
    for values in motion.values():
        values[200:260] = np.nan
    motion["u"][::13] = np.nan
    motion["x"][40:43] = np.nan
    found = short_horizon(suzaku, [replace(trial, **motion)], integrator=RK4)
    assert np.isnan(found.residuals[0][200:261]).all()  # the sample after the gap is where it begins anew
    assert np.isnan(found.residuals[0][40:43, 0]).all()
    assert np.isfinite(found.residuals[0][262:, 5]).all()
    assert np.all(found.pooled_rms_in_noise < 2.5)


def test_what_cannot_be_asked(suzaku, plain):
    with pytest.raises(ValueError, match="no trials"):
        short_horizon(suzaku, [])
    with pytest.raises(ValueError, match="not positive"):
        short_horizon(suzaku, plain, window=0.0)
    with pytest.raises(ValueError, match="no window of"):
        short_horizon(suzaku, plain, window=0.5)
