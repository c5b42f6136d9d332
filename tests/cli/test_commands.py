"""The other commands, help, and the ways out."""

import re
import subprocess
import sys
from dataclasses import replace

import pytest
from typer.main import get_command

from mmgtune.cli import _say_warning, app
from mmgtune.cli.exitcodes import EPILOG
from mmgtune.trial import load_trials, read_trial, write_trial
from tests.command import run, typed

COMMANDS = [
    ("fit",), ("sweep",), ("leave-out",), ("validate",), ("learn", "compare"), ("check",), ("cite",), ("doctor",),
    ("simulate",), ("report",), ("trials", "import"),
    ("trials", "check"), ("trials", "inspect"), ("profile", "list"), ("profile", "show"), ("profile", "validate"),
]  # fmt: skip
HEAVY = ("numpy", "scipy", "pandas", "numba", "cma", "matplotlib", "plotly", "pyarrow", "tomlkit", "jinja2")


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_help(command, tmp_path):
    ended = run(*command, "--help", cwd=tmp_path)
    assert ended.code == 0
    assert "Usage: mmgtune" in ended.out.replace("python -m mmgtune", "mmgtune")
    assert len(ended.out.splitlines()) > 5


def every_command(group=None, before=()):
    for name, one in (group or get_command(app)).commands.items():
        if hasattr(one, "commands"):
            yield from every_command(one, (*before, name))
        else:
            yield (*before, name), one


def test_every_command_has_examples_and_exit_codes():
    """Those of groups had no exit codes, and some no example, though the README promises one."""
    commands = dict(every_command())
    assert len(commands) > 25
    assert [name for name, one in commands.items() if one.epilog != EPILOG or "mmgtune " not in one.help] == []


