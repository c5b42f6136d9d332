"""Maps of logs: wrong types everywhere, odd numbers, deep nesting, and bytes that are no TOML."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np

from mmgtune.importing.maps.mapping import TABLES
from mmgtune.importing.maps.quantities import QUANTITIES
from mmgtune.importing.maps.reading_map import COLUMN_KEYS
from tests.importing.made import MAP

from ..mutating import encoded, line_doubled, line_emptied, line_removed, mutated_bytes, pick, several
from . import Files, Kind, csv_logs
from .metadata import odd_toml

WORDS = (
    '"hex"', '"rot13"', '"idna"', '"punycode"', '"undefined"', '"unicode_escape"', '"utf-16"', '"zlib"', '"mbcs"',
    '"utf-7"', '"1e-9 s"', '"1e300 s"', '"1e-300 s"', '"100 s"', '"-1 s"', '"nmea"', '"parquet"', '"csv"', '"ship"',
    '"earth"', '"antenna"', '"first-rudder-order"', '"last-order"', '"pull-out"', '"print-resolution"', '"yaw-rate"',
    '"uniform"', '"clock"', '"iso"', '"number"', '"port"', '"{stem}"', '"../x"', '"1 m"', '"east"', "false", "0", "1",
    "2", '"xlsx"', '"mat"', '"dmy"', '"date"', '"first-order"', '"?"', '"? a or b: which?"', '"d"',
)  # fmt: skip


STEPS = ('"1e-9 s"', '"1e-300 s"', '"0.01 s"', '"0.1 s"', '"3 s"', '"1e9 s"', '"1e300 s"')
LONGITUDE = '\n[columns.longitude]\ncolumn = "ahead"\nminutes = "heading"\nseconds = "rudder"'
FITTING = (
    ("resample", "step", STEPS),
    ("resample", "gap", ("1.0", "2.5", "1e9", "1e300")),
    ("time", "step", STEPS),
    ("time", "scale", ("1e9", "1e-9", "1e300", "1e-300", "-1.0", "60")),
    ("time", "recover", ('"uniform"', '"never"', '"auto"')),
    ("time", "format", ('"iso"', '"clock"', '"number"', '"date"', '"mdy"', '"ymd"')),
    ("cut", "start", ('"10 s"', '"1e9 s"', '"-5 s"')),
    ("cut", "end", ('"100 s"', '"-20 s"', '"-1e9 s"', '"1e300 s"')),
    ("cut", "from", ('"first-rudder-order"', '"first-order"')),
    ("cut", "to", ('"last-order"',)),
    ("cut", "split", ('"pull-out"',)),
    ("velocity", "shifted", ('"earth-axes"',)),
    ("velocity", "point", ('{ x = "3 m", y = "0 m" }', '{ x = "1e300 m", y = "-1e300 m" }')),
    ("antenna", 'x = "3 m"\ny', ('"0 m"', '"1e300 m"', '"1e9 m"')),
    ("log", "missing", ('["-999", "n/a"]', '["0"]', '[""]')),
    ("log", "delimiter", ('","', '";"', '"space"', '"tab"')),
    ("log", "decimal", ('","',)),
    ("log", "thousands", ('"."', '","', '"none"')),
    ("time", 'column = ["rudder", "heading", "time"]\nunit', ('["h", "min", "s"]', '["d", "h", "us"]', '["min"]')),
    ("time", 'column = ["heading", 1]\nunit', ('["min", "s"]', '["h", "ms"]', '["s", "s"]', '"s"')),
    ("log", "skip", ("0", "1", "50")),
    ("log", "header", ("false", "true")),
    ("log", "encoding", ('"utf-16"', '"cp1252"', '"utf-8-sig"', '"cp037"', '"utf-7"', '"iso2022_jp"')),
    ("trial", "id", ('"{stem}-{parent}"', '"../../x"', '"."', '"{x}"')),
    ("trial", "group", ('"{parent}"', '""', '"day\\n3"', "3")),
    ("trial", "noise", ('{ x = "0.5 m" }', '{ u = "1e300 m/s" }')),
    ("columns.x", 'column = "north"\nunit = "m"\nrecover', ('"print-resolution"',)),
    ("columns.psi", 'column = "heading"\nunit = "deg"\nrecover', ('"yaw-rate"',)),
    ("columns.delta", 'column = "rudder"\nunit = "deg"\nscale', ("1.0", "1e-9", "-1", "1e300")),
    ("columns.delta", 'column = "rudder"\nunit = "deg"\nlate', ('"1.5 s"', '"-40 s"', '"1e9 s"', '"inf s"', "5")),
    ("columns.latitude", 'column = "rudder"\nminutes', (f'"ahead"{LONGITUDE}', f'"heading"{LONGITUDE}', '"north"')),
    ("columns.latitude", 'column = "ahead"\nhemisphere', (f'"rudder"{LONGITUDE}', f"3{LONGITUDE}")),
    ("columns.latitude", 'column = "ahead"\nunit', (f'"ddmm"{LONGITUDE}', f'"ddmm"\nhemisphere = "rudder"{LONGITUDE}')),
    ("columns.latitude", "column", ('"ahead"\n[columns.longitude]\ncolumn = "ahead"',)),
    ("columns.n", "value", ('"100 rpm"', '"0 rpm"', '"-1e300 rpm"')),
)
"""Table, key and values that a map may have."""


@functools.cache
def lines() -> tuple[str, ...]:
    """A good map with a table of each name."""
    more = [f"[{name}]" for name in TABLES if name and f"[{name}]" not in MAP and name != "antenna"]
    return (*MAP.strip().splitlines(), *more)


def _value(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """A value somewhere replaced."""
    at = [k for k, line in enumerate(lines) if "=" in line]
    if not at:
        return lines
    k = pick(rng, at)
    return [*lines[:k], f"{lines[k].split('=')[0]}= {_any(rng)}", *lines[k + 1 :]]


def _key(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """A key that maps have, with any value, in its table."""
    name = pick(rng, list(TABLES))
    added = f"{pick(rng, [*TABLES[name], 'odd'])} = {_any(rng)}"
    if name and f"[{name}]" in lines:
        at = lines.index(f"[{name}]") + 1
        return [*lines[:at], added, *lines[at:]]
    return [added, *lines] if not name else [*lines, f"[{name}]", added]


def _fitting(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """A key with a value that it may have, however unwise."""
    name, key, values = pick(rng, FITTING)
    added = f"{key} = {pick(rng, values)}"
    replaced = ("x", "y") if name == "columns.latitude" else (name.removeprefix("columns."),)
    lines = [line for line in lines if not line.startswith(tuple(f"{one} = {{" for one in replaced))]
    at = lines.index(f"[{name}]") + 1 if f"[{name}]" in lines else len(lines)
    if name == "time" and key.startswith("column"):
        lines = [line for k, line in enumerate(lines) if not (at <= k < at + 2)]
    return [*lines[:at], added, *lines[at:]] if at < len(lines) else [*lines, f"[{name}]", added]


def _column(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """A key in a column's table, or another column."""
    rows = [k for k, line in enumerate(lines) if line.endswith("}")]
    if rows and rng.random() < 0.7:
        k = pick(rng, rows)
        return [*lines[:k], f"{lines[k][:-1]}, {pick(rng, COLUMN_KEYS)} = {_any(rng)} }}", *lines[k + 1 :]]
    column = pick(rng, ('"time"', '"ahead"', "99", "1", _any(rng)))
    added = f"[columns.{pick(rng, list(QUANTITIES))}]\ncolumn = {column}"
    return [*lines, added]


