"""A ship that swings in waves is told, and no manoeuvre and no noise is taken for it."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.trial import check_trial, load_trials
from mmgtune.trial.checks.swell import swell_findings

from .made import DEG, made

SUZAKU = load_trials("suzaku").trials


def in_waves(trial, period, yaw=0.6 * DEG, sway=0.1, spread=0.0, seed=1):
    """The trial with the motions of waves about a period [s] on top; ``spread`` of their frequencies."""
    rng = np.random.default_rng(seed)
    frequencies = 2.0 * np.pi / period * (1.0 + spread * np.linspace(-1.0, 1.0, 25 if spread else 1))
    phases = rng.uniform(0.0, 2.0 * np.pi, (2, len(frequencies)))
    waves = np.exp(1j * (np.outer(trial.t, frequencies)[None] + phases[:, None])) / np.sqrt(len(frequencies))
    turn, slide = (one.sum(axis=-1) for one in waves)
    rate = (1j * frequencies * waves[0]).sum(axis=-1)
    return replace(
        trial,
        psi=trial.psi + yaw * turn.real,
        r=trial.r + yaw * rate.real,
        v_m=trial.v_m + sway * slide.real,
    )


def told(trial, L_pp=None):
    return [one for one in check_trial(trial, L_pp) if one.code == "swell"]


@pytest.mark.parametrize("zigzag", [False, True])
@pytest.mark.parametrize(("period", "dt"), [(9.0, 1.0), (9.0, 2.0), (5.0, 0.5), (14.0, 1.0)])
def test_swinging_is_told_with_its_period_and_size(zigzag, period, dt):
    trial = made(zigzag=zigzag, seed=3, dt=dt, samples=round(500.0 / dt))
    assert not told(trial)
    (found,) = told(in_waves(trial, period))
    said = float(found.what.split("period of ")[1].split(" s")[0])
    assert said == pytest.approx(period, rel=0.08)
    yaw = float(found.why.split("'psi' by ")[1].split(" deg")[0])
    assert yaw == pytest.approx(0.6, rel=0.25)


@pytest.mark.parametrize("seed", range(4))
def test_waves_are_irregular(seed):
    trial = made(seed=3, samples=900)
    assert told(in_waves(trial, 9.0, yaw=0.8 * DEG, sway=0.2, spread=0.1, seed=seed))


@pytest.mark.parametrize("name", SUZAKU)
def test_what_the_bundled_ship_does_is_no_swinging(name):
    assert not swell_findings(SUZAKU[name], name)
    assert not swell_findings(SUZAKU[name], name, 83.0)


@pytest.mark.parametrize("period", [30.0, 60.0])
def test_what_is_as_slow_as_steering_is_none(period):
    assert not told(in_waves(made(seed=3, samples=1000), period))


def test_what_the_ship_does_in_her_own_length_is_none():
    trial = in_waves(made(seed=3), 9.0)
    assert told(trial, 80.0)
    assert not told(trial, 20.0)  # 7 s a length: she may steer so fast


def test_one_channel_alone_is_a_matter_of_its_sensor():
    trial = made(seed=3)
    assert not told(replace(trial, r=in_waves(trial, 9.0).r))


def test_a_part_of_the_record_is_none():
    trial = made(seed=3)
    waves = in_waves(trial, 9.0)
    first = trial.t < 150.0
    assert not told(replace(trial, **{name: np.where(first, getattr(waves, name), getattr(trial, name))
                                      for name in ("psi", "r", "v_m")}))  # fmt: skip


def test_records_that_cannot_tell():
    trial = in_waves(made(seed=3), 9.0)
    uneven = replace(trial, t=trial.t + 0.1 * np.sin(trial.t))
    assert not told(uneven)
    assert not told(replace(trial, **{name: getattr(trial, name)[:20] for name in
                                      ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")}))  # fmt: skip
    gaps = np.where(np.arange(trial.n_samples) % 50 == 7, np.nan, trial.r)
    assert told(replace(trial, r=gaps))
