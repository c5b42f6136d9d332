"""What a report tells to do next can be pasted."""

from __future__ import annotations

import html
import re
import shlex
import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from typer.main import get_command

from mmgtune.cli import app
from mmgtune.networks import save_network
from mmgtune.profile import load_profile
from mmgtune.report import advice, render
from mmgtune.trial import load_trials
from tests.command import run
from tests.networks.made import network

pytestmark = pytest.mark.xdist_group("report")

ROOT = Path(__file__).parents[2]
PLANNED = ("fit", "sweep", "leave-out", "diagnose")
"""Commands that say with --dry-run what they would do, and refuse what they would refuse."""


QUICK = (*PLANNED, "validate", "compare", "simulate", "trials", "check", "plan", "predict")
"""Commands that can be run here, if need be with --dry-run."""


def commands_of(folder: Path) -> list[str]:
    """The commands of a report as a reader copies them."""
    page = (folder / "report.html").read_text(encoding="utf-8")
    found = re.findall(r"<pre><code>(.*?)</code></pre>", page, re.S)
    return [html.unescape(re.sub(r"</?span>", "", text)) for text in found]


def paste(command: str, cwd: Path, tmp_path: Path, quick: Sequence[str] = QUICK) -> None:
    """Run a command as pasted, those that take long with --dry-run; of others than ``quick`` look at the options."""
    words = shlex.split(command)
    assert words[0] == "mmgtune"
    if "&&" in words:  # what comes after needs what the first makes, which takes long
        words = words[: words.index("&&")]
    if words[1] not in quick:
        resolve(words)
        return
    more = ("--dry-run",) if words[1] in PLANNED and quick is QUICK else ()
    if words[1] == "simulate" and "--out" in words:
        words[words.index("--out") + 1] = str(tmp_path / "again")
    ended = run(*words[1:], *more, cwd=cwd)
    assert ended.code == 0, (command, ended.err)


@pytest.mark.daily("validate", "simulate")
@pytest.mark.parametrize("name", ["diagnosis", "leave-out", "validate", "simulate"])
def test_commands_work_when_pasted(more: dict[str, Path], name: str, tmp_path: Path) -> None:
    commands = commands_of(more[name])
    assert commands
    for command in commands:
        paste(command, ROOT, tmp_path)


def resolve(words: Sequence[str]) -> None:
    """A command whose options are known and whose profile and trials are there."""
    made = get_command(app).commands[words[1]].make_context(words[1], list(words[2:]))  # type: ignore[attr-defined]
    load_profile(made.params["profile"])
    load_trials(made.params["trials"])


QUICKLY = (
    "-p",
    "suzaku",
    "-t",
    "suzaku",
    "--method",
    "least-squares",
    "--starts",
    "1",
    "--targets",
    "hull.R_0,rudder.a_H",
)


def test_commands_of_a_fit_work_when_pasted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("fit", *QUICKLY, "--ar", "0.1", "--out", "a run", cwd=tmp_path).code == 0
    commands = commands_of(tmp_path / "a run")
    assert {shlex.split(one)[1] for one in commands} == {"fit", "sweep", "simulate", "posterior"}
    for command in commands:
        paste(command, tmp_path, tmp_path, ("simulate", *(("fit",) if "--force" in command else ())))


@pytest.mark.long
def test_commands_of_a_sweep_work_when_pasted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("sweep", *QUICKLY, "--ar", "0.1,0.2", "--out", "a run", cwd=tmp_path).code == 0
    commands = commands_of(tmp_path / "a run")
    assert {shlex.split(one)[1] for one in commands} >= {"sweep", "simulate"}
    (wider,) = [one for one in commands if "--ar 0.2,0.3,0.4" in one]
    assert wider.endswith(" --ar 0.2,0.3,0.4 --method least-squares --starts 1 --targets hull.R_0,rudder.a_H")
    for command in commands:
        paste(command, tmp_path, tmp_path, ("simulate",))


@pytest.mark.parametrize(
    ("command", "kept"),
    [
        ("mmgtune sweep -p a -t b --ar=0.2 --starts 4 --out x --force -q --fix 'wake.*'", " --starts 4 --fix 'wake.*'"),
        ("mmgtune sweep", ""),
        ("mmgtune fleet run f.toml --out x", ""),
        ("", ""),
        ("mmgtune sweep 'half", ""),
    ],
)
def test_what_was_chosen_stays(command: str, kept: str) -> None:
    assert advice.chosen_in(command, "sweep", ("--ar",)) == kept


def test_a_stopped_search_goes_on_in_its_folder() -> None:
    """It was told to replace what it should continue, and a folder with a blank in its name was two words."""
    stopped = "mmgtune diagnose -p suzaku -t suzaku --ar -0.5 --force --out 'runs/my run'"
    assert advice.gone_on(stopped, "runs/my run") == (
        "mmgtune diagnose -p suzaku -t suzaku --ar -0.5 --out 'runs/my run' --resume"
    )


def test_what_follows_a_fit_has_its_choices() -> None:
    command = "mmgtune fit -p a -t b --ar 0.2 --method least-squares --starts=1 --targets 'hull.Y_*' --bands --out r"
    data = {
        "profile": {"path": "a"}, "trials": {"path": "b"}, "options": {"a_r": 0.2}, "out": "r", "J_test": 2.0,
        "misses": True, "at_bound": ["hull.Y_v"], "command": command,
    }  # fmt: skip
    sweep, diagnose, *_ = [command for _, command in advice.after_fit(data)]
    assert sweep == "mmgtune sweep -p a -t b --method least-squares --starts=1 --targets 'hull.Y_*'"
    assert diagnose == "mmgtune diagnose -p a -t b --ar 0.2 --targets 'hull.Y_*'"


