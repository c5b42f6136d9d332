"""``mmgtune fit``."""

from __future__ import annotations

from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..options import FitOptions, in_flags
from ..run_files import PROFILE
from ..units import in_time
from . import common as c
from .exitcodes import ExitCode
from .options import RunOptions, takes
from .predict import indices_text
from .progress import Progress
from .stated import stated_table

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from ..fitting import FitResult, Plan
    from ..fitting.comparison import TrialComparison


BANDS = "the bands"
"""What may be stopped when the fit itself is complete."""

LONG = 60.0
"""Seconds that a fit may take without a word on how it could take fewer."""


@takes(options=FitOptions, run=RunOptions)
def command(
    profile: c.Profile = c.DEFAULT,
    trials: c.Trials = c.DEFAULT,
    *,
    options: FitOptions,
    run: RunOptions,
    strict: Annotated[
        bool,
        typer.Option("--strict", help="Exit 1 unless the searches agree on the optimum.", rich_help_panel=c.OUTPUT),
    ] = False,
    bands: Annotated[
        bool,
        typer.Option("--bands", help="Also draw particles for bands, as posterior does.", rich_help_panel=c.OUTPUT),
    ] = False,
    no_report: c.NoReport = False,
) -> None:
    """Fine-tune the coefficients of a profile to trials, within +-a_r of their pre-determined values.

    Examples:

      mmgtune fit --ar 0.5

      mmgtune fit -p my_ship.toml -t my_trials/ --targets "hull.Y_*,hull.N_*" --method least-squares

      mmgtune fit --ar 0.5 --json --out runs/today | jq .J_test
    """
    from ..fitting import fit, plan_fit, write_run
    from ..predicting import fit_bands, write_fit_bands
    from ..report import render
    from ..run_folders import claimed

    ship, data = c.load(profile, trials)
    if (asked := c.planned(run, ship, lambda: plan_fit(ship, data, options))) is None:
        return
    folder, plan = asked
    if not run.quiet and plan.seconds[0] > LONG:
        c.say(f"note: {in_time_of(plan)}")
    with (
        claimed(folder, force=run.force, resume=run.resume, anew=True, reads=(profile, trials)),
        Progress(run.quiet, folder) as progress,
    ):
        result = fit(
            ship,
            data,
            options,
            hooks=progress.hooks(),
            folder=folder,
            resume=run.resume,
            command=c.command_line(),
        )
        document = write_run(result, folder, overwrite=True)
        with_bands = bands and not result.interrupted
        progress.saved(result.interrupted, but=BANDS if with_bands else "")
        if with_bands:
            found = fit_bands(result, data, hooks=progress.hooks(), command=c.command_line())
            document = write_fit_bands(found, folder, overwrite=True)
            progress.saved(False, but=BANDS if found.interrupted else "")
        if not no_report:
            render(folder)
    if run.json:
        c.print_json(document)
    else:
        c.show(summary(result, str(folder), report=not no_report))
        if "bands" in document:
            c.show(bands_text(document["bands"], folder))
        elif result.compared and not result.interrupted:
            for line in next_steps(result, profile, trials):
                c.show(line)
            tuned = quote(str(folder / PROFILE))
            c.show(f"Bands: mmgtune posterior -p {tuned} -t {quote(trials)} --out {quote(str(folder))}")
    progress.leave()
    if strict and not result.converged:
        raise typer.Exit(ExitCode.NO)


def in_time_of(plan: Plan) -> str:
    """How long a fit may take, and what shortens that."""
    low, high = (in_time(seconds) for seconds in plan.seconds)
    return (
        f"this takes about {low} to {high} on this machine; quicker with --method least-squares, fewer --starts or "
        "fewer --targets; Ctrl-C keeps the best so far"
    )


