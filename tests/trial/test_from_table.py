"""Trials from tables in memory, as in a notebook."""

from dataclasses import replace
from decimal import Decimal

import numpy as np
import pandas as pd
import pytest

import mmgtune
from mmgtune.errors import TrialError
from mmgtune.trial import load_trials, trial_of, write_trial
from mmgtune.trial.parquet import read_trial


@pytest.fixture
def table():
    trial = load_trials("suzaku")["turn_p35"]
    return pd.DataFrame(trial.columns)


def test_a_table_of_columns_is_a_trial(table, tmp_path):
    trial = trial_of(table.assign(mode="auto", torque=1.0), "one", ship="suzaku", source="measured")
    assert (trial.id, trial.ship, trial.source) == ("one", "suzaku", "measured")
    np.testing.assert_array_equal(trial.motion, table[["x", "y", "psi", "u", "v", "r"]])
    assert trial.ignored == ("mode",)
    assert trial.extra["torque"].tolist() == [1.0] * len(table)
    assert np.array_equal(read_trial(write_trial(trial, tmp_path / "one.parquet")).motion, trial.motion)
    assert len(mmgtune.validate("suzaku", trial).profiles) == 1


def test_time_may_be_the_index_and_a_dict_will_do(table):
    usual = trial_of(table, "one")
    for other in (table.set_index("t"), dict(table), {name: table[name].tolist() for name in table}):
        np.testing.assert_array_equal(trial_of(other, "one").t, usual.t)


@pytest.mark.parametrize("zone", [None, "Asia/Tokyo"])
def test_dates_and_times_of_an_index_count_from_the_first(table, zone):
    seconds = pd.to_timedelta(np.asarray(table["t"]), unit="s")
    others = pd.DataFrame(table).drop(columns="t")
    for index in (pd.Timestamp("2026-03-01 23:59:50", tz=zone) + seconds, seconds):
        trial = trial_of(others.set_axis(index, axis=0), "a")
        np.testing.assert_allclose(trial.t, np.asarray(table["t"]) - table["t"].iloc[0], atol=1e-9)


@pytest.mark.parametrize("made", [pd.DataFrame, dict])
def test_dates_and_times_in_the_column_of_time_count_from_the_first(table, made):
    """They were "no numbers", and what pandas.to_numeric makes of them is not seconds."""
    stamps = pd.Timestamp("2026-03-01 23:59:50") + pd.to_timedelta(np.asarray(table["t"]), unit="s")
    trial = trial_of(made(pd.DataFrame(table).assign(t=stamps)), "a")
    np.testing.assert_allclose(trial.t, np.asarray(table["t"]) - table["t"].iloc[0], atol=1e-9)


def test_a_name_that_a_frame_has_twice_is_told(table):
    frame = pd.concat([pd.DataFrame(table), pd.DataFrame(table)[["x"]]], axis=1)
    with pytest.raises(TrialError, match="column 'x' is there twice"):
        trial_of(frame, "a")


def test_a_frame_goes_back_into_a_trial():
    trial = next(iter(load_trials("suzaku")))
    again = trial_of(trial.to_frame(), trial.id)
    assert list(again.columns) == list(trial.columns)
    for name, values in trial.columns.items():
        np.testing.assert_array_equal(again.columns[name], values)
    (motion,) = mmgtune.simulate("suzaku", [trial])
    assert list(motion.to_frame())[:6] == list(trial.to_frame())[:6]
    np.testing.assert_array_equal(trial_of(motion.to_frame().reset_index(), "simulated").motion, motion.states)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda table: table.drop(columns="r"), "column 'r' is missing"),
        (lambda table: table.rename(columns={"psi": "Psi"}), "rename Psi to psi"),
        (lambda table: table.assign(delta=table.delta * 57.3), "probably in degrees"),
        (
            lambda table: table.assign(u="fast"),
            "column 'u' holds no numbers (one)\n  why: it begins with 'fast', a str",
        ),
        (lambda table: table.assign(x=table.x.astype(str)), "by pandas.to_numeric(table['x'])"),
        (lambda table: table.assign(t=table.t.astype(str)), "column 't' holds no numbers"),
        (lambda table: {**table, "u": table.u[:9]}, "samples, 'u' 9"),
        (lambda table: table.rename(columns={"psi": "psi [deg]"}), "give it as 'psi [rad]'"),
        (lambda table: table.assign(**{"u [m/s]": table.u}), "'u' is there twice"),
        (lambda _: [1, 2, 3], "this is no table"),
        (lambda table: table.iloc[::-1], "time"),
    ],
)
def test_what_is_wrong_is_said_as_of_a_file(table, change, said):
    with pytest.raises(TrialError) as found:
        trial_of(change(table), "one")
    assert said in str(found.value)


