"""Runs that were stopped: they say so, recommend nothing, and come to the same numbers when they are continued."""

import json
import signal
from dataclasses import replace

import numpy as np
import pytest

import mmgtune
from mmgtune.backends import Integrator
from mmgtune.errors import OptionError
from mmgtune.fitting import FitOptions, Hooks, LeaveOutOptions, SweepOptions, leave_out, sweep, write_left_out
from mmgtune.fitting import folder as run_folder
from mmgtune.fitting.checkpoint import Checkpoint
from mmgtune.fitting.setting import make_setting
from mmgtune.run_files import JOURNAL
from mmgtune.trial import load_trials, write_trial
from mmgtune.trial.schema import ATTRIBUTES
from tests.command import run, run_until
from tests.fitting.conftest import solve_asked

CLOCK = {"created", "wall_s", "command", "out"}
FEW = ("hull.R_0", "wake.w_P0", "rudder.kappa")


def same(document):
    """A document without what may differ between two runs."""
    if isinstance(document, dict):
        return {key: same(value) for key, value in document.items() if key not in CLOCK}
    return [same(one) for one in document] if isinstance(document, list) else document


IN_THREE = LeaveOutOptions(targets=FEW, starts=1, folds=3)


@pytest.fixture(scope="module")
def in_three(tmp_path_factory):
    """A whole leave-out in three parts, and its journal."""
    folder = tmp_path_factory.mktemp("whole")
    whole = leave_out("suzaku", "suzaku", IN_THREE, folder=folder)
    return same(whole.to_dict()), (folder / JOURNAL).read_bytes()


def stopping(phase):
    """Hooks that stop the run when a phase begins whose words hold ``phase``, and those begun."""
    begun = []
    hooks = Hooks(on_phase=begun.append, stop=lambda: any(phase in words for words in begun))
    return hooks, begun


def lines(folder):
    return (folder / JOURNAL).read_text().splitlines()


@pytest.mark.long
def test_a_stopped_leave_out_tells_what_it_has_and_goes_on(tmp_path):
    options = LeaveOutOptions(targets=FEW, starts=1)
    whole = leave_out("suzaku", "suzaku", options)
    hooks, _ = stopping("leaving out turn_m")
    cut = leave_out("suzaku", "suzaku", options, hooks=hooks, folder=tmp_path)
    assert cut.interrupted
    assert 0 < len(cut.parts) < cut.n_parts == len(whole.parts)
    assert cut.rows()[0]["runs"] == len(cut.parts)
    assert cut.to_dict()["interrupted"]
    noted = len(lines(tmp_path))
    assert noted == 1 + 1 + len(cut.parts)  # what it belongs to, the fit to all, a line a part
    hooks, begun = stopping("never")
    resumed = leave_out("suzaku", "suzaku", options, hooks=hooks, folder=tmp_path, resume=True)
    assert same(resumed.to_dict()) == same(whole.to_dict())
    assert len(begun) == 1 + len(whole.parts)
    assert (tmp_path / JOURNAL).exists()  # as long as its result is nowhere else
    write_left_out(resumed, tmp_path)
    assert not (tmp_path / JOURNAL).exists()


def test_stopped_before_the_first_part(tmp_path):
    """Ended in a ValueError of an array without elements."""
    cut = leave_out("suzaku", "suzaku", LeaveOutOptions(targets=FEW, starts=1), hooks=Hooks(stop=lambda: True))
    assert cut.interrupted
    assert cut.rows() == []
    json.dumps(cut.to_dict(), allow_nan=False)


def test_a_stopped_sweep_recommends_nothing_and_goes_on(tmp_path):
    options = SweepOptions(widths=(0.2, 0.4, 0.5), targets=FEW, starts=2, method="least-squares")
    whole = sweep("suzaku", "suzaku", options)
    hooks, _ = stopping("a_r = 0.4")
    cut = sweep("suzaku", "suzaku", options, hooks=hooks, folder=tmp_path)
    assert cut.interrupted
    assert cut.recommended()["a_r"] is None
    assert "stopped" in cut.recommended()["sentence"]
    assert cut.overfitting()["found"] is None
    assert (tmp_path / "ar_0.2" / "fit.json").exists()
    with pytest.raises(OptionError, match="different now: method"):
        sweep("suzaku", "suzaku", SweepOptions(widths=(0.2, 0.4), starts=2), folder=tmp_path, resume=True)
    resumed = sweep("suzaku", "suzaku", options, folder=tmp_path, resume=True)
    assert same(resumed.to_dict()) == same(whole.to_dict())
    assert not (tmp_path / JOURNAL).exists()


