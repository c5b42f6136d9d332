"""Models on voyages, as a user asks for it: the library, the command, the run folder and the report."""

from __future__ import annotations

import json
import signal
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import mmgtune
from mmgtune.errors import OptionError, TrialError
from mmgtune.particles import Particles
from mmgtune.report import render
from mmgtune.trial import write_trial
from mmgtune.voyages import Hooks, VoyageOptions, validate_voyages, write_voyages
from mmgtune.voyages import run as running
from tests.cli.test_interrupts import ended as ended_by
from tests.command import run
from tests.trial.made import made
from tests.voyages.conftest import rows, with_nan
from tools.generate_voyage import make_voyage


@pytest.fixture(scope="module")
def found(voyage_file):
    """Two models on two hours."""
    return validate_voyages({"true": "suzaku", "other": "kvlcc2"}, voyage_file)


@pytest.fixture(scope="module")
def folder(found, tmp_path_factory):
    """The run folder of that, with its report."""
    path = tmp_path_factory.mktemp("run")
    write_voyages(found, path)
    render(path)
    return path


def test_the_true_model_is_the_better_everywhere(found):
    assert found.n_windows == 60
    assert found.median("true") < 0.2 * found.median("other")
    (one,) = found.comparisons
    assert (one.first, one.second, one.windows, one.better) == ("true", "other", 60, 0.0)
    assert one.difference > 10.0
    assert found.classes("other") == {"optimal": 0, "satisfactory": 0, "sub-optimal": 60}
    assert repr(found).startswith("VoyageValidation(on ")
    assert "60 windows" in repr(found)


def test_without_noise_the_true_model_is_optimal(suzaku, tmp_path):
    path = write_trial(make_voyage(suzaku, 1.0, noise=0.0), tmp_path / "a.parquet")
    clean = validate_voyages("suzaku", path)
    assert clean.classes("suzaku") == {"optimal": 30, "satisfactory": 0, "sub-optimal": 0}
    assert clean.table.models["suzaku"].cVDM.max() < 1e-6


def test_to_dict_is_json(found):
    document = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert document["kind"] == "voyages"
    assert document["n_windows"] == 60
    true, other = document["models"]
    assert set(true["measures"]) == {"MMD", "MED", "ASD", "MSD", "PMD", "PED", "cVDM"}
    row = true["measures"]["cVDM"]
    assert row["q05"] <= row["q25"] <= row["median"] <= row["q75"] <= row["q95"]
    assert sum(true["cVDM_parts"].values()) == pytest.approx(row["mean"])
    assert true["L_MSE"] == pytest.approx(sum(true["L_MSE_by_state"].values()))
    assert true["tells_most"] == true["where"][0]["feature"]
    assert sum(one["windows"] for one in true["where"][0]["bins"]) == 60
    assert document["r_max"]["from"].startswith("largest of true in its own turn")
    assert [one["role"] for one in document["drawn"]] == ["best"] * 2 + ["median"] * 2 + ["worst"] * 2
    assert document["drawn"][0]["cVDM"]["true"] < document["drawn"][-1]["cVDM"]["true"]
    assert other["id"] == "kvlcc2"


def test_r_max_as_given(voyage_file, found):
    twice = validate_voyages("suzaku", voyage_file, VoyageOptions(r_max=2.0 * np.degrees(found.r_max)))
    before, now = found.table.models["true"].parts, twice.table.models["suzaku"].parts
    np.testing.assert_allclose(now["yaw"], before["yaw"] / 2.0)
    np.testing.assert_array_equal(now["heading"], before["heading"])


def test_files(found, folder):
    table = pd.read_parquet(folder / "windows.parquet")
    assert len(table) == 120
    true = table[table["model"] == "true"].reset_index()
    np.testing.assert_array_equal(true["cVDM"], found.table.models["true"].cVDM)
    parts = [f"cVDM_{name}" for name in ("position", "heading", "surge", "sway", "yaw")]
    np.testing.assert_allclose(true[parts].sum(axis=1), true["cVDM"])
    assert true["class"].value_counts().to_dict() == {k: v for k, v in found.classes("true").items() if v}
    assert list(true["window"]) == list(found.table.ids)
    assert true["begins"].tolist() == [120.0 * k for k in range(60)]
    assert (true["rudder_moves"] == (true["rudder_range"] >= np.radians(2.0))).all()
    drawn = pd.read_parquet(folder / "drawn.parquet")
    assert drawn.groupby(["window", "model"]).size().tolist() == [121] * 18
    first = drawn[drawn["measured"]].groupby("window").first()
    start = drawn[~drawn["measured"]].groupby(["window", "model"]).first()
    for (window, _), row in start.iterrows():
        assert row["x"] == first.loc[window, "x"]


