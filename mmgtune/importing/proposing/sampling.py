"""The beginning of a log without a map: how it is written, and its columns as numbers."""

from __future__ import annotations

import contextlib
import io
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ... import units
from ...arrays import FloatArray
from ...errors import LogError, Problem, reason
from ...limits import LOG_BYTES, LOG_COLUMNS, LOG_LINE
from ...phrases import counted, listed
from ..cells.degrees import degrees
from ..cells.headers import bare, find_column
from ..cells.numerals import holds_numbers, numbers_in
from ..cells.position_parts import HEMISPHERES
from ..cells.stopwatch import EITHER, TIME_OF_DAY, are_times, times_told
from ..cells.thousands import CLOSED, in_thousands
from ..cells.with_units import is_with_unit, numbers_with_unit
from ..formats.forms import form_of, refuse_binary
from ..formats.parquet_log import batches, being_read, schema_of
from ..formats.sides import midships, sided, takes_side
from ..formats.table import MISSING
from ..formats.text import PEEK, Lines, fields_of, start_of
from ..formats.workbook import Outline
from ..maps.mapping import LogMap, TimeSource
from .words import DATE, TIME, known_unit, quantity_named

ROWS = 60_000
"""Rows of a log that are looked at."""
RUNS = 8
"""Runs in one log that are looked at."""
HEADING = 400
"""Rows among which the names of the columns are looked for."""
MOST_SIGNALS = 500
"""Names of signals that a column may hold."""
NO_ANGLES = {one for kind in ("m", "s", "m/s", "1/s") for one in units.factors(kind)}
"""Units behind numbers that may look like minutes and sides of an angle."""
_PATH = re.compile(r"[./_:]")
"""What divides the name of a signal."""
FEWEST = 10
"""Rows from which a sheet may be a part of a log."""
_HEAD = ("skip", "header", "fields")
"""Keys of [log] that say where the names of the columns are."""
HEAD, ALMOST = 20, 0.95
"""Lines that names may stand in, and share of lines with as many fields from which a mark divides them."""
MARKS = ("\t", ";", ",", "|", " ")
SHOWN = {"\t": "tab", " ": "space"}
_JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")
_NUMBER = re.compile(rf"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|{CLOSED}(\.\d*)?|-?inf", re.ASCII)
_COMMA = re.compile(rf"([-+]?(\d+|\d{{1,3}}(\.\d{{3}})+)|{CLOSED}),\d+([eE][-+]?\d+)?", re.ASCII)
_DATED = re.compile(r"(\d{1,4}[-./:]\d{1,2}[-./:]\d{1,4}|\d{1,3}:\d{2}|[-+]?\d{1,3}°)[^;|\t,]*(,[^;|\t,]*)?")


