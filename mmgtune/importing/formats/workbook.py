"""Reading spreadsheets: one sheet of a workbook (.xlsx), by openpyxl."""

from __future__ import annotations

import datetime
import itertools
import re
import warnings
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...errors import LogError, Problem, among, brief, reason
from ...limits import LOG_COLUMNS, SHEET_BYTES, SHEET_CELLS, SHEET_ROWS
from ...phrases import listed
from ...units import is_unit
from ..cells.headers import find_column, unit_in
from ..cells.numerals import number_in
from ..cells.with_units import is_with_unit
from ..maps.mapping import LogMap, TimeSource
from .in_memory import table_of
from .joining import Apart, Joined, Part, joined
from .kept import opened
from .table import InPart, Table

ENTRIES = 2000
"""Parts that a workbook may have."""
LONGEST = 200
"""Characters of a cell that are looked at."""
ZIP = b"PK\x03\x04"
"""How a workbook begins, and any other zip archive."""
OLD = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
"""How a workbook of the older kind begins (.xls), and one with a password."""


LOOKED_AT = 2000
"""Rows of a sheet that are looked at to tell which holds a log."""
COLUMNS = 4
"""Numbers in a row from which it may be one of a log: time, and a position and heading at least."""
TITLES = 400
"""Rows of a sheet among which the names of the columns are looked for."""
FEWEST_NAMES = 3
"""Names of columns by which the row that they stand in is known."""
_COUNTED = (float, int, datetime.datetime, datetime.time, datetime.timedelta)
SMALL = 0.2
"""Share of the numbers of the largest sheet, of the rows looked at, from which another one is a log too."""


@dataclass(frozen=True)
class Sheet:
    """One sheet: its rows as they stand, empty cells None, ragged; notes: what is to be said of the others."""

    name: str
    rows: list[tuple[Any, ...]]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Outline:
    """A sheet before it is read: its first rows, how many numbers are in rows of them, and whether it is hidden."""

    name: str
    hidden: bool
    rows: list[tuple[Any, ...]]
    numbers: int


def read_workbook(path: Path, log_map: LogMap) -> Table:
    """The columns of a sheet that a map names.

    Raises LogError where it cannot be read, is empty, has formulas without results, or lacks a column.
    """
    import pandas as pd

    if log_map.joined:
        return _read_joined(path, log_map)
    sheet = sheet_of(path, log_map.sheet)
    skip = _head_of(sheet, log_map)
    rows = sheet.rows[skip:]
    where = InPart(f"{path}, sheet '{sheet.name}', row {skip + 1}")
    if not any(rows):
        why = f"the sheet has {len(sheet.rows)} rows, of which {skip} are to be skipped"
        raise LogError(Problem("the log has no rows", where, why, "check 'sheet' and 'skip' in [log], and the file"))
    names = names_of(rows, log_map.header)
    if log_map.header and names and all(_numeric(one) for one in names if one):
        fix = "say header = false in [log] and give columns by number, or correct 'skip'"
        raise LogError(Problem("numbers where names of columns should be", where, f"the row is {brief(names)}", fix))
    if not log_map.header and log_map.fields not in (None, len(names)):
        why = f"its rows have {len(names)} cells, and the map is for rows of {log_map.fields}"
        fix = "use the map made for this log, or correct sheet, skip and fields in [log]"
        raise LogError(Problem("the log is of another kind than the map is for", where, why, fix))
    body = rows[1:] if log_map.header else rows
    columns = [
        pd.Series([as_text(row[k]) if k < len(row) else None for row in body], dtype="string")
        for k in range(len(names))
    ]
    first = skip + (2 if log_map.header else 1)
    table = table_of(path, log_map, names, columns, first, "row", where)
    table.notes += sheet.notes
    if skip != log_map.skip:
        table.notes.append(f"the names of the columns were found in row {skip + 1}, not in row {log_map.skip + 1}")
    empty = [table.headers[name] for name, values in table.columns.items() if not (values == values).any()]
    require_results(path, sheet.name, formulas_in(path, sheet.name, names, empty))
    return table


