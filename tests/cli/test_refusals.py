"""What the command line says when it cannot go on: always what, where, why and the fix, in a line each."""

import pytest
import typer

from mmgtune import resources
from mmgtune.cli import app
from tests.command import typed

TRIAL = resources.folder("trials") / "suzaku" / "turn_p35.parquet"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("fit", "-p", "suzuku"), ("no such ship profile (suzuku)", "no bundled profile", "did you mean 'suzaku' or")),
        (("fit", "-t", "nowhere"), ("no such trials (nowhere)", "no bundled data set", "give a folder")),
        (
            ("fit", "-t", "mine/trials"),
            ("no such trials (mine/trials)", "there is no 'mine/trials' in ", "give a folder"),
        ),
        (("fit", "--targets", "hull.R0"), ("'hull.R0' (--targets)", "coefficients", "did you mean 'hull.R_0'")),
        (("fit", "--method", "cmaess"), ("(--method)", "the only names known here: ", "did you mean 'cma-es'?")),
        (("fit", "--ar", "-1"), ("a_r is -1 (--ar)", "Half width of the box", "0.001 or more")),
        (("fit", "--ar", "1e-300", "--dry-run"), ("a_r is 1e-300 (--ar)", "from 0.001", "0.001 or more")),
        (("sweep", "--ar", "0.2,1e-300", "--dry-run"), ("widths is 1e-300 (--ar)", "from 0.001", "0.001 or more")),
        (("fit", "--channels", "speed"), ("(--channels)", "known here: x, y", "write one of these")),
        (("fit", "--window", "9:3"), ("is empty (--window)", "its end is not after", "--window FIRST:LAST")),
        (("diagnose", "--effects", "curent"), ("(--effects)", "names known here", "did you mean 'current'")),
        (("diagnose", "--fail-on", "certain"), ("(--fail-on)", "known here: ", "write one of these")),
        (
            ("check", "suzaku", "suzaku", "-b", "no.json"),
            ("no baseline (no.json)", "there is no 'no.json' in", "--update"),
        ),
        (("check", "suzaku", "suzaku", "--format", "jsn"), ("(--format)", "the only names", "did you mean 'json'")),
        (("compare", "suzaku"), ("(MODEL... TRIALS)", "only 'suzaku' was given", "such as mmgtune compare")),
        (("validate", "suzaku"), ("(PROFILE... TRIALS)", "only 'suzaku' was given", "such as mmgtune validate")),
        (("simulate", "--turn", "hard"), ("'hard' cannot be read (--turn)", "not a number with a unit", "--turn 35")),
        (("simulate", "--zigzag", "20"), ("is not a zigzag (--zigzag)", "with a stroke between", "such as 20/20")),
        (("report", "nowhere"), ("no such run folder (nowhere)", "there is no 'nowhere' in ", "give the folder")),
        (
            ("report", str(TRIAL)),
            ("this is a file, not a run folder", "of the whole folder", f"give the folder: {TRIAL.parent}"),
        ),
        (("trials", "import", "a.csv"), ("(--map, --preset)", "what the columns of a log mean", "mmgtune trials map")),
        (("trials", "make", "suzuku", "-o", "x"), ("'suzuku' (ship)", "known here", "")),
        (("plan",), ("argument MODEL is missing (mmgtune plan)", "Particles of posterior", "mmgtune plan runs/bands")),
        (("trials", "make", "suzaku"), ("--out is missing (mmgtune trials make)", "Folder for", "mmgtune trials make")),
        (("fit", "--metod", "x"), ("unknown option --metod (mmgtune fit)", "none is called that", "'--method'")),
        (
            ("simulate", "--resume"),
            ("unknown option --resume", "these have it: diagnose, fit, fleet run", "fix: mmgtune simulate --help"),
        ),
        (
            ("leave-out", "--method", "cma-es"),
            ("unknown option --method", "these have it: fit, sweep", "fix: mmgtune leave-out --help lists them"),
        ),
        (
            ("validate", "-p", "suzaku", "-t", "suzaku"),
            ("unknown option -p (mmgtune validate)", "no option before", "fix: write mmgtune validate suzaku suzaku"),
        ),
        (
            ("compare", "a.toml", "--trials=my logs", "--profile", "b.toml", "--restart", "100"),
            (
                "unknown option --trials",
                "no option before",
                "write mmgtune compare b.toml a.toml 'my logs' --restart 100",
            ),
        ),
        (
            ("check", "-p", "a.toml", "-t"),
            ("unknown option -p", "no option before", "mmgtune check ship.toml trials/ "),
        ),
        (("report", "-p", "run"), ("unknown option -p", "takes argument RUN, with no option", "write mmgtune report ")),
        (("--zzz",), ("unknown option --zzz (mmgtune)", "options", "mmgtune --help lists them")),
        (("fit", "more"), ("'more' is one word too many (mmgtune fit)", "takes options alone", "write mmgtune fit ")),
        (("fit", "ship", "logs"), ("'ship logs' are words", "takes options", "write mmgtune fit -p ship -t logs")),
        (("fit", "a.parquet"), ("'a.parquet' is one word", "takes options", "write mmgtune fit -t a.parquet")),
        (
            ("fit", "-p", str(TRIAL), "-t", "suzaku"),
            ("a trial, not a ship profile", "TOML files", f"--trials {TRIAL}"),
        ),
        (
            ("predict", "suzaku", "--turn", "35", "--rpm", "1e9"),
            ("1e+09 rpm (--rpm)", "times the 106 rpm of the profile's approach", "less than 530 rpm"),
        ),
        (
            ("predict", "suzaku", "--speed", "500 kn"),
            ("500 kn (--speed)", "a Froude number of 9 ", "a speed below 27.7 kn"),
        ),
        (
            ("predict", "suzaku", "--stop", "--astern", "1e6"),
            ("1e+06 rpm (--astern)", "the 106 rpm", "less than 530 rpm"),
        ),
        (("simulate", "--turn", "35", "--speed", "500kn"), ("500 kn (--speed)", "Froude", "a speed below")),
        (("simulate", "--turn", "35", "--rpm", "1e9"), ("1e+09 rpm (--rpm)", "times the", "less than")),
        (
            ("plan", "my bands", "x"),
            ("'x' is one word too many", "argument MODEL", "mmgtune plan 'my bands' --question "),
        ),
        (("report", "a", "b"), ("'b' is one word too many", "takes argument RUN", "write mmgtune report ")),
        (
            ("fit", "--starts", "many"),
            ("the value is not a whole number (--starts)", "it sets this: ", "give a whole number"),
        ),
        (("fit", "--ar", "30%"), ("the value is not a number (--ar)", "it sets this: ", "write --ar 0.3")),
        (("fit", "--ar=0,4"), ("the value is not a number (--ar)", "it sets this: ", "write --ar 0.4")),
        (("simulate", "--turn", "35,5"), ("'35,5' may be one number or two", "a comma", "write --turn 35.5, or")),
        (
            ("simulate", "--speed", "7,5m/s"),
            ("'7,5m/s' cannot be read (--speed)", "decimal point", 'write --speed "7.5m/s"'),
        ),
        (("simulate", "--speed", "7,5"), ("'7,5' cannot be read", "decimal point", 'write --speed "7.5 m/s" if')),
        (("simulate", "--speed", "1, 2 kn"), ("cannot be read (--speed)", "it is 2 numbers", "write --speed")),
        (("simulate", "--speed", "-5kn"), ("the approach speed is -5kn", "begin ahead", "a speed above 0")),
        (("fit", "--targets", ""), ("'' names nothing (--targets)", "no list", "give --targets a value, or leave")),
        (("diagnose", "--targets=,"), ("',' names nothing (--targets)", "no list", "give --targets a value, or leave")),
        (("simulate", "--turn", " "), ("' ' names nothing (--turn)", "no number", "give --turn a value")),
        (("fit", "-t", ""), ("'' names nothing (-t)", "no name", "give -t a value")),
        (("trials", "check", ""), ("'' names nothing (command line)", "no name", "write a name")),
        (("fit", "--starts"), ("--starts has no value (--starts)", "where its value belongs", "or leave")),
        (("fitt",), ("unknown command 'fitt' (mmgtune)", "names known here", "did you mean 'fit'")),
        (("import", "a.csv"), ("unknown command 'import' (mmgtune)", "", "fix: write mmgtune trials import")),
        (("profile", "check"), ("unknown command 'check'", "", "fix: write mmgtune profile validate")),
        (("trials", "show"), ("unknown command 'show' (mmgtune trials)", "", "fix: write mmgtune trials inspect")),
        (("version",), ("unknown command 'version'", "", "fix: write mmgtune --version")),
        (("help", "fit"), ("unknown command 'help'", "", "mmgtune fit --help")),
        (
            ("simulate", "run/particles.parquet"),
            ("is one word too many", "options alone", "write mmgtune simulate -p run/particles.parquet"),
        ),
        (("effects",), ("unknown command 'effects' (mmgtune)", "", "--dry-run, which lists what would be")),
        (("learn", "foo"), ("unknown command 'foo' (mmgtune learn)", "known here: ", "write one of these")),
    ],
    ids=lambda value: "-".join(value).replace(str(TRIAL), TRIAL.name) if " " not in value[-1] else "",
)
def test_a_refusal_says_what_where_why_and_the_fix(tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    ended = typed(*arguments)
    what, why, fix = ended.err.splitlines()
    assert ended.code == 2
    assert (what[:7], why[:7], fix[:7]) == ("error: ", "  why: ", "  fix: ")
    assert all(part in line for part, line in zip(words, (what, why, fix), strict=True)), ended.err
    assert not [*tmp_path.iterdir()]


def test_every_command_that_needs_an_argument_has_an_example_to_show(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for names, command in commands(typer.main.get_command(app)):
        if any(one.required for one in command.params):
            what, why, fix = typed(*names).err.splitlines()
            path = " ".join(("mmgtune", *names))
            assert f"is missing ({path})" in what
            assert "it is needed: " in why
            assert fix.startswith(f"  fix: write {path} ")


def commands(group, names=()):
    """All commands with what is typed for them."""
    for name, one in group.commands.items():
        if hasattr(one, "commands"):
            yield from commands(one, (*names, name))
        else:
            yield (*names, name), one


def test_a_group_without_a_command_shows_its_help(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("fleet", "learn", "trials", "profile", "study"):
        shown = typed(name)
        assert shown.code == 2
        assert "Usage: " in shown.out + shown.err
