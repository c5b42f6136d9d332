"""``mmgtune diagnose``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import OptionError, Problem, closest
from ..options import DiagnoseOptions
from . import common as c
from .exitcodes import ExitCode
from .options import RunOptions, split, takes
from .progress import Progress

if TYPE_CHECKING:
    from ..diagnose import Diagnosis
    from ..diagnose.by_run import ByRun
    from ..diagnose.legs import Difference


@takes(options=DiagnoseOptions, run=RunOptions)
def command(
    profile: c.Profile = "suzaku",
    trials: c.Trials = "suzaku",
    *,
    options: DiagnoseOptions,
    run: RunOptions,
    fail_on: Annotated[
        list[str] | None,
        typer.Option(
            "--fail-on",
            help="Exit 1 on these verdicts: none, found, not-separable, unexplained, interrupted.",
            rich_help_panel=c.OUTPUT,
        ),
    ] = None,
    no_report: c.NoReport = False,
) -> None:
    """Name what a re-tuned model still gets wrong: cause, size, and the gain on trials not used.

    Of voyages (logs that say manoeuvre "voyage", or last more than an hour) at most --windows windows of 120 s, or
    --restart, are looked at, and what differs from voyage to voyage is told besides: current and resistance.

    A diagnosis that was stopped has the verdict interrupted; it ends with 130 whatever --fail-on says.

    Examples:

      mmgtune diagnose --profile suzaku --trials suzaku

      mmgtune diagnose -p my_ship.toml -t my_trials/ --json | jq .verdict

      mmgtune diagnose -p my_ship.toml -t my_trials/ --fail-on found,unexplained
    """
    from ..diagnose import VERDICTS, diagnose, plan_diagnosis, write_diagnosis
    from ..fitting import claimed, refuse_taken
    from ..report import render

    failing = split(fail_on)
    unknown = [word for word in failing if word not in VERDICTS]
    if unknown:
        raise OptionError(
            *(Problem(f"unknown verdict '{word}'", "fail_on", fix=closest(word, VERDICTS)) for word in unknown)
        )
    ship, data = c.load_with_voyages(profile, trials)
    folder = run.out or c.default_out(ship)
    if not run.dry_run:
        refuse_taken(folder, force=run.force, resume=run.resume)
    plan = plan_diagnosis(ship, data, options)
    if run.dry_run:
        c.print_plan(plan, folder)
        return
    with claimed(folder, force=run.force, resume=run.resume), Progress(run.quiet, folder) as progress:
        result = diagnose(
            ship, data, options, hooks=progress.hooks(), folder=folder, resume=run.resume, command=c.command_line()
        )
        document = write_diagnosis(result, folder)
        progress.saved(result.interrupted)
        if not no_report:
            render(folder)
    if run.json:
        c.print_json(document)
    else:
        c.show(summary(result, str(folder), report=not no_report))
    progress.leave()
    if result.verdict in failing:
        raise typer.Exit(ExitCode.NO)


def _by_voyage(one: Difference) -> list[str]:
    """A line for each voyage, where these differ."""
    if one.pattern not in ("each", "trend"):
        return []
    width = max(len(name) for name in one.voyages)
    rows = []
    for name, values, errors in zip(one.voyages, one.values, one.stderr, strict=True):
        told = (
            f"{parameter} {value:7.3f} +- {1.96 * error:.3f}"
            for parameter, value, error in zip(one.quantity.parameters, values, errors, strict=True)
        )
        rows.append(f"  {name:<{width}}  {'   '.join(told)}")
    return rows


def _of_runs(one: ByRun) -> list[str]:
    """A line for each run, or group of runs, with its 95 % interval."""
    rows = one.table()
    widths = [max(len(row[k]) for row in rows) for k in range(3)]
    return [
        "  " + "   ".join(word.ljust(width) for word, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]


def summary(result: Diagnosis, folder: str, report: bool) -> str:
    """The result as a person wants to read it in a terminal."""
    from ..profile.doubts import in_words

    lines = [f"{'hypothesis':<44}{'score':>12}{'gain':>12}{'by chance':>12}{'J test':>10}", ""]
    for row in result.candidates[:12]:
        label = row.label
        J = "" if row.J_test is None else f"{row.J_test:.4g}"
        lines.append(f"{label:<44}{row.score:>12.4g}{row.gain:>12.4g}{row.p_value:>12.2g}{J:>10}")
    before, after = result.gain.J
    lines += ["", f"verdict: {result.verdict}", result.sentence()]
    if before is not None and after is not None and result.causes and not result.interrupted:
        low, high = result.gain.share_removed[1:]
        lines.append(
            f"J held out ({result.gain.words}; {result.gain.method}): {before:.4g} -> {after:.4g}; "
            f"95 % interval of the share removed {100.0 * low:.1f} to {100.0 * high:.1f} %."
        )
    for cause in result.causes:
        lines += ["", *_of_runs(cause.runs)] if cause.runs and not result.interrupted else []
    for one in result.differing:
        lines += ["", one.sentence, *_by_voyage(one)]
    if result.suggestion:
        lines.append(f"A trial that would tell: {result.suggestion.manoeuvre}.")
    doubts = in_words(result.profile.doubts())
    lines += ["", *(f"Note: {words}." for words in doubts)] if doubts else []
    lines += ["", f"{'Stopped after' if result.interrupted else 'Finished in'} {result.wall_s:.1f} s."]
    lines.append(f"Report: {folder}/report.html" if report else f"Results: {folder}")
    return "\n".join(lines)