def _read_joined(path: Path, log_map: LogMap) -> Table:
    """The columns of several sheets that a map names, put together by their times."""
    asked = [one for source in log_map.sources.values() for one in source.columns.values() if isinstance(one, str)]

    def named(sheet: str, column: str) -> str:
        """As the map calls it: by its sheet too, or by its name alone."""
        full = in_sheet(sheet, column)
        return full if find_column(full, asked) is not None else column

    try:
        found = joined_sheets(path, log_map.joined, log_map.skip, log_map.time, named)
    except Apart as why:
        fix = "put what belongs together on one sheet, or name other sheets in [log]"
        raise LogError(Problem("the sheets cannot be put together by their times", str(path), str(why), fix)) from why
    table = table_of(path, log_map, found.names, found.columns, 1, "row", f"{path}, {len(log_map.joined)} sheets")
    table.notes.append(found.note)
    return table


def in_sheet(sheet: str, column: str) -> str:
    """How a column of one of several sheets is called, where its name alone does not tell what it is."""
    return f"{sheet}.{column}"


def joined_sheets(
    path: Path, sheets: Sequence[str], skip: int, time: TimeSource, named: Callable[[str, str], str]
) -> Joined:
    """Sheets of a workbook as one table, its first column the time.

    sheets  names of them
    skip    rows above the names of the columns, in a sheet that has not the column of time in another row
    time    what the column of time is called, or its number; a sheet that has none of that name has it in its first
    named   (sheet, column) -> what the column is called in the table

    Raises LogError where a sheet is not there, and Apart where their times do not fit together.
    """
    import pandas as pd

    parts: list[Part] = []
    heads: list[str] = []
    for name in sheets:
        sheet = sheet_of(path, name)
        texts = [[as_text(cell) for cell in row] for row in sheet.rows]
        rows = [[cell or "" for cell in row] for row in texts[:TITLES]]
        wanted = time.column if time.column is not None else 1
        first = next((k for k in (skip, *range(len(rows))) if k < len(rows) and _names(rows[k], wanted)), skip)
        if first >= len(rows):
            raise Apart(f"'{name}' has no rows below the first {skip}")
        names = rows[first]
        body = texts[first + 1 :]
        below = [one or "" for one in body[0]] if body else []
        units = {k: one for k, one in enumerate(below) if is_unit(one.strip("[]()"))}
        if units and not any(_numeric(one) for one in below):
            names = [f"{one} [{units[k].strip('[]()')}]" if k in units else one for k, one in enumerate(names)]
            body = body[1:]
        found = find_column(wanted, names)
        at = 0 if found is None else found
        columns = [
            pd.Series([row[k] if k < len(row) else None for row in body], dtype="string") for k in range(len(names))
        ]
        own = [k for k, one in enumerate(names) if k != at and one.strip()]
        empty = [names[k] for k in own if not columns[k].notna().any()]
        require_results(path, name, formulas_in(path, name, names, empty))
        heads.append(names[at])
        parts.append(Part(name, columns[at], [named(name, names[k]) for k in own], [columns[k] for k in own]))
    if len(said := {unit for one in heads if (unit := unit_in(one))}) > 1:
        raise Apart(f"they count their times in {listed(sorted(said))}")
    made = joined(parts, path, time)
    head = next((one for one in heads if unit_in(one)), heads[0])
    return replace(made, names=[head, *made.names], columns=[made.times, *made.columns])


def _names(row: Sequence[str], time: str | int) -> bool:
    """Whether a row holds names of columns: that of the time among them, or, where that is a number, no numbers."""
    if isinstance(time, str):
        return find_column(time, row) is not None
    filled = [one for one in row if one]
    return len(filled) > 1 and not any(_numeric(one) for one in filled)


def _head_of(sheet: Sheet, log_map: LogMap) -> int:
    """How many rows stand above the names: as many as the map says, or of one of several runs as it takes there."""
    named = [log_map.time.columns, *(source.columns for source in log_map.sources.values())]
    asked = [column for columns in named for column in columns.values() if isinstance(column, str)]
    if not (log_map.parts and log_map.header) or len(asked) < FEWEST_NAMES:
        return log_map.skip
    places: list[int] = [log_map.skip, *range(min(len(sheet.rows), TITLES))]
    for k in places:
        names = [as_text(cell) or "" for cell in (sheet.rows[k] if k < len(sheet.rows) else ())]
        if all(find_column(one, names) is not None for one in asked):
            return k
    return log_map.skip