def test_the_journal_tells_problems_apart(suzaku):
    """Of one fit with parts left out, the box and the starts are the same throughout."""
    trials = load_trials("suzaku")
    options = FitOptions(targets=FEW)
    setting = make_setting(suzaku.profile, trials, options)
    problem = setting.problem(("turn_p35", "turn_m35"))
    problems = [
        problem,
        setting.problem(("turn_p35", "turn_p10")),
        problem.with_integrator(Integrator("euler")),
        problem.with_cases(replace(problem.cases, weight=2.0 * problem.cases.weight)),
        problem.estimated(np.full((2, 6), 0.1)),
        problem.with_offsets(np.full((2, 6), 0.1)),
    ]
    starts = np.full((3, 1), 0.5)
    asked = {solve_asked(one, starts, ridge=0.0) for one in problems}
    asked |= {solve_asked(problem, starts, ridge=0.1), solve_asked(problem, starts, whiten=abs, ridge=0.0)}
    assert len(asked) == len(problems) + 2
    assert solve_asked(setting.problem(("turn_p35", "turn_m35")), starts, ridge=0.0) in asked
    assert solve_asked(problem, starts) in asked  # a default that is not given is the same


def test_half_a_line_at_the_end_is_done_again(tmp_path, in_three):
    hooks, _ = stopping("leaving out turn_p35")
    leave_out("suzaku", "suzaku", IN_THREE, hooks=hooks, folder=tmp_path)
    text = (tmp_path / JOURNAL).read_text()
    (tmp_path / JOURNAL).write_text(text[:-40])
    resumed = leave_out("suzaku", "suzaku", IN_THREE, folder=tmp_path, resume=True)
    assert same(resumed.to_dict()) == in_three[0]


def test_a_journal_of_an_earlier_form_is_refused(tmp_path, in_three):
    """Its results hold no counts: read on, they ended in a TypeError."""
    head, _, rest = in_three[1].partition(b"\n")
    earlier = head.replace(b'"schema": 3', b'"schema": 1')
    assert earlier != head
    (tmp_path / JOURNAL).write_bytes(earlier + b"\n" + rest)
    with pytest.raises(OptionError, match="another version of this program"):
        leave_out("suzaku", "suzaku", IN_THREE, folder=tmp_path, resume=True)
    (tmp_path / JOURNAL).write_bytes(10_000 * b"[" + b"\n" + rest)
    with pytest.raises(OptionError, match="it is damaged"):
        leave_out("suzaku", "suzaku", IN_THREE, folder=tmp_path, resume=True)


def test_a_changed_line_is_done_again_and_so_is_what_follows(tmp_path, in_three):
    """A digit changed in a result, as by a bad disk, went into the numbers of the run without a word."""
    whole, kept = in_three
    at = kept.index(b"0.", kept.index(b"\n") + 200)
    for damaged in (kept[: at + 3] + b"7" + kept[at + 4 :], kept[:at] + b"\xff" + kept[at + 1 :]):
        assert damaged != kept
        (tmp_path / JOURNAL).write_bytes(damaged)
        resumed = leave_out("suzaku", "suzaku", IN_THREE, folder=tmp_path, resume=True)
        assert same(resumed.to_dict()) == whole
        assert (tmp_path / JOURNAL).read_bytes() == kept


def test_nothing_to_resume(tmp_path):
    with pytest.raises(OptionError, match="nothing to resume"):
        leave_out("suzaku", "suzaku", folder=tmp_path, resume=True)


def test_a_run_that_has_ended_names_the_command_for_its_report(tmp_path):
    """Killed between result and report it was told to run without --resume, which the result refused."""
    (tmp_path / "leave_out.json").write_text("{}")
    with pytest.raises(OptionError, match=r"leave_out\.json is its result") as refused:
        leave_out("suzaku", "suzaku", folder=tmp_path, resume=True)
    assert f"mmgtune report {tmp_path} renders its report" in str(refused.value)
    with pytest.raises(OptionError, match=r"leave_out\.json is its result"):
        Checkpoint(tmp_path, {}).load()


def few_trials(folder):
    """Some bundled trials in a folder, every third sample of them, so that a diagnosis takes a moment."""
    for name in ("turn_p35", "turn_m20", "zigzag_10"):
        whole = load_trials("suzaku").trials[name]
        thin = {channel: getattr(whole, channel)[::3] for channel in ATTRIBUTES.values()}
        write_trial(replace(whole, **thin), folder / f"{name}.parquet")
    return folder


