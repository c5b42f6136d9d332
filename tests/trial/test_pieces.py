"""Long trials cut into windows."""

import numpy as np

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
