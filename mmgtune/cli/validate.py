"""``mmgtune validate``."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import OptionError, Problem
from ..options import ValidateOptions, VoyageOptions
from . import common as c
from . import completing
from .options import WrittenOptions, takes
from .stated import stated_table

if TYPE_CHECKING:
    from ..validating import Validation

OF_VOYAGES = 'a log that says manoeuvre "voyage" or lasts more than an hour'


@takes(options=VoyageOptions, run=WrittenOptions)
def command(
    names: Annotated[
        list[str],
        typer.Argument(
            metavar="PROFILE... TRIALS",
            help="Profiles, then the trials: files, folders or bundled names.",
            autocompletion=completing.models_and_trials,
        ),
    ],
    *,
    options: VoyageOptions,
    run: WrittenOptions,
    formerly: Annotated[str | None, typer.Option("--window", hidden=True)] = None,
    json: c.Json = False,
    no_report: c.NoReport = False,
) -> None:
    """Score profiles on trials: J and the standardised error L_MSE, per trial and per kind of manoeuvre.

    Each trial, or window of it, is simulated with its measured inputs from its first measured state, or from one within
    the noise of that (--initial estimated). L_MSE is the mean over time of the sum over all six states of squared
    differences over their variances (Wakita et al. 2022, eq. 26).

    Logs of hours and days are voyages: they say manoeuvre "voyage", or last more than an hour. They are cut into
    windows of 120 s, or --restart, and seven distance measures tell how far each model is off, and where its error
    lives. That has a run folder and a report; of trials, --out names a folder for them.

    Examples:

      mmgtune validate suzaku suzaku

      mmgtune validate before.toml after.toml my_trials/ --restart 100 --json

      mmgtune validate suzaku suzaku --manoeuvres --out runs/scores

      mmgtune validate before.toml after.toml voyages/ --out runs/voyages
    """
    from ..recording import write_validation
    from ..report import render
    from ..run_folders import claimed, refuse_taken
    from ..trial import holds_voyages
    from ..validating import validate

    if formerly is not None:
        why = "--window FIRST:LAST is the time that counts, in the commands that fit"
        raise OptionError(
            Problem("the length of windows has another name", "--window", why, f"write --restart {formerly}")
        )
    if len(names) < 2:
        raise OptionError(
            Problem(
                "a profile or the trials are missing",
                "PROFILE... TRIALS",
                f"only '{names[0]}' was given, and trials stand last",
                "write mmgtune validate PROFILE... TRIALS, such as mmgtune validate suzaku suzaku",
            )
        )
    if holds_voyages(names[-1]):
        from .voyages import on_voyages

        on_voyages(names[:-1], names[-1], options, run, json=json, no_report=no_report)
        return
    _refuse(options, run, no_report)
    if run.out is not None:
        refuse_taken(run.out, force=run.force)
    result = validate(names[:-1], names[-1], ValidateOptions(**options.shared_with(ValidateOptions)))
    if run.out is not None:
        with claimed(run.out, force=run.force):
            write_validation(result, run.out, c.command_line(), overwrite=True)
            if not no_report:
                render(run.out)
    if json:
        c.print_json(result.to_dict())
    else:
        c.show(summary(result))
        for warning in result.oddities:
            c.say(f"Note: {warning}")
        for note in dict.fromkeys(note for one in result.profiles for note in one.notes):
            c.say(f"note: {note}")
        for one in result.profiles:
            c.say_doubts(one.doubts, f"{one.name}: ")
        if run.out is not None:
            c.say(f"Results: {run.out}" if no_report else f"Report: {run.out}/report.html")


def _refuse(options: VoyageOptions, run: WrittenOptions, no_report: bool) -> None:
    """Raises OptionError for what was asked of voyages where there are none."""
    own = {one.name for one in fields(VoyageOptions)} - {one.name for one in fields(ValidateOptions)}
    asked = [name for name in sorted(own) if getattr(options, name) != getattr(VoyageOptions, name)]
    asked += [name for name in ("resume", "quiet") if getattr(run, name)]
    if asked:
        raise OptionError(
            *(
                Problem(
                    "these trials are no voyages",
                    name,
                    "of trials the scores are printed, and written where --out names a folder",
                    f"leave it out, or give {OF_VOYAGES}",
                )
                for name in asked
            )
        )
    if run.out is None:
        c.needs_folder(force=run.force, no_report=no_report)


def summary(result: Validation) -> str:
    """Plain-text summary of the result."""
    from .repeated import table

    lines = []
    for one in result.to_dict()["profiles"]:
        begun = ", first states estimated" if result.options.initial == "estimated" else ""
        lines.append(f"{one['profile']} ({one['id']}), {one['method']}{begun}")
        if one.get("stated"):
            lines += [
                "",
                *stated_table(one["stated"], ("simulated",)),
                "",
                f"  off by {_rms(one['stated'])}",
            ]
        if "J" not in one:
            continue
        rows = [
            (kind or "manoeuvre not stated", str(row["runs"]), _shown(row["J"]), _shown(row["L_MSE"]), *_held(row))
            for kind, row in one["by_manoeuvre"].items()
        ]
        rows.append(("all", str(len(one["trials"])), _shown(one["J"]), _shown(one["L_MSE"]), *_held(one)))
        bands = ("90 % holds", "CRPS") if "bands" in one else ()
        rows += [
            (f"  {row['id']}", "", _shown(row["J"]), _shown(row["L_MSE"]), *("" for _ in bands))
            for row in one["trials"]
        ]
        lines += [f"  {line}" for line in c.table(("", "runs", "J", "L_MSE", *bands), rows, less=2)]
    if result.options.manoeuvres:
        lines.append(table({one.name: one.repeated for one in result.profiles}))
    return "\n".join(lines)


def _held(row: dict[str, Any]) -> tuple[str, ...]:
    """What the bands of a row hold, and their CRPS; nothing where there are none."""
    if "bands" not in row:
        return ()
    share, crps = row["bands"]["coverage_90"], row["bands"]["CRPS"]
    return ("-" if share is None else f"{100.0 * share:.0f} %", "-" if crps is None else f"{crps:.3g}")


def _rms(rows: list[dict[str, Any]]) -> str:
    """Root mean square of what stated indices are off by."""
    off = [row["off"]["simulated"] for row in rows]
    if None in off:
        return "more than a thousand tolerances: some are never reached"
    return f"{(sum(one**2 for one in off) / len(off)) ** 0.5:.3g} tolerances, root mean square over {len(off)} indices"


def _shown(value: float | None) -> str:
    return "diverged" if value is None else f"{value:.4g}"
