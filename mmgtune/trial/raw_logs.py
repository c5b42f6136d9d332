"""Logs where trials are expected: what to do with them, as commands that can be pasted."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Collection, Sequence
from pathlib import Path

from ..errors import Problem, TrialError, brief
from ..phrases import listed
from .schema import REQUIRED

KINDS = (".csv", ".txt", ".dat", ".tsv", ".asc", ".log", ".nmea", ".xlsx", ".mat")
"""Endings of files that logs have."""

NOTES = ("readme", "licence", "license", "citation", "changelog")
"""Beginnings of names that text files beside data have."""

WHY = "trials are Parquet files with columns of known names and units; a map says what the columns of a log are"

NAMED = 12
"""Columns of a table that are named."""


class LogInstead(TrialError):
    """A Parquet file has the columns of somebody's log, not those of a trial."""


def refuse_log(path: Path, names: Collection[str], *, facts: bool) -> None:
    """Raise LogInstead for a Parquet file that nobody meant for a trial.

    names  of its columns: few are those of a trial, in capitals or not, and there are others
    facts  whether it says of itself that it is a trial
    """
    held = _held(names)
    if not facts and 2 * held < len(REQUIRED) and len(names) > held:
        raise LogInstead(instead(path, [path]))


def table_instead(names: Collection[str], where: str) -> Problem | None:
    """The problem of a table in memory of which the same is true; None where it is not.

    names  of its columns
    where  the trial it was to be, for messages
    """
    held = _held(names)
    if 2 * held >= len(REQUIRED):
        return None
    what = "the table lacks most columns of a trial" if held else "the table has none of the columns of a trial"
    there = [brief(name) for name in names]
    wanted = [f"{name} [{column.unit}]" for name, column in REQUIRED.items()]
    why = f"it has {listed(there, NAMED) or 'no columns'}; a trial has {listed(wanted)}"
    fix = f"give its columns these names and units, or make a log of it: {TABLE_TO_LOG}"
    return Problem(what, where, why, fix)


def _held(names: Collection[str]) -> int:
    """How many of the columns of a trial are among names, in capitals or not."""
    small = {name.strip().lower() for name in names}
    return sum(name in small for name in REQUIRED)


def raw_logs(path: Path) -> list[Path]:
    """What looks like a log in a folder, or the file itself where it looks like one."""
    if path.is_dir():
        files = sorted(one for one in path.iterdir() if one.is_file() and not one.name.startswith("."))
    else:
        files = [path]
    return [one for one in files if one.suffix.lower() in KINDS and not one.stem.lower().startswith(NOTES)]


def logs_instead(path: Path) -> Problem | None:
    """The problem of logs where trials are expected, with commands that make trials of them; None of others."""
    found = raw_logs(path)
    return instead(path, found) if found else None


def instead(path: Path, found: Sequence[Path]) -> Problem:
    """The problem of a file that is a log, or of a folder that holds these."""
    what = f"'{path.name}' is a log, not a trial" if path.is_file() else "the folder holds logs, not trials"
    return Problem(what, str(path), WHY, import_commands(_as_argument(path, found)))


def map_instead(path: Path) -> Problem:
    """The problem of a map where trials are expected: it makes them of logs."""
    fix = f"mmgtune trials import LOG... --map {shlex.quote(str(path))} -o imported, and give the folder imported"
    return Problem(f"'{path.name}' is a map of logs, not a trial", str(path), WHY, fix)


def import_commands(argument: str) -> str:
    """What makes trials of logs: find out what the columns are, then import.  ``argument`` names them for a shell."""
    return (
        f"mmgtune trials map {argument} -o map.toml, look at what it asks, then "
        f"mmgtune trials import {argument} --map map.toml -o imported, and give the folder imported"
    )


TABLE_TO_LOG = f'table.to_csv("log.csv", index=False), then {import_commands("log.csv")}'
"""How trials are made of a table in memory whose columns are not those of a trial."""


def _as_argument(path: Path, found: Sequence[Path]) -> str:
    """Logs as an argument of a shell command: one file, or all of the commonest kind of a folder."""
    if path.is_file() or len(found) == 1:
        return shlex.quote(str(found[0]))
    kind, n = Counter(one.suffix for one in found).most_common(1)[0]
    if n == 1:
        return shlex.quote(str(found[0]))
    return f"{shlex.quote(str(path))}/*{kind}"
