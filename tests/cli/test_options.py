"""Options are fields of dataclasses: one flag each, the same in every command; the library speaks of fields."""

import importlib.util
import subprocess
import sys
from dataclasses import dataclass, fields
from pathlib import Path

import pytest
import typer.main

import mmgtune
from mmgtune import backends, options
from mmgtune.cli import app
from mmgtune.cli.options import RunOptions, parameters_of, problems_in_flags
from mmgtune.errors import OptionError, Problem
from mmgtune.options import FLAGS, FitOptions, LearnOptions, choice, choices, in_flags
from mmgtune.options.simulation import BACKENDS, INTEGRATORS
from mmgtune.simulating import revolutions, rudder_angle
from tests.command import run

CLASSES = {
    "fit": options.FitOptions,
    "sweep": options.SweepOptions,
    "leave-out": options.LeaveOutOptions,
    "diagnose": options.DiagnoseOptions,
    "validate": options.ValidateOptions,
    "check": options.CheckOptions,
    "simulate": options.SimulateOptions,
}
MAY = ("cli", "report", "pytest_plugin.py", "importing", "doctor.py", "profile", "options")
COMMANDS = typer.main.get_command(app).commands
ROOT = Path(__file__).parents[2]


def flags_of(command):
    return {p.name: p for p in COMMANDS[command].params if p.param_type_name == "option"}


@pytest.mark.parametrize("command", CLASSES)
def test_every_field_is_one_flag_of_its_command(command):
    of = CLASSES[command]
    shown = flags_of(command)
    known = choices(of)
    assert set(known) == {one.name for one in fields(of)}
    taken = [flag for p in shown.values() for flag in (*p.opts, *p.secondary_opts)]
    for name, one in known.items():
        assert one.flag in (*shown[name].opts, *shown[name].secondary_opts)
        assert taken.count(one.flag) == 1
        assert shown[name].help == one.help


def test_a_flag_means_the_same_in_every_command():
    first = {}
    for of in CLASSES.values():
        for name, one in choices(of).items():
            flag, meaning = first.setdefault(name, (one.flag, one.help))
            assert one.flag == flag
            assert one.help.startswith(meaning) or meaning.startswith(one.help), (of, name)
    by_flag = {}
    for name, (flag, _) in first.items():
        by_flag.setdefault(flag, set()).add(name)
    assert [names for names in by_flag.values() if len(names) > 1] == [{"a_r", "widths"}]


@pytest.mark.parametrize("command", ["fit", "sweep", "leave-out", "diagnose"])
def test_every_long_command_can_be_planned_resumed_and_read(command):
    shown = flags_of(command)
    assert {"out", "force", "resume", "dry_run", "json", "quiet"} <= set(shown)
    assert {one.name for one in fields(RunOptions)} <= set(shown)


def test_what_fits_takes_the_same():
    """sweep had no --with-effects, leave-out neither --loss nor --identifiable."""
    shared = {one.name for one in fields(options.TuningOptions)}
    assert {"with_effects", "loss", "identifiable"} <= shared
    for command in ("fit", "sweep", "leave-out"):
        assert shared <= set(flags_of(command))


def test_a_new_field_is_a_flag_help_and_json_by_itself():
    @dataclass(frozen=True)
    class More(FitOptions):
        patience: int = choice(3, "How long to wait.", least=1)

    (found,) = [p for p in parameters_of(More) if p.name == "patience"]
    assert found.default == 3
    assert FLAGS.pop("patience") == "--patience"
    assert More().to_dict()["patience"] == 3
    with pytest.raises(OptionError, match="patience is 0"):
        More(patience=0)


def test_two_flags_for_one_field_are_a_mistake_found_at_once():
    @dataclass(frozen=True)
    class Other(options.Options):
        a_r: float = choice(0.5, "Something else.", flag="--width")

    with pytest.raises(TypeError, match="a_r"):
        parameters_of(Other)


def test_words_are_those_of_the_back_ends():
    assert BACKENDS == backends.BACKENDS
    for name in INTEGRATORS:
        assert backends.Integrator(name).name == name


def test_the_page_of_commands_has_every_option():
    pytest.importorskip("mkdocs")
    pytest.importorskip("latex2mathml")
    spec = importlib.util.spec_from_file_location("site_hooks", ROOT / "tools" / "site_hooks.py")
    hooks = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hooks)
    page = hooks.commands()
    for command, of in CLASSES.items():
        part = page.split(f"\n## mmgtune {command}\n")[1].split("\n## ")[0]
        for one in choices(of).values():
            assert f"| `{one.flag}" in part
            assert hooks.plain(one.help) in part


