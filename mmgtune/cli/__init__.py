"""The command line: thin adapters from options to library functions, and the only place that knows exit codes.

Nothing heavy is imported until a command runs, so that ``mmgtune --help`` is quick.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
import traceback
import warnings
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperGroup

from ..errors import MmgtuneError, OptionError, OutputError, Problem, cannot_write_reason, reason
from ..files import cannot_write
from . import (
    check,
    cite,
    common,
    compare,
    diagnose,
    doctor,
    fit,
    fleet,
    interrupts,
    learn,
    leave_out,
    mistyped,
    plan,
    posterior,
    predict,
    profiles,
    report,
    simulate,
    study,
    sweep,
    trials,
    validate,
)
from .exitcodes import ExitCode
from .options import App, problems_in_flags
from .output import limit_width, say, show
from .pipes import Piped, ReaderGone, say_no_more


class Commands(TyperGroup):
    """The commands; what Click would take for a user's answer at a prompt is none here, and mistyped command lines are
    problems like all others.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read what stands before the name of the command."""
        try:
            return super().parse_args(ctx, [at_home(one) for one in args])
        except mistyped.Mistyped as error:
            raise _as_ours(error) from error

    def invoke(self, ctx: Any) -> Any:
        """Run a command."""
        try:
            return super().invoke(ctx)
        except mistyped.Mistyped as error:
            raise _as_ours(error) from error
        except typer.Abort as error:  # Ctrl-D where a question was asked
            raise OptionError(Problem("the answers ended before the questions", fix="answer them all")) from error
        except EOFError as error:
            raise RuntimeError(f"the end of a file came too early: {error}") from error
        except BrokenPipeError as error:  # of a file: those of the streams are ReaderGone
            raise OutputError(Problem(cannot_write_reason(error))) from error


def at_home(argument: str) -> str:
    """An argument with the home folder for its tilde, which shells leave where it is quoted or stands behind "="."""
    option, tilde, rest = argument.partition("~")
    if tilde and rest[:1] in ("", "/", os.sep) and re.fullmatch(r"(--[\w-]+=)?", option):
        return option + os.path.expanduser(tilde + rest)
    return argument


def _as_ours(error: Exception) -> Exception:
    """What a mistyped command line is answered with; the help where that was asked for."""
    problem = mistyped.problem_of(error)
    return error if problem is None else OptionError(problem)


app = App(
    name="mmgtune",
    cls=Commands,
    help="Calibrate MMG manoeuvring models of ships against measured trials.",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        show(version("mmgtune"))
        raise typer.Exit


@app.callback()
def _options(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version and exit."
    ),
) -> None:
    pass


app.command("fit")(fit.command)
app.command("sweep")(sweep.command)
app.command("diagnose")(diagnose.command)
app.command("leave-out")(leave_out.command)
app.command("posterior")(posterior.command)
app.command("check")(check.command)
app.command("validate")(validate.command)
app.command("compare")(compare.command)
app.command("simulate")(simulate.command)
app.command("predict")(predict.command)
app.command("plan")(plan.command)
app.command("report")(report.command)
app.command("cite")(cite.command)
app.command("doctor")(doctor.command)
app.add_typer(fleet.app, name="fleet")
app.add_typer(learn.app, name="learn")
app.add_typer(study.app, name="study")
app.add_typer(trials.app, name="trials")
app.add_typer(profiles.app, name="profile")


def main() -> None:
    """Run the command line; every way out has its exit code."""
    interrupts.handle(interrupts.stop_at_once("nothing was left half-written"))
    limit_width()
    streams = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = Piped(sys.stdout, "standard output"), Piped(sys.stderr, "standard error")
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _say_warning  # type: ignore[assignment]
            sys.exit(_run())
    finally:
        common.tidy()
        interrupts.over()
        sys.stdout, sys.stderr = streams


def _run() -> int:
    """The exit code of the command that was typed; what went wrong is said."""
    try:
        try:
            _understand(sys.argv[1:])
            app()
        except SystemExit as end:
            sys.stdout.flush()
            return int(end.code or 0)
        except MmgtuneError as error:
            for problem in problems_in_flags(error):
                say(f"error: {_in_its_lines(problem)}")
            return ExitCode.COULD_NOT_RUN
        except OSError as error:  # a full disk, say, anywhere the library did not expect one
            where = error.filename
            say(f"error: {cannot_write(Path(str(where)), error) if where else OutputError(Problem(reason(error)))}")
            return ExitCode.COULD_NOT_RUN
        except Exception:
            with tempfile.NamedTemporaryFile(
                "w", prefix="mmgtune-", suffix=".log", delete=False, encoding="utf-8", errors="backslashreplace"
            ) as file:
                file.write(f"{' '.join(sys.argv)}\n{traceback.format_exc()}")
            say(f"bug: {sys.exc_info()[1]!r}\n  the full traceback is in {file.name}; please report it")
            return ExitCode.BUG
    except ReaderGone:
        say_no_more()
        return ExitCode.GOOD
    except OSError:  # what went wrong cannot be said: stderr has no room either
        say_no_more()
        return ExitCode.COULD_NOT_RUN
    return ExitCode.GOOD


def _say_warning(message: Warning | str, *_where: Any) -> None:
    """A warning of the program or a library in a line, without the place in the source and what else it quotes."""
    say(f"warning: {next(iter(str(message).strip().splitlines()), '')}")


def _understand(arguments: list[str]) -> None:
    """Raises OptionError for an argument that is empty, or no text: no file that is written could name it."""
    for one in arguments:
        try:
            one.encode()
        except UnicodeEncodeError:
            what = f"the argument {one!a} is not UTF-8 text"
            raise OptionError(
                Problem(what, "command line", "no file of results could name it", "rename the file or folder")
            ) from None
    for before, one in zip(["", *arguments], arguments, strict=False):
        flag, value = _flag_of(before, one)
        if not value.strip(" ,"):
            what, why = f"{value!r} names nothing", "an empty value is no name, no number and no list of them"
            fix = f"give {flag} a value, or leave it out" if flag else "write a name, or leave it out"
            raise OptionError(Problem(what, flag or "command line", why, fix))


def _flag_of(before: str, argument: str) -> tuple[str, str]:
    """The option that an argument is the value of, as far as that shows, and the value."""
    if argument.startswith("--") and "=" in argument:
        flag, _, value = argument.partition("=")
        return flag, value
    return before if before.startswith("-") and "=" not in before else "", argument


def _in_its_lines(problem: Problem) -> Problem:
    """A problem without line breaks from files: none of them can say a line of its own."""
    return Problem(*(" ".join(part.splitlines()) for part in problem.to_dict().values()))
