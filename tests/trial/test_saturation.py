"""A sensor at the end of its range is told; rest, few digits and smooth data are not."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.trial import check_trial, load_trials

from .made import DEG, made

SUZAKU = load_trials("suzaku").trials


def told(trial):
    return [one for one in check_trial(trial) if one.code == "saturated"]


@pytest.mark.parametrize(
    ("name", "low", "high", "word"),
    [
        ("u", -np.inf, 2.8, "largest"),
        ("r", -np.inf, 0.7 * DEG, "largest"),
        ("v_m", -0.2, np.inf, "smallest"),
    ],
)
def test_a_clipped_channel_is_told(name, low, high, word):
    trial = made(seed=2)
    assert not told(trial)
    (found,) = told(replace(trial, **{name: np.clip(getattr(trial, name), low, high)}))
    assert found.what.startswith(f"'{name.removesuffix('_m')}' stands still at its {word} value")
    assert "NaN" in found.fix


def test_a_clipped_channel_with_gaps_is_told():
    trial = made(seed=2)
    u = np.minimum(trial.u, 2.8)
    u[5::40] = np.nan
    assert told(replace(trial, u=u))


@pytest.mark.parametrize("name", SUZAKU)
def test_the_bundled_trials_have_none(name):
    assert not told(SUZAKU[name])


def test_few_digits_are_no_end_of_a_range():
    trial = made(seed=2)
    assert not told(replace(trial, u=np.round(trial.u, 1), r=np.round(trial.r / DEG, 1) * DEG))


def test_smooth_data_that_rests_is_none():
    assert not told(made())  # steady on her approach and in her turn
    trial = made()
    assert not told(replace(trial, u=np.minimum(trial.u, 2.9)))


def test_a_filtered_channel_held_for_a_moment_is_none():
    trial = made(seed=2)
    u = trial.u.copy()
    u[100:104] = u.max() + 0.01
    assert not told(replace(trial, u=u))


def noisy(values, size):
    return values + size * np.random.default_rng(3).standard_normal(len(values))


def test_a_yaw_rate_that_ends_below_noise_is_told():
    trial = SUZAKU["turn_p35"]
    end = 45.0 / 60.0 * DEG
    (found,) = told(replace(trial, r=noisy(np.clip(trial.r, -end, end), 0.03 * DEG)))
    assert found.what.startswith("the yaw rate ends at 0.7")
    assert not [one for one in check_trial(replace(trial, r=np.clip(trial.r, -end, end))) if one.code == "yaw-rate"]
    assert not told(replace(trial, r=0.8 * trial.r))  # a scale is no end
