"""Ctrl-C, SIGTERM and SIGHUP at any moment: an exit code of their own, one line, and never a traceback."""

import signal
import subprocess
import sys
from dataclasses import replace

import pytest

from mmgtune.cli import interrupts
from mmgtune.trial import load_trials, write_trial

WATCHED = """
import os, signal, sys

class Watch:
    def find_spec(self, name, *_):
        if name == {name!r}:
            {when}
        return None

def sent():
    os.kill(os.getpid(), {number})

class Gone:
    def __del__(self):
        sent()

sys.meta_path.insert(0, Watch())
signal.signal(signal.SIGHUP, signal.SIG_DFL)  # whatever the tests were started by
sys.argv = ["mmgtune", *{arguments!r}]
from mmgtune.__main__ import main
{before}
main()
"""


def ended(folder, *arguments, number=signal.SIGINT, name="", when="sent()", before=""):
    """A command that gets a signal when it imports a module, or from what ``before`` puts in its way."""
    code = WATCHED.format(name=name, when=when, number=int(number), arguments=arguments, before=before)
    return subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, timeout=120)


@pytest.mark.daily("pyarrow", "cli")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("name", ["mmgtune.cli", "typer", "mmgtune.trial", "pyarrow"])
def test_at_start(tmp_path, name, number):
    found = ended(tmp_path, "trials", "check", "suzaku", number=number, name=name)
    assert found.returncode == 128 + number
    words = {signal.SIGINT: "interrupted: ", signal.SIGTERM: "terminated: ", signal.SIGHUP: "hung up: "}
    assert found.stderr.startswith(words[number])
    assert len(found.stderr.splitlines()) == 1
    assert found.stdout == ""


def test_what_nohup_ignores_is_ignored(tmp_path):
    """What was done in a session that was lost ended there; under nohup it goes on."""
    before = "signal.signal(signal.SIGHUP, signal.SIG_IGN)"
    found = ended(tmp_path, "trials", "check", "suzaku", number=signal.SIGHUP, name="pyarrow", before=before)
    assert found.returncode == 0
    assert "hung up" not in found.stderr
    assert found.stdout


def test_in_a_destructor(tmp_path):
    """An exception raised there is printed, and lost: the command went on to its end."""
    found = ended(tmp_path, "trials", "check", "suzaku", name="pyarrow", when="Gone()")
    assert found.returncode == 130
    assert found.stderr == "interrupted: nothing was left half-written\n"


RESUMED = ("fit", "--method", "least-squares", "--quiet", "--resume", "--out", "run")


@pytest.mark.parametrize("name", ["mmgtune.trial.parquet", "mmgtune.fitting.run"])
def test_before_a_run_goes_on(tmp_path, name):
    """It said "nothing was left half-written" of a run that is there and goes on with --resume."""
    found = ended(tmp_path, *RESUMED, name=name)
    assert found.returncode == 130
    assert found.stderr == "interrupted: what is done is in run; --resume --out run continues\n"


@pytest.mark.long
def test_after_an_error_in_a_run(tmp_path):
    """What was worked out before the error is kept: the run goes on once the reason is mended."""
    before = """
import mmgtune.fitting as fitting
import mmgtune.cli as cli
from mmgtune.errors import OutputError, Problem
def failed(*_, **__):
    raise OutputError(Problem("the disk is full", "run"))
fitting.fit = failed
cli.problems_in_flags = lambda _: sent()
"""
    found = ended(tmp_path, "fit", *FEW, before=before)
    assert found.returncode == 130
    assert found.stderr == "interrupted: what is done is in run; --resume --out run continues\n"


def test_at_exit(tmp_path):
    before = "import atexit, time; atexit.register(lambda: (sent(), time.sleep(0.05)))"
    found = ended(tmp_path, "profile", "list", before=before)
    assert found.returncode == 0
    assert found.stderr == ""


FEW = ("--targets", "R_0,w_P0", "--method", "least-squares", "--starts", "1", "--no-report", "--quiet", "--out", "run")


