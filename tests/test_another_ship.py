"""Trials of another ship than the model: results say so, in the words of the commands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import mmgtune
from mmgtune.errors import TrialError
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
    assert f"T{SAID[1:]}." in told.warnings
    assert "another-ship" in told.to_dict()["warning_codes"]
    assert "T" + SAID[1:] in told.summary().replace("\n", " ")
    silent = mmgtune.fit("suzaku", own, QUICK)
    assert "another-ship" not in silent.to_dict()["warning_codes"]


def test_a_list_of_trials_says_so_as_a_set_does(others):
    told = mmgtune.fit("suzaku", list(others), QUICK)
    assert f"T{SAID[1:]}." in told.warnings


def test_others_that_learn_from_trials_say_so(own, others):
    few = mmgtune.PosteriorOptions(particles=10, leave_out=False)
    sweep = mmgtune.SweepOptions(widths=(0.5,), method="least-squares", starts=1, targets=("hull.R_0",))
    left_out = mmgtune.LeaveOutOptions(a_r=0.5, starts=1, targets=("hull.R_0",))
    told = [
        mmgtune.sweep("suzaku", others, sweep).warnings,
        mmgtune.leave_out("suzaku", others, left_out).warnings,
        mmgtune.posterior("suzaku", others, few).warnings,
        mmgtune.posterior("suzaku", list(others), few).warnings,
    ]
    assert all(f"T{SAID[1:]}." in one for one in told)
    assert not any("are of" in one for one in mmgtune.posterior("suzaku", own, few).warnings)


def test_trainings_say_so(own, others):
    """Of networks, ensembles and hybrids by what they hold, of a mixture by the trials that choose its share."""
    networks = mmgtune.LearnOptions(seeds=1, steps=2, validate_every=2, batch=4, width=4, memory=2, horizon=4)
    members = mmgtune.EnsembleOptions(
        members=2, width=4, layers=1, steps=2, validate_every=2, batch=4, horizon=4, initial=2
    )
    hybrid = mmgtune.HybridOptions(steps=2, validate_every=2, batch=4, width=4, step=2.0, refit=False)
    net = mmgtune.learn_rnn("suzaku", others, networks)
    told = [
        net,
        mmgtune.learn_ensemble("suzaku", others, members),
        mmgtune.learn_hybrid("suzaku", others, hybrid),
        mmgtune.learn_mixture("suzaku", net, others),
    ]
    assert [one.warnings for one in told] == [(f"T{SAID[1:]}.",)] * 4
    assert mmgtune.learn_mixture("suzaku", net, own).warnings == ()


def test_a_diagnosis_and_a_check_say_so(own, others):
    found = mmgtune.diagnose("suzaku", others, mmgtune.DiagnoseOptions(effects=("antenna",)))
    assert f"T{SAID[1:]}." in found.warnings
    frame = found.gain.compared.to_frame()
    assert [list(frame["trial"]), set(frame["role"])] == [[one.trial.id for one in found.gain.compared], {"test"}]
    assert np.isfinite(frame[["off track before [m]", "off track after [m]"]]).all(axis=None)
    assert "test" in repr(found.gain.compared)
    baseline = mmgtune.record_baseline("suzaku", own)
    assert SAID in mmgtune.check("suzaku", others, baseline).notes
    assert SAID not in mmgtune.check("suzaku", own, baseline).notes


def test_what_simulates_and_scores_says_so(own, others):
    validated = [mmgtune.validate("suzaku", of).profiles[0].notes for of in (others, list(others), own)]
    simulated = [mmgtune.simulate("suzaku", of).notes for of in (others, list(others), own)]
    predicted = [mmgtune.predict("suzaku", of).notes for of in (others, list(others), own)]
    compared = [mmgtune.compare_models(["suzaku", "suzaku_fam"], of).notes for of in (others, list(others), own)]
    for told in (validated, simulated, predicted, compared):
        assert [sum(SAID in note for note in notes) for notes in told] == [1, 1, 0]


def test_voyages_say_so(tmp_path, own):
    trial = replace(own["turn_p35"], ship="kvlcc2", manoeuvre="voyage")
    mmgtune.write_trial(trial, tmp_path / "log.parquet")
    result = mmgtune.validate_voyages(["suzaku"], tmp_path)
    assert result.notes["suzaku"][0] == SAID
    assert SAID in run("validate", "suzaku", "log.parquet", "--no-report", cwd=tmp_path).err


def test_commands_that_simulate_and_score_say_so(others, tmp_path):
    mmgtune.write_trial(others["turn_p35"], tmp_path / "a.parquet")
    for command in (
        ("validate", "suzaku", "a.parquet"),
        ("simulate", "-p", "suzaku", "-t", "a.parquet"),
        ("predict", "suzaku", "-t", "a.parquet"),
        ("compare", "suzaku", "suzaku_fam", "a.parquet"),
    ):
        assert f"note: {SAID}\n" in run(*command, cwd=tmp_path).err


def test_trials_of_several_ships_are_refused(own):
    mixed = [own["turn_p35"], own["turn_m35"], replace(own["turn_p20"], ship="kvlcc2")]
    ids = [one.id for one in mixed]
    for use in (
        lambda: mmgtune.TrialSet(mixed, ids, []),
        lambda: mmgtune.fit("suzaku", mixed, QUICK),
        lambda: mmgtune.validate("suzaku", mixed),
        lambda: mmgtune.simulate("suzaku", mixed),
        lambda: mmgtune.predict("suzaku", mixed),
        lambda: mmgtune.posterior("suzaku", mixed),
    ):
        with pytest.raises(TrialError) as caught:
            use()
        (problem,) = caught.value.problems
        assert problem.what == "the trials are of 2 ships"
        assert problem.why == "of 'suzaku': turn_p35, turn_m35; of 'kvlcc2': turn_p20"
    named = mmgtune.TrialSet(mixed, ids, [], ship="suzaku")
    assert named.ship == "suzaku"
    assert SAID not in mmgtune.simulate("suzaku", named).notes
    assert mmgtune.TrialSet([replace(own["turn_p35"], ship=""), own["turn_m35"]], [], []).ship == "suzaku"


def test_a_command_says_the_same(others, tmp_path):
    for one in others:
        mmgtune.write_trial(one, tmp_path / f"{one.id}.parquet")
    ended = run("fit", "-p", "suzaku", "-t", ".", "--ar", "0.5", "--dry-run", cwd=tmp_path)
    assert f"warning: {SAID}\n" in ended.err


@pytest.mark.parametrize(("trials", "ship"), [("", "suzaku"), ("suzaku", "suzaku")])
def test_nothing_is_said_of_her_own_and_of_a_ship_that_is_not_named(trials, ship):
    assert another_ship(trials, ship) == []
