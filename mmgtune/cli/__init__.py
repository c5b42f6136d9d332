"""The command line: thin adapters from options to library functions, and the only place that knows exit codes.

Nothing heavy is imported until a command runs, so that ``mmgtune --help`` is quick.
"""

from __future__ import annotations

import signal
import sys
import tempfile
import traceback

import typer

from ..errors import Interrupted, MmgtuneError, OutputError, Problem, cannot_write_reason
from . import check, cite, diagnose, doctor, fit, leave_out, profiles, report, simulate, sweep, trials, validate
from .exitcodes import ExitCode
from .interrupts import Stopped, stop_at_once
from .options import problems_in_flags
from .pipes import Piped, ReaderGone, say_no_more

EPILOG = "Exit codes: 0 good; 1 the answer is no; 2 could not run; 3 bug; 130 interrupted, best so far saved."

app = typer.Typer(
    name="mmgtune",
    help="Calibrate MMG manoeuvring models of ships against measured trials.",
    epilog=EPILOG,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(version("mmgtune"))
        raise typer.Exit


@app.callback()
def _options(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version and exit."
    ),
) -> None:
    pass


app.command("fit", epilog=EPILOG)(fit.command)
app.command("sweep", epilog=EPILOG)(sweep.command)
app.command("diagnose", epilog=EPILOG)(diagnose.command)
app.command("leave-out", epilog=EPILOG)(leave_out.command)
app.command("check", epilog=EPILOG)(check.command)
app.command("validate", epilog=EPILOG)(validate.command)
app.command("simulate", epilog=EPILOG)(simulate.command)
app.command("report", epilog=EPILOG)(report.command)
app.command("cite", epilog=EPILOG)(cite.command)
app.command("doctor", epilog=EPILOG)(doctor.command)
app.add_typer(trials.app, name="trials", epilog=EPILOG)
app.add_typer(profiles.app, name="profile", epilog=EPILOG)


def main() -> None:
    """Run the command line; every way out has its exit code."""
    signal.signal(signal.SIGINT, stop_at_once)
    stdout = sys.stdout
    sys.stdout = Piped(stdout)
    try:
        try:
            app()
        finally:
            sys.stdout.flush()
    except ReaderGone:
        say_no_more()
        sys.exit(ExitCode.GOOD)
    except (Stopped, Interrupted) as error:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # no second line from a second Ctrl-C
        print(f"interrupted: {error}", file=sys.stderr)
        sys.exit(ExitCode.INTERRUPTED)
    except MmgtuneError as error:
        for problem in problems_in_flags(error):
            print(f"error: {problem}", file=sys.stderr)
        sys.exit(ExitCode.COULD_NOT_RUN)
    except OSError as error:  # a full disk, say, anywhere the library did not expect one
        print(f"error: {OutputError(Problem(cannot_write_reason(error)))}", file=sys.stderr)
        sys.exit(ExitCode.COULD_NOT_RUN)
    except Exception:
        with tempfile.NamedTemporaryFile("w", prefix="mmgtune-", suffix=".log", delete=False) as file:
            file.write(f"{' '.join(sys.argv)}\n{traceback.format_exc()}")
        print(f"bug: {sys.exc_info()[1]!r}\n  the full traceback is in {file.name}; please report it", file=sys.stderr)
        sys.exit(ExitCode.BUG)
    finally:
        sys.stdout = stdout