@pytest.mark.long
def test_kill_9_of_a_diagnosis_and_resume(tmp_path):
    trials = str(few_trials(tmp_path / "trials"))
    wanted = ("--effects", "speed-scale,current", "--targets", "R_0,w_P0")
    asked = ("diagnose", "-t", trials, *wanted, "--no-report", "--quiet")
    journal = tmp_path / "cut" / JOURNAL

    def far():
        return journal.exists() and len(lines(journal.parent)) > 6

    killed = run_until(far, signal.SIGKILL, *asked, "--out", "cut", cwd=tmp_path)
    assert killed.code == -signal.SIGKILL
    other = run(*asked, "--seed", "3", "--resume", "--out", "cut", cwd=tmp_path)
    assert other.code == 2
    assert "different now: seed (3, was " in other.err
    resumed = run(*asked, "--resume", "--json", "--out", "cut", cwd=tmp_path)
    assert resumed.code == 0, resumed.err
    whole = run(*asked, "--json", "--out", "whole", cwd=tmp_path)
    assert same(resumed.json()) == same(whole.json())


def test_ctrl_c_of_a_diagnosis_concludes_nothing(tmp_path):
    trials = str(few_trials(tmp_path / "trials"))
    asked = ("diagnose", "-t", trials, "--effects", "speed-scale", "--targets", "R_0,w_P0", "--quiet")
    journal = tmp_path / "run" / JOURNAL

    def begun():
        return journal.exists() and len(lines(journal.parent)) > 1

    ended = run_until(begun, signal.SIGINT, *asked, "--json", "--out", "run", "--fail-on", "none", cwd=tmp_path)
    assert ended.code == 130, ended.err
    document = ended.json()
    assert document["verdict"] == "interrupted"
    assert document["causes"] == []
    assert "nothing can be concluded" in document["sentence"]
    assert "stopped before its end" in (tmp_path / "run" / "report.md").read_text()
    assert "--resume --out run continues" in ended.err


@pytest.mark.long
def test_ctrl_c_of_leave_out(tmp_path):
    asked = ("leave-out", "--targets", "R_0,w_P0,kappa", "--starts", "1", "--quiet", "--out", "run")
    journal = tmp_path / "run" / JOURNAL
    ended = run_until(journal.exists, signal.SIGINT, *asked, cwd=tmp_path)
    assert ended.code == 130, ended.err
    assert "Traceback" not in ended.err
    resumed = run(*asked, "--resume", "--json", cwd=tmp_path)
    assert resumed.code == 0, resumed.err
    assert not resumed.json()["interrupted"]
    assert len(resumed.json()["parts"]) == resumed.json()["n_parts"]


def test_ctrl_c_at_once_is_one_line(tmp_path):
    for wait in (0.05, 0.4):
        import time

        began = time.monotonic()
        ended = run_until(
            lambda began=began, wait=wait: time.monotonic() - began > wait, signal.SIGINT, "fit", "--dry-run",
            cwd=tmp_path,
        )  # fmt: skip
        if ended.code == -signal.SIGINT:  # before Python itself was up
            continue
        assert ended.code in (0, 130, 1), ended.err
        if ended.code == 130:
            assert len(ended.err.strip().splitlines()) == 1


def test_names_do_for_objects():
    assert mmgtune.load_profile("suzaku").id == mmgtune.simulate("suzaku", "suzaku").ship.id


@pytest.mark.long
def test_nothing_is_lost_between_the_end_of_a_run_and_its_result(tmp_path, monkeypatch):
    """The journal was gone before the result was written: a kill in between cost the whole run."""

    def killed(*_):
        raise KeyboardInterrupt

    options = FitOptions(targets=FEW, starts=1)
    whole = mmgtune.fit("suzaku", "suzaku", options, folder=tmp_path)
    with monkeypatch.context() as patched:
        patched.setattr(run_folder, "write_text", killed)
        with pytest.raises(KeyboardInterrupt):
            mmgtune.write_run(whole, tmp_path)
    resumed = mmgtune.fit("suzaku", "suzaku", options, folder=tmp_path, resume=True)
    assert same(resumed.to_dict()) == same(whole.to_dict())
    mmgtune.write_run(resumed, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {
        "fit.json",
        "profile.toml",
        "history.parquet",
        "motions.parquet",
    }


@pytest.mark.parametrize("work", [mmgtune.fit, mmgtune.sweep, mmgtune.leave_out, mmgtune.diagnose, mmgtune.posterior])
def test_the_library_too_goes_on_from_a_folder_only(work):
    with pytest.raises(OptionError, match="resume=True needs the folder") as refused:
        work("suzaku", "suzaku", resume=True)
    assert "add folder=FOLDER" in str(refused.value)