def next_steps(result: FitResult, profile: str, trials: str) -> list[str]:
    """What the outcome asks for, as commands."""
    given = f"-p {quote(profile)} -t {quote(trials)}"
    tested = any(one.role == "test" for one in result.compared)
    runs = {one.trial.run for one in result.compared if one.role == "tune"}
    steps = []
    if result.bends_to_noise:
        steps.append("Without the noise of first samples: the same again with --initial estimated")
    if result.misses:
        steps.append(f"It misses trials it was not tuned to; what is wrong: mmgtune diagnose {given}")
    elif not tested and len(runs) > 1:
        steps.append(f"How it does on trials it was not tuned to: mmgtune leave-out {given}")
    return steps


def bands_text(bands: Mapping[str, Any], folder: Path) -> str:
    """The usual manoeuvres with bands as a person wants to read them in a terminal, and what these are made of."""
    found, lines = bands["predicted"], [""]
    if found:
        lines.append(f"{found['particles']} particles, ± half the band of {found['level']:g} %")
        for run in found["runs"]:
            lines += ["", *indices_text(run, found["particles"])]
    said = [*bands["sentences"], *(f"Note: {warning}" for warning in bands["warnings"])]
    return "\n".join([*lines, "", *said, f"Particles: {folder}/particles.parquet"])


NOTES = {True: ("at {}er bound", "not determined"), False: ("{}er", "not det.")}
"""What is to be known of a coefficient, in many words or in few."""


def coefficient_table(result: FitResult) -> list[str]:
    """Lines of a table: each coefficient before and after, its standard error and its place in the box."""
    roomy = c.width() >= 90
    bound, unknown = NOTES[roomy]
    rows = []
    for row in result.coefficients():
        side = {"low": "low", "high": "upp"}.get(row["at_bound"], "")
        notes = [bound.format(side)] if side else []
        notes += [] if row["determined"] else [unknown]
        place = "".join("*" if round(row["position"] * 20) == k else "-" for k in range(21))
        before, tuned = ("inf" if row[key] is None else f"{row[key]:.4g}" for key in ("pre_determined", "value"))
        error = "" if row["stderr"] is None else f"{row['stderr']:.2g}"
        rows.append((row["name"], before, tuned, error, place, ", ".join(notes)))
    head = ("coefficient", "before", "tuned", "std.err", "place in box", "")
    first, *rest = c.table(head, rows, words=(0, 4, 5), spare=(4, 1))
    return [first, "", *rest]


def misfit_table(compared: Sequence[TrialComparison]) -> list[str]:
    """Lines of a table: how far off each trial is before and after, first as people measure it."""
    from ..fitting.comparison import rounded

    rows = []
    for one in compared:
        places, headings = zip(one.off("before"), one.off("after"), strict=True)
        J = " -> ".join(f"{one.J[which]:.4g}" for which in ("before", "after"))
        off = (" -> ".join(rounded(size, digits) for size in pair) for pair, digits in ((places, 3), (headings, 2)))
        rows.append((one.trial.id, one.role, *off, J))
    head, *rest = c.table(("trial", "role", "off track [m]", "off heading [deg]", "J"), rows, words=(0, 1), spare=(3,))
    return [head, "", *rest]


def summary(result: FitResult, folder: str, report: bool) -> str:
    """Plain-text summary of the result."""
    lines = coefficient_table(result)
    if result.compared:
        lines += ["", *misfit_table(result.compared), f"before -> after tuning; root mean square; J by {result.method}"]
    if result.stated:
        lines += ["", *stated_table([one.to_dict(result.profile.L_pp) for one in result.stated])]
    if result.beside:
        lines += ["", *result.beside.words()]
    lines += ["", *result.certificate.sentences[:2], *map(in_flags, result.identifiability.sentences[:2])]
    lines += [f"Note: {in_flags(warning)}" for warning in result.warnings]
    if result.compared and result.coverage.to_dict():
        lines += ["", result.coverage.sentence]
    lines += ["", result.sentence(), f"{result.evaluations} evaluations in {result.wall_s:.1f} s."]
    lines.append(f"Report: {folder}/report.html" if report else f"Results: {folder}")
    return "\n".join(lines)
