"""Reading text logs: comma, semicolon, tab or blank separated, with or without names, in blocks of rows."""

from __future__ import annotations

import csv
import io
import re
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LogError, Problem, reason
from ...files import require_regular
from ...limits import LOG_BYTES, LOG_COLUMNS, LOG_LINE
from ..maps.mapping import LogMap
from .rows import Rows, columns_named
from .table import Table

BLOCK = 50_000
"""Rows read at a time."""
CELLS = 2_000_000
"""Cells read at a time, of all columns: wide logs are read in smaller blocks."""

PEEK = LOG_LINE.most
"""Bytes looked at to find out how a log is written."""


def read_text(path: Path, log_map: LogMap) -> Table:
    """The columns of a text log that a map names.

    Raises LogError where the file is empty, binary, in another encoding, or has not the columns named.
    """
    import pandas as pd

    LOG_BYTES.require(path.stat().st_size, str(path), LogError)
    layout = look(path, log_map)
    gathered = Rows(path, log_map, layout.names, columns_named(log_map, layout.names, layout.where))
    line = layout.first + 1
    dropped: list[str] = []
    try:
        with warnings.catch_warnings(record=True) as said, io.BufferedReader(Lines(path), 1 << 16) as file:
            warnings.simplefilter("always", pd.errors.ParserWarning)
            reader = pd.read_csv(
                file,
                header=None,
                names=range(len(layout.names)),
                index_col=False,
                skiprows=layout.first,
                sep=r"\s+" if layout.delimiter == " " else layout.delimiter,
                decimal=log_map.decimal,
                dtype=dict.fromkeys(gathered.as_texts, "string"),
                encoding=log_map.encoding,
                na_values=list(log_map.missing),
                skip_blank_lines=False,
                skipinitialspace=True,
                on_bad_lines="warn",
                chunksize=max(1, min(BLOCK, CELLS // len(layout.names))),
                low_memory=False,
            )
            with reader:
                for block in reader:
                    rows = np.arange(line, line + len(block), dtype=np.int64)
                    line += len(block)
                    gathered.add(block.__getitem__, rows)
        dropped = [str(one.message) for one in said if issubclass(one.category, pd.errors.ParserWarning)]
    except (UnicodeDecodeError, UnicodeError) as error:
        raise _undecodable(path, log_map, error) from error
    except (pd.errors.ParserError, pd.errors.EmptyDataError, csv.Error) as error:
        fix = "say delimiter, skip and header in [log] of the map"
        raise LogError(Problem("the log cannot be read as a table", str(path), reason(error), fix)) from error
    if not gathered.collector.seen:
        raise LogError(Problem("the log has no rows", str(path), "only a header was found", "check 'skip' in [log]"))
    table = gathered.table("line")
    bad = [int(one) for message in dropped for one in re.findall(r"[Ll]ine (\d+)", message)]
    if bad:
        lines = "1 line has" if len(bad) == 1 else f"{len(bad)} lines have"
        was = "was dropped: line" if len(bad) == 1 else "were dropped, the first is line"
        table.notes.append(f"{lines} too many fields and {was} {bad[0]}")
        if len(bad) > 0.5 * max(1, len(table.t)):
            share = f"{len(bad)} of {len(bad) + len(table.t)} lines"
            why = f"{share} have more fields than the header's {len(layout.names)}"
            raise _too_wide(path, bad[0], why)
    gathered.judge(table)
    return table


class Lines(io.RawIOBase):
    """The bytes of a log, whose lines may be no longer than the limit: a line is held in memory as a whole."""

    def __init__(self, path: Path):
        self.path, self.file, self.since = path, path.open("rb", buffering=0), 0

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        n = self.file.readinto(buffer) or 0
        block = bytes(buffer[:n])
        first = min((at for at in (block.find(b"\n"), block.find(b"\r")) if at >= 0), default=n)
        LOG_LINE.require(self.since + first, str(self.path), LogError)
        last = max(block.rfind(b"\n"), block.rfind(b"\r"))
        self.since = self.since + n if last < 0 else n - 1 - last
        return n

    def close(self) -> None:
        self.file.close()
        super().close()


@dataclass(frozen=True)
class Layout:
    """How a text log is written: names of its columns, lines before the first row, and what separates fields."""

    names: list[str]
    first: int
    delimiter: str
    where: str


def look(path: Path, log_map: LogMap) -> Layout:
    """Find names and delimiter at the beginning of a log.  Raises LogError."""
    content = start_of(path)
    try:
        text = content.decode(log_map.encoding, errors="strict" if len(content) < PEEK else "replace")
    except (UnicodeDecodeError, UnicodeError) as error:
        raise _undecodable(path, log_map, error) from error
    # Not ``splitlines``, which also divides at marks that are no ends of lines to the reader of rows.
    lines = re.split(r"\r\n|\n|\r", text.lstrip("\ufeff"))[: log_map.skip + 50]
    at = log_map.skip
    if len(lines) <= at or not any(line.strip() for line in lines[at:]):
        why = f"it has {len(lines)} lines, of which {at} are to be skipped"
        raise LogError(Problem("the log has no rows", str(path), why, "check 'skip' in [log], and the file"))
    LOG_LINE.require(max(len(line) for line in lines) + 1, str(path), LogError)
    delimiter = log_map.delimiter or _delimiter(lines[at:])
    if log_map.header:
        names = fields_of(lines[at], delimiter)
        LOG_COLUMNS.require(len(names), f"{path}, line {at + 1}", LogError)
        if all(_is_number(name) for name in names):
            why = f"the line is '{lines[at][:60]}'"
            fix = "say header = false in [log] and give columns by number, or correct 'skip'"
            raise LogError(Problem("numbers where names of columns should be", f"{path}, line {at + 1}", why, fix))
        for number, line in enumerate(lines[at + 1 :], start=at + 2):
            fields = fields_of(line, delimiter)
            if len(fields) == len(names) + 1 and not fields[-1]:
                # Lines that end with a delimiter: one column more, without a name.
                names = [*names, ""]
            elif len(fields) > len(names) and number == at + 2:
                raise _too_wide(path, number, f"it has {len(fields)} fields, the header has {len(names)}")
        return Layout(names, at + 1, delimiter, f"{path}, line {at + 1}")
    width = max(len(fields_of(line, delimiter)) for line in lines[at : at + 20])
    LOG_COLUMNS.require(width, f"{path}, line {at + 1}", LogError)
    if log_map.fields not in (None, width):
        why = f"its rows have {width} fields, and the map is for rows of {log_map.fields}"
        fix = "use the map or preset made for this log, or correct delimiter, skip and fields in [log]"
        raise LogError(Problem("the log is of another kind than the map is for", f"{path}, line {at + 1}", why, fix))
    return Layout([f"column {k}" for k in range(1, width + 1)], at, delimiter, f"{path}, line {at + 1}")


def start_of(path: Path) -> bytes:
    """The first bytes of a log.  Raises LogError where it cannot be opened, is empty or binary."""
    try:
        require_regular(path)  # it is read more than once
        with path.open("rb") as file:
            content = file.read(PEEK)
    except OSError as error:
        fix = "check the path, and that you may read the file"
        if path.is_dir():
            fix = f"name the logs in it, such as {path}/*.csv"
        raise LogError(Problem("the log cannot be opened", str(path), reason(error), fix)) from error
    if not content.strip():
        raise LogError(Problem("the log is empty", str(path), fix="copy it again from where it was made"))
    return content


def binary(content: bytes) -> bool:
    """Whether bytes are no text in any encoding a logger writes."""
    return b"\0" in content and not content.startswith((b"\xff\xfe", b"\xfe\xff"))


def _too_wide(path: Path, line: int, why: str) -> LogError:
    fix = "the delimiter may be another one, or the decimal sign a comma: say delimiter and decimal in [log]"
    return LogError(Problem("lines have more fields than the header", f"{path}, line {line}", why, fix))


def _delimiter(lines: list[str]) -> str:
    """The character that divides the first lines into the same number of fields; blanks where none does."""
    whole = [line for line in lines if line.strip()][:20]
    for mark in ("\t", ";", ",", "|"):
        counts = [line.count(mark) for line in whole]
        if min(counts) > 0 and (mark != "," or max(counts) == counts[0] or min(counts[1:], default=0) >= counts[0]):
            return mark
    return " "


COMMENT = ("#", "%", "//", "!", ";", "*")
"""What stands alone before names of columns that are written as a comment."""
_UNIT_APART = re.compile(r"\s+(?=[\[(][^\s\])]*[\])](\s|$))")


def fields_of(line: str, delimiter: str) -> list[str]:
    """The fields of a line; between blanks the names of a comment, "% t [s]  x [m]", are those without its mark."""
    if delimiter == " ":
        found = line.split()
        return _UNIT_APART.sub("", line).split()[1:] if found and found[0] in COMMENT else found
    try:
        return [field.strip() for field in next(csv.reader([line], delimiter=delimiter), [])]
    except csv.Error:
        return [field.strip() for field in line.split(delimiter)]


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True


def _undecodable(path: Path, log_map: LogMap, error: Exception) -> LogError:
    fix = 'say its encoding in [log], such as encoding = "cp1252" or "utf-16"'
    return LogError(Problem(f"the log is not {log_map.encoding}", str(path), reason(error), fix))
