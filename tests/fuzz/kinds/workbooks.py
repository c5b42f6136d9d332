"""Workbooks: odd cells, parts replaced, damaged or left out, and bytes that are no archive."""

from __future__ import annotations

import datetime
import functools
import io
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl

from tests.importing.made import MAP, logged, turn

from ..mutating import NUMBERS, encoded, mutated_bytes, odd_text, pick, several
from . import Files, Kind
from .csv_logs import imports
from .proposals import proposes

ODD: tuple[Any, ...] = (
    None, True, 0, -1, 10**300, 1e300, -1e300, float(2**63), "=A1*2", "=1/0", "#DIV/0!", "#N/A", "1,5", "NaN",
    datetime.datetime(1900, 1, 1), datetime.datetime(9999, 12, 31), datetime.date(2024, 5, 1), datetime.time(12, 0),
    datetime.timedelta(days=-3), datetime.timedelta(hours=30), "x" * 5000, "52°06.00001'N", "31/02/2024 10:00", "💥",
)  # fmt: skip


WRITTEN_AT = re.compile(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ")
"""When a workbook was made and changed, as it says itself."""


@functools.cache
def rows() -> tuple[tuple[Any, ...], ...]:
    """Rows of a log that can be imported: 60 of a turn."""
    columns = {name: values[:60] for name, values in logged(turn()).items()}
    return (tuple(columns), *zip(*(np.round(one, 6).tolist() for one in columns.values()), strict=True))


def written(found: list[list[Any]], rng: np.random.Generator) -> bytes:
    """A workbook of rows, perhaps with other sheets and merged cells."""
    book = openpyxl.Workbook()
    for row in found:
        book.active.append([one[:32000] if isinstance(one, str) else one for one in row])
    if rng.random() < 0.2:
        book.create_sheet(pick(rng, ("a", "Ü" * 20, "1")), int(rng.integers(2)))
    if rng.random() < 0.2 and book.active.max_row > 2:
        book.active.merge_cells(start_row=1, start_column=1, end_row=2, end_column=3)
    out = io.BytesIO()
    book.save(out)
    return _archive(out.getvalue(), lambda _, part: WRITTEN_AT.sub(b"2000-01-01T00:00:00Z", part))


def _archive(content: bytes, changed: Callable[[str, bytes], bytes | None]) -> bytes:
    """The archive with each part changed, or left out for None; all of them of one time, so that a case can be made
    again to the byte."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            if (part := changed(name, old.read(name))) is not None:
                new.writestr(zipfile.ZipInfo(name), part, zipfile.ZIP_DEFLATED)
    return out.getvalue()


def _cells(rng: np.random.Generator, found: list[list[Any]]) -> list[list[Any]]:
    """Cells of a column replaced from somewhere on."""
    if not found:
        return found
    column, first = int(rng.integers(9)), int(rng.integers(len(found)))
    value = pick(rng, ODD)
    for row in found[first : first + int(pick(rng, (1, 3, 100)))]:
        if column < len(row):
            row[column] = value
    return found


def _rows(rng: np.random.Generator, found: list[list[Any]]) -> list[list[Any]]:
    """Rows left out, emptied, repeated or made longer."""
    at = int(rng.integers(len(found))) if found else 0
    how = int(rng.integers(5))
    if how == 0:
        return found[:at]
    if how == 1:
        return found[at:]
    if how == 2:
        return [*found[:at], [], *found[at:]]
    if how == 3:
        return [*found[:at], *[list(row) for row in found[at : at + 1]] * 30, *found[at:]]
    return [[*row, *[1.0] * 40] for row in found]


def _parts(rng: np.random.Generator, content: bytes) -> bytes:
    """A part of the archive left out, damaged, or with odd words in its XML."""
    with zipfile.ZipFile(io.BytesIO(content)) as old:
        struck = pick(rng, old.namelist())

    def changed(name: str, part: bytes) -> bytes | None:
        if name != struck:
            return part
        how = rng.random()
        if how < 0.15:
            return None
        if how < 0.4:
            return mutated_bytes(rng, part)
        word = pick(rng, (b"1", b"0", b"A1", b"<v>", b"t=", b"r=", b"s=", b'"', b"General", b"rId1", b"sheet"))
        other = encoded(pick(rng, (*NUMBERS, "-5", "A0", "XFD1048576", "ZZZZ9", "1048577", "<a>", "&x;", "é", "")))
        return part.replace(word, other, int(pick(rng, (1, 5, 10000))))

    return _archive(content, changed)


def make(rng: np.random.Generator) -> Files:
    """A workbook with something wrong in its cells, parts or bytes."""
    found = [list(row) for row in rows()]
    if rng.random() < 0.6:
        found = several(rng, found, [_cells, _cells, _rows])
    content = written(found, rng)
    how = rng.random()
    if how < 0.5:
        content = _parts(rng, content)
    elif how < 0.65:
        content = mutated_bytes(rng, content)
    text = MAP
    if rng.random() < 0.2:
        text = text.replace("[time]", f"[log]\nskip = {int(rng.integers(5))}\n[time]")
    if rng.random() < 0.1:
        text = text.replace('"time"', f'"{odd_text(rng)[:5]}"'.replace("\n", " ").replace("\\", "/"))
    return {"log.xlsx": content, "map.toml": encoded(text)}


def run(folder: Path) -> str:
    """Propose a map for it, and import it."""
    return proposes(folder, "log.xlsx") + "; " + imports(folder, "log.xlsx")


KIND = Kind("workbooks", make, run, seconds=4.0)
