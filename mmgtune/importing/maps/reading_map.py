"""Reading the map of a log from TOML; every problem of a map is reported at once."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ... import limits, units
from ...errors import LogError, Problem, among, brief, closest, reason
from ...phrases import counted
from ...resources import import_map_names, import_maps, must_be_name
from ...toml_reading import TomlReader, finite, named, toml_of
from ...trial.metadata import antenna_of
from ...trial.schema import COLUMNS, SOURCES, impossible, known_column
from ..cells.degrees import DDMM
from ..cells.headers import PERCENT
from ..cells.position_parts import HEMISPHERES, PARTS
from ..cells.time_parts import PARTS as TIME_PARTS
from ..cells.time_parts import in_order
from .checking_map import check
from .mapping import ASKS, FORMATS, PLACEHOLDERS, PROJECTIONS, TABLES, TIME_FORMATS, Cut, LogMap, Source, TimeSource
from .quantities import QUANTITIES, known_quantity, meaning, quantity_of

SCHEMA = 1
COLUMN_KEYS = (
    "column", "value", "unit", "header_says", "positive", "zero", "direction", "scale", "offset", "late",
    "recover", *PARTS,
)  # fmt: skip
RECOVER = {"x": ("print-resolution",), "y": ("print-resolution",), "psi": ("yaw-rate",)}
"""What a map may have made up for where few digits are printed."""
MOST_COUNT = 1000
"""Lines that may be skipped: they are looked for in the beginning of a log."""
NO_CHARSETS = ("idna", "punycode", "undefined", "unicode_escape", "raw_unicode_escape", "mbcs", "oem")
DELIMITERS = {",": ",", ";": ";", "|": "|", "tab": "\t", "\t": "\t", "space": " ", " ": " "}


def load_map(name: str | Path, preset: bool = False) -> LogMap:
    """Read and validate a map: a TOML file, or a bundled one by name.

    Raises LogError with everything wrong in it.
    """
    must_be_name(name, "map", LogError)
    path = import_maps() / f"{name}.toml" if preset else Path(name)
    if preset and str(name) not in import_map_names():
        raise LogError(Problem(f"no preset is called '{name}'", "--preset", **among(str(name), import_map_names())))
    try:
        text = limits.content(path, limits.MAP_BYTES, LogError).decode("utf-8-sig")
    except (OSError, ValueError) as error:
        fix = f"give a TOML file in UTF-8, or --preset with one of: {', '.join(import_map_names())}"
        raise LogError(Problem("cannot read the map", str(path), reason(error), fix)) from error
    return parse_map(text, path)


def parse_map(text: str, path: Path = Path("map")) -> LogMap:
    """The map written in ``text``; ``path`` is for messages.  Raises LogError with everything wrong in it."""
    data = toml_of(text, "the map", str(path), LogError, log_map=True)
    asked = questions(data, text, path)
    if asked:
        raise LogError(*asked)
    some = data.pop("logs", [])
    reader = _Reader(data, text, path)
    made = reader.read()
    if not isinstance(some, list) or not all(isinstance(one, dict) for one in some):
        reader.problem("'logs' is not a list of tables", "logs", fix='write [[logs]] with name = "*_turn_*"')
        some = []
    limits.MAP_ENTRIES.require(len(some), str(path), LogError)
    parts = []
    for number, table in enumerate(some, start=1):
        part = _part(data, table, number, text, path, reader.problems)
        if part is not None:
            parts.append(part)
    if reader.problems:
        raise LogError(*reader.problems)
    return replace(made, some=tuple(parts))


def questions(data: dict[str, Any], text: str, path: Path) -> list[Problem]:
    """What a map asks for: values that begin with a question mark, as ``trials map`` writes them."""
    reader = TomlReader(data, text, str(path))
    inside: list[tuple[str, Any]] = [("", data)]
    while inside:
        table, value = inside.pop(0)
        for key, one in value.items():
            if isinstance(one, dict):
                inside.append((named(table, key), one))
            elif isinstance(one, str) and one.startswith(ASKS):
                answers, mark, question = one.removeprefix(ASKS).strip().partition(": ")
                what = f"the map asks for '{named(table, key)}': {question if mark else answers}"
                fix = f"write {key} = {answers}" if mark else f"write {key} = ... in its place"
                reader.problem(what[:500], table, key, "the log does not tell it", fix[:200])
    return reader.problems


def _part(
    data: dict[str, Any], table: dict[str, Any], number: int, text: str, path: Path, problems: list[Problem]
) -> tuple[str, LogMap] | None:
    """Pattern and map of the logs that one table of [[logs]] is for; what is wrong goes into ``problems``."""
    where = f"{path}, [[logs]] {number}"
    pattern = table.get("name")
    if not isinstance(pattern, str) or not pattern:
        fix = 'write name = "*_turn_*": * stands for any characters, ? for one'
        problems.append(Problem("'logs.name', a pattern of names of logs, is missing", where, fix=fix))
        return None
    own = {key: value for key, value in table.items() if key != "name"}
    known = tuple(name for name in TABLES if name)
    for key in [key for key, value in own.items() if key not in known or not isinstance(value, dict)]:
        what = f"'logs.{key}' is not a table" if key in known else f"unknown key 'logs.{key}'"
        problems.append(Problem(what, where, **among(key, ("name", *known))))
        del own[key]
    if not own:
        problems.append(Problem("the entry changes nothing", where, fix="say what is different, or remove it"))
        return None
    # Lines are known of what all logs share; what is wrong only here is in this entry.
    reader = _Reader(_merged(data, own), text, path)
    made = reader.read()
    shared = {problem.at(where) for problem in problems}
    problems += [here for problem in reader.problems if (here := problem.at(where)) not in shared]
    return pattern, made


def _merged(data: dict[str, Any], own: dict[str, Any]) -> dict[str, Any]:
    """Tables with some of their entries replaced, key by key."""
    out = dict(data)
    for key, value in own.items():
        before = out.get(key)
        out[key] = _merged(before, value) if isinstance(value, dict) and isinstance(before, dict) else value
    return out


def is_charset(name: str) -> bool:
    """Whether a name is of an encoding that text is written in, and no other kind of codec."""
    import codecs

    # Python has more under such names: compression, escapes, and names of hosts, which take long to decode.
    try:
        found = codecs.lookup(name).name
        return found not in NO_CHARSETS and isinstance("a".encode(found), bytes)
    except (LookupError, ValueError):
        return False


def canonical(unit: object) -> str | None:
    """A unit of a map by the name the program knows it by, a word for none where it is no text; None without."""
    return None if unit is None else units.canonical(unit) if isinstance(unit, str) else "?"


class _Reader(TomlReader):
    """One pass over a parsed map."""

    def __init__(self, data: dict[str, Any], text: str, path: Path):
        super().__init__(data, text, str(path))
        self.path = path
        self.no_tables: set[str] = set()

    def read(self) -> LogMap:
        self.unknown("", self.data, TABLES[""])
        self.schema(SCHEMA)
        log = self.table("log")
        trial = self.table("trial")
        position = self.table("position")
        form = self.choice("log", log, "format", FORMATS)
        sources = self.sources()
        point, stated = self.point()
        sheets, held = self.parts(log, "sheet"), self.parts(log, "variable")
        join = self.flag(log, "join", default=False)
        if join and len(sheets) < 2:
            fix = 'write sheet = ["...", "..."], the sheets that hold a part of the log each'
            self.problem("'log.join' is true, but no sheets are named that could be joined", "log", "join", fix=fix)
        made = LogMap(
            name=self.path.stem,
            path=self.path,
            format=form,
            delimiter=DELIMITERS.get(self.choice("log", log, "delimiter", tuple(DELIMITERS)) or ""),
            encoding=self.encoding(log),
            decimal=self.choice("log", log, "decimal", (".", ",")) or ".",
            thousands=self.thousands(log),
            skip=self.count(log, "skip"),
            header=self.flag(log, "header"),
            fields=self.count(log, "fields") or None,
            missing=self.texts(log, "missing"),
            sheet=next(iter(sheets), ""),
            joined=tuple(sheets) if join else (),
            variable=next(iter(held), ""),
            parts=tuple(one) if len(one := sheets or held) > 1 and not join else (),
            time=self.time(),
            sources=sources,
            axes=self.choice("velocity", self.table("velocity"), "axes", ("ship", "earth")),
            point=point,
            stated=stated,
            shifted=self.choice("velocity", self.table("velocity"), "shifted", ("earth-axes",)),
            antenna=self.antenna(),
            projection=self.choice("position", position, "projection", PROJECTIONS) or PROJECTIONS[0],
            origin=self.origin(position),
            step=self.quantity("resample", "step", "s", least=0.0),
            gap=self.number("resample", self.table("resample"), "gap", 5.0, least=1.0),
            cut=self.cut(),
            ship=self.text_of("trial", trial, "ship"),
            id=self.id(trial),
            manoeuvre=self.text_of("trial", trial, "manoeuvre"),
            group=self.template(trial, "group"),
            source=self.choice("trial", trial, "source", SOURCES) or "measured",
            note=self.text_of("trial", trial, "note"),
            noise=self.noise(trial),
        )
        for name in TABLES:
            if name and name != "columns" and isinstance(self.data.get(name), dict):
                self.unknown(name, self.data[name], TABLES[name])
        check(made, self)
        return made

    # tables and single values

    def table(self, name: str) -> dict[str, Any]:
        table = self.data.get(name, {})
        if not isinstance(table, dict):
            if name not in self.no_tables:  # which is said once, however often it is asked for
                self.no_tables.add(name)
                self.problem(f"'{name}' is not a table", "", name, fix=f"write [{name}]")
            return {}
        return table

    def template(self, trial: dict[str, Any], key: str) -> str:
        """A text in which names in braces stand for something of the log."""
        text = self.text_of("trial", trial, key)
        for name in re.findall(r"\{(\w*)\}", text):
            if name not in PLACEHOLDERS:
                self.problem(f"'trial.{key}' has '{{{name}}}' in it", "trial", key, **among(name, PLACEHOLDERS))
        return text

    def id(self, trial: dict[str, Any]) -> str:
        """Names of trials, before what stands for the log's name is put in."""
        template = self.template(trial, "id") or "{stem}"
        problem = limits.NAME.problem(len(template), "")
        if problem is not None:
            self.problem(problem.what, "trial", "id", problem.why, problem.fix)
        return template

    def thousands(self, log: dict[str, Any]) -> str | None:
        found = self.choice("log", log, "thousands", (".", ",", "none"))
        if found is not None and found == log.get("decimal", "."):
            fix = 'say the other one, or "none"'
            self.problem("'log.thousands' is the decimal sign", "log", "thousands", "one sign cannot be both", fix)
        return found

    def parts(self, table: dict[str, Any], key: str) -> list[str]:
        """Names of sheets or variables: one, or a list of several."""
        value = table.get(key, "")
        if not isinstance(value, list):
            one = self.text_of("log", table, key)
            return [one] if one else []
        if value and all(isinstance(one, str) and one for one in value) and len({*value}) == len(value):
            limits.LOG_RUNS.require(len(value), f"{self.path}, log.{key}", LogError)
            return value
        why = "each is to be a name of its own"
        self.problem(f"'log.{key}' is {brief(value)}", "log", key, why, f'write {key} = ["...", "..."], or one name')
        return []

    def texts(self, table: dict[str, Any], key: str) -> tuple[str, ...]:
        value = table.get(key, [])
        if not isinstance(value, list):
            self.problem(f"'log.{key}' is not a list of texts", "log", key, fix=f'write {key} = ["-999", "n/a"]')
            return ()
        odd = [one for one in value if not isinstance(one, str) and finite(one) is None]
        if odd:
            self.problem(f"'log.{key}' has {brief(odd[0])} in it, no text and no number", "log", key)
            return ()
        return tuple(str(one) for one in value)

    def count(self, table: dict[str, Any], key: str) -> int:
        value = table.get(key, 0)
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= MOST_COUNT:
            self.problem(
                f"'log.{key}' is {brief(value)}, not a whole number up to {MOST_COUNT}",
                "log",
                key,
                fix=f"write {key} = 3",
            )
            return 0
        return value

    def flag(self, table: dict[str, Any], key: str, default: bool = True) -> bool:
        value = table.get(key, default)
        if not isinstance(value, bool):
            self.problem(f"'log.{key}' is {brief(value)}", "log", key, fix=f"write {key} = true or {key} = false")
            return default
        return value

    def number(self, name: str, table: dict[str, Any], key: str, default: float, least: float | None = None) -> float:
        value = table.get(key, default)
        number = finite(value)
        if not number or (least is not None and number < least):
            bound = "" if least is None else f" of at least {least:g}"
            self.problem(f"'{name}.{key}' is {brief(value)}", name, key, fix=f"write a number{bound}, not 0")
            return default
        return number

    def quantity(self, name: str, key: str, unit: str, least: float | None = None) -> float | None:
        table = self.table(name)
        return self.parsed(name, key, table[key], unit, least) if key in table else None

    def parsed(self, name: str, key: str, written: Any, unit: str, least: float | None = None) -> float | None:
        values = self.quantities(name, key, written, unit)
        if values is None:
            return None
        if len(values) > 1:
            self.problem(f"'{name}.{key}' has {len(values)} values, not 1", name, key)
            return None
        value = values[0]
        if not math.isfinite(value) or (least is not None and value <= least):
            self.problem(f"'{name}.{key}' is {written}", name, key, fix=f"it must be above {least or 0:g} {unit}")
            return None
        if impossible(np.array([value]), unit).any():
            self.problem(f"'{name}.{key}' is {brief(written)}, which nothing about a ship is", name, key)
            return None
        return value

    def encoding(self, table: dict[str, Any]) -> str:
        name = table.get("encoding", "utf-8")
        if isinstance(name, str) and is_charset(name):
            return name
        fix = 'such as "utf-8", "cp1252", "utf-16"'
        self.problem(f"unknown encoding {brief(name)}", "log", "encoding", fix=fix)
        return "utf-8"

    # what the tables mean

    def time(self) -> TimeSource:
        table = self.table("time")
        parts: dict[str, str | int] = {}
        if isinstance(table.get("column"), list):
            parts = self.time_parts(table)
            table = {key: value for key, value in table.items() if key in ("scale", "step", "recover")}
        recover = self.choice("time", table, "recover", ("auto", "uniform", "never")) or "auto"
        return TimeSource(
            column=self.column("time", table),
            parts=parts,
            format=self.choice("time", table, "format", TIME_FORMATS),
            unit=self.unit("time", "time", table, "unit", "s"),
            header_says=self.unit("time", "time", table, "header_says", "s"),
            scale=self.number("time", table, "scale", 1.0),
            recover=recover,
            step=self.quantity("time", "step", "s", least=0.0),
        )

    def time_parts(self, table: dict[str, Any]) -> dict[str, str | int]:
        """Columns that hold a part of the time each, by the unit of what they hold."""
        columns, said = table["column"], table.get("unit")
        example = 'column = ["Hour", "Min", "Sec"] and unit = ["h", "min", "s"]'
        for key in ("format", "header_says"):
            if key in table:
                self.problem(f"'time.{key}' has no meaning for time in several columns", "time", key, fix="remove it")
        names = [self.column("time", {"column": one}) for one in columns]
        found = [canonical(one) or "?" for one in said] if isinstance(said, list) else []
        if said is None:
            why = "nothing says what they are the parts of time in"
            self.problem("time has several columns and no units", "time", "column", why, f"write {example}")
        elif len(found) != len(names) or not in_order(found):
            what = f"'time.unit' is {brief(said)}, for {counted(len(names), 'column')} of time"
            why = f"each column has a unit of its own, the longest first: {', '.join(TIME_PARTS)}"
            self.problem(what, "time", "unit", why, f"write {example}")
        else:
            return {unit: name for unit, name in zip(found, names, strict=True) if name is not None}
        return {}

    def column(self, name: str, table: dict[str, Any], key: str = "column") -> str | int | None:
        value = table.get(key)
        if value is None or (isinstance(value, str) and value.strip()):
            return value
        if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= limits.LOG_COLUMNS.most:
            return value
        what = f"'{name}.{key}' is {brief(value)}"
        self.problem(what, name, key, fix="write the column's name, or its number counted from 1")
        return None

    def sources(self) -> dict[str, Source]:
        found = {}
        for name, table in self.table("columns").items():
            where = f"columns.{name}"
            if quantity_of(name) is None:
                fix = "[time] says where time is" if name in ("t", "time") else closest(name, tuple(QUANTITIES))
                self.problem(f"unknown column '{name}'", where, fix=fix)
            elif not isinstance(table, dict):
                fix = f'write [columns.{name}] with column = "..." and unit = "..."'
                self.problem(f"'{where}' is {brief(table)}, not a table", "columns", name, fix=fix)
            else:
                found[name] = self.one(name, where, table)
        return found

    def unit(self, name: str, where: str, table: dict[str, Any], key: str, target: str) -> str | None:
        """A unit of what has another, as the program writes it; None where none is said."""
        found, known = canonical(table.get(key)), dict.fromkeys(units.factors(target))
        if name in HEMISPHERES and key == "unit":
            known[DDMM] = None
        if key == "header_says" and found == PERCENT:
            return found
        if found is None or found in known:
            return found
        of = f"unit of {'time' if name == 'time' else repr(name)}"
        self.problem(f"{of} is {brief(table[key])}", where, key, fix=f"one of: {', '.join(known)}")
        return None

    def one(self, name: str, where: str, table: dict[str, Any]) -> Source:
        quantity = known_quantity(name)
        self.unknown(where, table, COLUMN_KEYS)
        for key, can in (("positive", quantity.positive), ("zero", quantity.origin), ("direction", quantity.points)):
            if key in table and not can:
                self.problem(f"'{where}.{key}' has no meaning for {meaning(name)}", where, key, fix="remove it")
        value = self.parsed(where, "value", table["value"], quantity.unit) if "value" in table else None
        if "value" in table and set(table) & {*COLUMN_KEYS} - {"value", "direction"}:
            fix = "a constant is its value with a unit, in the trial format's conventions; nothing else"
            self.problem(f"'{where}' has a value and keys of a column", where, "value", fix=fix)
        offset = self.parsed(where, "offset", table["offset"], quantity.unit) if "offset" in table else 0.0
        if "recover" in table and name not in RECOVER:
            what = f"'{where}.recover' is for positions x and y and for the heading"
            self.problem(what, where, "recover", fix="remove it")
        parts = {key: self.column(where, table, key) for key in PARTS if key in table}
        self.require_parts(name, where, table)
        direction = self.choice(where, table, "direction", ("from", "to")) if quantity.points else None
        if quantity.points and "direction" not in table and "value" not in table and "column" in table:
            self.problem(
                f"is '{name}' the direction it comes from or goes to?",
                where,
                why="both are in use",
                fix='say direction = "from" or direction = "to"',
            )
        return Source(
            column=self.column(where, table),
            value=value,
            unit=self.unit(name, where, table, "unit", quantity.unit),
            header_says=self.unit(name, where, table, "header_says", quantity.unit),
            positive=self.choice(where, table, "positive", quantity.positive) if quantity.positive else None,
            zero=(self.choice(where, table, "zero", ("north", "east")) if quantity.origin else None) or "north",
            direction=direction,
            scale=self.number(where, table, "scale", 1.0),
            offset=offset or 0.0,
            late=(self.parsed(where, "late", table["late"], "s") if "late" in table else None) or 0.0,
            recover=self.choice(where, table, "recover", RECOVER[name]) if name in RECOVER else None,
            parts={key: column for key, column in parts.items() if column is not None},
            line=self.line(where),
        )

    def require_parts(self, name: str, where: str, table: dict[str, Any]) -> None:
        """Note what is wrong about columns of minutes, seconds and hemisphere."""
        given = [key for key in PARTS if key in table]
        if given and name not in HEMISPHERES:
            what = f"'{where}.{given[0]}' is for latitude and longitude"
            self.problem(what, where, given[0], fix="remove it")
        elif given and "column" not in table and "value" not in table:
            fix = 'write column = "..." for the degrees'
            self.problem(f"'{where}.{given[0]}' is given without the degrees", where, given[0], fix=fix)
        elif given and canonical(table.get("unit")) in ("rad", *([] if given == ["hemisphere"] else [DDMM])):
            fix = "remove it: the column holds degrees"
            self.problem(f"'{where}.unit' is {brief(table['unit'])}, beside '{given[0]}'", where, "unit", fix=fix)
        if "seconds" in given and "minutes" not in given:
            fix = 'write minutes = "..." too'
            self.problem(f"'{where}.seconds' is given without minutes", where, "seconds", fix=fix)
        if "hemisphere" in given and "positive" in table:
            fix = "remove one of them"
            self.problem(f"'{where}' has both 'hemisphere' and 'positive'", where, "positive", "both say the sign", fix)

    def antenna(self) -> tuple[float, float] | None:
        if "antenna" not in self.data:
            return None
        place = self.place("antenna", self.table("antenna"))
        if place is None or antenna_of({"antenna": place}) is not None:
            return place
        fix = "give forward and to starboard of midship, with the unit they are in"
        what = f"the antenna is {max(map(abs, place)):.4g} m from midship"
        self.problem(what, "antenna", why="no ship is as long", fix=fix)
        return None

    def point(self) -> tuple[str | None, tuple[float, float] | None]:
        table = self.table("velocity")
        if not isinstance(table.get("point"), dict):
            return self.choice("velocity", table, "point", ("midship", "antenna")), None
        self.unknown("velocity.point", table["point"], ("x", "y"))
        return "stated", self.place("velocity.point", table["point"])

    def place(self, name: str, table: dict[str, Any]) -> tuple[float, float] | None:
        """A point of the ship from midship, forward and to starboard [m]."""
        ends = [self.parsed(name, key, table[key], "m") if key in table else None for key in ("x", "y")]
        for key in ("x", "y"):
            if key not in table:
                self.problem(f"'{name}.{key}' is missing", name, fix='write x = "12 m" (forward), y = "0 m"')
        return None if ends[0] is None or ends[1] is None else (ends[0], ends[1])

    def origin(self, table: dict[str, Any]) -> tuple[float, float] | None:
        value = table.get("origin")
        if value is None:
            return None
        pair = [finite(one) for one in value] if isinstance(value, list) else []
        latitude, longitude = pair if len(pair) == 2 else (None, None)
        if latitude is None or longitude is None or abs(latitude) > 90.0 or abs(longitude) > 360.0:
            fix = "write origin = [latitude, longitude] in degrees"
            self.problem(f"'position.origin' is {brief(value)}", "position", "origin", fix=fix)
            return None
        return latitude, longitude

    def cut(self) -> Cut:
        table = self.table("cut")
        begin = self.choice("cut", table, "from", ("first-rudder-order", "first-order"))
        start, end = self.quantity("cut", "start", "s"), self.quantity("cut", "end", "s")
        if end == 0.0:
            fix = 'write end = "600 s", or end = "-20 s" to drop the last 20 s'
            self.problem("'cut.end' is 0", "cut", "end", "nothing would be left", fix)
        if start is not None and end is not None and start >= end > 0.0:
            self.problem("'cut.start' is not before 'cut.end'", "cut", "start")
        if "lead" in table and begin is None:
            self.problem("'cut.lead' is given without 'cut.from'", "cut", "lead", fix='add from = "first-rudder-order"')
        return Cut(
            start=start,
            end=end,
            begin=begin,
            lead=self.quantity("cut", "lead", "s") or 0.0,
            to=self.choice("cut", table, "to", ("last-order",)),
            split=self.choice("cut", table, "split", ("pull-out",)),
        )

    def noise(self, trial: dict[str, Any]) -> dict[str, float]:
        noise = trial.get("noise", {})
        if not isinstance(noise, dict):
            self.problem("'trial.noise' is not a table", "trial", "noise", fix='write noise = { x = "0.5 m" }')
            return {}
        found = {}
        for name, written in noise.items():
            column = known_column(name)
            if column is None:
                self.problem(f"noise of unknown column '{name}'", "trial", "noise", **among(name, tuple(COLUMNS)))
                continue
            value = self.parsed("trial", f"noise.{name}", written, column.unit, least=0.0)
            if value is not None:
                found[name] = value
        return found
