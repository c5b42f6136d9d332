"""``mmgtune check``."""

from __future__ import annotations

import os
from dataclasses import dataclass
from json import dumps
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
    from ..checking import CheckReport

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
            "--out", "-o", help="Also write check.json and a report to this folder.", rich_help_panel=c.OUTPUT
        ),
    ] = None,
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
    from .. import checking
    from ..files import refuse_file
    from ..networks import named_ship
    from ..trial import load_trials

    if out is not None:
        refuse_file(out)
    chosen = "json" if json else format
    if chosen is not None and chosen not in FORMATS:
        raise OptionError(Problem(f"no format '{chosen}'", "format", **among(chosen, FORMATS)))
    if baseline is None and (update_baseline or sensitivity is not None):
        name = "update_baseline" if update_baseline else "sensitivity"
        raise OptionError(
            Problem(
                f"{name}=True needs a baseline", name, "the file of what is good was not named", "add baseline=FILE"
            )
        )
    if sensitivity is not None:
        _sensitivity(profile, trials, baseline, options, sensitivity, json)
        return
    give = Given(chosen, everything, junit, summary, out)
    names = (profile, trials, None if baseline is None else str(baseline))
    try:
        recorded = None
        if baseline is not None and not (update_baseline and not baseline.exists()):
            recorded = checking.read_baseline(baseline)
        ship, data = named_ship(profile), load_trials(trials)
        c.warn_of_another_ship(ship, data)
        how: dict[str, Any] = {"names": names, "metrics": options.metrics, "backend": options.backend}
        how["integrator"] = options.asked_integrator(recorded.method if recorded else None)
        if update_baseline:
            give.update(checking.update_baseline(profile, data, str(baseline), **how), str(baseline))
            return
        report = checking.check(profile, data, recorded, **how)
    except MmgtuneError as error:
        give.elsewhere(checking.could_not_run(names, tuple(problems_in_flags(error))))
        raise
    give(report)
    raise typer.Exit(CODES[report.verdict])


def _sensitivity(
    profile: str, trials: str, baseline: Path | None, options: CheckOptions, share: float, json: bool
) -> None:
    from ..checking import read_baseline
    from ..checking.sensitivity import sensitivity, table

    recorded = read_baseline(Path(str(baseline)))
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

    def elsewhere(self, report: CheckReport) -> None:
        """A check that could not run: the problem itself goes to stderr, a machine's format to stdout."""
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

        if self.out is not None:
            from ..provenance import made_by
            from ..report import render

            document = {**report.to_dict(), **made_by(c.command_line()), "out": str(self.out)}
            write_text(self.out / "check.json", dumps(document, indent=1, allow_nan=False, ensure_ascii=False) + "\n")
            render(self.out)
        if self.junit is not None:
            write_text(self.junit, RENDERERS["junit"](report))
        if self.summary is not None:
            try:
                with self.summary.open("a", encoding="utf-8") as file:
                    file.write(RENDERERS["markdown"](report))
            except OSError as error:
                raise cannot_write(self.summary, error) from error