def require_results(path: Path, sheet: str, formulas: Mapping[str, str]) -> None:
    """Raise LogError for columns that hold formulas, by name, whose results the file does not hold."""
    for name, formula in formulas.items():
        why = f"a cell says {formula}, and the file does not hold what comes of it"
        fix = "open it in a spreadsheet program and save it again, or save the values alone"
        place = InPart(f"{path}, sheet '{sheet}'")
        raise LogError(Problem(f"column '{name}' holds formulas without results", place, why, fix))


def formulas_in(path: Path, sheet: str, names: list[str], empty: list[str]) -> dict[str, str]:
    """Of columns in which there is nothing those that hold formulas, each with the first of them."""
    found: dict[str, str] = {}
    if not empty:
        return found
    with _opened(path, formulas=True) as book:
        rows = next(one for one in book.worksheets if one.title == sheet)
        rows.reset_dimensions()
        for row in itertools.islice(rows.iter_rows(values_only=True), 200):
            for name, cell in zip(names, row, strict=False):
                if name in empty and isinstance(cell, str) and re.match(r"=\S", cell):
                    found.setdefault(name, f"'{cell[:60]}'")
    return found


def sheet_of(path: Path, wanted: str) -> Sheet:
    """A sheet by name, or the first that holds a log where ``wanted`` is "".  Raises LogError."""
    with _opened(path) as book:
        names = [one.title for one in book.worksheets]
        if wanted and wanted not in names:
            place = f"{path}, [log] sheet of the map"
            raise LogError(Problem(f"the workbook has no sheet '{wanted[:80]}'", place, **among(wanted, names)))
        notes: list[str] = []
        if not wanted:
            outlines = _outlines(book, path)
            wanted = next(iter(logs_among(outlines)), names[-1])
            notes = passed_over(outlines, wanted)
        elif len(names) > 1:
            notes = [f"read from sheet '{wanted}'"]
        found = next(one for one in book.worksheets if one.title == wanted)
        return Sheet(wanted, _rows(found, path), tuple(notes))


def outlines_of(path: Path) -> list[Outline]:
    """What the sheets of a workbook begin with.  Raises LogError where it cannot be read."""
    with _opened(path) as book:
        return _outlines(book, path)


def _outlines(book: Any, path: Path) -> list[Outline]:
    outlines = []
    if not book.worksheets:
        raise LogError(Problem("the workbook has no sheet with cells", str(path), fix="give another file"))
    for one in book.worksheets:
        rows = _rows(one, path, LOOKED_AT)
        outlines.append(Outline(one.title, one.sheet_state != "visible", rows, numbers_in_rows(rows, COLUMNS)))
    if not any(one.numbers for one in outlines):
        return [replace(one, numbers=numbers_in_rows(one.rows, 2)) for one in outlines]
    return outlines


def logs_among(outlines: Sequence[Outline]) -> list[str]:
    """Names of the sheets that hold logs: of those that are not hidden all with rows of numbers, but for small ones."""
    shown = [one for one in outlines if not one.hidden and one.numbers > 0]
    shown = shown or [one for one in outlines if one.numbers > 0]
    most = max((one.numbers for one in shown), default=0)
    return [one.name for one in shown if one.numbers >= SMALL * most]


def passed_over(outlines: Sequence[Outline], read: str) -> list[str]:
    """What is said of the sheets that are not read, in sentences."""
    if len(outlines) < 2:
        return []
    others = [one.name for one in outlines if one.name != read]
    logs = [one for one in logs_among(outlines) if one != read]
    hidden = {one.name for one in outlines if one.hidden}
    shown = listed([f"'{one}'{' (hidden)' if one in hidden else ''}" for one in others], 6)
    said = f"the workbook has {len(outlines)} sheets: '{read}' is read, {shown} not"
    return [f'{said}; sheet = "{logs[0]}" in [log] of a map reads another one' if logs else said]


def names_of(rows: list[tuple[Any, ...]], header: bool) -> list[str]:
    """Names of the columns: of the first row, or by number."""
    width = max(len(row) for row in rows[:50])
    if not header:
        return [f"column {k}" for k in range(1, width + 1)]
    return [as_text(one) or "" for one in rows[0]] + [""] * (width - len(rows[0]))


