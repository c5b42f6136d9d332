"""Reading TOML that people write: everything wrong in a file is said at once, each with its line."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from typing import Any

from . import units
from .errors import MmgtuneError, Problem, among, brief
from .limits import NESTING


def toml_of(
    text: str, what: str, where: str, error: type[MmgtuneError], *, profile: bool = False, log_map: bool = False
) -> dict[str, Any]:
    """The tables written in ``text``; a byte-order mark in front is passed over.

    profile, log_map  whether it may be a ship profile, or the map of a log
    Raises ``error`` where ``what``, such as "the split", is not TOML, or is one of these where it may not be.
    """
    try:
        found = tomllib.loads(text.removeprefix("\ufeff"))
    except tomllib.TOMLDecodeError as why:
        raise error(Problem(f"{what} is not valid TOML", where, _in_words(why), "correct the line named")) from why
    except RecursionError as why:
        raise error(Problem(f"{what} is nested too deeply", where, fix=NESTING.fix)) from why
    except ValueError as why:  # a number of thousands of digits
        raise error(Problem(f"{what} has a number that cannot be read", where, str(why), "write it shorter")) from why
    NESTING.require(depth(found), where, error)
    if not profile and {"ship", "hull"} <= found.keys():
        there = f"it has [ship] and [hull], and {what} is wanted here"
        fix = f"give {what}, and the profile where a ship is wanted"
        raise error(Problem("this is a ship profile", where, there, fix))
    if not log_map and is_map(found) and not {"ship", "hull"} & found.keys():
        there = f"it says what the columns of a log are, and {what} is wanted here"
        raise error(
            Problem("this is the map of a log", where, there, f"give {what}, and the map where logs are imported")
        )
    return found


def is_map(data: Mapping[str, Any]) -> bool:
    """Whether parsed TOML is a map that makes trials of logs."""
    return "columns" in data or "log" in data


def _in_words(error: tomllib.TOMLDecodeError) -> str:
    """What is wrong with the TOML; of what is there twice what that is."""
    said = str(error)
    said = re.sub(r"^Cannot overwrite a value", "a name or a table is there twice", said)
    twice = re.match(r"Cannot declare \((.*?),?\) twice(.*)", said)
    if twice is None:
        return said
    return f"the table [{'.'.join(name.strip(chr(39)) for name in twice[1].split(', '))}] is there twice{twice[2]}"


def depth(value: object) -> int:
    """How many tables and lists lie in each other."""
    levels, inside = 0, [value]
    while inside := [one for one in inside if isinstance(one, (dict, list))]:
        levels += 1
        inside = [two for one in inside for two in (one.values() if isinstance(one, dict) else one)]
    return levels


def finite(value: object) -> float | None:
    """A number as a file gives it; None for a truth value, anything else, and what no float can hold."""
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def line_index(text: str) -> dict[tuple[str, str], int]:
    """Line numbers of tables, under (table, ""), and of keys, under (table, key)."""
    index: dict[tuple[str, str], int] = {}
    table = ""
    for number, line in enumerate(text.splitlines(), start=1):
        if header := re.match(r"\s*\[([\w.-]+)\]", line):
            table = header.group(1)
            index.setdefault((table, ""), number)
        elif key := re.match(r"\s*([\w.-]+)\s*=", line):
            index.setdefault((table, key.group(1)), number)
            # An inline table is a table of its own name too: [columns] x = { ... }.
            index.setdefault((named(table, key.group(1)), ""), number)
    return index


def named(table: str, key: str) -> str:
    """A key with its table, as messages name it."""
    return f"{table}.{key}" if table else key


class TomlReader:
    """One pass over parsed TOML, collecting problems as it goes; what is wrong reads as if it were not there.

    where  the file, for messages
    """

    def __init__(self, data: dict[str, Any], text: str, where: str):
        self.data, self.text, self.where = data, text, where
        self.lines = line_index(text)
        self.problems: list[Problem] = []

    def line(self, table: str, key: str = "") -> int:
        """Line of a key, of its table where the key has none, 0 where neither is there."""
        return self.lines.get((table, key)) or self.lines.get((table, "")) or 0

    def problem(self, what: str, table: str = "", key: str = "", why: str = "", fix: str = "") -> None:
        """Note something wrong, where table and key stand."""
        line = self.line(table, key)
        self.problems.append(Problem(what, f"{self.where}, line {line}" if line else self.where, why, fix))

    def schema(self, number: int) -> None:
        """The version of the format, which must be ``number``."""
        found = self.data.get("schema")
        if type(found) is not int or found != number:  # true equals 1 too
            what = f"schema is {brief(found)}, not {number}"
            self.problem(what, "", "schema", fix=f"write 'schema = {number}' on top")

    def unknown(self, name: str, table: dict[str, Any], known: tuple[str, ...]) -> None:
        """Note keys of a table that are not among those known."""
        for key in table:
            if key not in known:
                self.problem(f"unknown key '{named(name, key)}'", name, key, **among(key, known))

    def text_of(self, name: str, table: dict[str, Any], key: str) -> str:
        """A text, "" where there is none."""
        value = table.get(key, "")
        if isinstance(value, str):
            return value
        self.problem(f"'{named(name, key)}' is {brief(value)}, not text", name, key, fix=f'write {key} = "..."')
        return ""

    def choice(self, name: str, table: dict[str, Any], key: str, allowed: tuple[str, ...]) -> str | None:
        """One of the words allowed, None where there is none."""
        if key not in table:
            return None
        if isinstance(table[key], str) and table[key] in allowed:
            return str(table[key])
        words = ", ".join(repr(one) for one in dict.fromkeys(allowed))
        self.problem(f"'{named(name, key)}' is {brief(table[key])}", name, key, fix=f"one of: {words}")
        return None

    def quantities(
        self,
        name: str,
        key: str,
        written: Any,
        unit: str,
        infinite: bool = False,
        low: float | None = None,
        high: float | None = None,
    ) -> tuple[float, ...] | None:
        """The numbers of text with a unit in ``unit``, or of a bare number where it is dimensionless; else None.

        low, high  limits (exclusive) that the number has: an example lies between them
        """
        shown = named(name, key)
        if isinstance(written, str):
            try:
                return units.parse(written, unit, infinite=infinite)
            except units.Unreadable as error:
                self.problem(f"'{shown}': {error}", name, key, fix=error.fix)
        elif not isinstance(written, (int, float)) or isinstance(written, bool):
            fix = f"write {key} = {units.example_in_toml(unit, low, high)}"
            self.problem(f"'{shown}' is {brief(written)}, not a number", name, key, fix=fix)
        elif not infinite and isinstance(written, float) and not math.isfinite(written):
            with_unit = "" if unit in units.DIMENSIONLESS else "a number with its unit: "
            fix = f"write {with_unit}{key} = {units.example_in_toml(unit, low, high)}"
            self.problem(f"'{shown}' is {written}", name, key, "only finite numbers can be simulated", fix)
        elif unit not in units.DIMENSIONLESS:
            such = units.likely(float(written), unit, low, high) if finite(written) is not None else unit
            why = "a number does not say what it is in"
            fix = f'write {key} = "{brief(written)} {such}" if it is in {such}'
            self.problem(f"'{shown}' = {brief(written)} has no unit", name, key, why, fix)
        elif isinstance(written, int) and finite(written) is None:
            self.problem(f"'{shown}' is {brief(written)}, more than a number can be", name, key, fix="write it shorter")
        else:
            return (float(written),)
        return None
