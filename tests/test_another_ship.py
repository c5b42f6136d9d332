"""Trials of another ship than the model: results say so, in the words of the commands."""

from __future__ import annotations

from dataclasses import replace

import pytest

import mmgtune
from mmgtune.trial import another_ship
from tests.command import run

QUICK = mmgtune.FitOptions(a_r=0.5, method="least-squares", starts=1, targets=("hull.R_0",))
SAID = "the trials are of 'kvlcc2', the model is of 'suzaku'"


@pytest.fixture(scope="module")
def own():
    return mmgtune.load_trials("suzaku")


@pytest.fixture(scope="module")
def others(own):
    """Three turns, said to be of another ship."""
    trials = [replace(own[id], ship="kvlcc2") for id in ("turn_p35", "turn_m35", "turn_p20")]
    return mmgtune.TrialSet(trials, tune=[one.id for one in trials], test=[])


def test_a_fit_says_so(own, others):
    told = mmgtune.fit("suzaku", others, QUICK)
    assert f"T{SAID[1:]}." in told.warnings()
    assert "another-ship" in told.to_dict()["warning_codes"]
    assert "T" + SAID[1:] in told.summary().replace("\n", " ")
    silent = mmgtune.fit("suzaku", own, QUICK)
    assert "another-ship" not in silent.to_dict()["warning_codes"]


def test_a_list_of_trials_says_so_as_a_set_does(others):
    told = mmgtune.fit("suzaku", list(others), QUICK)
    assert f"T{SAID[1:]}." in told.warnings()


def test_others_that_learn_from_trials_say_so(own, others):
    few = mmgtune.PosteriorOptions(particles=10, leave_out=False)
    sweep = mmgtune.SweepOptions(widths=(0.5,), method="least-squares", starts=1, targets=("hull.R_0",))
    left_out = mmgtune.LeaveOutOptions(a_r=0.5, starts=1, targets=("hull.R_0",))
    told = [
        mmgtune.sweep("suzaku", others, sweep).warnings(),
        mmgtune.leave_out("suzaku", others, left_out).warnings,
        mmgtune.posterior("suzaku", others, few).warnings(),
        mmgtune.posterior("suzaku", list(others), few).warnings(),
    ]
    assert all(f"T{SAID[1:]}." in one for one in told)
    assert not any("are of" in one for one in mmgtune.posterior("suzaku", own, few).warnings())


def test_a_diagnosis_and_a_check_say_so(own, others):
    found = mmgtune.diagnose("suzaku", others, mmgtune.DiagnoseOptions(effects=("antenna",)))
    assert f"T{SAID[1:]}." in found.warnings
    baseline = mmgtune.record_baseline("suzaku", own)
    assert SAID in mmgtune.check("suzaku", others, baseline).notes
    assert SAID not in mmgtune.check("suzaku", own, baseline).notes


def test_a_command_says_the_same(others, tmp_path):
    for one in others:
        mmgtune.write_trial(one, tmp_path / f"{one.id}.parquet")
    ended = run("fit", "-p", "suzaku", "-t", ".", "--ar", "0.5", "--dry-run", cwd=tmp_path)
    assert f"warning: {SAID}\n" in ended.err


@pytest.mark.parametrize(("trials", "ship"), [("", "suzaku"), ("suzaku", "suzaku")])
def test_nothing_is_said_of_her_own_and_of_a_ship_that_is_not_named(trials, ship):
    assert another_ship(trials, ship) == []
