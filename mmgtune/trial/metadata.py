"""Facts about a trial in the metadata of its file, a JSON object."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..documents import RepeatedKey, parsed
from ..errors import Problem, among, brief, reason
from ..files import can_name_file
from ..limits import FACTS_BYTES, NAME, NESTING, as_float, is_real
from ..toml_reading import depth, finite
from .schema import COLUMNS, LARGEST, METADATA, MOTION, SCHEMA, SOURCES, impossible, known_column

LONGEST = 1000.0
"""Distance from midship [m] that nothing on a ship is at."""


def facts_of(raw: bytes | None, path: Path, columns: Sequence[str]) -> tuple[dict[str, Any], list[Problem]]:
    """The facts written in ``raw`` and what is wrong with them; no facts where there is no metadata.

    columns  names in the file, which noise may be given for
    """
    if raw is None:
        return {}, []
    where = f"{path}, metadata 'mmgtune'"
    problem = FACTS_BYTES.problem(len(raw), where)
    if problem is not None:
        return {}, [problem]
    try:
        facts = parsed(raw)
        if not isinstance(facts, dict):
            raise ValueError(f"it is a {type(facts).__name__}")
        if depth(facts) > NESTING.most:
            raise ValueError(f"it is nested more than {NESTING.most} levels deep")
    except RepeatedKey as error:
        return {}, [Problem("the metadata says something twice", where, str(error), "leave one of the two out")]
    except (ValueError, RecursionError) as error:
        fix = 'write an object such as {"schema": 1, "ship": "...", "id": "..."}, or leave the metadata out'
        return {}, [Problem("the metadata is not a JSON object", where, reason(error), fix)]
    return facts, problems_in(facts, where, columns)


def as_json(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Facts of a trial in memory as a file has them: lists and plain numbers."""
    noise, derived = facts.get("noise"), facts.get("derived")
    made = dict(facts)
    if isinstance(noise, Mapping):
        made["noise"] = {name: as_float(one) if is_real(one) else one for name, one in noise.items()}
    if isinstance(derived, tuple):
        made["derived"] = list(derived)
    return made


def problems_in(facts: Mapping[str, Any], where: str, columns: Sequence[str]) -> list[Problem]:
    """What is wrong with facts as a file has them; ``where`` they stand, for messages.

    columns  of the trial, which noise may be given for
    """
    problems = [
        Problem(f"unknown key {brief(key)}", where, **among(key, METADATA)) for key in facts if key not in METADATA
    ]
    if facts.get("schema", SCHEMA) != SCHEMA:
        fix = "update mmgtune, or write the file again"
        problems.append(Problem(f"schema is {brief(facts['schema'])}, not {SCHEMA}", where, fix=fix))
    for key in ("id", "ship", "manoeuvre", "source", "note", "cut_from", "group"):
        if key in facts and not _is_text(facts[key]):
            problems.append(Problem(f"'{key}' is {brief(facts[key])}, not text", where, fix=f'write "{key}": "..."'))
    name = facts.get("id", "")
    if isinstance(name, str) and not can_name_file(name):
        problems.append(
            Problem(
                f"id {brief(name)} cannot be the name of a file",
                where,
                "results of a trial are written to files named after it",
                "use letters, digits, '_' and '-'",
            )
        )
    too_long = NAME.problem(len(name), where) if isinstance(name, str) else None
    problems += [too_long] if too_long else []
    source = facts.get("source", "")
    if isinstance(source, str) and source not in ("", *SOURCES):
        problems.append(Problem(f"source is {brief(source)}", where, fix=f"one of: {', '.join(SOURCES)}"))
    derived = facts.get("derived", [])
    if not isinstance(derived, list) or not set(map(str, derived)) <= set(MOTION):
        fix = f"write a list of any of {', '.join(MOTION)}, or leave it out"
        problems.append(Problem(f"'derived' is {brief(derived)}, not a list of motion columns", where, fix=fix))
    if "antenna" in facts and antenna_of(facts) is None:
        problems.append(no_place(facts["antenna"], where))
    return problems + noise_problems(facts.get("noise", {}), where, columns)


def antenna_of(facts: Mapping[str, Any]) -> tuple[float, float] | None:
    """Where positions were measured [m], forward and to starboard of midship; None where no place on a ship is said."""
    place = facts.get("antenna")
    if not isinstance(place, list | tuple) or len(place) != 2:
        return None
    if not all(is_real(one) and abs(as_float(one)) < LONGEST for one in place):
        return None
    return as_float(place[0]), as_float(place[1])


def no_place(place: object, where: str) -> Problem:
    """The problem of what is no place on a ship."""
    fix = 'write [ahead, to starboard] of midship in m, "antenna": [-25.0, 0.0], or leave it out'
    why = f"it is two numbers, each of less than {LONGEST:.0f} m from midship"
    return Problem(f"'antenna' is {brief(place)}, no place on a ship", where, why, fix)


def nameless(id: object) -> bool:
    """Whether an id is a text of nothing but spaces."""
    return isinstance(id, str) and not id.strip()


def without_id(where: str) -> Problem:
    """The problem of a trial in memory that has no id; a file without one is called after itself."""
    why = "trials are told apart by their ids, and results are named after them"
    return Problem("the id of a trial is empty", where, why, 'give it one, such as "turn_p35"')


def noise_problems(noise: object, where: str, columns: Sequence[str]) -> list[Problem]:
    """What is wrong with standard deviations by column."""
    if not isinstance(noise, dict):
        fix = 'write {"x": 0.5, ...}, or leave it out'
        return [Problem("'noise' is not an object of standard deviations", where, fix=fix)]
    problems = []
    known = list(dict.fromkeys([*COLUMNS, *columns]))
    for name, value in noise.items():
        if name not in known:
            problems.append(Problem(f"noise of unknown column {brief(name)}", where, **among(name, known)))
        number = finite(value)
        if number is None or number < 0.0:
            what = f"noise of {brief(name)} is {brief(value)}, not a standard deviation"
            problems.append(Problem(what, where, fix="write a number, zero or more, in the column's unit"))
        elif (column := known_column(name)) and impossible(np.array([number]), column.unit).any():
            what = f"noise of {brief(name)} is {brief(value)} {column.unit}"
            why = f"nothing about a ship is beyond {LARGEST[column.unit]:g} {column.unit}"
            problems.append(Problem(what, where, why, "write the sensor's standard deviation, or leave it out"))
    return problems


def _is_text(value: object) -> bool:
    """Whether a value is text that can be written again: JSON can name halves of characters, which cannot."""
    if not isinstance(value, str):
        return False
    try:
        value.encode("utf-8")
    except UnicodeEncodeError:
        return False
    return True
