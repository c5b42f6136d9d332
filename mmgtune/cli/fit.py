"""``mmgtune fit``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import OptionError, Problem
from . import common as c
from .exitcodes import ExitCode
from .progress import Progress

if TYPE_CHECKING:
    from ..fitting import FitResult


def command(
    ar: Annotated[
        float,
        typer.Option(
            "--ar", help="Half width of the box, as a share of each pre-determined value.", rich_help_panel=c.SEARCH
        ),
    ] = 0.5,
    profile: c.Profile = "suzaku",
    trials: c.Trials = "suzaku",
    targets: c.Targets = None,
    fix: c.Fix = None,
    with_effects: c.WithEffects = None,
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
    resume: Annotated[
        bool, typer.Option("--resume", help="Continue the interrupted search in --out.", rich_help_panel=c.OUTPUT)
    ] = False,
    strict: Annotated[
        bool,
        typer.Option("--strict", help="Exit 1 unless the searches agree on the optimum.", rich_help_panel=c.OUTPUT),
    ] = False,
    json: c.Json = False,
    quiet: c.Quiet = False,
    dry_run: c.DryRun = False,
    no_report: c.NoReport = False,
) -> None:
    """Fine-tune the coefficients of a profile to trials, within +-a_r of their pre-determined values.

    Examples:

      mmgtune fit --ar 0.5

      mmgtune fit -p my_ship.toml -t my_trials/ --targets "hull.Y_*,hull.N_*" --method least-squares

      mmgtune fit --ar 0.5 --json --out runs/today | jq .J_test
    """
    from ..fitting import FitOptions, fit, prepare, write_run

    ship, data = c.load(profile, trials)
    ship, added = c.with_effects(ship, c.split(with_effects))
    options = FitOptions(
        a_r=ar,
        seed=seed,
        method=method,
        targets=(*(c.split(targets) or (ship.targets if added else ())), *added),
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
    if resume and out is None:
        raise OptionError(
            Problem("--resume needs the folder of the interrupted run", "--resume", fix="add --out FOLDER")
        )
    folder = out or c.default_out(ship)
    plan = c.plan(ship, data, options, folder)  # also finds what is wrong before a folder is made
    if dry_run:
        print(plan)
        return
    prepare(folder, force=force, resume=resume)
    with Progress(quiet) as progress:
        result = fit(
            ship,
            data,
            options,
            hooks=progress.hooks(),
            checkpoint_folder=folder,
            resume=resume,
            command=c.command_line(),
        )
        document = write_run(result, folder)
    if not no_report:
        from ..report import render

        render(folder)
    if json:
        c.print_json(document)
    else:
        print(summary(result, str(folder), report=not no_report))
    if result.interrupted:
        raise typer.Exit(ExitCode.INTERRUPTED)
    if strict and not result.converged:
        raise typer.Exit(ExitCode.NO)


def summary(result: FitResult, folder: str, report: bool) -> str:
    """The result as a person wants to read it in a terminal."""
    lines = [f"{'coefficient':<24}{'before':>11}{'tuned':>11}{'std.err':>10}  place in box", ""]
    for row in result.coefficients():
        error = "" if row["stderr"] is None else f"{row['stderr']:.2g}"
        mark = (
            f"at {row['at_bound']}er bound" if row["at_bound"] == "low" else "at upper bound" if row["at_bound"] else ""
        )
        note = ", ".join(word for word in (mark, "" if row["determined"] else "not determined") if word)
        place = "".join("*" if round(row["position"] * 20) == k else "-" for k in range(21))
        before, tuned = ("inf" if row[key] is None else f"{row[key]:.4g}" for key in ("pre_determined", "value"))
        lines.append(f"{row['name']:<24}{before:>11}{tuned:>11}{error:>10}  {place} {note}")
    width = max([22, *(len(one.trial.id) for one in result.compared)]) + 2
    lines += ["", f"{'trial':<{width}}{'role':<7}{'J before':>11}{'J after':>11}   {result.method}", ""]
    for one in result.compared:
        lines.append(f"{one.trial.id:<{width}}{one.role:<7}{one.J['before']:>11.4g}{one.J['after']:>11.4g}")
    lines += ["", *result.certificate.sentences[:2], *result.identifiability.sentences[:2]]
    lines += [f"Note: {warning}" for warning in result.warnings()]
    lines += ["", result.verdict(), f"{result.evaluations} evaluations in {result.wall_s:.1f} s."]
    lines.append(f"Report: {folder}/report.html" if report else f"Results: {folder}")
    return "\n".join(lines)