def test_report(folder):
    html = (folder / "report.html").read_text(encoding="utf-8")
    markdown = (folder / "report.md").read_text(encoding="utf-8")
    for words in ("Where the error lives", "midway between them", "own turn, rudder hard over", "drawn anew"):
        assert words in html
        assert words in markdown
    assert {one.stem for one in (folder / "figures").iterdir()} == {
        "classes", "distributions", "where", "parts", "tracks", "histories",
    }  # fmt: skip
    before = {one.name: one.read_bytes() for one in (*folder.glob("figures/*"), folder / "report.html")}
    ended = run("report", folder, cwd=folder.parent)
    assert ended.code == 0, ended.err
    assert before == {one.name: one.read_bytes() for one in (*folder.glob("figures/*"), folder / "report.html")}


def test_a_damaged_run_folder(folder, tmp_path):
    import shutil

    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    (copy / "windows.parquet").unlink()
    ended = run("report", copy, cwd=tmp_path)
    assert ended.code == 2
    assert "not whole" in ended.err
    shutil.copy(folder / "drawn.parquet", copy / "windows.parquet")
    ended = run("report", copy, cwd=tmp_path)
    assert ended.code == 2
    assert "columns lack: cVDM" in ended.err
    (copy / "voyages.json").write_text('{"schema": 1, "kind": "voyages"}')
    assert "it lacks" in run("report", copy, cwd=tmp_path).err


def test_the_command(voyage, tmp_path):
    write_trial(voyage, tmp_path / "logs" / "a.parquet")
    stop = with_nan(rows(voyage, slice(0, 3000)), "x", slice(1000, 1400))
    write_trial(replace(stop, id="b"), tmp_path / "logs" / "b.parquet")
    write_trial(made("turn", ship="suzaku", samples=400), tmp_path / "logs" / "turn.parquet")
    ended = run("validate", "suzaku", "logs", "--out", "run", "--json", cwd=tmp_path)
    assert ended.code == 0, ended.err
    document = ended.json()
    assert document == json.loads((tmp_path / "run" / "voyages.json").read_text(encoding="utf-8"))
    assert [log["id"] for log in document["logs"]] == ["voyage", "b", "turn"]
    assert [log["rows_left_out"]["incomplete motion"] for log in document["logs"]] == [0, 400, 0]
    assert document["shorter"] == ["turn"]
    assert (tmp_path / "run" / "report.html").is_file()
    again = run("validate", "suzaku", "logs", "--out", "run", cwd=tmp_path)
    assert again.code == 2
    assert "exists already" in again.err
    shown = run(
        "validate",
        "suzaku",
        "kvlcc2",
        "logs",
        "--restart",
        "300",
        "--classes",
        "5,50",
        "--out",
        "run",
        "--force",
        "--no-report",
        cwd=tmp_path,
    )
    assert shown.code == 0, shown.err
    assert "optimal to 5 %, satisfactory to 50 %" in shown.out
    assert "windows of 300 s" in shown.out
    assert "400 with incomplete motion" in shown.out
    assert "kvlcc2 is better than suzaku in" in shown.out


def test_by_default_the_run_is_under_runs(voyage_file, tmp_path):
    ended = run("validate", "suzaku", voyage_file, "--no-report", cwd=tmp_path)
    assert ended.code == 0, ended.err
    (made_there,) = (tmp_path / "runs").iterdir()
    assert made_there.name.endswith("-suzaku")
    assert {one.name for one in made_there.iterdir()} == {"voyages.json", "windows.parquet", "drawn.parquet"}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--classes", "4,1"), "--classes 1.3,4.1"),
        (("--classes", "a"), "not a list of numbers"),
        (("--r-max", "0"), "--r-max"),
        (("--gap", "-1"), "--gap"),
        (("--manoeuvres",), "cannot be repeated"),
        (("--restart", "0"), "--restart"),
    ],
)
def test_wrong_arguments(voyage_file, tmp_path, arguments, said):
    ended = run("validate", "suzaku", voyage_file, *arguments, cwd=tmp_path)
    assert ended.code == 2
    assert said in ended.err
    assert "Traceback" not in ended.err


@pytest.mark.parametrize("arguments", [("--quiet",), ("--r-max", "1.8"), ("--classes", "1,2")])
def test_what_is_of_voyages_is_refused_for_trials(tmp_path, arguments):
    ended = run("validate", "suzaku", "suzaku", *arguments, cwd=tmp_path)
    assert ended.code == 2
    assert f"these trials are no voyages ({arguments[0]})" in ended.err
    assert not (tmp_path / "run").exists()


def test_damage_in_the_middle_leaves_no_result(voyage, tmp_path):
    path = write_trial(voyage, tmp_path / "a.parquet")
    t = np.array(voyage.t)
    t[6000] = 0.0
    write_trial(replace(voyage, t=t), tmp_path / "logs" / "b.parquet")
    write_trial(replace(voyage, id="first"), tmp_path / "logs" / "a.parquet")
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 0xFF
    path.write_bytes(content)
    for logs in ("logs", "a.parquet"):
        out = f"of_{logs}"
        ended = run("validate", "suzaku", logs, "--out", out, cwd=tmp_path)
        assert ended.code == 2, ended.out
        assert "Traceback" not in ended.err
        assert f"--resume --out {out} goes on" in ended.err
        assert "row 6000" in ended.err or "row group 1 of 1" in ended.err or "not what was written" in ended.err
        assert not (tmp_path / out / "voyages.json").exists()


