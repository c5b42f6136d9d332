"""``mmgtune check`` as a CI server runs it: exit codes, files, and nothing lost."""

import json
import os
import shutil

import pyarrow.parquet as pq
import pytest

from tests.checking.test_renderers import check_junit
from tests.command import run


@pytest.fixture
def ready(folder):
    """A folder with its baseline written."""
    ended = run("check", "ship.toml", "trials", "--baseline", "check.json", "--update-baseline", cwd=folder)
    assert ended.code == 0, ended.err
    assert "wrote check.json" in ended.out
    return folder


def check(folder, *more, **env):
    return run("check", "ship.toml", "trials", "--baseline", "check.json", *more, cwd=folder, env=env)


def unsealed(table):
    """A table as a program would write it that knows nothing of digests."""
    return table.replace_schema_metadata(
        {key: value for key, value in table.schema.metadata.items() if key != b"mmgtune.sha256"}
    )


def rewrite(path, **values):
    text = path.read_text(encoding="utf-8")
    for name, value in values.items():
        lines = [f"{name} = {value}" if line.startswith(f"{name} = ") else line for line in text.splitlines()]
        text = "\n".join(lines) + "\n"
    path.write_text(text, encoding="utf-8")


def test_pass_regression_improvement(ready):
    passed = check(ready)
    assert (passed.code, passed.out.splitlines()[-1][:4]) == (0, "pass")
    rewrite(ready / "ship.toml", N_r=-0.055)
    regressed = check(ready, "--junit", "out/junit.xml", "--summary", "summary.md")
    assert regressed.code == 1
    assert regressed.out.splitlines()[-1].startswith("FAIL")
    assert "hull.N_r: -0.057 -> -0.055" in regressed.out
    assert check_junit((ready / "out/junit.xml").read_text(encoding="utf-8")).find(".//failure") is not None
    assert (ready / "summary.md").read_text(encoding="utf-8").startswith("### FAIL")
    rewrite(ready / "ship.toml", N_r=-0.0571)
    improved = check(ready, "--summary", "summary.md", "--metrics", "J")
    assert improved.code == 0
    assert "better" in improved.out
    summary = (ready / "summary.md").read_text(encoding="utf-8")
    assert summary.count("### ") == 2


def test_update_says_what_it_changes_and_keeps_tolerances(ready):
    baseline = json.loads((ready / "check.json").read_text(encoding="utf-8"))
    baseline["tolerances"]["J"]["relative"] = 0.25
    (ready / "check.json").write_text(json.dumps(baseline), encoding="utf-8")
    rewrite(ready / "ship.toml", N_r=-0.055)
    updated = check(ready, "--update-baseline")
    assert updated.code == 0
    assert "->" in updated.out
    assert "for the worse" in updated.out.splitlines()[-1]
    after = json.loads((ready / "check.json").read_text(encoding="utf-8"))
    assert after["tolerances"]["J"]["relative"] == 0.25
    assert after["profile"]["coefficients"]["hull.N_r"] == -0.055
    assert check(ready).code == 0
    assert " no value changes" in check(ready, "--update-baseline").out


def test_only_update_writes(ready):
    before = (ready / "check.json").read_bytes()
    rewrite(ready / "ship.toml", N_r=-0.055)
    check(ready)
    check(ready, "--sensitivity", "0.02")
    assert (ready / "check.json").read_bytes() == before


def test_a_changed_trial_cannot_be_compared(ready):
    path = next((ready / "trials").glob("turn_p35*"))
    table = pq.read_table(path)
    x = table.column("x").to_numpy() + 1.0
    pq.write_table(unsealed(table).set_column(table.schema.get_field_index("x"), table.field("x"), [x]), path)
    ended = check(ready, "--json")
    assert ended.code == 2
    document = ended.json()
    assert document["verdict"] == "not comparable"
    assert "changed since the baseline" in document["sentence"]
    assert "--update-baseline" in document["next"]