@dataclass(frozen=True, eq=False)
class Sample:
    """What a log holds.

    layout   keys of [log] in the map, as TOML has them
    names    of the columns; "" where one has none, all "" where the log has no header
    units    as a second line of the header says them, "" where it does not
    texts    columns as pandas has them, (n_rows,)
    numbers  (n_rows,) of every column, NaN where a cell is no number
    written  columns whose cells are positions in degrees and minutes
    sided    columns whose cells say the side, such as 35.0S; starboard is positive
    part     sheet or variable that is looked at, of several
    groups   what stands above several names in a row of its own, such as "Steering gear" above "Order" and "Actual"; ()
             where no row does
    second   columns that are the second half of another one, whose cells hold a latitude and a longitude each
    """

    path: Path
    layout: dict[str, Any]
    names: tuple[str, ...]
    units: tuple[str, ...]
    texts: list[Any]
    numbers: list[FloatArray]
    written: frozenset[int] = frozenset()
    sided: frozenset[int] = frozenset()
    second: Mapping[int, int] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    part: str = ""
    groups: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """Where it is from, for messages."""
        return f"{self.path}, '{self.part}'" if self.part else str(self.path)

    def turned_round(self) -> Sample:
        """The sample with its rows in the other order."""
        texts = [one[::-1].reset_index(drop=True) for one in self.texts]
        return replace(self, texts=texts, numbers=[one[::-1] for one in self.numbers])

    def in_order(self, other: Sample) -> Sample:
        """The sample with its columns in the order of another one; as it is where names do not tell them all."""
        names = [one.strip() for one in other.names]
        own = [one.strip() for one in self.names]
        if sorted(own) != sorted(names) or any(isinstance(other.reference(k), int) for k in range(len(names))):
            return self
        return self.only(names)

    def divided(self, k: int, halves: Sequence[FloatArray]) -> Sample:
        """The sample with a column whose cells hold two numbers (n_rows,) as two columns, the second behind all."""
        last = len(self.names)
        numbers = [halves[0] if i == k else one for i, one in enumerate(self.numbers)]
        return replace(
            self,
            names=(*self.names, ""),
            units=(*self.units, ""),
            texts=[*self.texts, self.texts[k]],
            numbers=[*numbers, halves[1]],
            written=self.written | {k, last},
            second={**self.second, last: k},
            groups=(*self.groups, "") if self.groups else (),
        )

    def only(self, names: Sequence[str]) -> Sample:
        """The sample with columns of these names alone, in their order."""
        own = [one.strip() for one in self.names]
        moved = [own.index(name) for name in names]
        return replace(
            self,
            names=tuple(self.names[k] for k in moved),
            units=tuple(self.units[k] for k in moved),
            texts=[self.texts[k] for k in moved],
            numbers=[self.numbers[k] for k in moved],
            written=frozenset(to for to, k in enumerate(moved) if k in self.written),
            sided=frozenset(to for to, k in enumerate(moved) if k in self.sided),
            groups=tuple(self.groups[k] for k in moved) if self.groups else (),
        )

    def called(self, k: int, name: str, unit: str, factor: float = 1.0) -> Sample:
        """The sample with another name and unit of a column, its numbers times a factor."""
        if (name, unit, factor) == (self.names[k], self.units[k], 1.0):
            return self
        return replace(
            self,
            names=tuple(name if i == k else one for i, one in enumerate(self.names)),
            units=tuple(unit if i == k else one for i, one in enumerate(self.units)),
            numbers=[one * factor if i == k and factor != 1.0 else one for i, one in enumerate(self.numbers)],
        )

    def reference(self, k: int) -> str | int:
        """How a map names a column: by its name where that is its own, else by its number."""
        k = self.second.get(k, k)
        name = self.names[k].strip()
        if not name or len(name) > 200 or not name.isprintable() or self.layout.get("header") is False:
            return k + 1
        return name if find_column(name, self.names) == k else k + 1

    def shown(self, k: int) -> str:
        """A column for people, by its number where it has no name or shares it."""
        k = self.second.get(k, k)
        name = self.names[k].strip()
        alone = name and sum(one.strip() == name for one in self.names) == 1
        return f"'{name[:60]}'" if alone else f"column {k + 1}"


def sample_of(path: Path) -> Sample:
    """The beginning of a log of any kind but NMEA 0183, of several runs in it the first.

    Raises LogError where it cannot be read.
    """
    return samples_of(path)[0]


def samples_of(path: Path) -> list[Sample]:
    """The beginnings of the runs in a log: of sheets with the same columns, and of structures or matrices.

    Their layout is that of all of them.  Raises LogError where the log cannot be read.
    """
    form = form_of(path)
    if form == "nmea":
        raise LogError(Problem("the log is NMEA 0183, whose sentences say what they hold", str(path)))
    if form in ("xlsx", "mat"):
        samples = (_of_workbook if form == "xlsx" else _of_matlab)(path)
    else:
        samples = [(_of_text if form == "csv" else _of_parquet)(path)]
    for sample in samples:
        if len(sample.names) < 2 or not any(np.isfinite(one).sum() > 1 for one in sample.numbers):
            raise _no_table(path, len(sample.names), "none with numbers")
        _require_wide(sample)
    return samples