def test_nothing_to_cut(voyage, tmp_path):
    path = write_trial(with_nan(voyage, "v_m", slice(1, None)), tmp_path / "a.parquet")
    with pytest.raises(TrialError, match="no window could be cut"):
        validate_voyages("suzaku", path)
    still = replace(voyage, u=0.001 * np.ones(voyage.n_samples), v_m=np.zeros(voyage.n_samples))
    with pytest.raises(TrialError, match="60 windows with the ship at rest"):
        validate_voyages("suzaku", write_trial(still, tmp_path / "b.parquet"))


def test_a_model_needs_its_inputs(voyage_file):
    class Twin:
        name, L_pp, n_members, inputs, method = "twin", 83.0, 1, ("n_port", "delta"), "none"

        def predict(self, cases):
            raise AssertionError

    with pytest.raises(TrialError, match="does not say 'n_port'"):
        validate_voyages(Twin(), voyage_file)


def test_a_predictor_and_the_rest_of_the_library(voyage_file):
    class Straight:
        name, L_pp, n_members, inputs, method = "straight", 83.0, 1, ("n", "delta"), "none"

        def predict(self, cases):
            states = np.repeat(cases.initial[:, None, None], cases.t.shape[1], axis=2)
            return mmgtune.Prediction(states, np.zeros(states.shape[:2], dtype=bool))

    result = mmgtune.validate_voyages([Straight()], voyage_file)
    assert "quantile of the windows' largest" in result.r_max_from
    with pytest.raises(OptionError, match="no profile to score"):
        validate_voyages([], voyage_file)
    with pytest.raises(OptionError, match="manoeuvres"):
        validate_voyages("suzaku", voyage_file, VoyageOptions(manoeuvres=True))


def test_sigma_from_trials(voyage_file):
    result = validate_voyages("suzaku", voyage_file, VoyageOptions(sigma_from="suzaku"))
    assert result.sigma_from == "suzaku"
    assert result.to_dict()["models"][0]["L_MSE"] > 0.0


def test_stopped_between_portions(voyage_file, monkeypatch):
    monkeypatch.setattr(running, "AT_ONCE", 1300)
    told: list[tuple[int, int, str]] = []
    hooks = Hooks(on_progress=lambda *words: told.append(words), stop=lambda: len(told) >= 2)
    result = validate_voyages("suzaku", voyage_file, hooks=hooks)
    assert result.interrupted
    assert result.n_windows == 20
    assert told[0][1:] == (7201, "voyage")
    (log,) = result.to_dict()["logs"]
    assert (log["complete"], log["windows"]) == (False, 20)
    assert "interrupted" in repr(result)
    assert result.sentence().startswith("Stopped before its end: ")


@pytest.mark.daily("2")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c(voyage, tmp_path, number):
    """What is done so far is written, marked interrupted, and the exit code says so."""
    for name in ("a", "b"):
        write_trial(replace(voyage, id=name), tmp_path / "logs" / f"{name}.parquet")
    before = "import mmgtune.cli.progress as p; p.Progress.on_share = lambda *_: sent()"
    found = ended_by(
        tmp_path, "validate", "suzaku", "logs", "--out", "run", "--no-report", number=number, before=before
    )
    assert found.returncode == 128 + number
    assert "what is done so far is in run" in found.stderr
    assert "Traceback" not in found.stderr
    document = json.loads((tmp_path / "run" / "voyages.json").read_text(encoding="utf-8"))
    assert document["interrupted"]
    assert document["n_windows"] == 60
    assert [log["complete"] for log in document["logs"]] == [True]
    assert "Stopped after 1 of 2 voyages" in found.stdout
    written = render(tmp_path / "run")
    assert "Stopped by the user after 1 of 2 voyages" in written[0].read_text(encoding="utf-8")


def test_stopped_before_anything(voyage_file, tmp_path):
    result = validate_voyages("suzaku", voyage_file, hooks=Hooks(stop=lambda: True))
    assert result.interrupted
    assert result.n_windows == 0
    write_voyages(result, tmp_path / "run")
    assert render(tmp_path / "run")[0].is_file()


def test_bands_of_a_model_with_particles_are_held_against_windows(suzaku, voyage_file):
    drawn = np.random.default_rng(2).normal(0.017, 0.002, size=(1, 30))
    uncertain = Particles(suzaku.profile, ("hull.R_0",), drawn, {}).predictor(as_logged=True)
    result = validate_voyages({"alone": "suzaku", "with bands": uncertain}, voyage_file)
    assert list(result.bands) == ["with bands"]
    rows = {one["profile"]: one for one in result.to_dict()["models"]}
    assert "bands" not in rows["alone"]
    held = rows["with bands"]["bands"]
    assert held["windows"] == min(200, result.n_windows)
    assert 0.0 < held["coverage_50"] < held["coverage_90"] < 1.0
