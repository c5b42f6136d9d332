"""``mmgtune fit`` and what it leaves behind."""

import json
import signal

import numpy as np
import pytest

from mmgtune.fitting import FitOptions, make_problem
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials
from tests.command import QUICK, run, run_until

pytestmark = pytest.mark.xdist_group("cli_fit")

PROMISED = {
    "J_tune", "J_test", "J_tune_before", "J_test_before", "theta", "stderr", "at_bound", "undetermined", "evaluations",
    "restarts", "agreement", "wall_s", "out",
}  # fmt: skip
# What may differ between two runs of the same fit.
CLOCK = {"created", "wall_s", "command", "out"}

FEW = ("--integrator", "euler", "--targets", "R_0,w_P0,kappa,N_r,Y_v")
"""A search of seconds."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fit")
    return folder, run("fit", *QUICK, "--json", "--out", "run", cwd=folder)


def test_json_is_all_there_is_on_stdout(finished):
    _, ended = finished
    assert ended.code == 0
    document = ended.json()
    assert set(document) >= PROMISED
    assert document["out"] == "run"
    assert document["J_test"] < document["J_test_before"]
    assert set(document["theta"]) == set(document["stderr"]) == set(load_profile("suzaku").targets)


def test_run_folder_holds_the_same_document(finished):
    folder, ended = finished
    assert json.loads((folder / "run" / "fit.json").read_text()) == ended.json()
    assert {p.name for p in (folder / "run").iterdir()} == {
        "fit.json",
        "profile.toml",
        "history.parquet",
        "motions.parquet",
    }


def test_tuned_profile_keeps_comments_and_gives_the_same_cost(finished):
    folder, ended = finished
    text = (folder / "run" / "profile.toml").read_text()
    for comment in ("# M.V. SUZAKU", "# K_T stands for two things"):
        assert comment in text
    tuned = load_profile(folder / "run" / "profile.toml")
    assert tuned.provenance["a_r"] == 0.5
    assert tuned.coefficient("hull.R_0").pre_determined == 0.017
    assert tuned.coefficient("hull.R_0").stderr == ended.json()["stderr"]["hull.R_0"]
    problem = make_problem(tuned, load_trials("suzaku"), FitOptions())
    J = problem.costs(problem.box.to_unit(problem.box.pre)[:, None])[0]
    assert pytest.approx(ended.json()["J_tune"], rel=1e-12) == J


@pytest.mark.long
def test_a_tuned_profile_can_be_tuned_again(finished):
    folder, ended = finished
    again = run("fit", *QUICK, "--ar", "0.1", "--json", "-p", "run/profile.toml", "--out", "again", cwd=folder)
    assert again.code == 0
    assert again.json()["J_tune"] <= ended.json()["J_tune"]
    tuned = load_profile(folder / "again" / "profile.toml")
    assert tuned.coefficient("hull.R_0").pre_determined == 0.017
    assert tuned.name.count("(tuned)") == 1


def test_output_that_exists_is_refused_and_force_replaces_it(finished):
    folder, _ = finished
    before = (folder / "run" / "fit.json").read_bytes()
    refused = run("fit", *QUICK, "--out", "run", cwd=folder)
    assert refused.code == 2
    assert "exists already" in refused.err
    assert "--force" in refused.err
    assert (folder / "run" / "fit.json").read_bytes() == before
    assert run("fit", *QUICK, "--out", "run", "--force", cwd=folder).code == 0


def test_a_finished_run_is_not_resumed_but_reported(finished):
    folder, _ = finished
    ended = run("fit", *QUICK, "--out", "run", "--resume", cwd=folder)
    assert ended.code == 2
    assert "the run there has ended: fit.json is its result" in ended.err
    assert "mmgtune report run renders its report; --force in the place of --resume repeats it" in ended.err


def test_force_never_mixes_with_other_files(tmp_path):
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "holiday.jpg").write_text("x")
    ended = run("fit", *QUICK, "--out", "photos", "--force", cwd=tmp_path)
    assert ended.code == 2
    assert "not a run" in ended.err
    assert [p.name for p in (tmp_path / "photos").iterdir()] == ["holiday.jpg"]


def test_dry_run_writes_nothing(tmp_path):
    ended = run("fit", "--dry-run", "--targets", "hull.Y_*", cwd=tmp_path)
    assert ended.code == 0
    assert "hull.Y_vvr" in ended.out
    assert list(tmp_path.iterdir()) == []


@pytest.mark.daily("[fit]")
@pytest.mark.parametrize("command", ["fit", "diagnose"])
def test_dry_run_compiles_nothing(command, tmp_path):
    ended = run(command, "--dry-run", cwd=tmp_path, env={"MMGTUNE_CACHE": str(tmp_path / "cache")}, fresh=True)
    assert ended.code == 0
    assert "once its simulator is compiled" in ended.out
    assert list(tmp_path.rglob("*.nbc")) == []


@pytest.mark.long
def test_kill_9_and_resume_gives_the_same_result(tmp_path):
    search = ("fit", *FEW, "--no-report", "--quiet", "--starts", "2", "--seed", "5")
    whole = run(*search, "--json", "--out", "whole", cwd=tmp_path)
    checkpoint = tmp_path / "cut" / "checkpoint.npz"
    killed = run_until(checkpoint.exists, signal.SIGKILL, *search, "--out", "cut", cwd=tmp_path)
    assert killed.code == -signal.SIGKILL
    assert not (tmp_path / "cut" / "fit.json").exists()
    with np.load(checkpoint) as costs:
        assert len(costs["sizes"])
    assert run(*search, "--out", "cut", cwd=tmp_path).code == 2  # the half-finished run is not overwritten either
    other = run("fit", "--no-report", "--seed", "6", "--resume", "--out", "cut", cwd=tmp_path)
    assert other.code == 2
    assert "belongs to another run" in other.err
    assert "seed (6, was " in other.err
    resumed = run(*search, "--json", "--resume", "--out", "cut", cwd=tmp_path)
    assert resumed.code == 0
    a, b = whole.json(), resumed.json()
    assert {k: v for k, v in a.items() if k not in CLOCK} == {k: v for k, v in b.items() if k not in CLOCK}
    assert not checkpoint.exists()


def test_ctrl_c_saves_the_best_so_far_and_can_be_continued(tmp_path):
    search = ("fit", *FEW, "--quiet", "--starts", "2", "--no-report")
    checkpoint = tmp_path / "run" / "checkpoint.npz"
    ended = run_until(checkpoint.exists, signal.SIGINT, *search, "--json", "--out", "run", cwd=tmp_path)
    assert ended.code == 130
    document = ended.json()
    assert document["interrupted"]
    assert document["J_tune"] < document["J_tune_before"]
    assert document["restarts"][-1]["stop"] == "interrupted"
    said = dict(zip(document["warning_codes"], document["warnings"], strict=True))
    assert "interrupted" in said["interrupted"]
    assert "generated, not measured" in said["generated"]
    assert load_profile(tmp_path / "run" / "profile.toml").value("hull.R_0") == document["theta"]["hull.R_0"]
    resumed = run(*search, "--json", "--resume", "--out", "run", cwd=tmp_path)
    assert resumed.code == 0
    assert not resumed.json()["interrupted"]


def test_strict_is_satisfied_where_searches_agree(tmp_path):
    assert run("fit", *QUICK, "--strict", "--out", "run", cwd=tmp_path).code == 0


def test_text_output_names_what_matters(tmp_path):
    ended = run("fit", "--method", "least-squares", "--starts", "2", "--no-report", "--out", "run", cwd=tmp_path)
    assert "hull.R_0" in ended.out
    assert "not determined" in ended.out
    assert "No trial can tell" in ended.out
    assert "generated, not measured" in ended.out
    assert "least squares" in ended.err  # progress goes to stderr
