"""``mmgtune leave-out``."""

from __future__ import annotations

from typing import Annotated

import typer

from . import common as c
from .progress import Progress


def command(
    ar: Annotated[
        float,
        typer.Option(
            "--ar", help="Half width of the box, as a share of each pre-determined value.", rich_help_panel=c.SEARCH
        ),
    ] = 0.5,
    profile: c.Profile = "suzaku",
    trials: c.Trials = "suzaku",
    folds: Annotated[
        int,
        typer.Option(
            "--folds", help="Parts the runs are dealt out to; 0: each run alone.", min=0, rich_help_panel=c.SEARCH
        ),
    ] = 0,
    targets: c.Targets = None,
    fix: c.Fix = None,
    with_effects: c.WithEffects = None,
    channels: c.Channels = None,
    window: c.Window = None,
    objective: c.Objective = "paper",
    restart: c.Restart = None,
    every: c.Every = None,
    regularise: c.Regularise = 0.0,
    starts: c.Starts = 4,
    initial: c.Initial = "measured",
    integrator: c.IntegratorName = "rk4",
    substeps: c.Substeps = 1,
    backend: c.BackendName = "compiled",
    seed: c.Seed = 1,
    manoeuvres: c.Manoeuvres = False,
    json: c.Json = False,
    quiet: c.Quiet = False,
) -> None:
    """Fit without each tune trial in turn and score the trials left out: what a tuning is worth on unseen runs.

    Trials are scored from their measured first state; J and L_MSE are those of validate.

    Examples:

      mmgtune leave-out --ar 0.5

      mmgtune leave-out -p my_ship.toml -t my_trials/ --restart 100 --objective standardised --folds 5
    """
    from ..fitting import FitOptions, fit_leaving_out
    from ..repeating import document
    from .repeated import table

    ship, data = c.load(profile, trials)
    ship, added = c.with_effects(ship, c.split(with_effects))
    options = FitOptions(
        a_r=ar,
        seed=seed,
        method="least-squares",
        targets=(*(c.split(targets) or (ship.targets if added else ())), *added),
        fixed=c.split(fix),
        channels=c.split(channels),
        window=c.window_of(window),
        objective=objective,
        restart=restart,
        every=every,
        regularise=regularise,
        initial=initial,
        integrator=integrator,
        substeps=substeps,
        backend=backend,
        starts=starts,
    )
    with Progress(quiet) as progress:
        result = fit_leaving_out(
            ship, data, options, folds, manoeuvres, hooks=progress.hooks(), command=c.command_line()
        )
    if json:
        said = result.to_dict()
        if manoeuvres:
            before, after = document(result.repeated_before), document(result.repeated_after)
            said["manoeuvres"] = {"before": before, "left_out": after}
        c.print_json(said)
        return
    print(
        f"{'left out':<20}{'runs':>6}{'L_MSE before':>14}{'after':>10}{'J before':>12}{'after':>10}   removed of L_MSE"
    )
    for row in result.rows():
        interval = row["share_removed_ci95"]
        removed = "-" if row["share_removed"] is None else f"{100 * row['share_removed']:.0f} %"
        if interval:
            removed += f" ({100 * interval[0]:.0f} to {100 * interval[1]:.0f} %, runs drawn anew)"
        numbers = [row[key] for key in ("L_MSE_before", "L_MSE_after", "J_before", "J_after")]
        shown = [
            f"{'diverged':>{w}}" if v is None else f"{v:>{w}.4g}"
            for v, w in zip(numbers, (14, 10, 12, 10), strict=True)
        ]
        print(f"{row['manoeuvre']:<20}{row['runs']:>6}{''.join(shown)}   {removed}")
    if manoeuvres:
        print(table({"before": result.repeated_before, "left out": result.repeated_after}))
    print(f"{len(result.parts)} fits in {result.wall_s:.1f} s, simulated by {result.method}.")