@pytest.mark.parametrize("name", ["fit", "sweep", "leave-out", "diagnose"])
def test_choices_of_a_fit_are_options_of_what_follows(name: str) -> None:
    commands = get_command(app).commands
    there = {one: {flag for option in commands[one].params for flag in option.opts} for one in ("fit", name)}
    assert there["fit"] - there[name] - {"--ar"} == set(advice._OF_A_FIT[name]) - {"--ar"}


def test_commands_of_a_comparison_of_profiles_work_when_pasted(more: dict[str, Path], tmp_path: Path) -> None:
    commands = commands_of(more["comparison"])
    assert [shlex.split(one)[1] for one in commands] == ["validate", "simulate", "simulate"]
    for command in commands:
        paste(command, ROOT, tmp_path)


@pytest.mark.long
def test_commands_of_a_comparison_of_models_work_when_pasted(tmp_path: Path) -> None:
    asked = ("compare", "suzaku_fam", "suzaku", "suzaku", "suzaku", "--only", "turning", "--out", "a run")
    assert run(*asked, cwd=tmp_path).code == 0
    commands = commands_of(tmp_path / "a run")
    assert [shlex.split(one)[1] for one in commands] == ["diagnose", "validate", "compare", "compare"]
    assert "--force" in commands[-1]
    for command in commands:
        paste(command, tmp_path, tmp_path)


def test_a_command_can_be_given_again() -> None:
    assert advice.again("mmgtune fit --out 'a run' --resume") == "mmgtune fit --out 'a run' --force"
    assert advice.again("mmgtune fit -o run --force") == "mmgtune fit -o run --force"
    assert advice.again("mmgtune fit --seed 2") == "mmgtune fit --seed 2"


def test_commands_of_a_training_work_when_pasted(more: dict[str, Path], tmp_path: Path) -> None:
    folder = tmp_path / "a run"
    shutil.copytree(more["learning"], folder)
    net = network(step=1.0, size=0.1)
    save_network(replace(net, ship="suzaku", L_pp=83.0), folder / "model.safetensors")
    render(folder)
    commands = commands_of(folder)
    assert [shlex.split(one)[1] for one in commands] == ["validate", "simulate"]
    for command in commands:
        paste(command, ROOT, tmp_path)


def test_commands_of_a_check_work_when_pasted(more: dict[str, Path], tmp_path: Path) -> None:
    commands = commands_of(more["check"])
    assert [shlex.split(one)[1] for one in commands] == ["diagnose"]
    for command in commands:
        paste(command, ROOT, tmp_path, ())


@pytest.mark.long
def test_commands_of_voyages_work_when_pasted(voyages_folder: Path, tmp_path: Path) -> None:
    commands = commands_of(voyages_folder)
    assert [shlex.split(one)[1] for one in commands] == ["validate", "simulate"]
    for command in commands:
        paste(command, ROOT, tmp_path)


def test_a_fleet_says_whom_to_ask_why(more: dict[str, Path]) -> None:
    changed, best = [one for one in commands_of(more["fleet"]) if shlex.split(one)[1] in ("diagnose", "validate")]
    assert changed.startswith("mmgtune diagnose -p suzaku -t logs/bb/2025-0")
    assert best.endswith("runs/bb/2025-12/state/profile.toml logs/bb/2025-12 --manoeuvres")


def test_a_current_is_taken_out_before_calm_water_is_predicted(more: dict[str, Path]) -> None:
    folder = more["diagnosis"]
    (calm,) = [text for text in commands_of(folder) if "calm.toml" in text]
    assert calm.startswith("mmgtune simulate -p ")
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert page.index("Before predicting calm water take out the current") < page.index("calm.toml</span>")
    extended, without = (load_profile(folder / f"{name}.toml") for name in ("profile", "calm"))
    assert "effects.current" in extended.sections
    assert "effects.current" not in without.sections
    assert {kind for kind in extended.sections if kind != "effects.current"} == set(without.sections)
    assert without.value("hull.R_0") == extended.value("hull.R_0")


def test_reasons_stand_before_commands(more: dict[str, Path]) -> None:
    page = (more["diagnosis"] / "report.html").read_text(encoding="utf-8")
    for reason, command in re.findall(r"<li><p>(.*?)</p><div class=\"command\"><pre><code>(.*?)</code>", page, re.S):
        assert not reason.startswith("mmgtune")
        assert command.startswith("<span>mmgtune</span>")


@pytest.mark.parametrize("misses", [False, True])
def test_a_fit_that_misses_held_out_trials_is_to_be_diagnosed(misses: bool) -> None:
    data = {
        "profile": {"id": "suzaku"}, "trials": {"path": "mine"}, "options": {}, "out": "run", "J_test": 2.0,
        "misses": misses,
    }  # fmt: skip
    commands = [command for _, command in advice.after_fit(data)]
    assert any(command.startswith("mmgtune diagnose") for command in commands) is misses


@pytest.mark.parametrize(("by_run", "kept"), [(None, True), ({"by": "trial"}, False)])
def test_what_differs_from_run_to_run_is_in_no_profile(by_run: dict[str, str] | None, kept: bool) -> None:
    """The report sent to a calm.toml that a current of each run leaves none of."""
    cause = {"effect": "current", "by_run": by_run}
    data = {"causes": [cause], "verdict": "found", "out": "RUN", "profile": {"path": "suzaku"}, "trials": {"path": "t"}}
    said = [" ".join(pair) for pair in advice.after_diagnosis(data)]
    assert any("calm.toml" in one for one in said) is kept
    assert any("See the model with current" in one for one in said) is kept
    assert any("mmgtune diagnose -p RUN/profile.toml" in one for one in said) is kept
