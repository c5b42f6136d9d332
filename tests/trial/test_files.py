"""Trial files: what goes in comes out."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mmgtune import trial_of
from mmgtune.errors import OutputError, TrialError
from mmgtune.trial import Trial, check_trial, load_trials, read_trial, write_trial

COLUMNS = ("x", "y", "psi", "u", "v_m", "r", "n", "delta")


def straight(seconds=60, **changes):
    """A ship going north-east at 3 m/s."""
    t = np.arange(seconds + 1.0)
    psi = np.full(len(t), np.pi / 4)
    columns = {
        "t": t, "x": 3 * t * np.cos(psi), "y": 3 * t * np.sin(psi), "psi": psi, "u": np.full(len(t), 3.0),
        "v_m": 0 * t, "r": 0 * t, "n": 1.7 + 0 * t, "delta": 0 * t,
    }  # fmt: skip
    return Trial(**{"id": "run", "ship": "s", "manoeuvre": "straight", "source": "measured", **columns, **changes})


@settings(max_examples=25, deadline=None)
@given(values=hnp.arrays(float, (8, 5), elements=st.floats(-0.1, 0.1)), note=st.text(max_size=40))
def test_round_trip(tmp_path_factory, values, note):
    assume(values.any())  # a record in which nothing moves is refused
    path = tmp_path_factory.mktemp("trial") / "a.parquet"
    trial = straight(
        4, **dict(zip(COLUMNS, values, strict=True)), note=note, extra={"wind_speed": values[0]}, noise={"x": 0.5}
    )
    write_trial(trial, path)
    read = read_trial(path)
    for name in ("t", *COLUMNS):
        assert np.array_equal(getattr(read, name), getattr(trial, name))
    assert np.array_equal(read.extra["wind_speed"], values[0])
    assert (read.id, read.ship, read.note, read.noise, read.source) == ("run", "s", note, {"x": 0.5}, "measured")


def test_a_file_without_metadata_still_loads(tmp_path):
    import pyarrow.parquet as pq

    path = write_trial(straight(), tmp_path / "somewhere.parquet")
    pq.write_table(pq.read_table(path).replace_schema_metadata(None), path)
    trial = read_trial(path)
    assert (trial.id, trial.ship, trial.source) == ("somewhere", "", "")
    assert load_trials(path).tune == ("somewhere",)


def test_arrays_are_read_only():
    with pytest.raises(ValueError, match="read-only"):
        straight().x[0] = 1.0


def test_existing_files_are_kept(tmp_path):
    path = write_trial(straight(), tmp_path / "a.parquet")
    with pytest.raises(OutputError, match="exists already"):
        write_trial(straight(30), path)
    assert read_trial(path).n_samples == 61


def test_a_sound_trial_has_no_warnings():
    assert [f for f in check_trial(straight()) if f.severity == "warning"] == []


def turning(side=1.0):
    t = np.arange(301.0)
    r = np.where(t > 20, 0.015 * side, 0.0)
    psi = np.concatenate([[0.0], np.cumsum(0.5 * (r[1:] + r[:-1]))])
    middle = 0.5 * (psi[1:] + psi[:-1])
    x, y = (np.concatenate([[0.0], np.cumsum(3.0 * f(middle))]) for f in (np.cos, np.sin))
    return straight(
        300, psi=psi, r=r, x=x, y=y, delta=np.where(t > 20, 0.3 * side, 0.0) * np.minimum(1, (t - 20) / 10).clip(0)
    )


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        (lambda trial: {"psi": (trial.psi + np.pi) % (2 * np.pi)}, "jumps by a full turn"),
        (lambda trial: {"r": -trial.r}, "turn opposite ways"),
        (lambda trial: {"delta": -trial.delta}, "turns away from its rudder"),
        (lambda trial: {"u": np.gradient(trial.x), "v_m": np.gradient(trial.y)}, "fit if read in earth axes"),
        (lambda trial: {"u": 2 * trial.u}, "do not integrate to the positions"),
        (lambda trial: {"n": 102 + 0 * trial.t}, "probably per minute"),
        (lambda trial: {"delta": np.where(trial.t > 20, 0.5, 0.0)}, "may be orders"),
    ],
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_what_is_odd_is_said(changes, word, side):
    trial = turning(side)
    assert not [f for f in check_trial(trial) if f.severity == "warning"]
    odd = {**{n: getattr(trial, n) for n in ("t", *COLUMNS)}, **changes(trial)}
    found = check_trial(straight(300, **odd))
    assert any(word in f"{f.what} {f.why}" for f in found), found


def test_bundled_trials_are_labelled_generated_and_sound():
    data = load_trials("suzaku")
    assert {trial.source for trial in data.trials.values()} == {"generated"}
    assert len(data.tune) == len(data.test) == 4
    for trial in data.trials.values():
        assert "Generated, not measured" in trial.note
        assert [f for f in check_trial(trial) if f.severity == "warning"] == []


@pytest.mark.parametrize("antenna", [(-120.0, 6.5), None])
def test_where_positions_were_moved_from_is_kept(antenna, tmp_path):
    trial = replace(load_trials("suzaku").trials["turn_p35"], antenna=antenna)
    assert read_trial(write_trial(trial, tmp_path / "trial.parquet")).antenna == antenna
    assert replace(trial, antenna=list(antenna) if antenna else None).antenna == antenna
    assert trial_of(trial.columns, "one", antenna=(3.0, 1)).antenna == (3.0, 1.0)


@pytest.mark.parametrize("antenna", [(1.0,), (1.0, 2e3), (float("nan"), 0.0), (True, 0.0), ("3 m", 0.0)])
def test_an_antenna_that_is_on_no_ship_is_refused(antenna):
    trial = load_trials("suzaku").trials["turn_p35"]
    with pytest.raises(TrialError, match="no place on a ship"):
        replace(trial, antenna=antenna)
    with pytest.raises(TrialError, match="no place on a ship"):
        trial_of(trial.columns, "one", antenna=antenna)
