"""Numbers of a profile that may be wrong: every command that uses it says so, in the same words, and in JSON."""

import json
from dataclasses import replace

import pytest

from mmgtune.profile import load_profile, parse_profile
from mmgtune.trial import load_trials, write_trial
from tests.command import run
from tools.generate_voyage import make_voyage

WORDS = "hull.R_0, wake.w_P0 are doubtful: such a ship was never seen"
FEW = ("--targets", "hull.N_r", "--method", "least-squares", "--starts", "1", "--quiet")


@pytest.fixture(scope="module")
def folder(tmp_path_factory, suzaku):
    """A profile with two doubtful numbers, two trials and a voyage."""
    folder = tmp_path_factory.mktemp("doubts")
    ship = load_profile("suzaku")
    sections = dict(ship.sections)
    for name in ("hull.R_0", "wake.w_P0"):
        kind, symbol = name.split(".")
        number = replace(ship.coefficient(name), warning="such a ship was never seen")
        sections[kind] = replace(sections[kind], coefficients={**sections[kind].coefficients, symbol: number})
    text = replace(ship, sections=sections, limits={"J": 1e9}).text
    (folder / "ship.toml").write_text(text, encoding="utf-8")
    assert [one.name for one in parse_profile(text).doubts()] == ["hull.R_0", "wake.w_P0"]
    for name in ("turn_p35", "turn_m35"):
        trial = load_trials("suzaku").trials[name]
        write_trial(trial, folder / "trials" / f"{name}.parquet")
    write_trial(make_voyage(suzaku, 1.1), folder / "voyage.parquet")
    return folder


def holds(rows):
    """Whether rows of a record are the two doubts."""
    values = {one["name"]: one["value"] for one in rows}
    ship = load_profile("suzaku")
    assert values == {name: ship.value(name) for name in ("hull.R_0", "wake.w_P0")}
    assert {one["warning"] for one in rows} == {"such a ship was never seen"}
    assert {one["unit"] for one in rows} == {"prime", "-"}


def said(ended, code=0):
    assert ended.code == code, ended.err
    return (ended.out + ended.err).count(WORDS)


def page(folder):
    return (folder / "report.html").read_text(encoding="utf-8"), (folder / "report.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("command", "record"), [("fit", "fit.json"), ("sweep", "sweep.json"), ("leave-out", "leave_out.json")]
)
def test_what_tunes(folder, command, record):
    out = f"of_{command}"
    few = tuple(word for word in FEW if word not in ("--method", "least-squares")) if command == "leave-out" else FEW
    more = ("--ar", "0.2") if command == "sweep" else ()
    ended = run(command, "-p", "ship.toml", "-t", "trials", *few, *more, "--out", out, cwd=folder)
    assert said(ended) == 1
    found = json.loads((folder / out / record).read_text())
    assert f"{WORDS}." in found["warnings"]
    holds(found["doubts"])
    if command != "leave-out":
        for text in page(folder / out):
            assert "such a ship was never seen" in text


def test_diagnose(folder):
    arguments = ("diagnose", "-p", "ship.toml", "-t", "trials", "--effects", "current", "--quiet")
    assert said(run(*arguments, "--out", "of_diagnose", cwd=folder)) == 1
    holds(json.loads((folder / "of_diagnose" / "diagnosis.json").read_text())["doubts"])
    for text in page(folder / "of_diagnose"):
        assert "such a ship was never seen" in text


def test_validate_on_trials(folder):
    ended = run("validate", "ship.toml", "suzaku", "trials", cwd=folder)
    assert said(ended) == 1
    assert f"note: ship.toml: {WORDS}\n" in ended.err
    one, other = run("validate", "ship.toml", "suzaku", "trials", "--json", cwd=folder).json()["profiles"]
    holds(one["doubts"])
    assert other["doubts"] == []


@pytest.mark.long
def test_validate_on_voyages(folder):
    ended = run("validate", "ship.toml", "suzaku", "voyage.parquet", "--quiet", "--out", "on", cwd=folder)
    assert said(ended) == 1
    one, other = json.loads((folder / "on" / "voyages.json").read_text())["models"]
    holds(one["doubts"])
    assert other["doubts"] == []
    for text in page(folder / "on"):
        assert "such a ship was never seen" in text


@pytest.mark.long
def test_compare_and_simulate(folder):
    ended = run("profile", "compare", "suzaku", "ship.toml", "--out", "compared", cwd=folder)
    assert said(ended) == 1
    assert f"note: ship: {WORDS}\n" in ended.err
    other, one = json.loads((folder / "compared" / "comparison.json").read_text())["profiles"]
    holds(one["doubts"])
    assert other["doubts"] == []
    for text in page(folder / "compared"):
        assert "such a ship was never seen" in text
    assert said(run("simulate", "-p", "ship.toml", "--turn", "35", cwd=folder)) == 1
    holds(run("simulate", "-p", "ship.toml", "--turn", "35", "--json", cwd=folder).json()["doubts"])


def test_check(folder):
    arguments = ("check", "ship.toml", "trials", "--metrics", "J")
    assert said(run(*arguments, cwd=folder)) == 1
    assert said(run(*arguments, "--format", "markdown", cwd=folder)) == 0  # its signs are escaped there
    assert "such a ship was never seen" in run(*arguments, "--format", "markdown", cwd=folder).out
    found = run(*arguments, "--format", "json", cwd=folder).json()
    assert WORDS in found["notes"]
    holds(found["doubts"])


def test_profile_itself(folder):
    for command in ("show", "validate"):
        assert said(run("profile", command, "ship.toml", cwd=folder)) == 1
    holds(run("profile", "show", "ship.toml", "--json", cwd=folder).json()["doubts"])
