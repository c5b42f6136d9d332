"""A sensor that shows another factor from some time on is told, and no other habit of a sensor is taken for one."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.diagnose import diagnose
from mmgtune.options import DiagnoseOptions
from mmgtune.physics.frame import to_earth
from mmgtune.trial import check_trial, load_trials
from mmgtune.trial.checks.in_parts import changes_within
from mmgtune.units import DEG

TRIALS = load_trials("suzaku").trials
ZIGZAG, TURN = TRIALS["zigzag_20"], TRIALS["turn_p35"]


def later(trial, factor, share=0.5):
    """1, and the factor from a share of the trial on, (n_samples,)."""
    return np.where(np.arange(trial.n_samples) < share * trial.n_samples, 1.0, factor)


@pytest.mark.parametrize("factor", [0.8, 0.9, 1.15])
@pytest.mark.parametrize("share", [0.4, 0.6])
def test_a_gyro_that_changes_its_factor_is_told_with_the_row(factor, share):
    wrong = replace(ZIGZAG, r=ZIGZAG.r * later(ZIGZAG, factor, share))
    (found,) = changes_within(wrong).values()
    assert found.before == pytest.approx(1.0, abs=0.02)
    assert found.behind == pytest.approx(1.0 / factor, rel=0.03)
    assert abs(found.row - share * ZIGZAG.n_samples) < 0.08 * ZIGZAG.n_samples
    (warning,) = [one for one in check_trial(wrong) if "changes within the run" in one.what]
    assert "'r'" in warning.what
    assert "times from about" in warning.why
    assert "NaN" in warning.fix


@pytest.mark.parametrize("factor", [0.85, 1.15])
def test_so_is_a_speed_log(factor):
    assert [*changes_within(replace(TURN, u=TURN.u * later(TURN, factor)))] == ["u"]


def test_noise_of_the_yaw_rate_that_fades_slowly_is_none():
    """Its sums walk at random: one run in twelve was told to have a gyro that fails."""
    rng, kept = np.random.default_rng(5), np.exp(-1.0 / 40.0)
    told = []
    for _ in range(60):
        noise = np.zeros(ZIGZAG.n_samples)
        for k, step in enumerate(rng.normal(0.0, 0.06 * DEG * np.sqrt(1.0 - kept**2), len(noise) - 1)):
            noise[k + 1] = kept * noise[k] + step
        told.append(bool(changes_within(replace(ZIGZAG, r=ZIGZAG.r + noise))))
    assert sum(told) <= 2


@pytest.mark.parametrize("trial", TRIALS.values(), ids=lambda one: one.id)
def test_other_habits_are_none(trial):
    t, r = trial.t, trial.r
    others = {
        "as it is": trial,
        "a factor throughout": replace(trial, r=0.9 * r, u=1.1 * trial.u),
        "a zero error": replace(trial, r=r + 0.05 * DEG),
        "one that grows": replace(trial, r=r + 0.1 * DEG * t / t[-1]),
        "a compass that deviates": replace(trial, psi=trial.psi + 4.0 * DEG * np.sin(trial.psi + 0.7)),
        "a late heading": replace(trial, psi=np.interp(t - 4.0, t, trial.psi)),
        "a current": replace(trial, x=trial.x + 0.3 * t, y=trial.y - 0.2 * t),
        "a tide": replace(trial, x=trial.x + 0.0005 * t**2),
        "an antenna": replace(trial, **dict(zip("xy", _moved(trial, 30.0, 5.0), strict=True))),
        "gaps": replace(trial, r=np.where(np.arange(trial.n_samples) % 7 == 3, np.nan, r)),
    }
    assert {name: found for name, one in others.items() if (found := changes_within(one))} == {}


def _moved(trial, x, y):
    north, east = to_earth(trial.psi, x, y)
    return trial.x + north, trial.y + east


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e8, 1e120])
@pytest.mark.parametrize("names", [("u", "v_m"), ("x", "y"), ("r", "psi"), ("u", "v_m", "r", "psi", "x", "y")])
def test_ships_at_rest_and_beyond_the_world_say_nothing(size, names):
    odd = {name: size * np.sign(getattr(TURN, name)) for name in names}
    assert changes_within(replace(TURN, **odd)) == {}


def test_a_short_record_says_nothing():
    cut = {name: getattr(ZIGZAG, name)[:100] for name in ("t", "x", "y", "psi", "u", "v_m", "r", "n", "delta")}
    assert changes_within(replace(ZIGZAG, **cut, extra={})) == {}


@pytest.mark.long
def test_a_diagnosis_does_not_call_it_noise(suzaku):
    """Taken for noise that lasts for minutes it would pass for nothing."""
    wrong = [replace(one, r=one.r * later(one, 0.9)) for one in (ZIGZAG, TRIALS["zigzag_10"])]
    result = diagnose(suzaku.profile, wrong, DiagnoseOptions(effects=("current", "gyro-bias")))
    assert result.verdict == "unexplained"
    assert result.of_a_sensor
    assert "the yaw rate reads by another factor from some time on in zigzag_10 and zigzag_20" in result.sentence()
    odd = "the factor of the yaw rate changes (zigzag_10, and 1 more alike)"
    assert f"without what is odd: {odd}" in result.whereabouts.suggestion
    right = diagnose(suzaku.profile, [ZIGZAG, TURN], DiagnoseOptions(effects=("current", "gyro-bias")))
    assert (right.verdict, right.leftover.changed) == ("none", {})
