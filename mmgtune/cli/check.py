"""``mmgtune check``."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import MmgtuneError, OptionError, Problem, among
from ..options import FORMATS, CheckOptions
from . import common as c
from . import completing
from .exitcodes import ExitCode
from .options import problems_in_flags, takes

if TYPE_CHECKING:
    from ..checking import Baseline, CheckReport
    from ..trial import TrialSet

CI = "CI"
CODES = {"pass": ExitCode.GOOD, "regressed": ExitCode.NO, "not comparable": ExitCode.COULD_NOT_RUN}


@takes(options=CheckOptions)
def command(
    profile: Annotated[
        str,
        typer.Argument(
            help="Profile, or model.safetensors: a file or a bundled name.", autocompletion=completing.models
        ),
    ],
    trials: Annotated[
        str,
        typer.Argument(help="Folder of trial files, one file, or a bundled name.", autocompletion=completing.trials),
    ],
    *,
    options: CheckOptions,
    baseline: Annotated[
        Path | None,
        typer.Option("--baseline", "-b", help="The committed JSON file to compare with.", rich_help_panel=c.INPUT),
    ] = None,
    update_baseline: Annotated[
        bool,
        typer.Option(
            "--update-baseline",
            help="Write the baseline anew and print what that changes. Tolerances in it stay.",
            rich_help_panel=c.OUTPUT,
        ),
    ] = False,
    everything: Annotated[bool, typer.Option("--all", help="Also list what passed.", rich_help_panel=c.OUTPUT)] = False,
    format: Annotated[
        str | None,
        typer.Option(
            "--format",
            help="How the result is told. Default: text; on GitHub Actions annotations follow it.",
            metavar="|".join(FORMATS),
            autocompletion=completing.words(FORMATS),
            rich_help_panel=c.OUTPUT,
        ),
    ] = None,
    json: c.Json = False,
    junit: Annotated[
        Path | None,
        typer.Option(
            "--junit", help="Also write JUnit XML to this file, in place of an older one.", rich_help_panel=CI
        ),
    ] = None,
    summary: Annotated[
        Path | None,
        typer.Option(
            "--summary",
            help='Also add Markdown to the end of this file, such as "$GITHUB_STEP_SUMMARY".',
            rich_help_panel=CI,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Also write checked.json and a report to this folder.", rich_help_panel=c.OUTPUT
        ),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace the results in --out.", rich_help_panel=c.OUTPUT)
    ] = False,
    sensitivity: Annotated[
        float | None,
        typer.Option(
            "--sensitivity",
            help="Instead: which coefficients, changed by this share either way, would the check notice?",
            rich_help_panel=CI,
        ),
    ] = None,
) -> None:
    """Does the profile still reproduce the trials? Compare with a committed baseline, or with its own limits.

    Exit codes: 0 as good as the baseline or better; 1 worse; 2 not comparable, or could not run.

    Examples:

      mmgtune check ship.toml trials/ --baseline check.json --update-baseline

      mmgtune check ship.toml trials/ --baseline check.json

      mmgtune check ship.toml trials/ -b check.json --junit junit.xml --summary "$GITHUB_STEP_SUMMARY"

      mmgtune check ship.toml trials/ -b check.json --sensitivity 0.02
    """
    chosen = "json" if json else format
    if chosen is not None and chosen not in FORMATS:
        raise OptionError(Problem(f"no format '{chosen}'", "format", **among(chosen, FORMATS)))
    given = Given(chosen, everything, junit, summary, out)
    names = (profile, trials, baseline)
    if sensitivity is not None:
        path = given.baseline_alone("sensitivity", baseline)
        _sensitivity(profile, trials, path, options, sensitivity, chosen == "json")
    elif update_baseline:
        path = given.baseline_alone("update_baseline", baseline)
        _update(names, path, options, given)
    else:
        given.require_writable()
        with c.placed(out, force=force):
            report = _checked(names, options, given)
        raise typer.Exit(CODES[report.verdict])


Names = tuple[str, str, Path | None]
"""Profile, trials and baseline as they were named."""


def _checked(names: Names, options: CheckOptions, given: Given) -> CheckReport:
    """The check, told and written; one that could not run is written too, where a machine will look."""
    from .. import checking

    profile, _, baseline = names
    try:
        recorded = checking.read_baseline(baseline) if baseline else None
        data = _data(names)
        report = checking.check(profile, data, recorded, **_how(names, options, recorded))
    except MmgtuneError as error:
        given.elsewhere(checking.could_not_run(_words(names), tuple(problems_in_flags(error))))
        raise
    given(report)
    return report


def _update(names: Names, baseline: Path, options: CheckOptions, given: Given) -> None:
    from .. import checking

    recorded = checking.read_baseline(baseline) if baseline.exists() else None
    how = _how(names, options, recorded)
    given.update(checking.update_baseline(names[0], _data(names), str(baseline), **how), str(baseline))


def _data(names: Names) -> TrialSet:
    """The trials; what is odd about them and the ship is said."""
    from ..networks import named_ship
    from ..trial import load_trials

    ship, data = named_ship(names[0]), load_trials(names[1])
    c.warn_of_another_ship(ship, data)
    return data


def _how(names: Names, options: CheckOptions, recorded: Baseline | None) -> dict[str, Any]:
    """How it is measured: as the baseline was, where nothing else is asked for."""
    integrator = options.asked_integrator(recorded.method if recorded else None)
    return {
        "names": _words(names),
        "metrics": options.metrics,
        "backend": options.backend,
        "integrator": integrator,
    }


def _words(names: Names) -> tuple[str, str, str | None]:
    profile, trials, baseline = names
    return profile, trials, None if baseline is None else str(baseline)


def _sensitivity(profile: str, trials: str, baseline: Path, options: CheckOptions, share: float, json: bool) -> None:
    from ..checking import read_baseline
    from ..checking.sensitivity import sensitivity, table

    recorded = read_baseline(baseline)
    ship, data = c.load(profile, trials)
    rows = sensitivity(ship, data, recorded, share, backend=options.backend)
    if json:
        c.print_json({"schema": 1, "kind": "check-sensitivity", "share": share, "rows": [r.to_dict() for r in rows]})
    else:
        c.show(table(rows, share), end="")


@dataclass(frozen=True)
class Given:
    """Where a report goes: stdout in a format, and files besides."""

    format: str | None
    everything: bool
    junit: Path | None
    summary: Path | None
    out: Path | None = None

    def baseline_alone(self, name: str, baseline: Path | None) -> Path:
        """The baseline that ``name`` needs.

        Raises OptionError where there is none, or something was asked for that only a check has.
        """
        if baseline is None:
            why = "the file of what is good was not named"
            raise OptionError(Problem(f"{name}=True needs a baseline", name, why, "add baseline=FILE"))
        of_a_check: dict[str, object] = {"everything": self.everything, "junit": self.junit, "summary": self.summary}
        of_a_check |= {"out": self.out, "format": self.format not in (None, "text", "json")}
        why = "beside it no check is made, and nothing is written of one"
        if asked := [option for option, value in of_a_check.items() if value]:
            raise OptionError(*(Problem(f"it does not go with {name}=True", one, why, "leave it out") for one in asked))
        return baseline

    def require_writable(self) -> None:
        """Raises OutputError where a file that is asked for cannot be written, before any work."""
        from ..checking.renderers.junit import refuse_other

        if self.junit is not None:
            refuse_other(self.junit)

    def __call__(self, report: CheckReport) -> None:
        """Print the report, and write it to the files asked for."""
        from ..checking.renderers import RENDERERS

        if self.format in (None, "text"):
            c.show(RENDERERS["text"](report, self.everything, c.width()), end="")
            if self.format is None and os.environ.get("GITHUB_ACTIONS") == "true":
                c.show(RENDERERS["github"](report), end="", commands=True)
        else:
            c.show(RENDERERS[self.format](report), end="", commands=self.format == "github")
        self._write(report)
        if self.out is not None:
            from ..checking import write_check
            from ..report import render

            write_check(report, self.out, c.command_line(), overwrite=True)
            render(self.out)

    def elsewhere(self, report: CheckReport) -> None:
        """A check that could not run: the problem itself goes to stderr, a machine's format to stdout.

        There are no results to put into a folder: the next try finds it as it was.
        """
        from ..checking.renderers import RENDERERS

        if self.format not in (None, "text"):
            c.show(RENDERERS[self.format](report), end="", commands=self.format == "github")
        elif self.format is None and os.environ.get("GITHUB_ACTIONS") == "true":
            c.show(RENDERERS["github"](report), end="", commands=True)
        self._write(report)

    def update(self, report: CheckReport | None, path: str) -> None:
        """What a new baseline changes; ``report`` is None where there was none to compare with."""
        from ..checking.renderers.text import difference

        if self.format == "json":
            c.print_json(
                {"schema": 1, "kind": "check-update", "wrote": path, "difference": report and report.to_dict()}
            )
        else:
            c.show(difference(report, path) if report else f"wrote {path}.\n", end="")

    def _write(self, report: CheckReport) -> None:
        from ..checking.renderers import RENDERERS
        from ..files import cannot_write, write_text

        if self.junit is not None:
            write_text(self.junit, RENDERERS["junit"](report))
        if self.summary is not None:
            try:
                with open(self.summary, "a", encoding="utf-8", opener=_without_waiting) as file:
                    file.write(RENDERERS["markdown"](report))
            except OSError as error:
                raise cannot_write(self.summary, error) from error


def _without_waiting(path: str, flags: int) -> int:
    """Open a file; a pipe that nobody reads from is an error."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0), 0o666)