def _require_wide(sample: Sample) -> None:
    """Raise LogError for a log that has a row for each value, and a column that says of what it is."""
    for k, texts in enumerate(sample.texts):
        if holds_numbers(texts) or _holds_dates(texts) or np.isfinite(sample.numbers[k]).any():
            continue
        several = texts.dropna().unique()[: MOST_SIGNALS + 1].tolist()
        known = [one for one in several if quantity_named(_PATH.sub(" ", one))]
        if len(known) < 2 or len(several) > MOST_SIGNALS or texts.count() < 5 * len(several):
            continue
        what = f"the log has a row for each value: {sample.shown(k)} says of what it is"
        shown = listed([f"'{one[:40]}'" for one in several], 4)
        fix = "write a row for each time and a column for each of them, such as by pivot_table of pandas"
        raise LogError(Problem(what, str(sample.path), f"such as {shown}", fix))


def _no_table(path: Path, seen: int, but: str) -> LogError:
    """What is said of a log without rows of numbers, of which some columns were seen."""
    why = (
        f"{counted(seen, 'column')} {'was' if seen == 1 else 'were'} seen, {but}" if seen else "there are no rows in it"
    )
    fix = "give a table with a row for each time and a column for each quantity"
    return LogError(Problem("the log is no table of numbers", str(path), why, fix))


def _made(path: Path, layout: dict[str, Any], names: Sequence[str], below: Sequence[str], texts: list[Any]) -> Sample:
    """A sample of columns as they are printed."""
    LOG_COLUMNS.require(len(names), str(path), LogError)
    if texts and len(texts[0]) < 2:  # be they thousands, which take long to look at
        raise _no_table(path, len(names), "with less than two rows")
    texts = [one if holds_numbers(one) or _holds_dates(one) else one.astype("string").str.strip() for one in texts]
    # A table whose cells are texts, exported from somewhere, may have decimal commas in them.
    if layout["format"] != "csv" and any(_has_commas(one) for one in texts):
        layout["decimal"] = ","
    decimal = layout.get("decimal", ".")
    if (decimal == "," or not any(_has_points(one) for one in texts)) and any(_divides(one, ",") for one in texts):
        layout["decimal"], layout["thousands"] = (decimal := ","), "."
    said = list(below)
    numbers, written, with_side = [], set(), set()
    for k, text in enumerate(texts):
        if holds_numbers(text):
            found = text.to_numpy(dtype=np.float64, na_value=np.nan)
        elif _holds_dates(text):
            found = np.full(len(text), np.nan)
        else:
            found = numbers_in(text, decimal, layout.get("thousands"))
            clock = are_times(text)
            plain = float(np.isfinite(found).mean()) if len(text) else 1.0
            named = takes_side(quantity_named(names[k]))
            if named and not clock:
                found = np.where(midships(text), 0.0, found)
            if plain < (1.0 if named else 0.5) and not clock:
                with_unit, unit = numbers_with_unit(text.where(~text.str.lower().isin(MISSING)), decimal)
                angles, sides = degrees(text), sided(text, decimal)
                told = [float(np.isfinite(one).mean()) for one in (angles, sides)]
                if unit in NO_ANGLES and quantity_named(names[k]) not in HEMISPHERES:
                    told[0] = 0.0  # 12.5 m has no minutes, and 12.5 s is not south
                # S alone is south to one column and starboard to another: its name tells.
                if told[1] > max(0.5, plain) and (told[1] > told[0] or named):
                    found = sides
                    with_side.add(k)
                elif told[0] > 0.5 > plain:
                    found = angles
                    written.add(k)
                elif unit:
                    found, said[k] = with_unit, unit
        with np.errstate(over="ignore"):
            numbers.append(np.where(np.abs(found) < 1e14, found, np.nan))
    return Sample(path, layout, tuple(names), tuple(said), texts, numbers, frozenset(written), frozenset(with_side))


