"""``mmgtune fleet``: many ships at many dates."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..options import FleetOptions
from ..phrases import counted
from ..units import in_time
from . import common as c
from . import interrupts
from .exitcodes import ExitCode
from .options import App, takes

if TYPE_CHECKING:
    from ..fleet import FleetPlan, Progress

app = App(help="Run commands for many ships at many dates, and see what changed.")

EVERY = 5.0
"""Seconds between two lines of progress."""

SHOWN = 10
"""Failures and changes that are printed; the report has all."""


@app.command("run")
@takes(options=FleetOptions)
def run(
    table: Annotated[Path, typer.Argument(help="TOML file with the jobs.", metavar="FLEET.TOML")],
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the results.", rich_help_panel=c.OUTPUT)] = Path(
        "runs/fleet"
    ),
    *,
    options: FleetOptions,
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Go on in --out: only what is not done there is run.", rich_help_panel=c.OUTPUT),
    ] = False,
    dry_run: Annotated[
        bool,
        typer.Option("--dry-run", help="List the jobs and about how long they take.", rich_help_panel=c.OUTPUT),
    ] = False,
    strict: Annotated[
        bool, typer.Option("--strict", help="Exit 1 where a job could not run.", rich_help_panel=c.OUTPUT)
    ] = False,
    json: c.Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress.", rich_help_panel=c.OUTPUT)] = False,
    no_report: c.NoReport = False,
) -> None:
    """Run all jobs of a table: fit, sweep, diagnose, validate or check, for each ship and date that its patterns match.

    Jobs run in worker processes, one a core, or on a Dask scheduler. A job that fails is listed with its error and
    stops nothing. What was killed or stopped goes on with --resume; jobs whose data and options are the same are not
    run again.

    Examples:

      mmgtune fleet run fleet.toml --dry-run

      mmgtune fleet run fleet.toml --out runs/fleet

      mmgtune fleet run fleet.toml --out runs/fleet --resume --scheduler tcp://10.0.0.5:8786
    """
    from ..files import refuse_file
    from ..fleet import plan_fleet, run_fleet
    from ..report import render

    refuse_file(out)
    if dry_run:
        plan = plan_fleet(table, out)
        c.print_json(_plan_dict(plan, options)) if json else c.show(plan_text(plan, options, out))
        return
    interrupts.handle(interrupts.stop_at_once(interrupts.continued(out)))
    said = _Said(quiet)
    result = run_fleet(table, out, options, resume=resume, on_progress=said, command=c.command_line())
    if not no_report:
        render(out)
    if json:
        c.print_json(dict(result.document))
    else:
        c.show(summary(result.document))
        workers = counted(result.workers, "worker")
        ran = f"{counted(len(result.ran), 'job')} run by {workers} in {result.wall_s:.1f} s"
        again = f", {result.killed} of them again since their worker was killed" if result.killed else ""
        c.show(f"{ran if result.ran else 'Nothing was left to run'}{again}.")
        c.show(f"Results: {out}" if no_report else f"Report: {out}/report.html")
    if strict and (result.document["jobs"]["failed"] or result.document["jobs"]["missing"]):
        raise typer.Exit(ExitCode.NO)


@app.command("report")
def report(
    folder: Annotated[Path, typer.Argument(help="Folder of a fleet, as --out of fleet run named it.")],
    pdf: Annotated[bool, typer.Option("--pdf", help="Write the figures as PDF files too.")] = False,
    json: c.Json = False,
) -> None:
    """Put the results of a fleet together anew: of a run that is still going on, too.

    Example:

      mmgtune fleet report runs/fleet
    """
    from ..fleet import check_out, record_anew
    from ..report import render

    check_out(folder)
    document = record_anew(folder)
    written = render(folder, pdf=pdf)
    if json:
        c.print_json(document)
        return
    c.show(summary(document))
    c.show(f"Report: {written[0]}")


class _Said:
    """Says every few seconds how far a run has come."""

    def __init__(self, quiet: bool):
        self.quiet, self.began, self.last = quiet, time.monotonic(), 0.0

    def __call__(self, progress: Progress) -> None:
        now = time.monotonic()
        ran = sum(progress.answers.values())
        over = progress.done == progress.total
        if self.quiet or (now - self.last < EVERY and not over) or not ran:
            return
        self.last = now
        left = (progress.total - progress.done) * (now - self.began) / ran
        failed = f", {progress.answers['failed']} failed" if progress.answers.get("failed") else ""
        killed = f", {progress.killed} run again" if progress.killed else ""
        rest = "" if over else f", about {in_time(left)} left"
        c.say(f"{progress.done} of {progress.total} jobs{failed}{killed}{rest}")


def plan_text(plan: FleetPlan, options: FleetOptions, out: Path) -> str:
    """Jobs and times as a person wants to read them in a terminal."""
    rows = [(job.ship, job.date, job.name, job.command, job.trials.path) for job in plan.jobs]
    head, *rest = c.table(("ship", "date", "job", "command", "trials"), rows, words=(0, 1, 2, 3, 4), spare=(3,))
    lines = [head, "", *rest, ""]
    there = sum(job.key in plan.there for job in plan.jobs)
    lines.append(counted(len(plan.jobs), "job") + (f", {there} of them done in {out}" if there else ""))
    for name, count, low, high in plan.reckoned.kinds:
        lines.append(f"  {name}: {count} to run, {low / count:.2g} to {high / count:.2g} s each")
    low, high = plan.reckoned.seconds
    workers = _workers(options)
    lines.append(
        f"time      about {in_time(low / workers)} to {in_time(high / workers)} on {workers} workers like this machine"
    )
    return "\n".join(lines)


def _workers(options: FleetOptions) -> int:
    from ..fleet.processes import cores

    return options.workers or cores()


def _plan_dict(plan: FleetPlan, options: FleetOptions) -> dict[str, Any]:
    low, high = plan.reckoned.seconds
    keys = ("ship", "date", "name", "command", "key")
    return {
        "schema": 1,
        "kind": "fleet-plan",
        "jobs": [
            {**{key: getattr(job, key) for key in keys}, "trials": job.trials.path, "done": job.key in plan.there}
            for job in plan.jobs
        ],
        "seconds_of_one_worker": [low, high],
        "workers": _workers(options),
    }


def summary(document: Mapping[str, Any]) -> str:
    """The results of a fleet as a person wants to read them in a terminal."""
    jobs = document["jobs"]
    several = counted(len(document["ships"]), "ship"), counted(len(document["dates"]), "date")
    head = f"{', '.join(several)}: {counted(jobs['total'], 'job')}; "
    parts = f"nothing wrong in {jobs['good']}, something in {jobs['no']}, {jobs['failed']} failed"
    lines = [f"{head}{parts}, {jobs['missing']} not run yet."]
    for one in document["failures"][:SHOWN]:
        lines.append(f"failed: {one['ship']} {one['date']} {one['name']}")
        for problem in one["problems"]:
            where = f" ({problem['where']})" if problem["where"] else ""
            lines.append(f"  {problem['what']}{where}")
            lines += [f"    {word}: {problem[word]}" for word in ("why", "fix") if problem[word]]
    if len(document["failures"]) > SHOWN:
        lines.append(f"and {len(document['failures']) - SHOWN} more failed")
    if document["changes"]:
        lines += ["", "Changes:"]
        lines += [f"  {one['ship']}: {one['sentence']}." for one in document["changes"][:SHOWN]]
        more = len(document["changes"]) - SHOWN
        lines += [f"  and {more} more in the report"] if more > 0 else []
    best = [one for one in document["ranking"] if one["gain"] > 0.0][:3]
    if best:
        said = ", ".join(f"{one['ship']} {one['off_track']:.3g} -> {one['tuned_track']:.3g} m" for one in best)
        lines += ["", f"Most to gain by recalibration: {said}."]
    for one in document["classes"]:
        said = f"mean and spread of {len(one['coefficients'])} coefficients, {one['ships']} ships"
        lines += ["", f"Class {one['name']}: {said}."]
    return "\n".join(lines)