def test_the_library_names_fields_and_the_command_line_flags(tmp_path):
    with pytest.raises(OptionError) as found:
        FitOptions(a_r=50.0, loss="huber")
    assert {problem.where for problem in found.value.problems} == {"method", "a_r"}
    assert "--" not in str(found.value)
    said = "\n".join(map(str, problems_in_flags(found.value)))
    assert "did you mean --ar 0.5?" in said
    with pytest.raises(OptionError, match=r"fix: give a number, 0 or more and 0\.8 or less"):  # 0.9 was no percent
        LearnOptions(validation=0.9)
    assert "add --method least-squares" in said
    assert in_flags("add force=True, or choose.") == "add --force, or choose."
    assert in_flags('name some, such as targets="hull.Y_*"') == 'name some, such as --targets "hull.Y_*"'
    assert in_flags("epsilon=0.5 is no option") == "epsilon=0.5 is no option"


def test_no_module_below_the_command_line_speaks_of_flags():
    # Whole commands to type next, as a report or a check proposes them, are meant.
    for path in (ROOT / "mmgtune").rglob("*.py"):
        below = path.relative_to(ROOT / "mmgtune").parts
        if "renderers" in below or below[0] in (
            "cli",
            "report",
            "pytest_plugin.py",
            "importing",
            "doctor.py",
            "profile",
            "options",
        ):
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if '"--' in line or " --" in line.partition("#")[0]:
                assert "mmgtune " in line, (path.name, number, line)


def test_a_length_of_windows_is_called_restart_everywhere(tmp_path):
    ended = run("validate", "suzaku", "suzaku", "--window", "100", cwd=tmp_path)
    assert ended.code == 2
    assert "write --restart 100" in ended.err


@pytest.mark.parametrize(
    ("read", "text", "value"),
    [
        (rudder_angle, "35", 0.6109), (rudder_angle, "-35 deg", -0.6109), (rudder_angle, "0.61 rad", 0.61),
        (rudder_angle, "1 deg", 0.01745), (revolutions, "106", 1.7667), (revolutions, "1.77 1/s", 1.77),
        (revolutions, "12 rpm", 0.2),
    ],
)  # fmt: skip
def test_angles_and_revolutions_with_and_without_a_unit(read, text, value):
    assert read(text) == pytest.approx(value, abs=1e-4)


@pytest.mark.parametrize(
    ("read", "text", "said"),
    [
        (rudder_angle, "0.61", "looks like radians"), (rudder_angle, "120", "between -90 and 90"),
        (rudder_angle, "35 kn", "unit 'kn'"), (revolutions, "1.77", "look like 1/s"), (revolutions, "-5", "above 0"),
    ],
)  # fmt: skip
def test_what_looks_like_another_unit_is_refused(read, text, said):
    with pytest.raises(OptionError, match=said):
        read(text)


def test_orders_in_degrees_are_refused():
    with pytest.raises(OptionError, match=r"35 rad.*\n.*radians\n.*math.radians\(35\)"):
        mmgtune.TurningOrder(35)
    with pytest.raises(OptionError, match="check heading is 20 rad"):
        mmgtune.ZigzagOrder(0.35, 20)
    assert mmgtune.TurningOrder(-1.2).angle == -1.2


@pytest.mark.long
def test_a_pipe_that_closes_early_is_no_failure(tmp_path):
    code = "import sys; from mmgtune.__main__ import main; sys.argv = ['mmgtune', 'fit', '--dry-run']; main()"
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        process.stdout.close()  # as head does when it has seen enough
        err = process.stderr.read()
    assert process.returncode == 0, err
    assert err == ""


def test_everything_has_a_short_repr():
    profile, trials = mmgtune.load_profile("suzaku"), mmgtune.load_trials("suzaku")
    trial = trials.trials["turn_p35"]
    result = mmgtune.fit("suzaku", "suzaku", FitOptions(method="least-squares", starts=1, targets=("hull.R_0",)))
    scored = mmgtune.validate("suzaku", "suzaku")
    motions = mmgtune.simulate("suzaku", [trial])
    checked = mmgtune.check("suzaku", "suzaku", ROOT / "trials" / "suzaku" / "check.json")
    for one in (
        profile, trials, trial, result, result.compared[0], scored, scored.profiles[0], motions, motions[0], checked
    ):  # fmt: skip
        assert len(repr(one)) < 300
        assert repr(one).startswith(type(one).__name__)


def test_problems_of_files_stay_as_they_are():
    (told,) = problems_in_flags(OptionError(Problem("x", "a/b.json")))
    assert told.where == "a/b.json"
