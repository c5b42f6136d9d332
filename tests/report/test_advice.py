"""What a report tells to do next can be pasted."""

from __future__ import annotations

import html
import re
import shlex
from pathlib import Path

import pytest

from mmgtune.profile import load_profile
from mmgtune.report import advice
from tests.command import run

pytestmark = [pytest.mark.xdist_group("report"), pytest.mark.slow(20)]

ROOT = Path(__file__).parents[2]
PLANNED = ("fit", "sweep", "leave-out", "diagnose")
"""Commands that say with --dry-run what they would do, and refuse what they would refuse."""


def commands_of(folder: Path) -> list[str]:
    """The commands of a report as a reader copies them."""
    page = (folder / "report.html").read_text(encoding="utf-8")
    found = re.findall(r"<pre><code>(.*?)</code></pre>", page, re.S)
    return [html.unescape(re.sub(r"</?span>", "", text)) for text in found]


def paste(command: str, cwd: Path, tmp_path: Path) -> None:
    """Run a command as pasted, those that take long with --dry-run."""
    words = shlex.split(command)
    assert words[0] == "mmgtune"
    more = ("--dry-run",) if words[1] in PLANNED else ()
    if words[1] == "simulate" and "--out" in words:
        words[words.index("--out") + 1] = str(tmp_path / "again")
    ended = run(*words[1:], *more, cwd=cwd)
    assert ended.code == 0, (command, ended.err)


@pytest.mark.parametrize("name", ["diagnosis", "leave-out", "validate", "simulate"])
def test_commands_work_when_pasted(more: dict[str, Path], name: str, tmp_path: Path) -> None:
    commands = commands_of(more[name])
    assert commands
    for command in commands:
        paste(command, ROOT, tmp_path)


def test_a_current_is_taken_out_before_calm_water_is_predicted(more: dict[str, Path]) -> None:
    folder = more["diagnosis"]
    (calm,) = [text for text in commands_of(folder) if "calm.toml" in text]
    assert calm.startswith("mmgtune simulate -p ")
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert page.index("Before predicting calm water take the current out") < page.index("calm.toml</span>")
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
