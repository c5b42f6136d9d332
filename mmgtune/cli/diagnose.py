"""``mmgtune diagnose``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import OptionError, Problem, closest
from . import common as c
from .exitcodes import ExitCode
from .progress import Progress

if TYPE_CHECKING:
    from ..diagnose import Diagnosis


def command(
    ar: Annotated[
        float,
        typer.Option("--ar", help="How far targets may be re-tuned, as a share of each.", rich_help_panel=c.SEARCH),
    ] = 0.5,
    profile: c.Profile = "suzaku",
    trials: c.Trials = "suzaku",
    targets: c.Targets = None,
    fix: c.Fix = None,
    effects: Annotated[
        list[str] | None,
        typer.Option("--effects", help="Effects to look for, comma-separated. Default: all.", rich_help_panel=c.SEARCH),
    ] = None,
    channels: Annotated[
        list[str] | None,
        typer.Option(
            "--channels", help="Motion channels that count: x, y, psi, u, v, r. Default: all.", rich_help_panel=c.SEARCH
        ),
    ] = None,
    restart: c.Restart = None,
    most: Annotated[
        int, typer.Option("--most", help="Largest number of causes looked for.", rich_help_panel=c.SEARCH)
    ] = 4,
    level: Annotated[
        float,
        typer.Option("--level", help="Largest probability of a false alarm over the search.", rich_help_panel=c.SEARCH),
    ] = 0.01,
    integrator: Annotated[
        str, typer.Option("--integrator", help="rk4, or euler at the trial's step.", rich_help_panel=c.SEARCH)
    ] = "rk4",
    substeps: c.Substeps = 1,
    backend: c.BackendName = "compiled",
    seed: c.Seed = 1,
    out: c.Out = None,
    force: c.Force = False,
    fail_on: Annotated[
        list[str] | None,
        typer.Option(
            "--fail-on",
            help="Exit 1 on these verdicts: none, found, not-separable, unexplained.",
            rich_help_panel=c.OUTPUT,
        ),
    ] = None,
    json: c.Json = False,
    quiet: c.Quiet = False,
    no_report: c.NoReport = False,
) -> None:
    """Name what a re-tuned model still gets wrong: cause, size, and the gain on trials not used.

    Examples:

      mmgtune diagnose --profile suzaku --trials suzaku

      mmgtune diagnose -p my_ship.toml -t my_trials/ --json | jq .verdict

      mmgtune diagnose -p my_ship.toml -t my_trials/ --fail-on found,unexplained
    """
    from ..diagnose import VERDICTS, DiagnoseOptions, diagnose, write_diagnosis
    from ..fitting import prepare

    failing = c.split(fail_on)
    unknown = [word for word in failing if word not in VERDICTS]
    if unknown:
        raise OptionError(
            *(Problem(f"unknown verdict '{word}'", "--fail-on", fix=closest(word, VERDICTS)) for word in unknown)
        )
    ship, data = c.load(profile, trials)
    options = DiagnoseOptions(
        a_r=ar,
        targets=c.split(targets),
        fixed=c.split(fix),
        effects=c.split(effects),
        channels=c.split(channels),
        integrator=integrator,
        substeps=substeps,
        backend=backend,
        seed=seed,
        restart=restart,
        most=most,
        level=level,
    )
    folder = out or c.default_out(ship)
    prepare(folder, force=force)
    with Progress(quiet) as progress:
        result = diagnose(ship, data, options, hooks=progress.hooks(), command=c.command_line())
        document = write_diagnosis(result, folder)
    if not no_report:
        from ..report import render

        render(folder)
    if json:
        c.print_json(document)
    else:
        print(summary(result, str(folder), report=not no_report))
    if result.interrupted:
        raise typer.Exit(ExitCode.INTERRUPTED)
    if result.verdict in failing:
        raise typer.Exit(ExitCode.NO)


def summary(result: Diagnosis, folder: str, report: bool) -> str:
    """The result as a person wants to read it in a terminal."""
    lines = [f"{'hypothesis':<44}{'score':>12}{'gain':>12}{'by chance':>12}{'J test':>10}", ""]
    for row in result.candidates[:12]:
        label = f"{row.effect} ({', '.join(row.parameters)})"
        J = "" if row.J_test is None else f"{row.J_test:.4g}"
        lines.append(f"{label:<44}{row.score:>12.4g}{row.gain:>12.4g}{row.p_value:>12.2g}{J:>10}")
    before, after = result.gain.J
    lines += ["", f"verdict: {result.verdict}", result.sentence()]
    if before is not None and after is not None and result.causes:
        low, high = result.gain.share_removed[1:]
        lines.append(
            f"J held out ({result.gain.words}; {result.gain.method}): {before:.4g} -> {after:.4g}; "
            f"95 % interval of the share removed {100.0 * low:.1f} to {100.0 * high:.1f} %."
        )
    if result.suggestion:
        lines.append(f"A trial that would tell: {result.suggestion.manoeuvre}.")
    lines += ["", f"Finished in {result.wall_s:.1f} s."]
    lines.append(f"Report: {folder}/report.html" if report else f"Results: {folder}")
    return "\n".join(lines)
