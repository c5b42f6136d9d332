"""``fleet.toml``: which jobs there are, as entries that stand for many."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from .. import limits
from ..errors import OptionError, Problem, reason
from ..limits import Limit
from ..options import Options
from ..resources import must_be_name
from ..toml_reading import TomlReader, line_index, toml_of
from .commands import COMMANDS

TABLE_BYTES = Limit(1 << 20, "bytes", "a table of jobs", "write entries with patterns, not one for each job")
KEYS = ("name", "command", "profile", "trials", "ship", "date", "class", "baseline", "options")
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,79}")
"""What ships and entries may be called: folders are named after them."""

DATE = re.compile(r"(\d{4})(?:-?(\d{2})(?:-?(\d{2}))?)?")
"""A year, a month or a day, with dashes or without."""

_HEAD = re.compile(r"\s*\[\[jobs\]\]")


@dataclass(frozen=True)
class Entry:
    """Jobs that differ in ship and date alone.

    name      of the job among those of a ship and date
    profile, trials, baseline  patterns: {ship} and {date} are filled in, and ``trials`` may have * and ?
    ship, date  of all of them, "" where ``trials`` says it
    sisters   the class of ships whose calibrations are pooled, "" for none
    where     file and line, for messages
    """

    name: str
    command: str
    profile: str
    trials: str
    ship: str
    date: str
    sisters: str
    baseline: str
    options: Options
    where: str


@dataclass(frozen=True)
class FleetTable:
    """A table of jobs: its entries, and the file they stand in, whose folder relative paths are taken from."""

    path: Path
    entries: tuple[Entry, ...]

    @property
    def base(self) -> Path:
        """The folder that relative paths are taken from."""
        return self.path.absolute().parent


def read_table(path: Path | str) -> FleetTable:
    """The table of a file.  Raises OptionError with everything that is wrong in it."""
    must_be_name(path, "table of jobs", OptionError)
    path = Path(path)
    try:
        text = limits.text(path, TABLE_BYTES, OptionError)
    except (OSError, ValueError) as error:
        why = reason(error)
        raise OptionError(Problem("the table of jobs cannot be read", str(path), why, "give a TOML file")) from error
    reader = _Reader(toml_of(text, "the table of jobs", str(path), OptionError), text, str(path))
    entries = reader.read()
    if reader.problems:
        raise OptionError(*reader.problems)
    return FleetTable(path, entries)


class _Reader(TomlReader):
    """One pass over a table; entries are told apart by where they begin."""

    def read(self) -> tuple[Entry, ...]:
        self.schema(1)
        self.unknown("", self.data, ("schema", "jobs"))
        jobs = self.data.get("jobs")
        if not isinstance(jobs, list) or not jobs or not all(isinstance(one, dict) for one in jobs):
            self.problem(
                "the table has no jobs", "", "jobs", fix="write an entry: [[jobs]], then command, profile, ..."
            )
            return ()
        lines = self.text.splitlines()
        begins = [k for k, line in enumerate(lines) if _HEAD.match(line)]
        if len(begins) != len(jobs):
            self.problem("jobs are not written as entries", "", "jobs", fix="begin each with a line [[jobs]]")
            return ()
        found: list[Entry] = []
        for job, first, last in zip(jobs, begins, [*begins[1:], len(lines)], strict=True):
            own = line_index("\n".join(lines[first + 1 : last]).replace("[jobs.options]", "[options]"))
            self.lines = {
                ("jobs", key) if not table else (table, key): k + first + 1 for (table, key), k in own.items()
            }
            self.lines[("jobs", "")] = first + 1
            entry = self._entry(job)
            found += [entry] if entry else []
        return tuple(found)

    def _entry(self, job: dict[str, Any]) -> Entry | None:
        before = len(self.problems)
        self.unknown("jobs", job, KEYS)
        texts = {key: self.text_of("jobs", job, key) for key in KEYS if key != "options"}
        command = self.choice("jobs", job, "command", tuple(COMMANDS))
        for key in ("command", "profile", "trials"):
            if key not in job:
                examples = {"command": '"fit"', "profile": '"ships/{ship}.toml"', "trials": '"logs/{ship}/{date}"'}
                self.problem(f"the entry has no '{key}'", "jobs", "", fix=f"write {key} = {examples[key]}")
            elif texts[key] == "" and job[key] == "":
                self.problem(f"'{key}' is empty", "jobs", key, fix="write what is meant")
        for key in ("ship", "date"):
            said = f"{{{key}}}" in texts["trials"]
            if not said and not texts[key] and texts["trials"]:
                why = "results are kept by ship and date"
                fix = f'put {{{key}}} into trials = "{texts["trials"]}", or write {key} = "..."'
                self.problem(f"nothing says the {key} of the jobs", "jobs", "trials", why, fix)
            if said and texts[key]:
                self.problem(f"'{key}' is said twice", "jobs", key, "trials has it too", "leave one out")
        for key in ("name", "ship", "class"):
            if texts[key] and not NAME.fullmatch(texts[key]):
                fix = "use letters, digits, '_', '-' and '.'"
                self.problem(f"{key} '{texts[key]}' cannot be the name of a folder", "jobs", key, fix=fix)
        if texts["date"] and not iso_date(texts["date"]):
            self.problem(f"'{texts['date']}' is no date", "jobs", "date", fix='write date = "2026-05-31", or "2026-05"')
        if command == "check" and "baseline" not in job:
            why, fix = "a check compares with one", 'write baseline = "checks/{ship}.json"'
            self.problem("a check has no baseline", "jobs", "command", why, fix)
        if command and command != "check" and "baseline" in job:
            self.problem(f"a {command} takes no baseline", "jobs", "baseline", fix="leave it out")
        options = self._options(job.get("options", {}), command) if command else None
        if len(self.problems) > before or options is None:
            return None
        return Entry(
            texts["name"] or str(command),
            str(command),
            texts["profile"],
            texts["trials"],
            texts["ship"],
            iso_date(texts["date"]),
            texts["class"],
            texts["baseline"],
            options,
            f"{self.where}, line {self.line('jobs')}",
        )

    def _options(self, given: Any, command: str) -> Options | None:
        """The options of a command as its dataclass has them."""
        of = COMMANDS[command].options
        if not isinstance(given, dict):
            self.problem("'jobs.options' is not a table", "jobs", "options", fix="write options = { a_r = 0.5 }")
            return None
        self.unknown("options", given, tuple(of.__dataclass_fields__))
        try:
            return options_of(command, {key: value for key, value in given.items() if key in of.__dataclass_fields__})
        except OptionError as error:
            for one in error.problems:
                self.problem(one.what, "options", one.where, one.why, one.fix)
            return None


def options_of(command: str, given: Mapping[str, Any]) -> Options:
    """The options of a command from what a file says: lists are tuples.  Raises OptionError."""
    tuples = {key: tuple(value) if isinstance(value, list) else value for key, value in given.items()}
    return COMMANDS[command].options(**tuples)


def iso_date(text: str) -> str:
    """A date as 2026, 2026-05 or 2026-05-31; "" for what is none."""
    found = DATE.fullmatch(text)
    if found is None:
        return ""
    parts = [part for part in found.groups() if part]
    try:
        date(int(parts[0]), *(int(part) for part in (*parts[1:], "1", "1")[:2]))
    except ValueError:
        return ""
    return "-".join(parts)
