"""``fleet.json``: what the results of all jobs say together, for the report and for programs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .. import limits
from ..documents import parsed, write_json
from ..errors import OptionError, Problem, reason
from ..phrases import capital
from ..run_files import FLEET, JOBS, REPORT_HTML
from . import rows as result_rows
from .changes import FEWEST, LEVEL, SURE, Course
from .pooling import classes_of, write_classes
from .series import Series, courses, series_of

SCHEMA = 1

CELL = (
    "ship", "date", "name", "command", "answer", "verdict", "off_track", "off_heading", "tuned_track", "causes",
    "profile", "trials",
)  # fmt: skip
"""What is told of each job."""


def write_record(out: Path, made: Mapping[str, Any]) -> dict[str, Any]:
    """Write the record of a fleet from its results, and the classes of sister ships.  Returns it.

    made  which program made it, how, and of which table
    """
    rows = result_rows.read(out)
    classes = write_classes(out, classes_of(out, rows))
    listed = _listed(out)
    document = {
        "schema": SCHEMA,
        "kind": "fleet",
        **made,
        "out": str(out),
        "jobs": _counts(rows, listed),
        "ships": sorted({row["ship"] for row in rows}),
        "dates": sorted({row["date"] for row in rows}),
        "generated": any(row["generated"] for row in rows),
        "cells": [_cell(out, row) for row in rows],
        "failures": [_failure(row) for row in rows if row["answer"] == "failed"],
        "rules": {"level": LEVEL, "interval": SURE, "fewest_dates": FEWEST},
        **_over_time(rows),
        "ranking": _ranking(rows),
        "classes": [{"name": one["name"], **(one["pooled"] or {})} for one in classes],
    }
    write_json(document, out / FLEET)
    return document


def made_before(out: Path) -> dict[str, Any]:
    """What an earlier record says of how the fleet was made.  Raises OptionError where there is none."""
    path = out / FLEET
    try:
        document = parsed(limits.text(path, limits.RECORD_BYTES, OptionError))
        if not isinstance(document, dict):
            raise ValueError("it holds no table")
        return {key: document[key] for key in ("mmgtune", "created", "command", "environment", "table")}
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        fix = "give the folder that --out of mmgtune fleet run named; one that was stopped goes on with resume=True"
        what = "there is no record of a fleet"
        if path.is_file():
            what = "the record of a fleet cannot be read"
            fix = "remove that file and run the fleet again with resume=True: it is written anew"
        raise OptionError(Problem(what, str(path), reason(error), fix)) from error


def _listed(out: Path) -> set[str]:
    return {one["key"] for one in _jobs_of(out)}


def _jobs_of(out: Path) -> list[dict[str, Any]]:
    try:
        jobs = parsed((out / JOBS).read_text(encoding="utf-8"))["jobs"]
        return [{**one, "key": str(one["key"])} for one in jobs]
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        fix = "remove that file and run the fleet again with resume=True: it is written anew"
        raise OptionError(Problem("the list of jobs cannot be read", str(out / JOBS), reason(error), fix)) from error


def listed_places(out: Path) -> set[str]:
    """The places of the jobs that are listed in a folder; none where it has no list."""
    if not (out / JOBS).is_file():
        return set()
    return {str(one["place"]) for one in _jobs_of(out) if "place" in one}


def _counts(rows: Sequence[Mapping[str, Any]], listed: set[str]) -> dict[str, Any]:
    answers = Counter(row["answer"] for row in rows)
    missing = len(listed - {row["key"] for row in rows})
    seconds = sum(row["seconds"] for row in rows)
    counts = {answer: answers[answer] for answer in result_rows.ANSWERS}
    others = sum(row["key"] not in listed for row in rows)
    return {"total": len(rows) + missing, **counts, "missing": missing, "others": others, "seconds": seconds}


def _cell(out: Path, row: Mapping[str, Any]) -> dict[str, Any]:
    run = row["run"] if row["record"] else ""
    return {
        **{key: row[key] for key in CELL},
        "run": run,
        "report": bool(run) and (out / run / REPORT_HTML).is_file(),
    }


def _failure(row: Mapping[str, Any]) -> dict[str, Any]:
    return {key: row[key] for key in ("ship", "date", "name", "command", "problems")}


def _over_time(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Series of quantities, what they do, and the changes of all in time."""
    every = series_of(rows)
    found = {(one.ship, one.job, one.name): what for one, what in courses(every)}
    changes = []
    told = []
    for one in every:
        what = found.get((one.ship, one.job, one.name))
        told.append({**one.to_dict(), "course": _course(what)})
        for k, change in enumerate(what.changes if what else ()):
            between = one.dates[change.first], one.dates[change.last]
            changes.append(
                {
                    **{key: getattr(one, key) for key in ("ship", "job", "name", "tag", "words", "unit")},
                    "month": one.dates[change.after],
                    "after": between[0],
                    "by": between[1],
                    "size": change.size,
                    "error": change.error,
                    "p": change.p,
                    "sentence": _sentence(one, change.size, change.error, between),
                    "number": k,
                }
            )
    changes.sort(key=lambda one: (one["month"], one["ship"], one["name"]))
    return {"series": told, "changes": changes, "trends": _trends(every, found)}


def _course(what: Course | None) -> dict[str, Any] | None:
    if what is None:
        return None
    places = [one.after for one in what.changes]
    return {
        "slope": what.slope,
        "slope_error": what.slope_error,
        "grows": what.grows,
        "places": places,
        "fitted": what.fitted.tolist(),
    }


def _sentence(one: Series, size: float, error: float, between: tuple[str, str]) -> str:
    unit = f" {one.unit}" if one.unit else ""
    verb = "rises" if size > 0.0 else "falls"
    words = one.words if one.words == one.name else capital(one.words)
    return f"{words} {verb} by {abs(size):.3g}{unit} (± {error:.2g}) between {between[0]} and {between[1]}"


def _trends(every: Sequence[Series], found: Mapping[tuple[str, str, str], Course]) -> list[dict[str, Any]]:
    """What grows or falls steadily."""
    rows = []
    for one in every:
        what = found.get((one.ship, one.job, one.name))
        if what is not None and what.grows:
            said = {key: getattr(one, key) for key in ("ship", "job", "name", "tag", "words", "unit")}
            rows.append({**said, "slope": what.slope, "error": what.slope_error})
    return rows


def _ranking(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Ships by what a recalibration would gain, from their latest fit: metres off track now, and when tuned."""
    latest: dict[str, Mapping[str, Any]] = {}
    for row in rows:
        if row["off_track"] is not None and row["tuned_track"] is not None:
            latest[row["ship"]] = row
    told = []
    for ship, row in latest.items():
        keys = ("date", "name", "off_track", "tuned_track", "off_heading", "tuned_heading", "run")
        told.append({"ship": ship, **{key: row[key] for key in keys}, "gain": row["off_track"] - row["tuned_track"]})
    return sorted(told, key=lambda one: (-one["gain"], one["ship"]))