def _holds_dates(column: Any) -> bool:
    import pandas as pd

    return bool(pd.api.types.is_datetime64_any_dtype(column.dtype))


def _divides(column: Any, decimal: str) -> bool:
    """Whether points divide the thousands of a column, where the decimal sign is a comma."""
    return not holds_numbers(column) and not _holds_dates(column) and in_thousands(column, decimal) is True


def _has_points(column: Any) -> bool:
    """Whether a column holds numbers with decimal points that divide no thousands."""
    if holds_numbers(column) or _holds_dates(column):
        return False
    pointed = column.str.fullmatch(r"[-+]?\d*\.\d+").fillna(False)
    return bool(pointed.mean() > 0.2) and in_thousands(column, ",") is False


def _has_commas(column: Any) -> bool:
    """Whether a column holds numbers with a decimal comma, as texts."""
    if holds_numbers(column) or _holds_dates(column) or not len(column):
        return False
    return bool(column.str.fullmatch(_COMMA.pattern).fillna(False).mean() > 0.2)


def _of_text(path: Path) -> Sample:
    import pandas as pd

    LOG_BYTES.require(path.stat().st_size, str(path), LogError)
    content = start_of(path)
    encoding = _encoding(content)
    refuse_binary(path, content, LogMap("", Path(), encoding=encoding))
    text = content.decode(encoding, "replace").lstrip("\ufeff")
    lines = re.split(r"\r\n|\n|\r", text)
    if len(content) == PEEK:
        lines.pop()
    LOG_LINE.require(max((len(line) for line in lines), default=0) + 1, str(path), LogError)
    whole = lines[:400]
    mark, decimal = _separator(whole)
    rows = [fields_of(line, mark) for line in whole]
    first, header, unit_row, width = heading(rows)
    layout: dict[str, Any] = {"format": "csv", "delimiter": SHOWN.get(mark, mark)}
    if encoding != "utf-8":
        layout["encoding"] = encoding
    if decimal != ".":
        layout["decimal"] = decimal
    names, below = _named(layout, rows, first, header, unit_row, width)
    with warnings.catch_warnings(), io.BufferedReader(Lines(path), 1 << 16) as file:
        warnings.simplefilter("ignore")
        try:
            frame = pd.read_csv(
                io.BytesIO(text.encode("utf-8", "replace")) if len(content) < PEEK else file,
                header=None,
                names=range(max(width, len(names))),
                index_col=False,
                skiprows=first,
                sep=r"\s+" if mark == " " else mark,
                encoding="utf-8" if len(content) < PEEK else encoding,
                encoding_errors="replace",
                dtype="string",
                keep_default_na=False,
                na_values=[""],
                skip_blank_lines=True,
                skipinitialspace=True,
                on_bad_lines="skip",
                nrows=ROWS,
            )
        except (ValueError, pd.errors.ParserError, UnicodeError, OverflowError) as error:
            fix = "write the map by hand, with delimiter, skip and header in [log]"
            raise LogError(Problem("the log cannot be read as a table", str(path), reason(error), fix)) from error
    made = _made(path, layout, names, below, [frame[k] for k in range(len(names))])
    return replace(made, groups=_groups(rows, header, names))


def _of_parquet(path: Path) -> Sample:
    from pyarrow import types

    with being_read(path):
        schema = schema_of(path)
        flat = [
            one.name
            for one in schema
            if not types.is_nested(one.type) and not types.is_binary(one.type) and schema.names.count(one.name) == 1
        ]
        batch = next(batches(path, schema, flat, ROWS), None)
        texts = [] if batch is None else [_plain(column.to_pandas()) for column in batch.columns]
    return _made(path, {"format": "parquet"}, flat, [""] * len(flat), texts)