def test_a_missing_channel_and_an_unreadable_trial(ready):
    path = next((ready / "trials").glob("turn_p35*"))
    table = pq.read_table(path)
    pq.write_table(unsealed(table).drop_columns(["r"]), path)
    next((ready / "trials").glob("zigzag*")).write_bytes(b"PAR1 no")
    ended = check(ready, "--junit", "junit.xml")
    assert ended.code == 2
    assert "'r' is missing" in ended.err
    assert "zigzag_20" in ended.err
    assert len(check_junit((ready / "junit.xml").read_text(encoding="utf-8")).findall(".//error")) == 2


@pytest.mark.parametrize("content", ["", "{", "null", '{"schema": 1, "kind": "fit"}'])
def test_an_unreadable_baseline(ready, content):
    (ready / "check.json").write_text(content, encoding="utf-8")
    ended = check(ready)
    assert ended.code == 2
    assert "check.json" in ended.err
    assert "Traceback" not in ended.err
    # What is no baseline is not overwritten either.
    assert check(ready, "--update-baseline").code == 2
    assert (ready / "check.json").read_text(encoding="utf-8") == content


def test_a_missing_baseline(folder):
    ended = check(folder)
    assert ended.code == 2
    assert "--update-baseline" in ended.err


def test_a_crash_is_neither_pass_nor_regression(ready):
    (ready / "sitecustomize.py").write_text(
        "import mmgtune.checking.run as r\ndef broken(*a, **k): raise RuntimeError('boom')\nr.measure = broken\n",
        encoding="utf-8",
    )
    ended = check(ready, PYTHONPATH=str(ready))
    assert ended.code == 3
    assert "bug: RuntimeError('boom')" in ended.err


def test_no_trial_left(ready):
    shutil.rmtree(ready / "trials")
    (ready / "trials").mkdir()
    assert check(ready).code == 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--format", "xml"), "no format 'xml'"),
        (("--metrics", "JJ"), "unknown metric"),
        (("--integrator", "leapfrog"), "leapfrog"),
        (("--integrator", "euler"), "made with rk4"),
        (("--backend", "gpu"), "unknown back end"),
        (("--sensitivity", "0"), "of itself"),
        (("--summary", "no/such/folder/s.md"), "cannot write"),
    ],
)
def test_wrong_options(ready, arguments, said):
    ended = check(ready, *arguments)
    assert ended.code == 2
    assert said in ended.err
    assert "Traceback" not in ended.err


@pytest.mark.parametrize("option", ["--update-baseline", "--sensitivity=0.02"])
def test_what_needs_a_baseline(folder, option):
    ended = run("check", "ship.toml", "trials", option, cwd=folder)
    assert ended.code == 2
    assert "needs a baseline" in ended.err


def test_on_github_annotations_follow_the_text(ready):
    rewrite(ready / "ship.toml", N_r=-0.055)
    ended = check(ready, GITHUB_ACTIONS="true")
    assert ended.code == 1
    assert "FAIL" in ended.out
    assert "::error file=" in ended.out
    plain = check(ready, "--format", "text", GITHUB_ACTIONS="true")
    assert "::error" not in plain.out
    only = check(ready, "--format", "github")
    assert all(line.startswith("::") for line in only.out.splitlines())
    (ready / "check.json").unlink()
    assert "::error title=could not run" in check(ready, GITHUB_ACTIONS="true").out


def test_other_formats(ready):
    assert check(ready, "--json").json()["verdict"] == "pass"
    check_junit(check(ready, "--format", "junit").out)
    assert check(ready, "--format", "markdown").out.startswith("### pass")
    assert "ok" in check(ready, "--all").out


def test_limits_need_no_baseline(folder):
    path = folder / "ship.toml"
    path.write_text(path.read_text(encoding="utf-8") + '\n[limits]\nrms_psi = "1 deg"\n', encoding="utf-8")
    ended = run("check", "ship.toml", "trials", cwd=folder)
    assert ended.code == 1
    assert "above the profile's limit of 1" in ended.out


@pytest.mark.long
def test_sensitivity(ready):
    shown = check(ready, "--sensitivity", "0.02")
    assert shown.code == 0, shown.err
    assert "are noticed when changed by 2 %" in shown.out.splitlines()[-1]
    rows = check(ready, "--sensitivity", "0.02", "--json").json()["rows"]
    assert {row["change"] for row in rows} == {"+", "-"}


