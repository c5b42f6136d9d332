"""``mmgtune sweep``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import OptionError, Problem
from . import common as c
from .exitcodes import ExitCode
from .progress import Progress

if TYPE_CHECKING:
    from ..fitting import SweepResult


def command(
    ar: Annotated[
        str, typer.Option("--ar", help="Half widths of the box, comma-separated.", rich_help_panel=c.SEARCH)
    ] = "0.2,0.3,0.4,0.5,0.6",
    profile: c.Profile = "suzaku",
    trials: c.Trials = "suzaku",
    targets: c.Targets = None,
    fix: c.Fix = None,
    identifiable: c.Identifiable = False,
    channels: c.Channels = None,
    window: c.Window = None,
    objective: c.Objective = "paper",
    restart: c.Restart = None,
    every: c.Every = None,
    loss: c.Loss = "squares",
    regularise: c.Regularise = 0.0,
    method: c.Method = "cma-es",
    starts: c.Starts = 20,
    initial: c.Initial = "measured",
    integrator: c.IntegratorName = "rk4",
    substeps: c.Substeps = 1,
    backend: c.BackendName = "compiled",
    seed: c.Seed = 1,
    out: c.Out = None,
    force: c.Force = False,
    json: c.Json = False,
    quiet: c.Quiet = False,
    dry_run: c.DryRun = False,
    no_report: c.NoReport = False,
) -> None:
    """Fit at several widths of the box, recommend one, and say where over-fitting begins.

    Examples:

      mmgtune sweep --ar 0.2,0.3,0.4,0.5,0.6

      mmgtune sweep --method least-squares --out runs/sweep
    """
    from ..fitting import FitOptions, prepare, sweep

    ship, data = c.load(profile, trials)
    widths = _numbers(ar)
    options = FitOptions(
        a_r=widths[0],
        seed=seed,
        method=method,
        targets=c.split(targets),
        fixed=c.split(fix),
        channels=c.split(channels),
        window=c.window_of(window),
        objective=objective,
        restart=restart,
        every=every,
        loss=loss,
        regularise=regularise,
        initial=initial,
        integrator=integrator,
        substeps=substeps,
        backend=backend,
        starts=starts,
        identifiable=identifiable,
    )
    folder = out or c.default_out(ship)
    plans = [c.plan(ship, data, replace(options, a_r=a_r), folder) for a_r in widths]
    if dry_run:
        print(f"sweep over a_r = {ar}; the first:\n{plans[0]}")
        return
    prepare(folder, force=force)
    with Progress(quiet) as progress:
        result = sweep(ship, data, widths, options, hooks=progress.hooks(), folder=folder, command=c.command_line())
    if not no_report:
        from ..report import render

        render(folder)
    if json:
        c.print_json({**result.to_dict(), "out": str(folder)})
    else:
        print(summary(result, str(folder), report=not no_report))
    if result.interrupted:
        raise typer.Exit(ExitCode.INTERRUPTED)


def _numbers(text: str) -> list[float]:
    try:
        numbers = [float(part) for part in text.split(",") if part.strip()]
    except ValueError:
        numbers = []
    if not numbers:
        raise OptionError(Problem(f"'{text}' is not a list of numbers", "--ar", fix="write --ar 0.2,0.3,0.4,0.5,0.6"))
    return numbers


def summary(result: SweepResult, folder: str, report: bool) -> str:
    """The paper's Table 7 for this data, J on both sets, and the recommendation."""
    names = list(result.runs[0].theta)
    lines = [f"{'a_r':<24}" + "".join(f"{a_r:>11g}" for a_r in result.widths), ""]
    for name in names:
        cells = []
        for run in result.runs:
            mark = "*" if name in run.at_bound else " "
            cells.append(f"{run.theta[name]:>10.4g}{mark}")
        lines.append(f"{name:<24}" + "".join(cells))
    lines.append("")
    for label, role in (("J tune", "tune"), ("J test", "test")):
        before = result.runs[0].J_of(role, "before")
        if before is not None:
            cells = [f"{run.J_of(role, 'after') or float('nan'):>11.4g}" for run in result.runs]
            lines.append(f"{label:<24}" + "".join(cells) + f"   before {before:.4g}, {result.runs[0].method}")
    if result.leave_one_out is not None:
        lines.append(f"{'J left out':<24}" + "".join(f"{J:>11.4g}" for J in result.leave_one_out))
    lines += ["", "* on a bound", "", result.recommended()["sentence"], result.overfitting()["sentence"]]
    lines.append(f"{result.wall_s:.1f} s. " + (f"Report: {folder}/report.html" if report else f"Results: {folder}"))
    return "\n".join(lines)