@pytest.mark.daily("[1]")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_when_the_result_is_written(tmp_path, number):
    """What is said then names the folder with the results."""
    before = "import mmgtune.cli.sweep as sweep; sweep.summary = lambda *_, **__: sent()"
    found = ended(tmp_path, "sweep", "--ar", "0.2", *FEW, number=number, before=before)
    assert found.returncode == 128 + number
    assert found.stderr.splitlines()[-1].endswith("the results in run were complete by then")
    assert (tmp_path / "run" / "sweep.json").exists()


@pytest.mark.long
def test_twice_while_it_works(tmp_path):
    """The second ends it at once; halves of files do not stay."""
    before = """
import mmgtune.fitting as fitting
from pathlib import Path
from mmgtune.files import atomic
def interrupted(*_, **__):
    with atomic(Path("run/fit.json")) as part:
        part.write_text("half")
        sent(), sent()
fitting.fit = interrupted
"""
    found = ended(tmp_path, "fit", *FEW, before=before)
    assert found.returncode == 130
    assert "finishing this step" in found.stderr
    assert found.stderr.splitlines()[-1] == (
        "interrupted: stopped at once; --resume --out run continues from the last checkpoint"
    )
    assert list((tmp_path / "run").iterdir()) == []


@pytest.mark.long
@pytest.mark.parametrize("times", [1, 2])
def test_bands_that_are_stopped_are_named(tmp_path, times):
    """Of a fit that is complete; --resume draws them."""
    before = f"""
import mmgtune.posterior as posterior
draw = posterior.posterior
def interrupted(*given, **named):
    {"; ".join(["sent()"] * times)}
    return draw(*given, **named)
posterior.posterior = interrupted
"""
    few = ("fit", *FEW, "--ar", "0.5", "--bands")
    found = ended(tmp_path, *few, before=before)
    assert found.returncode == 130, found.stderr
    said = "interrupted: the results in run are complete but for the bands; --resume --out run continues"
    assert found.stderr.splitlines()[-1] == said
    assert (tmp_path / "run" / "fit.json").exists()
    assert (tmp_path / "run" / "particles.parquet").exists() is (times == 1)
    again = ended(tmp_path, *few, "--resume")
    assert again.returncode == 0, again.stderr
    assert "particles" in again.stdout
    assert "Stopped before its end" not in again.stdout


TUNED = ("--targets", "R_0,w_P0", "--starts", "1")
BARE = ("--quiet", "--out", "run")
KILLED = {
    "fit": ("fit", *TUNED, "--method", "least-squares", "--ar", "0.5", *BARE),
    "cmaes": ("fit", "--targets", "R_0", "--ar", "0.5", *BARE),
    "sweep": ("sweep", *TUNED, "--method", "least-squares", "--ar", "0.2", *BARE),
    "leave-out": ("leave-out", *TUNED, "--folds", "2", *BARE),
    "diagnose": ("diagnose", "--effects", "antenna", *BARE),
    "voyages": ("validate", "suzaku", "voyages", *BARE),
}


@pytest.mark.daily("fit")
@pytest.mark.parametrize("of", KILLED)
def test_a_run_that_is_killed_while_its_report_is_drawn_goes_on(tmp_path, of):
    trial = load_trials("suzaku")["turn_p35"]
    write_trial(replace(trial, manoeuvre="voyage"), tmp_path / "voyages" / "one.parquet")
    before = "import mmgtune.report as report; report.render = lambda *_: sent()"
    killed = ended(tmp_path, *KILLED[of], number=signal.SIGKILL, before=before)
    assert killed.returncode == -signal.SIGKILL
    (result,) = (tmp_path / "run").glob("[!r]*.json")
    assert not (tmp_path / "run" / "report.html").exists()
    again = ended(tmp_path, *KILLED[of], "--resume")
    assert again.returncode == 0, again.stderr
    assert (tmp_path / "run" / "report.html").exists()
    assert result.exists()
    kept = [one.name for one in (tmp_path / "run").iterdir() if one.suffix in (".jsonl", ".npz")]
    assert kept == []
    assert "the run there has ended" in ended(tmp_path, *KILLED[of], "--resume").stderr


def test_what_goes_on_is_told_as_it_may_be_typed(tmp_path):
    told = interrupts.continued(tmp_path / "my run")
    assert told.endswith(f"--resume --out '{tmp_path}/my run' continues")
