"""How much files and options may ask for: every limit, and the error that names it.

What is read or made in proportion to something written in a file is held against its limit before it is made, so that
no file and no option fills the machine.
"""

from __future__ import annotations

import math
import os
import stat
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import Any

from .errors import MmgtuneError, Problem


@dataclass(frozen=True)
class Limit:
    """The most of something.

    most  the limit, in ``unit``
    of    what it is of, as messages name it
    fix   what to do beyond it
    """

    most: int
    unit: str
    of: str
    fix: str

    def problem(self, asked: float, where: str, why: str = "") -> Problem | None:
        """What to say where ``asked`` is more than there may be, else None."""
        if asked <= self.most:
            return None
        size = f"{asked:.0f}" if asked < 1e15 else f"{asked:.3g}"
        why = f"the limit is {self.most}" + (f"; {why}" if why else "")
        return Problem(f"{self.of} of {size} {self.unit}: too many", where, why, self.fix)

    def require(self, asked: float, where: str, error: type[MmgtuneError], why: str = "") -> None:
        """Raise ``error`` where ``asked`` is more than there may be."""
        problem = self.problem(asked, where, why)
        if problem is not None:
            raise error(problem)


PROFILE_BYTES = Limit(1 << 20, "bytes", "a profile", "give the TOML file of a ship: some hundred lines")
NETWORK_BYTES = Limit(1 << 28, "bytes", "a network", "give a file that mmgtune learn has written")
NETWORK_MEMORY = Limit(1000, "samples", "a memory", "give a file that mmgtune learn has written")
NETWORKS = Limit(100, "networks", "a mixture", "put fewer together")
ORDERS_BYTES = Limit(16 << 20, "bytes", "a list of orders", "give a CSV file with a row an order")
ORDERS_STEPS = Limit(5_000_000, "steps of particles", "a list of orders", "end it earlier, or draw fewer particles")
CHECKS_BYTES = Limit(1 << 20, "bytes", "a file of checks", "give a TOML file of [[check]] tables")
RECORD_BYTES = Limit(1 << 28, "bytes", "a record", "give the folder of a run, or a baseline, as it was written")
MAP_BYTES = Limit(256 << 10, "bytes", "a map", "give the map of a log: a TOML file of a page or two")
MAP_ENTRIES = Limit(100, "entries", "[[logs]]", "use wider patterns, or several maps")
SPLIT_BYTES = Limit(1 << 20, "bytes", "a split", "give a TOML file with the ids that tune and test")
NESTING = Limit(32, "levels", "tables and lists in each other", "write it flat")
NAME = Limit(120, "characters", "an id", "ids are names of files: give a shorter one")
FACTS_BYTES = Limit(1 << 20, "bytes", "metadata", "write only ids, sources and a note into it")

LOG_BYTES = Limit(4 << 30, "bytes", "a text log", "split it, a file a day or less")
LOG_LINE = Limit(128 << 10, "bytes", "a line", "give a log with a row a line: this one is damaged, or of another kind")
LOG_COLUMNS = Limit(4096, "columns", "a log", "write only those that are needed")
SHEET_BYTES = Limit(1 << 28, "bytes", "a workbook, unpacked,", "save the sheet as CSV, or split it")
SHEET_ROWS = Limit(1 << 20, "rows", "a sheet", "save it again with a spreadsheet program: none has more rows")
SHEET_CELLS = Limit(20_000_000, "cells", "a sheet", "save it as CSV, or split it")
MATLAB_BYTES = Limit(1 << 29, "bytes", "a MATLAB file", "save only the columns that are needed, or split it")
LOG_PARTS = Limit(200, "parts", "a record", "correct the clock's stamps in the log, or split it")
LOG_RUNS = Limit(1000, "runs", "a log", "split the log")
GRID_SAMPLES = Limit(1_000_000, "samples", "a trial", "give a longer step, or cut the log")
GRID_PER_ROW = 200
"""Samples that a row of a log may become, beyond GRID_FREE of all: short steps add none that were measured."""
GRID_FREE = 20_000
RUN_STEPS = Limit(1_000_000, "steps", "a run", "cut the trial where its time jumps, or end what is ordered earlier")

