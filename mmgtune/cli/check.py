"""``mmgtune check``."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import MmgtuneError, OptionError, Problem, closest
from . import common as c
from .exitcodes import ExitCode

if TYPE_CHECKING:
    from ..backends import Integrator
    from ..checking import CheckReport
    from ..profile import ShipProfile
    from ..trial import TrialSet

CI = "CI"
FORMATS = ("text", "json", "junit", "github", "markdown")
CODES = {"pass": ExitCode.GOOD, "regressed": ExitCode.NO, "not comparable": ExitCode.COULD_NOT_RUN}


def command(
    profile: Annotated[str, typer.Argument(help="Ship profile: a TOML file or a bundled name.")],
    trials: Annotated[str, typer.Argument(help="Folder of trial files, one file, or a bundled name.")],
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
    metrics: Annotated[
        list[str] | None,
        typer.Option(
            "--metrics",
            help="Only these metrics (J, MED, cVDM, rms_psi, advance, ...); repeatable, or with commas.",
            rich_help_panel=c.INPUT,
        ),
    ] = None,
    everything: Annotated[bool, typer.Option("--all", help="Also list what passed.", rich_help_panel=c.OUTPUT)] = False,
    format: Annotated[
        str | None,
        typer.Option(
            "--format",
            help="text, json, junit, github or markdown. Default: text; on GitHub Actions annotations follow it.",
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
    sensitivity: Annotated[
        float | None,
        typer.Option(
            "--sensitivity",
            help="Instead: which coefficients, changed by this share either way, would the check notice?",
            rich_help_panel=CI,
        ),
    ] = None,
    integrator: Annotated[
        str | None,
        typer.Option("--integrator", help="rk4 or euler. Default: the baseline's, else rk4.", rich_help_panel=c.SEARCH),
    ] = None,
    substeps: c.Substeps = 1,
    backend: c.BackendName = "compiled",
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
        raise OptionError(Problem(f"no format '{chosen}'", "--format", fix=closest(chosen, FORMATS)))
    asked = Asked(
        (profile, trials, None if baseline is None else str(baseline)), c.split(metrics), integrator, substeps, backend
    )
    if sensitivity is not None:
        _sensitivity(asked, sensitivity, json)
        return
    give = Given(chosen, everything, junit, summary)
    try:
        if update_baseline:
            give.update(_update(asked), str(baseline))
            return
        report = _check(asked)
    except MmgtuneError as error:
        from ..checking import could_not_run

        give.elsewhere(could_not_run(asked.names, error.problems))
        raise
    give(report)
    raise typer.Exit(CODES[report.verdict])


@dataclass(frozen=True)
class Asked:
    """What is to be compared, and how: profile, trials and baseline as the user called them."""

    names: tuple[str, str, str | None]
    metrics: tuple[str, ...]
    integrator: str | None
    substeps: int
    backend: str

    def chosen_integrator(self) -> Integrator | None:
        """The integrator asked for; None takes the baseline's."""
        if self.integrator is None and self.substeps == 1:
            return None
        return c.integrator_of(self.integrator or "rk4", self.substeps)

    def loaded(self) -> tuple[ShipProfile, TrialSet]:
        """Profile and trials."""
        return c.load(self.names[0], self.names[1])


def _check(asked: Asked) -> CheckReport:
    from ..checking import check, read_baseline

    name = asked.names[2]
    baseline = None if name is None else read_baseline(Path(name))
    ship, data = asked.loaded()
    return check(
        ship,
        data,
        baseline,
        names=asked.names,
        metrics=asked.metrics,
        integrator=asked.chosen_integrator(),
        backend=asked.backend,
    )


def _update(asked: Asked) -> CheckReport | None:
    """Write the baseline; the comparison with the one before, None where there was none to compare with."""
    from ..backends import Integrator
    from ..checking import check, read_baseline, record_baseline, write_baseline

    path = _path(asked, "--update-baseline")
    ship, data = asked.loaded()
    before = read_baseline(path) if path.exists() else None
    integrator = asked.chosen_integrator()
    same = before is not None and integrator in (None, Integrator(before.integrator, before.substeps))
    report = None
    if before is not None and same:
        integrator = Integrator(before.integrator, before.substeps)
        report = check(ship, data, before, names=asked.names, integrator=integrator, backend=asked.backend)
    now = record_baseline(
        ship, data, asked.metrics, before=before, integrator=integrator or Integrator(), backend=asked.backend
    )
    write_baseline(now, path)
    return report


def _sensitivity(asked: Asked, share: float, json: bool) -> None:
    from ..checking import read_baseline
    from ..checking.sensitivity import sensitivity, table

    baseline = read_baseline(_path(asked, "--sensitivity"))
    ship, data = asked.loaded()
    rows = sensitivity(ship, data, baseline, share, backend=asked.backend)
    if json:
        c.print_json({"schema": 1, "kind": "check-sensitivity", "share": share, "rows": [r.to_dict() for r in rows]})
    else:
        print(table(rows, share), end="")


def _path(asked: Asked, option: str) -> Path:
    if asked.names[2] is None:
        raise OptionError(Problem(f"{option} needs a baseline", option, fix="name its file with --baseline FILE"))
    return Path(asked.names[2])


@dataclass(frozen=True)
class Given:
    """Where a report goes: stdout in a format, and files besides."""

    format: str | None
    everything: bool
    junit: Path | None
    summary: Path | None

    def __call__(self, report: CheckReport) -> None:
        """Print the report, and write it to the files asked for."""
        from ..checking.renderers import RENDERERS, github, text

        if self.format in (None, "text"):
            print(text(report, self.everything), end="")
            if self.format is None and os.environ.get("GITHUB_ACTIONS") == "true":
                print(github(report), end="")
        else:
            print(RENDERERS[self.format](report), end="")
        self._write(report)

    def elsewhere(self, report: CheckReport) -> None:
        """A check that could not run: the problem itself goes to stderr, a machine's format to stdout."""
        from ..checking.renderers import RENDERERS, github

        if self.format not in (None, "text"):
            print(RENDERERS[self.format](report), end="")
        elif self.format is None and os.environ.get("GITHUB_ACTIONS") == "true":
            print(github(report), end="")
        self._write(report)

    def update(self, report: CheckReport | None, path: str) -> None:
        """What a new baseline changes; ``report`` is None where there was none to compare with."""
        from ..checking.renderers.text import difference

        if self.format == "json":
            c.print_json(
                {"schema": 1, "kind": "check-update", "wrote": path, "difference": report and report.to_dict()}
            )
        else:
            print(difference(report, path) if report else f"wrote {path}.\n", end="")

    def _write(self, report: CheckReport) -> None:
        from ..checking.renderers import junit, markdown
        from ..files import cannot_write, write_text

        if self.junit is not None:
            write_text(self.junit, junit(report))
        if self.summary is not None:
            try:
                with self.summary.open("a", encoding="utf-8") as file:
                    file.write(markdown(report))
            except OSError as error:
                raise cannot_write(self.summary, error) from error