@pytest.mark.parametrize(
    ("names", "what"),
    [
        (["time", "lat", "lon", "hdg", "sog"], "the table has none of the columns of a trial"),
        (["t", "x", "y", "heading", "speed"], "the table lacks most columns of a trial"),
        ([], "the table has none of the columns of a trial"),
    ],
)
def test_a_table_with_other_columns_has_one_problem(names, what):
    with pytest.raises(TrialError) as found:
        trial_of(pd.DataFrame({name: np.arange(60.0) for name in names}), "one")
    (problem,) = found.value.problems
    assert problem.what == what
    assert "a trial has t [s], x [m], y [m], psi [rad], u [m/s], v [m/s], r [rad/s], n [1/s] and delta" in problem.why
    assert all(f"'{name}'" in problem.why for name in names)
    assert 'table.to_csv("log.csv", index=False), then mmgtune trials map log.csv' in problem.fix


@pytest.mark.parametrize("id", ["", "  "])
def test_an_empty_id_is_refused(table, id):
    for make in (
        lambda: trial_of(table, id),
        lambda: mmgtune.TrialSet([replace(trial_of(table, "a"), id=id)], [id], []),
        lambda: mmgtune.fit("suzaku", [replace(trial_of(table, "a"), id=id)]),
    ):
        with pytest.raises(TrialError, match="the id of a trial is empty"):
            make()


def test_positions_in_degrees_of_a_table_are_not_looked_for_in_a_file_of_its_id(table):
    with pytest.raises(TrialError) as found:
        trial_of(table.rename(columns={"x": "lat", "y": "lon"}), "one")
    assert "trials map one" not in str(found.value)
    assert "trials map log.csv" in str(found.value)


@pytest.mark.parametrize(
    "gap",
    [
        lambda x: x.astype(object).where(x.index != 5, None),
        lambda x: x.astype("Float64").where(x.index != 5, pd.NA),
        lambda x: x.where(x.index != 5).map(lambda value: Decimal(repr(value))),
        lambda x: np.ma.masked_array(x, x.index == 5),
    ],
    ids=["None", "<NA>", "Decimal", "masked"],
)
def test_gaps_as_tables_have_them(table, gap):
    """A masked sample was taken for measured, and a column with a None for empty."""
    trial = trial_of({**table, "x": gap(table.x)}, "one")
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(trial.x)), [5])
    np.testing.assert_array_equal(np.delete(trial.x, 5), np.delete(table.x.to_numpy(), 5))


def test_a_fact_that_no_trial_has(table):
    with pytest.raises(TrialError, match="no fact 'vessel'"):
        trial_of(table, "one", vessel="suzaku")


@pytest.mark.parametrize("id", ["../esc", "a/b", "a\\b", "..", "new\nline", "a" * 300, 3])
def test_an_id_that_cannot_name_a_file(table, tmp_path, id):
    """Results of the trial were written beside the folder that was asked for."""
    with pytest.raises(TrialError, match=r"cannot be the name of a file|too many|not text"):
        trial_of(table, id)
    whole = replace(trial_of(table, "one"), id=id)
    with pytest.raises(TrialError, match=r"cannot be the name of a file|too many|not text"):
        write_trial(whole, tmp_path / "one.parquet")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("facts", "said"),
    [
        ({"source": "guessed"}, "source is 'guessed'"),
        ({"noise": {"x": -1.0}}, "not a standard deviation"),
        ({"noise": {"x": 10**400}}, "not a standard deviation"),
        ({"noise": {"x": float("nan")}}, "noise of 'x' is nan"),
        ({"noise": {"z": 1.0}}, "noise of unknown column 'z'"),
        ({"derived": ("delta",)}, "not a list of motion columns"),
        ({"ship": None}, "'ship' is None, not text"),
    ],
)
def test_facts_that_no_file_may_have(table, tmp_path, facts, said):
    with pytest.raises(TrialError) as found:
        trial_of(table, "one", **facts)
    assert said in str(found.value)
    with pytest.raises(TrialError) as found:
        write_trial(replace(trial_of(table, "one"), **facts), tmp_path / "one.parquet")
    assert said in str(found.value)


def test_facts_of_numpy_are_written(table, tmp_path):
    trial = trial_of(table, "one", noise={"x": np.float32(0.5)}, derived=("u", "v"))
    read = read_trial(write_trial(trial, tmp_path / "one.parquet"))
    assert (read.noise, read.derived) == ({"x": 0.5}, ("u", "v"))


def test_a_table_of_no_rows_is_told_so_whatever_its_index_is(table):
    others = table.drop(columns="t").iloc[:0]
    for index in (pd.DatetimeIndex([]), pd.DatetimeIndex([], tz="Asia/Tokyo"), pd.to_timedelta([])):
        with pytest.raises(TrialError) as found:
            trial_of(others.set_axis(index, axis=0), "one")
        (problem,) = found.value.problems
        assert problem.what == "the trial has no samples"
    with pytest.raises(TrialError) as found:
        trial_of(pd.DataFrame(index=pd.DatetimeIndex([])), "one")
    assert "None" not in str(found.value)


def test_a_trial_of_which_nothing_is_said_prints_without_a_hole(table):
    assert repr(trial_of(table, "one")) == f"Trial(one: {len(table)} samples)"
    assert repr(trial_of(table, "one", manoeuvre="turning")) == f"Trial(one: turning, {len(table)} samples)"
