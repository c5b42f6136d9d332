"""Channels that nothing measured are known to be derived, in the file too, and count for nothing in a diagnosis."""

import json
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

from mmgtune.diagnose import DiagnoseOptions, diagnose
from mmgtune.errors import TrialError
from mmgtune.importing.motion import with_velocities, with_yaw_rate
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials, read_trial, write_trial
from mmgtune.trial.pieces import windows
from tests.hidden.cases import null
from tests.hidden.plant import simulate, write

from .made import made


def of_positions_and_heading(trial):
    """The trial as a log without speeds and a rate gyro gives it."""
    columns = {"x": trial.x, "y": trial.y, "psi": trial.psi}
    with_yaw_rate(trial.t, columns)
    with_velocities(trial.t, columns)
    return replace(trial, u=columns["u"], v_m=columns["v"], r=columns["r"], derived=("u", "v", "r"))


def test_what_was_measured_is_left():
    trial = replace(made(seed=1), derived=("v", "r"))
    left = trial.as_measured()
    for name in ("v_m", "r"):
        values = getattr(left, name)
        assert values[0] == getattr(trial, name)[0]
        assert np.isnan(values[1:]).all()
    np.testing.assert_array_equal(left.u, trial.u)
    plain = made(seed=1)
    assert plain.as_measured() is plain


def test_files_and_windows_keep_it(tmp_path):
    trial = replace(made(seed=1), derived=("r",))
    assert read_trial(write_trial(trial, tmp_path / "a.parquet")).derived == ("r",)
    assert all(piece.derived == ("r",) for piece in windows(trial, 100.0))
    assert read_trial(write_trial(made(seed=1), tmp_path / "b.parquet")).derived == ()


@pytest.mark.parametrize("derived", ["r", ["n"], [["r"]], {"r": 1}, 3, None])
def test_a_file_that_says_it_wrongly_is_refused(tmp_path, derived):
    path = write_trial(made(seed=1), tmp_path / "a.parquet")
    table = pq.read_table(path)
    facts = json.loads(table.schema.metadata[b"mmgtune"]) | {"derived": derived}
    pq.write_table(table.replace_schema_metadata({b"mmgtune": json.dumps(facts).encode()}), path)
    with pytest.raises(TrialError, match="'derived'"):
        read_trial(path)


@pytest.mark.long
def test_a_log_without_speeds_and_yaw_rate_hides_nothing(tmp_path):
    """What smoothing leaves is no noise of a sensor: taken for one, the rest would be something unknown."""
    case = null(5)
    write(simulate({}, case.effects, case.seed, case.noise), tmp_path)
    trials = load_trials(tmp_path)
    few = {name: of_positions_and_heading(trials.trials[name]) for name in trials.tune}
    asked = DiagnoseOptions(effects=("current", "gyro-bias"), targets=("hull.R_0", "wake.w_P0", "rudder.kappa"))
    said = {}
    for derived in (("u", "v", "r"), ()):
        marked = {name: replace(trial, derived=derived) for name, trial in few.items()}
        said[bool(derived)] = diagnose(load_profile("suzaku"), replace(trials, trials=marked, test=()), asked)
    assert said[True].verdict == "none"
    assert any("u, v, r were derived from other channels in 5 of 5 trials" in one for one in said[True].warnings)
    assert said[False].verdict != "none"
