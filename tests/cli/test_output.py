"""What is printed steers no terminal and no log, wherever its text came from."""

import ast
import json
from pathlib import Path

import pytest

import mmgtune.cli
from mmgtune.cli.output import filled, harmless
from mmgtune.profile import load_profile
from tests.command import typed

HOSTILE = "\x1b]0;title\x07\x1b[2J\r\u202e\x9b31m\n::error file=a.py::planted\n##[error]planted\n ##vso[task.logissue]x"


def test_everything_is_printed_in_one_place():
    """Where a command prints past ``output``, what it prints is not looked at."""
    for path in Path(mmgtune.cli.__file__).parent.glob("*.py"):
        if path.name != "output.py":
            called = [node.func for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
            names = [one.id for one in called if isinstance(one, ast.Name)]
            assert "print" not in names, path
            assert "echo" not in names, path


def steers(text):
    lines = text.splitlines()
    return (
        any(character in text for character in "\x1b\x07\r\u202e\x9b\x7f")
        or any(line.lstrip().startswith("::") for line in lines)
        or any("##[" in line or "##vso[" in line for line in lines)
    )


def test_text_is_made_harmless():
    assert steers(HOSTILE)
    assert not steers(harmless(HOSTILE))
    assert harmless("\udcff").isascii()
    plain = "Räderwerk δ 35° — 船\t::\n  a: b :: c # ## [x]\n"
    assert harmless(plain) == plain


def test_json_stays_the_same_json():
    document = {"a": HOSTILE + "\x7f\u2028\ud800", "##[b]": ["::x"]}
    text = json.dumps(document, ensure_ascii=False, indent=1)
    assert json.loads(harmless(text)) == document
    assert not steers(harmless(text))


def test_parts_fill_lines(monkeypatch):
    monkeypatch.setenv("COLUMNS", "24")
    assert filled(["one: 1", "two: 2", "three: 3", "four: 4"], "  ") == ["  one: 1   two: 2", "  three: 3   four: 4"]
    assert filled([], "  ") == []


@pytest.fixture
def ship(tmp_path, monkeypatch):
    """A profile with hostile texts."""
    monkeypatch.chdir(tmp_path)
    text = load_profile("suzaku").text
    planted = json.dumps(HOSTILE).replace("\x9b", "\\u009b").replace("\x7f", "\\u007f")
    before = next(line for line in text.splitlines() if line.startswith("name ="))
    (tmp_path / "ship.toml").write_text(text.replace(before, f"name = {planted}", 1), encoding="utf-8")
    assert load_profile("ship.toml").name == HOSTILE
    return tmp_path


@pytest.mark.parametrize(
    "arguments",
    [
        ("profile", "show", "ship.toml"),
        ("profile", "show", "ship.toml", "--json"),
        ("profile", "validate", "ship.toml"),
        ("cite", "ship.toml"),
        ("validate", "ship.toml", "nowhere" + HOSTILE),
        ("check", "ship.toml", "nowhere" + HOSTILE, "--format", "github"),
    ],
)
def test_hostile_names(ship, arguments):
    ended = typed(*arguments)
    assert ended.code in (0, 2)
    assert ended.out or ended.err
    lines = (ended.out + ended.err).splitlines()
    ours = [line for line in lines if line.startswith("::error title=could not run")]
    assert not steers("\n".join(line for line in lines if line not in ours))
    assert not any(steers(line[2:]) for line in ours)
    assert len(ours) == ("github" in arguments)


def test_a_name_that_is_not_text(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ended = typed("fit", "--dry-run", "--out", "a\udcff")
    assert ended.code == 2
    assert "not UTF-8" in ended.err


def test_closed_streams(tmp_path):
    import subprocess
    import sys

    for line in ("profile list >&-", "profile list >&- 2>&-", "fit -p nothing 2>&-"):
        ended = subprocess.run(f"'{sys.executable}' -m mmgtune {line}", shell=True, cwd=tmp_path, capture_output=True)
        assert ended.returncode == (2 if "nothing" in line else 0)
        assert b"Traceback" not in ended.stderr


def test_a_reader_of_both_streams_that_has_seen_enough(tmp_path):
    import subprocess
    import sys

    line = f"'{sys.executable}' -m mmgtune fit -p nothing 2>&1 | true; exit ${{PIPESTATUS[0]}}"
    assert subprocess.run(["bash", "-c", line], cwd=tmp_path).returncode in (0, 2)
