"""Long trials cut into windows."""

import numpy as np
import pytest

from mmgtune.objective import make_objective
from mmgtune.trial import TrialSet, windows
from tests.trial.made import made, with_value


def test_windows_cover_the_trial_and_meet_in_one_sample():
    trial = made(samples=250, dt=0.5)
    pieces = windows(trial, 30.0)
    assert [piece.id for piece in pieces] == [f"{trial.id}@{start}" for start in (0, 30, 60, 90, 120)]
    assert all(piece.t[0] == 0.0 and piece.part_of == trial.id and piece.run == trial.id for piece in pieces)
    assert sum(piece.n_samples - 1 for piece in pieces) == trial.n_samples - 1
    np.testing.assert_array_equal(pieces[1].motion[0], pieces[0].motion[-1])
    assert pieces[-1].duration < 30.0


def test_a_length_shorter_than_a_step_comes_to_an_end():
    """Began at the same sample for ever."""
    trial = made(samples=50)
    for length in (1e-12, 1e-9, 0.3):
        assert all(piece.n_samples > 2 for piece in windows(trial, length))


def test_a_window_begins_behind_a_gap():
    trial = with_value(made(samples=100), "x", slice(28, 35), np.nan)
    pieces = windows(trial, 30.0)
    assert [piece.id.partition("@")[2] for piece in pieces] == ["0", "35", "65"]  # the last five samples join
    assert all(np.isfinite(piece.motion[0]).all() for piece in pieces)


def test_extra_columns_and_roles_go_with_the_windows():
    tuned, tested = made("a", extra={"wind_speed": np.arange(500.0)}), made("b")
    cut = TrialSet({"a": tuned, "b": tested}, ("a",), ("b",)).in_windows(200.0)
    assert cut.tune == ("a@0", "a@200", "a@400")
    assert cut.role("b@200") == "test"
    assert cut.trials["a@200"].extra["wind_speed"][0] == 200.0


def test_every_window_has_a_sample_that_counts():
    """Fewer than two seconds are left at the end, and one sample in two seconds counts."""
    trial = made(samples=612, dt=0.1)
    assert [piece.id.partition("@")[2] for piece in windows(trial, 30.0)] == ["0", "30", "60"]
    pieces = windows(trial, 30.0, every=2.0)
    assert [piece.id.partition("@")[2] for piece in pieces] == ["0", "30"]
    assert pieces[-1].duration == pytest.approx(31.1)
    objective = make_objective(10.0, every=2.0)
    assert all(objective.weight(piece).any() for piece in pieces)


def test_a_window_lasts_until_a_sample_counts():
    trial = made(samples=600, dt=0.1)
    gap = with_value(trial, "v_m", slice(205, 390), np.nan)
    pieces = windows(gap, 10.0, every=2.0)
    # That from 20 s holds 0.5 s of samples and the end of the gap, which does not count: it lasts until 40 s.
    assert [piece.id.partition("@")[2] for piece in pieces] == ["0", "10", "20", "40", "50"]
    objective = make_objective(10.0, every=2.0)
    assert all(objective.weight(piece)[np.isfinite(piece.motion).all(axis=1)].any() for piece in pieces)
    short = windows(trial, 1.0, every=2.0)
    assert [piece.duration for piece in short] == pytest.approx([2.0] * 28 + [3.9])


def test_windows_with_every_are_the_same_where_each_had_a_sample():
    trial = with_value(made(samples=400, dt=0.5), "x", slice(101, 110), np.nan)
    ids = [piece.id for piece in windows(trial, 30.0)]
    assert [piece.id for piece in windows(trial, 30.0, every=2.0)] == ids