def _plain(column: Any) -> Any:
    """A pandas column that is no category of texts."""
    return column.astype("string") if str(column.dtype) == "category" else column


def _of_workbook(path: Path) -> list[Sample]:
    from ..formats.workbook import logs_among, outlines_of, passed_over

    outlines = outlines_of(path)
    logs = logs_among(outlines) or [one.name for one in outlines][-1:]
    heads = {one.name: _head(one.rows[:HEADING]) for one in outlines if one.name in logs}
    if (together := _joined_sheets(path, outlines)) is not None:
        return [together]
    # Sheets that are written alike are runs; of others the first is the log.
    alike = [one for one in logs if _alike(heads[logs[0]], heads[one])]
    layout: dict[str, Any] = {"format": "xlsx"}
    notes = passed_over(outlines, logs[0]) if len(alike) == 1 else []
    if len(alike) > 1:
        layout["sheet"] = alike
        others = [f"'{one.name}'" for one in outlines if one.name not in alike]
        notes = [f"{len(alike)} sheets have the same columns: each becomes a trial"]
        notes += [f"not read: sheet {listed(others, 6)}"] if others else []
    elif len(outlines) > 1:
        layout["sheet"] = logs[0]
    several = len(alike) > 1
    sheets: dict[str, Sample] = {}
    for one in alike[:RUNS]:
        own = dict(layout)
        sheets[one] = _of_sheet(path, one, own)
        # Where its names stand each sheet shows; the map says it of the first.
        layout |= {key: value for key, value in own.items() if not (sheets.keys() - {one}) or key not in _HEAD}
    sheets = {one: replace(of, layout=layout) for one, of in sheets.items()}
    return [replace(of, notes=[*notes, *of.notes], part=one if several else "") for one, of in sheets.items()]


