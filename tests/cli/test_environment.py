"""What the environment may say: numbers that are none, and settings of libraries, are said and never guessed at."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from pathlib import Path

import pytest

from mmgtune import doctor
from mmgtune.cli.pipes import Piped
from mmgtune.threads import cores
from tests.command import run

COMPILED = ("simulate", "--trials", "suzaku", "--no-report", "--out", "out")


@pytest.mark.daily("DISABLE_JIT")
@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("NUMBA_DISABLE_JIT", "1"),
        ("NUMBA_NUM_THREADS", "0"),
        ("NUMBA_NUM_THREADS", "-1"),
    ],
)
def test_settings_that_numba_cannot_work_with(name, value, tmp_path):
    ended = run(*COMPILED, cwd=tmp_path, env={name: value}, fresh=True)
    assert ended.code == 2, ended.err
    assert "NUMBA_" in ended.err
    assert "--backend numpy" in ended.err
    assert run(*COMPILED, "--backend", "numpy", "--force", cwd=tmp_path, env={name: value}, fresh=True).code == 0


@pytest.mark.daily("abc", "[0]")
@pytest.mark.parametrize("value", ["abc", "0", "-1", "1.5", "²", "9" * 30])
def test_cores_that_are_no_number(value, tmp_path, monkeypatch):
    few = ("--method", "least-squares", "--starts", "1", "--targets", "hull.R_0", "--no-report", "--quiet")
    fitted = run("fit", *few, cwd=tmp_path, env={"MMGTUNE_THREADS": value})
    assert (fitted.code, "MMGTUNE_THREADS is" in fitted.err) == (2, True), fitted.err
    scored = run("validate", "suzaku", "suzaku", cwd=tmp_path, env={"MMGTUNE_THREADS": value})
    assert (scored.code, "MMGTUNE_THREADS is" in scored.err) == (2, True), scored.err
    assert "unset it" in fitted.err
    monkeypatch.setenv("MMGTUNE_THREADS", value)
    monkeypatch.setattr(doctor, "cores", cores.__wrapped__)  # a process asks once
    assert "MMGTUNE_THREADS is" in doctor._cores().value


@pytest.mark.long
def test_the_doctor_says_so_too(tmp_path):
    assert "MMGTUNE_THREADS is" in run("doctor", cwd=tmp_path, env={"MMGTUNE_THREADS": "abc"}).out


@pytest.mark.daily("abc", "[0]")
@pytest.mark.parametrize("value", ["99999999", "9" * 30, "1", "0", "-5", "abc"])
def test_the_help_whatever_the_width(value, tmp_path):
    ended = run("--help", cwd=tmp_path, env={"COLUMNS": value}, fresh=True)
    assert ended.code == 0, ended.err
    assert max(map(len, ended.out.splitlines())) <= 1000


@pytest.mark.daily("nowhere", "version")
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("line", ["--version", "validate suzaku suzaku --json", "fit -t nowhere"])
def test_no_room_for_what_went_wrong_either(line, tmp_path):
    """Exit code 1 would mean that the answer is no."""
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "mmgtune", *line.split()]
        assert subprocess.run(command, cwd=tmp_path, stdout=full, stderr=full, timeout=60).returncode == 2


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_no_room_for_the_answer(tmp_path):
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "mmgtune", "profile", "list"]
        ended = subprocess.run(command, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    assert ended.returncode == 2
    assert ended.stderr.startswith("error: cannot write the output (standard output)\n  why: No space left on device\n")


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "utf-8"])
def test_letters_that_an_encoding_lacks(encoding):
    """A fit of minutes ended as a bug, with nothing said of it, over the sign of a degree."""
    written = io.BytesIO()
    text = json.dumps({"日本丸": "35° 🚢 naïve"}, ensure_ascii=False)
    stream = Piped(io.TextIOWrapper(written, encoding=encoding), "here")
    stream.write(text)
    stream.flush()
    assert json.loads(written.getvalue().decode(encoding)) == json.loads(text)


def test_a_terminal_without_the_sign_of_a_degree(tmp_path):
    ended = run("simulate", "--turn", "35", cwd=tmp_path, env={"PYTHONIOENCODING": "ascii"}, fresh=True)
    assert (ended.code, ended.err) == (0, "")
    assert r"turn 35\u00b0 to starboard" in ended.out
