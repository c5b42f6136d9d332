"""``mmgtune leave-out``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ..options import LeaveOutOptions, in_flags
from ..phrases import counted
from . import common as c
from .options import RunOptions, takes
from .progress import Progress
from .stated import stated_table

if TYPE_CHECKING:
    from ..fitting import LeftOut


@takes(options=LeaveOutOptions, run=RunOptions)
def command(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: LeaveOutOptions,
    run: RunOptions,
    bands: Annotated[
        bool,
        typer.Option("--bands", help="Also bands from the other runs, and what they hold.", rich_help_panel=c.OUTPUT),
    ] = False,
    no_report: c.NoReport = False,
) -> None:
    """Fit without each tune trial in turn and score the trials left out: what a tuning is worth on unseen runs.

    Trials are scored from their measured first state; J and L_MSE are those of validate.

    Examples:

      mmgtune leave-out --ar 0.5

      mmgtune leave-out -p my_ship.toml -t my_trials/ --restart 100 --objective standardised --folds 5

      mmgtune leave-out --folds 5 --bands
    """
    from ..fitting import leave_out, plan_leave_out, write_left_out
    from ..posterior import leave_out_with_bands
    from ..report import render
    from ..run_folders import claimed

    ship, data = c.load(profile, trials)
    if (asked := c.planned(run, ship, lambda: plan_leave_out(ship, data, options))) is None:
        return
    folder, _ = asked
    with (
        claimed(folder, force=run.force, resume=run.resume, anew=True, reads=(profile, trials)),
        Progress(run.quiet, folder) as progress,
    ):
        work = leave_out_with_bands if bands else leave_out
        result = work(
            ship, data, options, hooks=progress.hooks(), folder=folder, resume=run.resume, command=c.command_line()
        )
        document = write_left_out(result, folder, overwrite=True)
        progress.saved(result.interrupted)
        if not no_report:
            render(folder)
    if run.json:
        c.print_json(document)
    else:
        c.show(summary(result, str(folder), report=not no_report))
    progress.leave()


def summary(result: LeftOut, folder: str, report: bool = False) -> str:
    """Plain-text summary of the result."""
    from ..fitting.comparison import rounded
    from .repeated import table

    rows, drawn = [], False
    for row in result.rows():
        interval = row["share_removed_ci95"]
        removed = "-" if row["share_removed"] is None else f"{100 * row['share_removed']:.0f} %"
        drawn = drawn or bool(interval)
        spread = f"{100 * interval[0]:.0f} to {100 * interval[1]:.0f} %" if interval else ""
        shown = []
        for key, digits in (("position_rms_m", 3), ("heading_rms_deg", 2), ("L_MSE", 3), ("J", 4)):
            pair = (row[f"{key}_{when}"] for when in ("before", "after"))
            shown.append(" -> ".join("diverged" if value is None else rounded(value, digits) for value in pair))
        rows.append((row["manoeuvre"], str(row["runs"]), *shown, removed, spread))
    head = ("left out", "runs", "off track [m]", "off heading [deg]", "L_MSE", "J", "removed", "95 %")
    lines = c.table(head, rows, spare=(5, 4, 3)) if rows else []
    if rows:
        more = "; 95 %: with runs drawn anew" if drawn else ""
        lines.append(f"before -> as tuned to the others; root mean square; removed: share of L_MSE{more}")
    if result.stated:
        told = [one.to_dict(result.L_pp) for one in result.stated]
        off = result.stated_rms()
        lines += ["", *stated_table(told, ("before", "left_out")), ""]
        lines.append(f"off by {off['before']:.2f} tolerances before, {off['left_out']:.2f} left out, root mean square")
    if result.options.manoeuvres and result.parts:
        lines.append(table({"before": result.repeated_before, "left out": result.repeated_after}))
    if result.bands and result.bands.by_kind:
        lines += ["", f"{'bands from the other runs':<26}{'windows':>8}{'90 % holds':>12}{'CRPS':>8}{'width':>8}"]
        for kind, of in result.bands.by_kind.items():
            share = of.covers(0.9)
            held = "-" if share is None else f"{100.0 * share:.0f} %"
            crps, width = ("-" if value is None else f"{value:.3g}" for value in (of.CRPS, of.sharpness))
            lines.append(f"{kind or 'all':<26}{of.windows:>8}{held:>12}{crps:>8}{width:>8}")
        lines.append("CRPS and width of the 90 % band: mean over the states, in their spread over the trials.")
    lines += [f"Note: {in_flags(warning)}" for warning in result.warnings]
    if result.interrupted and result.bands and len(result.parts) == result.n_parts:
        banded = f"the bands of {result.bands.parts} of {result.n_parts} parts"
        lines.append(f"Stopped after {banded}; bands are of those alone.")
    elif result.interrupted:
        lines.append(f"Stopped after {len(result.parts)} of {result.n_parts} parts; scores are of those alone.")
    lines.append(f"{counted(len(result.parts), 'fit')} in {result.wall_s:.1f} s, simulated by {result.method}.")
    lines.append(f"Report: {folder}/report.html" if report else f"Results: {folder}")
    return "\n".join(lines)
