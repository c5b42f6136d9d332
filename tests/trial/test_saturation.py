"""A sensor at the end of its range is told; rest, few digits and smooth data are not."""

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.trial import check_trial, load_trials
from mmgtune.trial.checks.sensor_ends import ends_of, without_ends

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


@pytest.mark.parametrize("name", ["turn_p10", "turn_m10", "zigzag_20"])
def test_a_speed_log_that_ends_is_told_and_nothing_else_of_it(name):
    trial = SUZAKU[name]
    ended = replace(trial, u=noisy(np.minimum(trial.u, 2.6), 0.02))
    warnings = [one for one in check_trial(ended) if one.severity == "warning"]
    assert [one.what for one in warnings if one.code == "saturated"] == ["the speed log ends at 2.6 m/s"]
    assert not [one for one in warnings if "factor of 'u'" in one.what or "do not integrate" in one.what]
    for other in (0.75 * trial.u, noisy(np.maximum(trial.u, 2.8), 0.02)):  # a scale, and a log that begins somewhere
        assert not told(replace(trial, u=other))


def test_all_runs_together_show_where_a_log_ends():
    """A gentle zigzag is beyond the end from first to last, and shows a speed that hardly changes."""
    gentle = replace(SUZAKU["zigzag_10"], u=noisy(np.minimum(SUZAKU["zigzag_10"].u, 2.6), 0.02))
    hard = replace(SUZAKU["turn_p35"], u=noisy(np.minimum(SUZAKU["turn_p35"].u, 2.6), 0.02))
    ends = ends_of([gentle, hard])
    assert list(ends) == ["u"]
    assert ends["u"].value == pytest.approx(2.6, abs=0.01)
    assert ends_of(SUZAKU.values()) == ends_of([]) == {}
    kept = without_ends(gentle, ends)
    assert kept.u[0] == pytest.approx(SUZAKU["zigzag_10"].u[0], abs=0.15)  # by its positions
    assert np.isnan(kept.u[1:][SUZAKU["zigzag_10"].u[1:] > 2.65]).all()
    below = SUZAKU["turn_p35"].u < 2.4
    assert below.any()
    assert np.array_equal(without_ends(hard, ends).u[below], hard.u[below])
    assert without_ends(hard, {}) is hard


@pytest.mark.parametrize("factor", [3.6, 60.0])
def test_positions_in_another_unit_are_no_end_of_the_log(factor):
    trial = SUZAKU["turn_p35"]
    assert not told(replace(trial, x=factor * trial.x, y=factor * trial.y))


@pytest.mark.parametrize("axis", ["x", "y"])
def test_positions_too_long_along_one_axis_are_no_end_of_the_log(axis):
    trial = made(seed=1)
    assert not ends_of([replace(trial, **{axis: 1.3 * getattr(trial, axis)})])


def test_a_yaw_rate_that_ends_below_noise_is_told():
    trial = SUZAKU["turn_p35"]
    end = 45.0 / 60.0 * DEG
    (found,) = told(replace(trial, r=noisy(np.clip(trial.r, -end, end), 0.03 * DEG)))
    assert found.what.startswith("the yaw rate ends at 0.7")
    assert not [one for one in check_trial(replace(trial, r=np.clip(trial.r, -end, end))) if one.code == "yaw-rate"]
    assert not told(replace(trial, r=0.8 * trial.r))  # a scale is no end
