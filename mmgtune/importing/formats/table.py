"""A log read into memory: the needed columns as they are printed, and nothing else."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray, IntArray
from ...errors import LogError, Problem
from ...units import canonical, is_unit
from ..cells.degrees import DDMM, degrees, of_ddmm
from ..cells.numerals import holds_numbers, number_in, numbers_in
from ..cells.position_pair import pair_in
from ..cells.position_parts import HEMISPHERES, position_of
from ..cells.position_parts import PARTS as POSITION_PARTS
from ..cells.thousands import either_way, first_marked, in_thousands
from ..cells.with_units import WITH_UNIT, numbers_with_unit
from ..maps.mapping import LogMap
from .sides import SIGNED, midships, sided, takes_side

MOST_ROWS = 1_000_000
"""Rows kept of one log; of longer ones every second, fourth, ... row, so that memory stays bounded."""

TIME = "t"

MISSING = frozenset({"", "-", "--", "---", "----", "*", "**", "***", "nan", "na", "n/a", "#n/a", "null", "none"})
"""Texts for no value, in small letters, that need not be said in a map."""


class InPart(str):
    """A place in a log that names the sheet it is in."""


@dataclass(eq=False)
class Table:
    """Columns of a log by quantity, (n_rows,) each, in the log's own units and signs.

    t        time [s] where it was printed as a date or clock, else in the log's unit
    rows     number of each row in the file, counted from 1: of lines in text
    headers  the log's name of each quantity's column
    clock    whether ``t`` was printed as a date or clock, so that it is in s already
    stated   units that the cells of a quantity say themselves, such as 52°06.00001'N
    below    units that a row below the names says, by quantity
    sided    quantities whose cells say the side themselves, such as 35.0S; those to starboard are positive
    notes    what was done or dropped while reading, in sentences
    """

    path: Path
    t: FloatArray
    columns: dict[str, FloatArray]
    rows: IntArray
    headers: dict[str, str]
    clock: bool = False
    unit: str = "line"
    notes: list[str] = field(default_factory=list)
    stated: dict[str, str] = field(default_factory=dict)
    below: dict[str, str] = field(default_factory=dict)
    sided: tuple[str, ...] = ()

    def leave_out(self, lines: Collection[int]) -> None:
        """Drop rows by their number in the file, in place."""
        if lines:
            kept = ~np.isin(self.rows, list(lines))
            self.t, self.rows = self.t[kept], self.rows[kept]
            self.columns = {name: values[kept] for name, values in self.columns.items()}

    def place(self, row: int) -> str:
        """Where a row is in the file."""
        return f"{self.path}, {self.unit} {self.rows[row]}"


class Collector:
    """Gathers blocks of rows and keeps no more than MOST_ROWS of them."""

    def __init__(self, names: list[str]):
        self.blocks: list[npt.NDArray[Any]] = []
        self.rows: list[IntArray] = []
        self.names = names
        self.stride = 1
        self.kept = 0
        self.seen = 0

    def add(self, block: FloatArray, rows: IntArray) -> None:
        """Take a block (n_rows, n_names) and the numbers of its rows (n_rows,)."""
        first = -self.seen % self.stride
        self.seen += len(block)
        self.blocks.append(np.array(block[first :: self.stride]))
        self.rows.append(rows[first :: self.stride])
        self.kept += len(self.rows[-1])
        if self.kept > MOST_ROWS:
            block, rows = np.concatenate(self.blocks)[::2], np.concatenate(self.rows)[::2]
            self.blocks, self.rows, self.kept = [block.copy()], [rows.copy()], len(rows)
            self.stride *= 2

    def columns(self) -> tuple[dict[str, FloatArray], IntArray]:
        """The columns by name, (n_rows,) each, and the numbers of the rows."""
        if not self.blocks:
            return {name: np.zeros(0) for name in self.names}, np.zeros(0, dtype=np.int64)
        block = np.concatenate(self.blocks)
        self.blocks = []
        return {name: np.ascontiguousarray(block[:, k]) for k, name in enumerate(self.names)}, np.concatenate(self.rows)

    def notes(self) -> list[str]:
        """What was left out, in sentences."""
        if self.stride == 1:
            return []
        return [f"the log has {self.seen} rows; every {self.stride}th was kept, {self.kept} in all"]


@dataclass
class BadCells:
    """Cells of one column that are no numbers: how many, and the first."""

    count: int = 0
    row: int = 0
    text: str = ""


_ONE, _SEVERAL = ("cell", "says no side or ", "is no number"), ("cells", "say no side or ", "are no numbers")


class Cells:
    """Turns cells into numbers and remembers what could not be turned."""

    def __init__(self, log_map: LogMap):
        self.missing = {*MISSING, *(one.lower() for one in log_map.missing)}
        self.decimal, self.thousands = log_map.decimal, log_map.thousands
        self.doubted: dict[str, BadCells] = {}
        self.numbers = [one for text in log_map.missing if (one := number_in(text, self.decimal)) is not None]
        self.bad: dict[str, BadCells] = {}
        self.stated: dict[str, str] = {}
        self.sided: set[str] = set()
        self.plain: dict[str, int] = {}
        self.parted: dict[str, str] = {}
        places = [log_map.sources[name].column for name in HEMISPHERES if name in log_map.sources]
        self.paired = HEMISPHERES if len(places) == 2 and places[0] is not None and places[0] == places[1] else {}
        self.ddmm = {name for name, source in log_map.sources.items() if source.unit == DDMM}

    def of(self, name: str, values: Any, rows: IntArray) -> FloatArray:
        """Numbers (n_rows,) of a pandas column, NaN where a cell holds none."""

        side_said = says_more = False
        if holds_numbers(values):
            numbers = values.to_numpy(dtype=np.float64, na_value=np.nan)
        else:
            text = values.astype("string").str.strip()
            # One text in it leaves a column of numbers as texts, decimal commas and all.
            numbers = numbers_in(text, self.decimal, self.thousands)
            if self.thousands is None and name not in self.doubted and in_thousands(text, self.decimal) is None:
                first = first_marked(text, self.decimal)
                self.doubted[name] = BadCells(1, int(rows[first]), str(text.iloc[first]))
            there = ~text.str.lower().isin(self.missing).to_numpy() & text.notna().to_numpy()
            if name in self.paired:
                numbers, self.stated[name], says_more = pair_in(text)[name], "deg", True
            elif name in HEMISPHERES and np.isnan(numbers).any():
                written = degrees(text)
                # One way of writing in a column: a plain number among others is of no known unit.
                if np.isfinite(written).any():
                    numbers, self.stated[name], says_more = written, "deg", True
            elif takes_side(name) and np.isnan(numbers).any():
                numbers = np.where(there & midships(text), 0.0, numbers)
                with_side = np.where(there, sided(text, self.decimal), np.nan)
                # Zeros alone say no side.
                if (np.isfinite(with_side) & np.isnan(numbers)).any():
                    numbers, side_said = with_side, True
            if there.any() and np.isnan(numbers[there]).all():
                with_unit, unit = numbers_with_unit(text.where(there), self.decimal)
                if unit and self.stated.get(name, unit) == unit:
                    numbers, self.stated[name], says_more = with_unit, unit, True
            wrong = np.isnan(numbers) & there
            if wrong.any():
                k = int(np.flatnonzero(wrong)[0])
                bad = self.bad.setdefault(name, BadCells(0, int(rows[k]), str(text.iloc[k])))
                bad.count += int(wrong.sum())
        for number in self.numbers:
            numbers = np.where(numbers == number, np.nan, numbers)
        if name in self.ddmm and not says_more:
            numbers, self.stated[name], says_more = self._of_ddmm(name, numbers, rows), "deg", True
        if side_said:
            self.sided.add(name)
        elif not says_more and (plain := np.flatnonzero(np.abs(numbers) > 0.0)).size:
            self.plain.setdefault(name, int(rows[plain[0]]))
        return np.asarray(numbers)

    def _of_ddmm(self, name: str, numbers: FloatArray, rows: IntArray) -> FloatArray:
        """Degrees of numbers that hold degrees and minutes in one; what is none is noted."""
        found = of_ddmm(numbers)
        wrong = np.flatnonzero(np.isnan(found) & np.isfinite(numbers))
        if len(wrong):
            shown = f"{numbers[wrong[0]]:.10g}"
            self._makes_none(name, len(wrong), int(rows[wrong[0]]), shown, "minutes are less than 60")
        return found

    def _makes_none(self, name: str, count: int, row: int, shown: str, why: str) -> None:
        """Note cells of a latitude or longitude that make none; of several reasons the first is told."""
        self.parted.setdefault(name, why)
        self.bad.setdefault(name, BadCells(0, row, shown)).count += count

    def position_of(self, name: str, columns: Mapping[str, Any], rows: IntArray) -> FloatArray:
        """Degrees (n_rows,) of pandas columns that hold a part of a latitude or longitude each, by what they hold."""
        found = position_of(name, columns, self.decimal, self.missing, self.numbers, name in self.ddmm)
        self.stated[name] = "deg"
        wrong = np.any(list(found.wrong.values()), axis=0)
        if wrong.any():
            k = int(np.flatnonzero(wrong)[0])
            cells = [str(one.iloc[k]) for one in columns.values()]
            shown = next((one for one in cells if is_unit(one)), " ".join(cells))
            why = next(reason for reason, of in found.wrong.items() if of[k])
            self._makes_none(name, int(wrong.sum()), int(rows[k]), shown[:80], why)
        return found.degrees

    def judge(self, table: Table, log_map: LogMap, n_rows: int) -> None:
        """Note cells that are no numbers.  Raises LogError where they say that the log is to be read differently."""
        problems = []
        for name, cell in self.doubted.items():
            place = f"{table.path}, {table.unit} {cell.row}, column '{table.headers[name]}'"
            problems.append(either_way(cell.text, place))
        table.stated |= self.stated
        table.sided = tuple(name for name in table.columns if name in self.sided)
        no_side, plainly = "only some cells of the column say a side, such as 10 P", "those to starboard positive"
        for name in set(self.stated) & set(self.plain):  # of a long log too
            place = f"{table.path}, {table.unit} {self.plain[name]}, column '{table.headers[name]}'"
            what, why = f"only some cells of the column say a unit, {self.stated[name]}", "here a number has none"
            problems.append(Problem(what, place, why, "write the column as plain numbers in one unit"))
        for name in self.sided & set(self.plain):  # a long log, read in blocks that differ
            place = f"{table.path}, {table.unit} {self.plain[name]}, column '{table.headers[name]}'"
            fix = f"write the column as plain numbers, {plainly}"
            problems.append(Problem(no_side, place, "here a number has none", fix))
        units: dict[int, str] = {}
        for name, bad in self.bad.items():
            place = f"{table.path}, {table.unit} {bad.row}, column '{table.headers[name]}'"
            first = is_unit(bad.text) and bad.row <= table.rows.min(initial=bad.row)
            if first:
                table.below[name] = canonical(bad.text)
            if first and bad.count == 1:
                units[bad.row] = f"line {bad.row} holds units"
                continue
            if name in self.parted:
                said = f"{bad.count} of {n_rows} rows make no {name}, the first is '{bad.text}'"
                if bad.count > 0.5 * n_rows:
                    keys = ("unit", "hemisphere") if name in self.ddmm else POSITION_PARTS
                    fix = f"correct column, {', '.join(keys)} in [columns.{name}]"
                    what = f"the columns of '{name}' make no {name}"
                    problems.append(Problem(what, place, f"{said}: {self.parted[name]}", fix))
                else:
                    table.notes.append(f"{said} (line {bad.row}): {self.parted[name]}; taken as gaps")
                continue
            noun, no_side_said, no_number = _ONE if bad.count == 1 else _SEVERAL
            what = f"{no_side_said if name in self.sided else ''}{no_number}"
            cells = f"{bad.count} {noun} of {n_rows} {what}, the first is '{bad.text}'"
            if name in self.sided and bad.count > 0.5 * n_rows:
                fix = f"write the column as plain numbers, {plainly}"
                problems.append(Problem(no_side, place, cells, fix))
            elif re.fullmatch(r"[-+]?\d*,\d+([eE][-+]?\d+)?", bad.text):
                fix = 'decimal = "," in [log], if the comma is the decimal sign'
                problems.append(Problem("numbers with a comma in them", place, cells, fix))
            elif takes_side(name) and SIGNED.fullmatch(bad.text):
                fix = f"write the column as plain numbers, {plainly}, and remove the sides"
                problems.append(Problem("a cell has both a sign and a side", place, cells, fix))
            elif match := None if is_unit(bad.text) else WITH_UNIT.fullmatch(bad.text):
                fix = "write the column in one unit, as plain numbers, and say the unit in the map"
                problems.append(Problem(f"a cell has a unit of its own, '{match.group(2)}'", place, cells, fix))
            elif bad.count > 0.5 * n_rows:
                fix = f"name the column that holds '{name}'; texts for no value go into missing = [...] of [log]"
                problems.append(Problem(f"the column of '{name}' holds text", place, cells, fix))
            else:
                table.notes.append(f"{name}: {cells} (line {bad.row}); taken as gaps")
        table.notes += units.values()
        if problems:
            raise LogError(*problems)
        table.leave_out(units)
