"""Logs merged of recordings at several rates: most rows have no value of most columns."""

import numpy as np
import pandas as pd
import pytest

from mmgtune.importing import propose_map
from mmgtune.importing.cells.seldom import held, is_seldom

from .made import MAP, close, imported, logged, turn, write_csv

RATES = (("north", "east"), ("heading", "rate"), ("ahead", "abeam"), ("shaft",), ("rudder",))


def merged(columns, apart=0.1):
    """Columns of different devices, each with stamps of its own, in one table in the order of time."""
    frames = [
        pd.DataFrame({"time": columns["time"] + k * apart, **{name: columns[name] for name in names}})
        for k, names in enumerate(RATES)
    ]
    return pd.concat(frames).sort_values("time", kind="stable")


def test_a_merged_log_is_read_at_its_own_rates(tmp_path):
    trial = turn()
    log = tmp_path / "log.csv"
    merged(logged(trial)).to_csv(log, index=False)
    proposal = propose_map(log)
    assert proposal.asks == proposal.problems == ()
    assert proposal.guesses["delta"].keys == {"unit": "deg", "positive": "starboard"}
    back = imported(log, MAP)
    assert np.allclose(np.diff(back.t), 1.0)
    assert not np.isnan(back.motion).any()
    for name in ("x", "y", "psi", "r", "delta"):
        own, true = getattr(back, name), getattr(trial, name)
        assert np.abs(own - true[1 : 1 + len(own)]).max() < 0.03 * np.ptp(true), name


def test_a_faster_channel_beside_it(tmp_path):
    """A yaw rate at 5 Hz beside positions at 1 Hz: the trial has the step of the positions."""
    trial = turn()
    columns = logged(trial)
    t = np.arange(0.0, columns["time"][-1], 0.2)
    fast = pd.DataFrame({"time": t, "rate": np.interp(t, columns["time"], columns["rate"])})
    slow = pd.DataFrame({name: one for name, one in columns.items() if name != "rate"})
    log = tmp_path / "log.csv"
    pd.merge(fast, slow, on="time", how="outer").to_csv(log, index=False)
    close(imported(log, MAP), trial, 2e-3)


def test_values_missing_now_and_then_stay_gaps(tmp_path):
    columns = logged(turn())
    columns["north"] = columns["north"].copy()
    columns["north"][50:300:7] = np.nan
    back = imported(write_csv(tmp_path / "log.csv", columns))
    assert np.isnan(back.x).sum() == len(range(50, 300, 7))


@pytest.mark.parametrize(
    ("known", "seldom"),
    [([True, False] * 50, True), ([True] * 95 + [False] * 5, False), ([True, True, False] * 30, False), ([], False)],
)
def test_what_is_logged_seldom(known, seldom):
    assert is_seldom(np.array(known, dtype=bool)) is seldom


def test_a_value_stands_until_the_next():
    values = np.array([np.nan, 1.0, np.nan, 2.0, np.nan, 3.0] + [np.nan] * 10)
    assert held(values, 3.0)[:12].tolist()[1:] == [1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0]
    assert np.isnan(held(values, 3.0)[[0, 12, 13, 14, 15]]).all()
