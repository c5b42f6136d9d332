"""``mmgtune trials``: make, check and inspect trial files."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import MmgtuneError, OptionError, Problem
from ..options import MakeOptions, in_flags
from ..phrases import counted
from . import common as c
from . import completing
from .exitcodes import ExitCode
from .options import App, problems_in_flags, takes

if TYPE_CHECKING:
    from ..importing import Imported

app = App(help="Make trial files from logs or from a model, check and inspect them.")

Name = Annotated[
    str, typer.Argument(help="Folder of trial files, one file, or a bundled name.", autocompletion=completing.trials)
]


@app.command("check")
def check(
    trials: Name,
    json: c.Json = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit 1 on warnings.")] = False,
) -> None:
    """Check trial files; exit 2 where they cannot be used, 1 on warnings with --strict.

    Example:

      mmgtune trials check my_trials/
    """
    from ..profile import load_profile
    from ..resources import profile_names
    from ..trial import check_trials, load_trials

    try:
        data = load_trials(trials)
    except MmgtuneError as error:
        if json:
            problems = [problem.to_dict() for problem in problems_in_flags(error)]
            c.print_json({"schema": 1, "kind": "trials-check", "trials": {}, "problems": problems})
        raise
    # The trials of a ship with a bundled profile are checked against her length.
    L_pp = load_profile(data.ship).L_pp if data.ship in profile_names() else None
    found = check_trials(data.trials, L_pp)
    found |= {name: [] for name in data.stated}  # what is wrong with these is said on reading
    if json:
        listed = {name: [vars(f) for f in findings] for name, findings in found.items()}
        c.print_json({"schema": 1, "kind": "trials-check", "trials": listed, "problems": []})
    else:
        alike: dict[tuple[str, ...], list[str]] = {}
        for f in (f for findings in found.values() for f in findings):
            alike.setdefault((f.severity, f.what, f.why, f.fix), []).append(f.where)
        for (severity, what, why, fix), (first, *others) in alike.items():
            more = f", and {len(others)} more" if others else ""
            c.show(f"{severity}: {Problem(what, f'{first}{more}', why, fix)}")
        warnings = sum(f.severity == "warning" for findings in found.values() for f in findings)
        tune, test = len(data.tune) + len(data.tune_stated), len(data.test) + len(data.test_stated)
        c.show(f"{counted(len(found), 'trial')} can be used, {counted(warnings, 'warning')}; tune {tune}, test {test}")
    if strict and any(f.severity == "warning" for findings in found.values() for f in findings):
        raise typer.Exit(ExitCode.NO)


@app.command("inspect")
def inspect(
    trials: Name,
    profile: Annotated[
        str | None,
        typer.Option(
            "--profile",
            "-p",
            help="Ship profile, for her length. Default: the bundled one the trials name.",
            autocompletion=completing.profiles,
        ),
    ] = None,
    json: c.Json = False,
) -> None:
    """Show what each trial holds: length, ranges, metadata, and its manoeuvring indices.

    Example:

      mmgtune trials inspect suzaku
    """
    from ..inspecting import inspect_trials
    from ..motions import SHORT_GAP, track_if_whole
    from ..trial.index_trial import shown_index

    found = inspect_trials(trials, profile)
    for note in found.notes:
        c.say(f"warning: {note}")
    if json:
        c.print_json(found.to_dict())
        return
    data, L_pp = found.trials, found.L_pp
    for one in data.stated.values():
        c.show(f"{one.id}  {one.ship} {one.order} ({one.source or 'source not stated'}), {data.role(one.id)}")
        for index, (value, tolerance) in one.stated(L_pp).items():
            (shown, unit), (off, _) = shown_index(index, value, L_pp), shown_index(index, tolerance, L_pp)
            assumed = ", tolerance assumed" if one.indices[index].assumed else ""
            c.show(f"  {index:<34}{shown:.4g} +- {off:.2g} {unit}{assumed}")
    for row in found.rows:
        c.show(
            f"{row['id']}  {row['ship']} {row['manoeuvre']} ({row['source'] or 'source not stated'}), "
            f"{row['role']}, {counted(row['n_samples'], 'sample')}, {row['duration_s']:g} s"
        )
        for channel, span in row["ranges"].items():
            c.show(f"  {channel:<8}{span['min']:>12.4g} .. {span['max']:<12.4g} {span['unit']}")
        for index, value in row["indices"].items():
            if isinstance(value, float | str):
                c.show(f"  {index:<34}{value if isinstance(value, str) else f'{value:.4g}'}")
        if not row["indices"] and track_if_whole(data.trials[row["id"]]) is None:
            c.show(f"  no manoeuvring indices: they are read over gaps of up to {SHORT_GAP} samples, in no longer ones")
        if row["note"]:
            c.show(f"  {row['note']}")


@app.command("map")
def map_(
    logs: Annotated[
        list[str],
        typer.Argument(help="Logs of one kind: CSV or other text, .xlsx, .mat, Parquet, NMEA 0183.", metavar="LOG..."),
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="File for the map. Default: print it.", rich_help_panel=c.OUTPUT),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the map there.", rich_help_panel=c.OUTPUT)] = False,
    json: c.Json = False,
) -> None:
    """Find out what the columns of logs are, and write the map that imports them.

    Columns are told by how they behave and by their names. What does not show is a question in the map, marked with a
    question mark, and the import asks for it.

    Example:

      mmgtune trials map logs/*.csv -o map.toml
    """
    from ..files import refuse_existing, write_text
    from ..importing import propose_map

    if out is not None and not force:
        refuse_existing([out])
    proposal = propose_map(logs)
    if out is not None:
        write_text(out, proposal.text, force)
    if json:
        c.print_json(proposal.to_dict())
        return
    # Without a file the map is what is printed, so that it can be sent into one.
    tell = c.show if out is not None else c.say
    for line in proposal.lines(str(out) if out is not None else ""):
        tell(in_flags(line))
    if out is None:
        c.show(proposal.text, end="")


@app.command("import")
def import_(
    logs: Annotated[
        list[str], typer.Argument(help="Logs: CSV or other text, .xlsx, .mat, Parquet, NMEA 0183.", metavar="LOG...")
    ],
    map_: Annotated[
        str | None,
        typer.Option("--map", help="TOML file saying what the columns are.", rich_help_panel=c.INPUT),
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            "--preset", help="A bundled map by name.", rich_help_panel=c.INPUT, autocompletion=completing.maps
        ),
    ] = None,
    step: Annotated[
        str | None,
        typer.Option("--step", help="Time step of the trials, such as \"1 s\". Default: the map's, else the log's."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for the trial files.", rich_help_panel=c.OUTPUT)
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace trial files of the same name.", rich_help_panel=c.OUTPUT)
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Print the quality report, write nothing.", rich_help_panel=c.OUTPUT)
    ] = False,
    keep_going: Annotated[
        bool,
        typer.Option(
            "--keep-going",
            help="Import the logs and runs that can be, and exit 1 where others cannot.",
            rich_help_panel=c.INPUT,
        ),
    ] = False,
    json: c.Json = False,
) -> None:
    """Turn logs into trial files, one a log, and say what they are worth.

    What a log does not say and its motion does not show is asked for, never guessed. Where one log cannot be read, none
    is imported unless --keep-going is given.

    Example:

      mmgtune trials import logs/*.csv --map logger.toml -o my_trials
    """
    from .. import units
    from ..importing import import_logs, load_map

    if (map_ is None) == (preset is None):
        fix = "--map FILE.toml; mmgtune trials map LOG... -o FILE.toml writes one for these logs"
        why = "what the columns of a log mean is said by one of them" if map_ is None else "each says it all"
        raise OptionError(Problem("give either --map or --preset", "--map, --preset", why, fix))
    if out is None and not dry_run:
        why = "a trial file is written for each log"
        raise OptionError(Problem("no folder is given for the trials", "--out", why, "add -o FOLDER, or --dry-run"))
    seconds = None
    if step is not None:
        seconds = units.quantity(step, "step", "s", '"0.5 s"')
        if not 0.0 < seconds < float("inf"):
            raise OptionError(
                Problem(f"the step is {step}", "--step", "samples follow one another", "give a time above 0 s")
            )
    log_map = load_map(map_) if map_ is not None else load_map(str(preset), preset=True)
    imported = import_logs(logs, log_map, out or ".", seconds, force, dry_run, keep_going)
    if json:
        c.print_json(imported.to_dict())
    else:
        _show_imported(imported, out, dry_run)
    if imported.refused:
        refused = counted(len(imported.refused), "log or run was", "logs or runs were")
        c.say(f"not all came in: {refused} refused, {counted(len(imported.trials), 'trial')} made of the others")
        raise typer.Exit(ExitCode.NO)


def _show_imported(imported: Imported, out: Path | None, dry_run: bool) -> None:
    from ..trial.splitting import suggested_split

    c.show(imported.text())
    done = "would be written" if dry_run else f"written to {out}"
    c.show(f"{counted(len(imported.trials), 'trial')} {done}")
    if not dry_run:
        c.show(f"next: mmgtune trials check {quote(str(out))}")
        c.show(f"then, with her profile: mmgtune fit -p PROFILE -t {quote(str(out))}, or diagnose in the place of fit")
        if len(imported.trials) > 1 and out is not None and not (out / "split.toml").exists():
            tune, test = (", ".join(f'"{id}"' for id in ids) for ids in suggested_split(imported.trials))
            if test:
                where = quote(str(out / "split.toml"))
                c.show(f"all of them tune; to keep some for testing, say so in {where}, such as:")
                c.show(f"  tune = [{tune}]\n  test = [{test}]")


@app.command("make")
@takes(options=MakeOptions)
def make(
    ship: Annotated[str, typer.Argument(help="Ship whose trials are made: vectwin.")],
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the sets.", rich_help_panel=c.OUTPUT)],
    *,
    options: MakeOptions,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there.", rich_help_panel=c.OUTPUT)] = False,
    json: c.Json = False,
) -> None:
    """Make sets of trials from a model, with noise, and beside each set what was true.

    Example:

      mmgtune trials make vectwin --out vectwin --sets train-b,test-b
    """
    from ..generating import make_trials

    made = make_trials(ship, out, options, overwrite=force)
    if json:
        c.print_json(made.to_dict())
        return
    for row in made.sets:
        c.show(f"{row['set']:<10}{row['trials']:>4} trials {row['seconds']:>7g} s  {row['about']}: {row['folder']}")
    c.show(f"ship: {made.profile or made.ship}")