MANOEUVRE_STEPS = Limit(10_000_000, "steps", "a manoeuvre", "take longer steps, or end it earlier")
TRIAL_SAMPLES = Limit(2_000_000, "samples", "a trial", "cut it into several, or give fewer samples a second")
TRIAL_VALUES = Limit(40_000_000, "values", "a trial", "leave out columns that nothing uses, or cut it into several")
TRIAL_BYTES = Limit(1 << 30, "bytes", "a trial file", "leave out columns that nothing uses, or cut it into several")
VOYAGE_ROWS = Limit(100_000_000, "rows", "a voyage", "cut it into several files, or give fewer samples a second")
VOYAGE_COLUMNS = Limit(100, "columns of numbers", "a voyage", "leave out columns that nothing uses")
VOYAGE_BYTES = Limit(64 << 30, "bytes", "a voyage", "leave out columns that nothing uses, or cut it into several files")
PARQUET_BYTES = Limit(4 << 30, "bytes", "a Parquet file", "write only the columns that are needed, or split it")
FOOTER_VALUES = Limit(100_000, "column chunks", "a Parquet file", "write it with fewer columns and longer row groups")

ROWS_PER_BYTE = 8
"""Rows that a byte of a Parquet file may stand for beyond FREE_ROWS: measured rows do not compress further."""
FREE_ROWS = 1_000_000


def too_fine(asked: float, rows: int, step: float, where: str, fix: str = GRID_SAMPLES.fix) -> Problem | None:
    """What to say where more samples, one a ``step`` [s], would be made of so many rows than may be, else None."""
    most = min(GRID_SAMPLES.most, GRID_FREE + GRID_PER_ROW * rows)
    if asked < most:
        return None
    what = f"{asked:.4g} samples would be made of {rows} rows, with a step of {step:.4g} s"
    return Problem(what, where, f"the limit is {most} samples", fix)


def is_real(value: object) -> bool:
    """Whether a value is a real number; True and False are none, though Python counts them among them."""
    return isinstance(value, Real) and not isinstance(value, bool)


def as_float(number: Any) -> float:
    """A number as a float; infinite where it is more than any holds, such as a whole one of a thousand digits."""
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def text(path: Path, limit: Limit, error: type[MmgtuneError]) -> str:
    """A file's text, its lines ended as on any system, a byte-order mark in front passed over.

    Raises ``error`` beyond the limit, OSError, and ValueError where it is not UTF-8.
    """
    return content(path, limit, error).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")


def content(path: Path, limit: Limit, error: type[MmgtuneError]) -> bytes:
    """A file's bytes, never more than the limit.  Raises ``error`` beyond it, and OSError."""
    found = _start_of(path, limit.most)
    if len(found) > limit.most:
        raise error(Problem(f"{limit.of} of more than {limit.most} bytes", str(path), "that is the limit", limit.fix))
    return bytes(found)


def _start_of(path: Path, most: int) -> bytearray:
    """The first bytes of a file, more than ``most`` where it has more; a pipe that is written into is waited for.

    Raises OSError, also for a pipe that nobody writes into.
    """
    if "\0" in str(path):
        raise OSError("its name has a zero byte")
    # One read would take the room for ``most`` at once, and not everything that is opened has a size.
    with open(path, "rb", buffering=0, opener=_without_waiting) as file:
        block: bytes | None = file.read(1 << 20)  # None of a pipe whose writer has written nothing yet
        if block == b"" and stat.S_ISFIFO(os.fstat(file.fileno()).st_mode):
            raise OSError("it is a pipe that nobody writes into")
        if os.name == "posix":
            os.set_blocking(file.fileno(), True)
        found = bytearray(block or b"")
        while block != b"" and len(found) <= most:
            block = file.read(1 << 20)
            found += block
    return found


def _without_waiting(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))
