"""Entries to jobs: patterns become paths, and each path says its ship and date."""

from __future__ import annotations

import re
from pathlib import Path

from ..errors import MmgtuneError, OptionError, Problem, ProfileError
from ..options import Options
from ..profile import load_profile
from ..provenance import own_version
from .job import Job, Source
from .places import hashes, is_url, matching
from .table import Entry, FleetTable, iso_date

MOST = 20
"""Problems told of one table: the rest is likely the same."""

_PARTS = {"{ship}": r"(?P<ship>[A-Za-z0-9][A-Za-z0-9_.-]*)", "{date}": r"(?P<date>\d{4}(?:-?\d{2}){0,2})"}


def expand(table: FleetTable) -> list[Job]:
    """The jobs of a table, by ship, date and name.

    Raises OptionError for a pattern that nothing matches, paths that say no ship or date, profiles and baselines that
    are not there, and jobs that could not be told apart.
    """
    problems: list[Problem] = []
    jobs: dict[tuple[str, str, str], Job] = {}
    profiles: dict[str, str] = {}
    for entry in table.entries:
        for place, ship, date in _places(entry, table.base, problems):
            try:
                job = _job(entry, table.base, place, ship, date, profiles)
            except MmgtuneError as error:
                problems += error.problems
                continue
            twin = jobs.setdefault((ship, date, entry.name), job)
            if twin is not job:
                what = f"two jobs are '{job.label}'"
                why = f"one is of {twin.trials.path}, the other of {place}"
                fix = "give the entries different names, or put trials of one date into one folder"
                problems.append(Problem(what, entry.where, why, fix))
    if problems:
        told = list(dict.fromkeys(problems))
        more = [Problem(f"and {len(told) - MOST} more", str(table.path))] if len(told) > MOST else []
        raise OptionError(*told[:MOST], *more)
    return [jobs[key] for key in sorted(jobs)]


def _places(entry: Entry, base: Path, problems: list[Problem]) -> list[tuple[str, str, str]]:
    """Each place the pattern of an entry matches, with the ship and date it says."""
    pattern = entry.trials
    try:
        found = matching(re.sub(r"\{(ship|date)\}", "*", pattern), base)
    except MmgtuneError as error:
        problems += error.problems
        return []
    shape = _shape(pattern, base)
    said = [(place, match) for place in found if (match := shape.fullmatch(place))]
    if not said:
        why = f"{len(found)} paths are alike, but none says a ship and a date there" if found else ""
        fix = "ships are of letters, digits, '_', '-' and '.'; dates are 2026-05-31, 20260531, 2026-05 or 2026"
        fix = fix if found else "correct the pattern; paths are taken from the folder of the table"
        problems.append(Problem(f"no trials match '{pattern}'", entry.where, why, fix))
    rows = []
    for place, match in said:
        parts = match.groupdict()
        date = entry.date or iso_date(parts["date"])
        if date:
            rows.append((place, entry.ship or parts["ship"], date))
        else:
            problems.append(Problem(f"'{parts['date']}' is no date", place, fix="name it by a day, a month or a year"))
    return rows


def _shape(pattern: str, base: Path) -> re.Pattern[str]:
    """What the whole of a path must be like; a part that comes again must be the same again."""
    absolute = pattern if is_url(pattern) else str(base / pattern)
    words, seen = "", set()
    for part in re.split(r"(\{ship\}|\{date\}|\*|\?)", absolute):
        if part in _PARTS:
            words += f"(?P={part[1:-1]})" if part in seen else _PARTS[part]
            seen.add(part)
        else:
            words += {"*": "[^/]*", "?": "[^/]"}.get(part) or re.escape(part)
    return re.compile(words)


def _job(entry: Entry, base: Path, place: str, ship: str, date: str, profiles: dict[str, str]) -> Job:
    """The job of one place."""
    path = _filled(entry.profile, ship, date, base)
    if path not in profiles:
        try:
            profiles[path] = load_profile(path).text
        except ProfileError as error:
            whose = f"it is that of ship '{ship}'"
            told = [
                Problem(one.what, one.where, f"{whose}; {one.why}" if one.why else whose, one.fix)
                for one in error.problems
            ]
            raise ProfileError(*told) from error
    baseline = None
    if entry.baseline:
        file = _filled(entry.baseline, ship, date, base)
        if not Path(file).is_file():
            fix = "write it with mmgtune check PROFILE TRIALS --baseline FILE --update-baseline"
            raise OptionError(Problem("there is no such baseline", file, f"it is that of ship '{ship}'", fix))
        baseline = Source(file, hashes(file))
    options: Options = entry.options
    return Job(
        ship=ship,
        date=date,
        name=entry.name,
        command=entry.command,
        profile=profiles[path],
        profile_path=path,
        trials=Source(place, hashes(place)),
        options=options.to_dict(),
        version=own_version(),
        sisters=entry.sisters,
        baseline=baseline,
    )


def _filled(pattern: str, ship: str, date: str, base: Path) -> str:
    """A path with ship and date filled in, from ``base`` where there is such a file, else as it is: a bundled name."""
    filled = pattern.replace("{ship}", ship).replace("{date}", date)
    return str(base / filled) if (base / filled).exists() or "/" in filled else filled