def _joined_sheets(path: Path, outlines: Sequence[Outline]) -> Sample | None:
    """A workbook whose sheets hold some quantities each, with times of their own, as one log; None of any other.

    Raises LogError where each sheet holds one quantity and their times do not allow to put them together.
    """
    from ..formats.joining import Apart
    from ..formats.workbook import in_sheet, joined_sheets

    held = {one.name: found for one in outlines if not one.hidden and (found := _held(one)) is not None}
    quantities = [{of for of in one.quantities.values() if of} for one in held.values()]
    every = [of for one in quantities for of in one]
    if len(held) < 2 or len(set(every)) < len(every) or sum(map(bool, quantities)) < max(2, len(held) // 2):
        return None
    single = all(len(one.quantities) == 1 for one in held.values())

    def named(sheet: str, column: str) -> str:
        """By its name alone where that says what it is, and no other sheet has one of that name."""
        twice = sum(column in one.quantities for one in held.values()) > 1
        return column if quantity_named(column) and not twice else in_sheet(sheet, column)

    time = next(iter(held.values())).time
    try:
        table = joined_sheets(path, [*held], 0, TimeSource(column=time), named)
    except Apart as error:
        if not single:
            return None
        shown = listed([f"'{one}'" for one in held], 8)
        why = f"a log has a row for each time and a column for each of them, and {error}"
        fix = "put them on one sheet: a column of time, and one for each; cells without a value at a time stay empty"
        raise LogError(Problem(f"each sheet holds one quantity: {shown}", str(path), why, fix)) from error
    layout = {"format": "xlsx", "sheet": [*held], "join": True}
    made = _made(path, layout, table.names, [""] * len(table.names), [one[:ROWS] for one in table.columns])
    return replace(made, notes=[table.note])


@dataclass(frozen=True)
class _Held:
    """What a sheet holds beside its times: the name of their column, and the quantities of the others by name."""

    time: str
    quantities: Mapping[str, str]


def _held(outline: Outline) -> _Held | None:
    """What a sheet holds; None where it has no column of times, no other one, or hardly any rows."""
    from ..formats.workbook import numbers_in_rows

    names, header = _head(outline.rows[:HEADING])
    filled = [one for one in names if one.strip()]
    named = [[one for one in filled if quantity_named(one) == of] for of in (TIME, DATE)]
    times = named[0] or named[1]
    others = [one for one in filled if one not in times]
    if header is None or len(times) != 1 or not others or numbers_in_rows(outline.rows, 2) < 2 * FEWEST:
        return None
    of = {one: quantity_named(one) for one in others}
    if len(others) == 1 and not of[others[0]]:
        of[others[0]] = quantity_named(outline.name)
    return _Held(times[0], of)


def _alike(one: tuple[list[str], int | None], other: tuple[list[str], int | None]) -> bool:
    """Whether sheets with these names of columns, in these rows, can be read by one map."""
    names = [{bare(name).lower() for name in of[0] if name.strip()} for of in (one, other)]
    if not names[0]:
        return one == other
    if any(quantity_named(name) in (DATE, TIME) for name in names[0] ^ names[1]):
        return False
    if (one[1] is None) != (other[1] is None):
        return False
    return len(names[0] & names[1]) >= max(min(4, len(names[0])), 0.75 * max(map(len, names)))


def _head(rows: Sequence[Sequence[Any]]) -> tuple[list[str], int | None]:
    """The names of the columns of a sheet, and the row that they stand in."""
    from ..formats.workbook import as_text

    start = [[as_text(cell) or "" for cell in row] for row in rows]
    _, header, _, width = heading(start)
    return (start[header] if header is not None else [""] * width), header


def _of_sheet(path: Path, name: str, layout: dict[str, Any]) -> Sample:
    import pandas as pd

    from ..formats.workbook import as_text, formulas_in, require_results, sheet_of

    sheet = sheet_of(path, name)
    start = [[as_text(cell) or "" for cell in row] for row in sheet.rows[:HEADING]]
    first, header, unit_row, width = heading(start)
    names, below = _named(layout, start, first, header, unit_row, width)
    body = sheet.rows[first : first + ROWS]
    texts = [
        pd.Series([as_text(row[k]) if k < len(row) else None for row in body], dtype="string")
        for k in range(len(names))
    ]
    empty = [one for one, text in zip(names, texts, strict=True) if one and not text.notna().any()]
    formulas = formulas_in(path, sheet.name, names, empty)
    require_results(path, sheet.name, {name: one for name, one in formulas.items() if quantity_named(name)})
    made = _made(path, layout, names, below, texts)
    idle = [f"'{one}'" for one in formulas]
    notes = [f"formulas without results are left out: {listed(idle, 6)}"] if idle else []
    return replace(made, notes=notes, groups=_groups(start, header, names))


def _of_matlab(path: Path) -> list[Sample]:
    from ..formats.matlab import variables
    from ..formats.matlab_columns import columns_in, runs_in

    held = variables(path)
    runs = runs_in(held)
    if len(runs) > 1:
        layout: dict[str, Any] = {"format": "mat", "variable": runs}
        of_runs = {one: columns_in(held, path, one) for one in runs[:RUNS]}
        notes = [f"the file holds {len(runs)} runs: each becomes a trial"]
        return [
            replace(_of_columns(path, layout, found), notes=[*notes, *found.notes], part=one)
            for one, found in of_runs.items()
        ]
    found, layout = columns_in(held, path), {"format": "mat"}
    # One structure among other things is named, so that a vector beside it cannot come in its way.
    inside = [name for name, value in held.items() if isinstance(value, dict)]
    if len(inside) == 1 and len(held) > 1:
        with contextlib.suppress(LogError):  # what describes the run holds no columns
            within = columns_in(held, path, inside[0])
            if len(within.names) >= 4:
                found, layout["variable"] = within, inside[0]
    return [_of_columns(path, layout, found)]


def _of_columns(path: Path, layout: dict[str, Any], found: Any) -> Sample:
    import pandas as pd

    texts = [pd.Series(one[:ROWS], dtype="string" if isinstance(one, list) else "float64") for one in found.columns]
    made = _made(path, layout, found.names, [""] * len(found.names), texts)
    return replace(made, notes=found.notes)


def _named(
    layout: dict[str, Any], rows: list[list[str]], first: int, header: int | None, unit_row: int | None, width: int
) -> tuple[list[str], list[str]]:
    """Names and units of the columns, and what [log] has to say of them, put into ``layout``."""
    if header is None:
        layout["skip"], layout["header"], layout["fields"] = first, False, width
        return [""] * width, [""] * width
    names = [*rows[header], *[""] * (width - len(rows[header]))]
    below = rows[unit_row] if unit_row is not None else []
    if header:
        layout["skip"] = header
    return names, [*below, *[""] * (len(names) - len(below))][: len(names)]


def _groups(rows: Sequence[Sequence[str]], header: int | None, names: Sequence[str]) -> tuple[str, ...]:
    """What a row above the names says of several columns, over which it reaches to the next cell that is filled.

    () where no row does: one that says something of one column only, or of two alike, is a title or what it may be.
    """
    above = [cell.strip() for cell in rows[header - 1][: len(names)]] if header else []
    above += [""] * (len(names) - len(above))
    filled = [k for k, cell in enumerate(above) if cell]
    reach = list(pairwise([*filled, len(names)]))
    several = any(end - k > 1 and all(names[k:end]) for k, end in reach)
    if len(filled) < 2 or not several or _numeric_share(above) > 0.0:
        return ()
    groups = [""] * len(names)
    for k, end in reach:
        groups[k:end] = [above[k] if name.strip() else "" for name in names[k:end]]
    return tuple(groups)


def heading(rows: Sequence[Sequence[str]]) -> tuple[int, int | None, int | None, int]:
    """First row of numbers, rows with names and with units (None where there are none), and how many fields rows have.

    rows  (n_rows,) of cells as they are printed
    """
    filled = [k for k, row in enumerate(rows) if any(cell.strip() for cell in row)]
    if not filled:
        return 0, None, None, 0
    tail = [len(rows[k]) for k in filled[len(filled) // 4 :]]
    width = max(set(tail), key=lambda size: (tail.count(size), size))
    shares = {k: _numeric_share(rows[k]) for k in filled if len(rows[k]) >= max(2, width - 1)}
    usual = float(np.median(list(shares.values()))) if shares else 0.0
    first = next((k for k in filled if k in shares and shares[k] >= max(0.34, 0.6 * usual)), filled[0])
    above = [k for k in filled if k < first][-2:]
    named = [k for k in above if _names(rows[k], width)]
    # Of units most may be left out.
    if named[:1] == above[:1] and len(above) == 2 and len(rows[above[1]]) <= width and _are_units(rows[above[1]]):
        return first, above[0], above[1], width
    if not named or named[-1] != above[-1]:
        return first, None, None, width
    # Below the names units may be described in words, and remarks may stand.
    names = max(named, key=lambda k: (sum(bool(quantity_named(cell)) for cell in rows[k]), k))
    return first, names, None, width


def _names(row: Sequence[str], width: int) -> bool:
    cells = [cell for cell in row if cell.strip()]
    # A row with every field filled but the last, which lines that end with a mark do not have.
    return width - 1 <= len(row) <= width and len(cells) >= 0.6 * width and _numeric_share(row) < 0.34


def _are_units(row: Sequence[str]) -> bool:
    """Whether most cells of a row are units, or stand for none."""
    cells = [cell.strip().strip("[]()") for cell in row]
    known = [bool(known_unit(cell)) or cell in ("", "-", "--", "UTC", "%", "N", "kN", "Nm") for cell in cells]
    return sum(bool(known_unit(cell)) for cell in cells) >= 2 and sum(known) >= 0.6 * len(cells)


def _numeric_share(row: Sequence[str]) -> float:
    cells = [cell.strip() for cell in row if cell.strip()]
    told = [
        bool(
            _NUMBER.fullmatch(one)
            or _COMMA.fullmatch(one)
            or _DATED.fullmatch(one)
            or one.lower() in MISSING
            or is_with_unit(one)
        )
        for one in cells
    ]
    return sum(told) / len(told) if told else 0.0


def _separator(lines: Sequence[str]) -> tuple[str, str]:
    """The mark between fields, and the decimal sign."""
    body = [line for line in lines if line.strip()]
    body = body[len(body) // 4 :][:120]
    best: tuple[float, str, str] = (-1.0, ",", ".")
    divided_by_header = False
    for mark in MARKS:
        if mark == " " and divided_by_header:
            break  # blanks may stand in cells, such as those of dates and of 5.0 P
        rows = [fields_of(line, mark) for line in body]
        counts = [len(row) for row in rows]
        usual = max(set(counts), key=counts.count, default=0)
        if usual < 2:
            continue
        cells = [cell for row in rows for cell in row if cell.lower() not in MISSING]
        plain = sum(_NUMBER.fullmatch(cell) is not None for cell in cells)
        comma = sum(_COMMA.fullmatch(cell) is not None for cell in cells)
        dated = sum(_DATED.fullmatch(cell) is not None for cell in cells)
        score = counts.count(usual) / len(counts) * (plain + comma + dated) / max(1, len(cells))
        if usual > 2 and counts.count(usual) > ALMOST * len(counts):
            head = (fields_of(line, mark) for line in lines[:HEAD])
            divided_by_header = divided_by_header or any(len(row) == usual and _names(row, usual) for row in head)
        if score > best[0] + 0.02:
            # Between commas only what is quoted has commas in it: numbers, or thousands of numbers with points.
            points = sum("." in cell and _NUMBER.fullmatch(cell) is not None for cell in cells) if mark == "," else 0
            best = score, mark, "," if comma > max(0.2 * (plain + comma), points) else "."
    return best[1], best[2]


def _encoding(content: bytes) -> str:
    """The encoding of the beginning of a log."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    nulls = content[:2000].count(b"\0")
    if nulls > 0.3 * len(content[:2000]):
        return "utf-16-le" if content[1:2] == b"\0" else "utf-16-be"
    try:
        # The last character may be cut in two.
        content[: max(1, len(content) - 4) if len(content) == PEEK else len(content)].decode("utf-8")
        return "utf-8"
    except UnicodeDecodeError as error:
        if len(content) == PEEK and error.start > len(content) - 8:
            return "utf-8"
    try:
        text = content.decode("cp932")
        if len(_JAPANESE.findall(text)) > 3:
            return "cp932"
    except UnicodeDecodeError:
        pass
    return "cp1252"


def seconds(sample: Sample, k: int, form: str | None = None) -> tuple[FloatArray, str] | None:
    """Stamps (n_rows,) of a column that holds dates or clocks in s, and their format; None where it holds none.

    form  how to read stamps that are hours and minutes as well as minutes and seconds; None: as hours and minutes, and
          EITHER is their format then
    """
    from ..clock import Stamps

    texts = sample.texts[k]
    rows = np.arange(len(texts), dtype=np.int64)
    either = form is None and not (holds_numbers(texts) or _holds_dates(texts)) and times_told(texts) == EITHER
    stamps = Stamps(TimeSource(format=TIME_OF_DAY if either else form), sample.path)
    try:
        t = stamps.of(texts, rows)
    except LogError:
        # Dates whose order nothing shows: any will do to look at the motion.
        stamps = Stamps(TimeSource(format="dmy"), sample.path)
        try:
            return stamps.of(texts, rows), "?"
        except LogError:
            return None
    found = EITHER if either else str(stamps.format)
    return (t, found) if stamps.clock and np.isfinite(t).sum() > 1 else None