def as_text(cell: Any) -> str | None:
    """A cell as logs print it: numbers with all their digits, dates and times in ISO 8601; None where it is empty."""
    if cell is None:
        return None
    if isinstance(cell, datetime.timedelta):
        seconds = cell.total_seconds()
        return f"{int(seconds // 3600):02d}:{int(seconds % 3600 // 60):02d}:{seconds % 60:09.6f}"
    if isinstance(cell, datetime.datetime | datetime.date | datetime.time):
        return cell.isoformat()
    return repr(cell) if isinstance(cell, float) else str(cell)[:LONGEST].strip()


@contextmanager
def _opened(path: Path, formulas: bool = False) -> Iterator[Any]:
    """A workbook whose parts are within limits.  Raises LogError where it is damaged."""
    try:
        with opened(path, "formulas" if formulas else "xlsx", lambda: _book(path, formulas), _close) as book:
            yield book
    except (LogError, MemoryError):
        raise
    except zipfile.BadZipFile as error:
        with path.open("rb") as file:
            begins = file.read(len(ZIP)) == ZIP
        why = f"it is cut short, or damaged: {reason(error)}" if begins else "it is no .xlsx file"
        fix = "copy it again from its source" if begins else "use the map made for this log"
        raise LogError(Problem("the workbook cannot be read", str(path), why, fix)) from error
    except Exception as error:  # the library raises what it comes across where a file is damaged
        why = f"{type(error).__name__}: {reason(error)}"
        fix = "save it again as .xlsx with a spreadsheet program, or save the sheet as CSV"
        raise LogError(Problem("the workbook cannot be read", str(path), why, fix)) from error


def _book(path: Path, formulas: bool) -> Any:
    import openpyxl

    with zipfile.ZipFile(path) as parts:
        listed = parts.infolist()
        # What is read of a part never exceeds the size that its entry says.
        SHEET_BYTES.require(sum(one.file_size for one in listed), str(path), LogError)
        if len(listed) > ENTRIES:
            raise LogError(Problem(f"the workbook has {len(listed)} parts", str(path), f"the limit is {ENTRIES}"))
        for one in listed:
            with parts.open(one) as file:
                start = file.read(2048)
            if b"<!DOCTYPE" in start or b"<!ENTITY" in start:
                what = f"part '{one.filename[:80]}' of the workbook declares a document type"
                raise LogError(Problem(what, str(path), "no spreadsheet program writes that", "save it again"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return openpyxl.load_workbook(path, read_only=True, data_only=not formulas, keep_links=False)


def _close(book: Any) -> None:
    book.close()


def _rows(sheet: Any, path: Path, most: int | None = None) -> list[tuple[Any, ...]]:
    """All rows of a sheet, or the first of them, the empty ones at its end left out."""
    # The sheet's own word on its size is not to be relied on, and every row would be filled up to it.
    sheet.reset_dimensions()
    rows: list[tuple[Any, ...]] = []
    cells = 0
    for row in itertools.islice(sheet.iter_rows(values_only=True), most):
        cells += len(row) + 1
        LOG_COLUMNS.require(len(row), f"{path}, row {len(rows) + 1}", LogError)
        SHEET_ROWS.require(len(rows) + 1, str(path), LogError)
        SHEET_CELLS.require(cells, str(path), LogError)
        rows.append(row)
    while rows and all(cell is None for cell in rows[-1]):
        rows.pop()
    return rows


def numbers_in_rows(rows: Sequence[Sequence[Any]], least: int) -> int:
    """How many numbers stand in rows that hold so many at least and little else; also as texts, or with a unit."""
    total = 0
    for row in rows:
        cells = [cell for cell in row if cell is not None]
        numbers = sum(isinstance(cell, _COUNTED) or _numeric(cell) or _has_unit(cell) for cell in cells)
        total += numbers if numbers >= least and 2 * numbers >= len(cells) else 0
    return total


def _has_unit(cell: Any) -> bool:
    return isinstance(cell, str) and is_with_unit(cell.strip()[:LONGEST])


def _numeric(cell: Any) -> bool:
    """Whether a cell is a text that is a number, with a decimal point or comma."""
    return isinstance(cell, str) and number_in(cell, ",") is not None