def test_trials_of_another_ship_are_told(ready):
    ended = run("check", "kvlcc2", "trials", "--baseline", "check.json", cwd=ready)
    assert ended.code == 2
    assert "of ship 'suzaku'" in ended.err


def test_the_record_is_no_baseline_and_replaces_nothing(ready):
    """``--out`` wrote its record over a baseline of the same name, and over the record before."""
    before = (ready / "check.json").read_bytes()
    for more in ((), ("--force",)):
        ended = check(ready, "--out", ".", *more)
        assert ended.code == 2
        assert ("not a run of mmgtune" if more else "exists already") in ended.err
    assert check(ready, "--out", "found").code == 0
    assert {"checked.json", "report.html"} <= {one.name for one in (ready / "found").iterdir()}
    again = check(ready, "--out", "found")
    assert (again.code, "exists already" in again.err) == (2, True)
    assert check(ready, "--out", "found", "--force").code == 0
    assert (ready / "check.json").read_bytes() == before


def test_a_check_that_could_not_run_leaves_its_folder_to_the_next(ready):
    """After a name misspelt the command put right was refused: the output existed already."""
    misspelt = run("check", "suzaku", "trials", "--baseline", "chek.json", "--out", "new", cwd=ready)
    assert misspelt.code == 2
    assert not (ready / "new").exists()
    assert check(ready, "--out", "new").code == 0


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (
            ("--update-baseline", "--junit", "j.xml"),
            "it does not go with --update-baseline (--junit)\n",
        ),
        (("--update-baseline", "--format", "markdown"), "it does not go with --update-baseline (--format)\n"),
        (("--sensitivity", "0.02", "--summary", "s.md"), "it does not go with --sensitivity (--summary)\n"),
        (("--force",), "nothing is written (--force)"),
    ],
)
def test_what_would_be_ignored_is_refused(ready, asked, said):
    before = (ready / "check.json").read_bytes()
    ended = check(ready, *asked)
    assert (ended.code, ended.out) == (2, "")
    assert said in ended.err
    assert (ready / "check.json").read_bytes() == before
    assert not (ready / "j.xml").exists()


@pytest.mark.long
def test_the_sensitivity_as_json_by_either_name(ready):
    one, other = (check(ready, "--sensitivity", "0.02", *more) for more in (("--json",), ("--format", "json")))
    assert one.json() == other.json()


@pytest.mark.parametrize("node", ["pipe", "stdout"])
def test_a_pipe_or_a_device_is_not_replaced_by_a_report(ready, node):
    path = ready / "junit.xml"
    if node == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/proc/self/fd/1")  # as /dev/stdout is
    before = path.lstat()
    ended = check(ready, "--junit", "junit.xml")
    assert ended.code == 2
    assert "error: the output is not a file (junit.xml)" in ended.err
    assert "fix: give the name of a file" in ended.err
    assert not ended.out
    after = path.lstat()
    assert (after.st_ino, after.st_mode) == (before.st_ino, before.st_mode)


def test_only_an_older_report_is_replaced_by_a_report(ready):
    path = ready / "notes.xml"
    shutil.copy(ready / "ship.toml", ready / "kept.toml")
    ended = check(ready, "--junit", "kept.toml")
    assert ended.code == 2
    assert "what is there is no JUnit report, and would be lost" in ended.err
    assert (ready / "kept.toml").read_bytes() == (ready / "ship.toml").read_bytes()
    for older in ("", '<?xml version="1.0"?>\n<!-- made at night -->\n<testsuite name="x"/>\n'):
        path.write_text(older, encoding="utf-8")
        assert check(ready, "--junit", "notes.xml").code == 0
        assert check(ready, "--junit", "notes.xml").code == 0
    check_junit(path.read_text(encoding="utf-8"))


def test_a_summary_for_a_pipe_that_nobody_reads(ready):
    os.mkfifo(ready / "summary.md")
    ended = check(ready, "--summary", "summary.md")
    assert ended.code == 2
    assert "cannot write the output (summary.md)" in ended.err