@pytest.mark.parametrize(
    ("asked", "kind"),
    [
        (("profile", "list"), "profile-list"),
        (("profile", "show", "suzaku"), "profile"),
        (("profile", "validate", "suzaku"), "profile-validate"),
        (("trials", "check", "suzaku"), "trials-check"),
        (("trials", "inspect", "suzaku"), "trials-inspect"),
        (("simulate", "--turn", "35"), "simulate"),
        (("fit", "--dry-run"), "dry-run"),
        (("leave-out", "--dry-run"), "dry-run"),
    ],
    ids=lambda one: one if isinstance(one, str) else " ".join(one),
)
def test_documents_say_what_they_are(asked, kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    document = typed(*asked, "--json").json()
    assert (document["schema"], document["kind"]) == (1, kind)
    assert list(tmp_path.iterdir()) == []  # also of the folder that a dry run would take


@pytest.mark.parametrize(("named", "warned"), [((), True), (("-p", "suzaku"), False)])
def test_trials_that_name_no_ship_are_of_the_bundled_one_in_silence_only_if_she_is_named(named, warned, tmp_path):
    for trial in load_trials("suzaku").trials.values():
        write_trial(replace(trial, ship=""), tmp_path / f"{trial.id}.parquet")
    ended = typed("fit", *named, "-t", tmp_path, "--dry-run")
    assert ended.code == 0
    assert ("the trials do not say which ship they are of: M.V. SUZAKU" in ended.err) is warned


def test_help_imports_nothing_heavy():
    code = (
        "import sys\nsys.argv = ['mmgtune', '--help']\nfrom mmgtune.cli import main\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert end.code == 0\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules], file=sys.stderr)"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stderr.strip().endswith("[]")


def test_trials_are_read_without_scipy_and_pandas(tmp_path):
    """They take most of a second to load, and few commands need them."""
    code = (
        "import sys\nsys.argv = ['mmgtune', 'trials', 'check', 'suzaku']\nfrom mmgtune.cli import main\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert not end.code\n"
        "print([name for name in ('pandas', 'scipy', 'matplotlib', 'numba') if name in sys.modules], file=sys.stderr)"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert ended.stderr.strip().endswith("[]")


def test_a_mistyped_command_is_answered_with_the_nearest(tmp_path):
    ended = run("fti", cwd=tmp_path)
    assert ended.code == 2
    assert "fit" in ended.err


def test_a_bug_has_its_own_exit_code(monkeypatch, capsys):
    from mmgtune import cli, profile

    def broken(_name):
        raise RuntimeError("something nobody thought of")

    monkeypatch.setattr(profile, "load_profile", broken)
    monkeypatch.setattr(sys, "argv", ["mmgtune", "profile", "validate", "suzaku"])
    with pytest.raises(SystemExit) as end:
        cli.main()
    assert end.value.code == 3
    err = capsys.readouterr().err
    assert "nobody thought of" in err
    path = err.split("full traceback is in ")[1].split(";")[0]
    with open(path, encoding="utf-8") as file:
        assert "RuntimeError" in file.read()


def test_sweep(tmp_path):
    arguments = ("--ar", "0.2,0.5", "--method", "least-squares", "--starts", "2", "--no-report", "--quiet")
    ended = run("sweep", *arguments, "--json", "--out", "run", cwd=tmp_path)
    assert ended.code == 0
    document = ended.json()
    assert document["a_r"] == [0.2, 0.5]
    assert document["recommended"]["a_r"] == 0.5
    assert (tmp_path / "run" / "sweep.json").exists()
    assert (tmp_path / "run" / "ar_0.5" / "profile.toml").exists()


def test_simulate_writes_trials_that_read_back(tmp_path):
    ended = run("simulate", "--turn", "35", "--zigzag", "-10/10", "--out", "sim", "--forces", "--json", cwd=tmp_path)
    assert ended.code == 0
    document = ended.json()
    assert [r["id"] for r in document["runs"]] == ["turn_p35", "zigzag_m10_10"]
    assert document["runs"][0]["indices"]["tactical_diameter_over_L"] == pytest.approx(1.88, abs=0.02)
    assert {c["name"] for c in document["runs"][0]["criteria"]} >= {"advance", "tactical diameter"}
    assert all(c["passed"] for c in document["runs"][0]["criteria"])
    trial = read_trial(tmp_path / "sim" / "turn_p35.parquet")
    assert trial.source == "generated"
    total = trial.extra["hull_X"] + trial.extra["propeller_X"] + trial.extra["rudder_X"]
    assert total == pytest.approx(trial.extra["total_X"])
    assert "w_P" in trial.extra
    again = run("simulate", "--turn", "35", "--out", "sim", cwd=tmp_path)
    assert again.code == 2
    assert "exists already" in again.err


def test_simulate_trials_beside_the_measured_indices(tmp_path):
    ended = run("simulate", "--trials", "suzaku", "--json", cwd=tmp_path)
    runs = {r["id"]: r for r in ended.json()["runs"]}
    assert len(runs) == 10
    assert runs["turn_p35"]["measured"]["advance_m"] > runs["turn_p35"]["indices"]["advance_m"]
    assert runs["zigzag_20"]["measured"]["overshoot_1_deg"] > 0.0
    assert runs["zigzag_20"]["indices"]["order"] == runs["zigzag_20"]["measured"]["order"] == "20/20"
    assert runs["turn_m10"]["measures"]["MED"] > runs["turn_p40"]["measures"]["MED"] > 10.0
    assert set(runs["turn_m10"]["measures"]) == {"MMD", "MED", "ASD", "MSD", "PMD", "PED", "cVDM"}


def test_indices_have_one_name_and_one_order(tmp_path):
    orders = ("--turn", "35", "--zigzag", "10/10")
    simulated, predicted = (run(*start, *orders, cwd=tmp_path).out for start in (("simulate",), ("predict", "suzaku")))
    rows = r"^  (?!IMO)(\S.*?)  +[\d.]+(?: |$)"
    names = re.findall(rows, predicted, re.M)
    assert "speed ratio at 90 deg" in names
    assert names[-3:] == ["4th overshoot", "reach", "period"]
    assert [name for name in re.findall(rows, simulated, re.M) if name in names] == names


def test_simulate_says_indices_in_words_with_units(tmp_path):
    ended = run("simulate", "--turn", "35", "--zigzag", "10/10", cwd=tmp_path)
    assert re.search(r"^turn_p35  \(turn 35° to starboard, \d+ s, rk4\)\n  advance +[\d.]+ m +[\d.]+ L\n", ended.out)
    assert re.search(r"^  steady yaw rate +[\d.]+ deg/s$", ended.out, re.M)
    assert re.search(r"^  1st overshoot +[\d.]+ deg$", ended.out, re.M)
    assert "_" not in ended.out.replace("turn_p35", "").replace("zigzag_p10_10", "")
    ended = run("simulate", "--trials", "suzaku", cwd=tmp_path)
    assert re.search(r"^  advance +[\d.]+ m +[\d.]+ L +measured +[\d.]+ m +[\d.]+ L$", ended.out, re.M)
    assert re.search(r"^  MED \[m\] +[\d.]+$", ended.out, re.M)
    assert ended.err.count("MED: mean distance off the measured place") == 1


def test_trials_check_and_inspect(tmp_path):
    assert run("trials", "check", "suzaku", "--strict", cwd=tmp_path).code == 0
    ended = run("trials", "inspect", "suzaku", "--json", cwd=tmp_path)
    rows = {row["id"]: row for row in ended.json()["trials"]}
    assert "order 20/20" in " ".join(run("trials", "inspect", "suzaku", cwd=tmp_path).out.split())
    assert rows["turn_p35"]["role"] == "tune"
    assert rows["zigzag_10"]["role"] == "other"
    assert rows["turn_p35"]["ranges"]["delta"]["max"] == pytest.approx(35.0, abs=0.5)
    assert rows["turn_p35"]["source"] == "generated"


def test_trials_check_of_what_cannot_be_read_is_json_too(tmp_path):
    (tmp_path / "a.parquet").write_text("no table")
    ended = run("trials", "check", "a.parquet", "--json", cwd=tmp_path)
    assert ended.code == 2
    document = ended.json()
    assert document["trials"] == {}
    (problem,) = document["problems"]
    assert problem["what"] in ended.err
    assert run("trials", "check", "suzaku", "--json", cwd=tmp_path).json()["problems"] == []


def test_indices_are_counted_in_lengths_of_the_right_ship(tmp_path):
    trial = next(iter(load_trials("suzaku").trials.values()))
    write_trial(replace(trial, ship="kvlcc2"), tmp_path / "a.parquet")
    assert run("trials", "inspect", "a.parquet", "--json", cwd=tmp_path).json()["L_pp_m"] == 320.0
    other = run("trials", "inspect", "a.parquet", "-p", "suzaku", cwd=tmp_path)
    assert "warning: the trials are of 'kvlcc2'" in other.err
    write_trial(replace(trial, ship="Ever Given"), tmp_path / "b.parquet")
    unknown = run("trials", "inspect", "b.parquet", cwd=tmp_path)
    assert unknown.code == 2
    assert "'Ever Given', which is no bundled profile" in unknown.err


def test_profile_commands(tmp_path):
    listed = run("profile", "list", cwd=tmp_path).out
    assert all(name in listed for name in ("suzaku", "kvlcc2", "kvlcc2_l7"))
    shown = run("profile", "show", "suzaku", "--json", cwd=tmp_path).json()
    assumed = {row["name"] for row in shown["coefficients"] if row["assumption"]}
    assert assumed >= {"rudder.flap", "particulars.k_zz_", "rudder.x_R_", "propeller.slipstream_kt"}
    assert run("profile", "validate", "kvlcc2", cwd=tmp_path).code == 0


def test_report_of_no_run_is_refused(tmp_path):
    ended = run("report", ".", cwd=tmp_path)
    assert ended.code == 2
    assert "fix" in ended.err


@pytest.mark.parametrize("text", ["one line\nTraceback (most recent call last):\n  in there", "\none line\n"])
def test_of_a_warning_one_line_is_said(capsys, text):
    """Numba quotes a traceback in what it says of a variable of the environment."""
    _say_warning(text)
    assert capsys.readouterr().err == "warning: one line\n"


def test_what_is_the_same_of_several_trials_is_said_once(tmp_path):
    said = run("trials", "check", "suzaku", cwd=tmp_path).out
    assert said.count("note: generated, not measured") == 1
    assert re.search(r"note: generated, not measured \(\S+\.parquet, and 9 more\)", said)
