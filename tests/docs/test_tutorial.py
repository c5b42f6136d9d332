"""The tutorial, followed to the letter in an empty folder: its commands run, and say what the page shows."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tools import generate_tutorial_logs

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "tutorial" / "index.md"
BLOCK = re.compile(r'^```(sh|text|toml)(?: title="(.*?)")?\n(.*?)^```', flags=re.M | re.S)


def words(text: str) -> str:
    """Text with its spaces evened out."""
    return " ".join(text.split())


def follow(folder: Path) -> list[str]:
    """Do what the page says in a folder; what it shows and the program does not say."""
    (folder / "mmgtune").symlink_to(ROOT)  # "the folder that holds your copy of the repository"
    env = {**os.environ, "COLUMNS": "200", "NO_COLOR": "1"}
    env["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{env['PATH']}"
    said: list[str] = []
    missing = []
    for language, title, text in BLOCK.findall(PAGE.read_text(encoding="utf-8")):
        if title:
            (folder / title).write_text(text, encoding="utf-8")
        elif language == "sh":
            ended = subprocess.run(
                ["bash", "-e", "-o", "pipefail", "-c", text], cwd=folder, env=env, capture_output=True, text=True
            )
            assert ended.returncode == 0, (text, ended.stdout, ended.stderr)
            said = [line.rstrip() for line in (ended.stdout + ended.stderr).splitlines() if line.strip()]
        elif language == "text":
            missing += not_said(text, said)
    return missing


def not_said(shown: str, said: list[str]) -> list[str]:
    """Lines that are shown and not said, to the letter; between two that stand below each other nothing is left out."""
    missing, at, left_out = [], -1, True
    for line in shown.splitlines():
        if line.strip() == "...":
            left_out = True
        elif line.strip():
            places = [k for k, other in enumerate(said) if k > at and other == line.rstrip()]
            places = places if left_out else [k for k in places if k == at + 1]
            missing += [] if places else [line]
            at, left_out = (places[0] if places else at), False
    return missing


@pytest.mark.long
def test_the_tutorial_does_what_it_shows(tmp_path):
    assert follow(tmp_path) == []


def test_it_shows_the_import_to_its_end_and_edits_no_profile_by_hand():
    """The last lines of the import were left out, and tables were cut out of a profile with sed."""
    page = PAGE.read_text(encoding="utf-8")
    blocks = [text for language, _, text in BLOCK.findall(page) if language == "text"]
    (shown,) = [text for text in blocks if "4 trials written to trials" in text]
    last = [line.strip() for line in shown.splitlines()[-2:]]
    (split,) = [text for _, title, text in BLOCK.findall(page) if title == "trials/split.toml"]
    assert last == split.splitlines()[1:]
    assert not re.search(r"^sed ", page, re.M)
    assert "-p diagnosis/calm.toml" in page


def test_the_cause_it_names_is_the_one_that_was_hidden():
    text = words(PAGE.read_text(encoding="utf-8"))
    north, east = generate_tutorial_logs.CURRENT["north"], generate_tutorial_logs.CURRENT["east"]
    speed, towards = np.hypot(north, east), np.degrees(np.arctan2(east, north))
    assert f"{north:.2f} m/s to the north and {east:.2f} m/s to the east" in text
    assert f"is {speed:.3f} m/s towards {towards:03.0f}°" in text


def test_the_logs_say_that_they_are_generated():
    logs = sorted((ROOT / "docs" / "tutorial" / "logs").iterdir())
    assert [log.stem for log in logs] == sorted(generate_tutorial_logs.LOGS)
    assert all(log.read_text(encoding="utf-8").startswith("# GENERATED, not measured") for log in logs)
    assert sum(log.stat().st_size for log in logs) < 1e6


def test_the_logs_are_those_of_the_generator(tmp_path):
    generate_tutorial_logs.main(tmp_path)
    for log in (ROOT / "docs" / "tutorial" / "logs").iterdir():
        ours, theirs = log.read_text(encoding="utf-8"), (tmp_path / log.name).read_text(encoding="utf-8")
        assert len(ours.splitlines()) == len(theirs.splitlines())
        different = [(a, b) for a, b in zip(ours.splitlines(), theirs.splitlines(), strict=True) if a != b]
        assert len(different) < 0.01 * len(ours.splitlines()), different[
            :3
        ]  # a last digit may be rounded otherwise elsewhere