def _entry(rng: np.random.Generator, lines: list[str]) -> list[str]:
    """An entry for some of the logs."""
    name = pick(rng, list(TABLES)[1:])
    keys = TABLES.get(name) or ("x",)
    pattern = pick(rng, ('"*"', '"["', _any(rng)))
    return [*lines, "[[logs]]", f"name = {pattern}", f"{name}.{pick(rng, keys)} = {_any(rng)}"]


def _any(rng: np.random.Generator) -> str:
    return pick(rng, WORDS) if rng.random() < 0.5 else odd_toml(rng)


def make(rng: np.random.Generator) -> Files:
    """A good log with a map that is not."""
    written = list(lines())
    if rng.random() < 0.5:
        written = several(rng, written, [_fitting])
    else:
        changes = [_value, _value, _key, _key, _column, _entry, line_removed, line_doubled, line_emptied]
        written = several(rng, written, changes)
    content = encoded("\n".join(written))
    if rng.random() < 0.15:
        content = mutated_bytes(rng, content)
    if rng.random() < 0.05:
        content = b"\xef\xbb\xbf" + content
    return {"log.csv": csv_logs.whole().encode(), "map.toml": content}


def run(folder: Path) -> str:
    """Import the log by it."""
    return csv_logs.imports(folder, "log.csv")


KIND = Kind("maps", make, run)
