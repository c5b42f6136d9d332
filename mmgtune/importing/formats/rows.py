"""Columns that a map names, turned block by block into rows of numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import IntArray
from ...errors import LogError, Problem, closest
from ...phrases import listed
from ..cells.headers import columns_called, find_column
from ..cells.time_parts import WORDS, TimeParts
from ..clock import Stamps
from ..maps.mapping import LogMap
from ..maps.quantities import meaning
from .table import TIME, Cells, Collector, Table

Wanted = dict[str, dict[str, int]]
"""Positions of the columns that quantities are read from, time first, each by what it holds of its quantity."""


class Rows:
    """Gathers the rows of a log.

    wanted  the columns that the map names, of those called ``names``
    """

    def __init__(self, path: Path, log_map: LogMap, names: Sequence[str], wanted: Wanted):
        self.path, self.log_map, self.wanted, self.names = path, log_map, wanted, names
        self.cells = Cells(log_map)
        self.collector = Collector(list(wanted))
        self.stamps: Stamps | TimeParts = Stamps(log_map.time, path, log_map.decimal, log_map.thousands)
        if log_map.time.parts:
            shown = {unit: names[k] for unit, k in wanted[TIME].items()}
            self.stamps = TimeParts(shown, path, log_map.decimal)

    @property
    def as_texts(self) -> set[int]:
        """Columns to be read as texts: as whole numbers -0 degrees have no sign."""
        return {k for name, of in self.wanted.items() if name != TIME and len(of) > 1 for k in of.values()}

    def add(self, column: Callable[[int], Any], rows: IntArray) -> None:
        """Take a block: a pandas column for each position, and the numbers of its rows in the file (n_rows,)."""
        times = {part: column(k) for part, k in self.wanted[TIME].items()}
        t = self.stamps.of(times) if isinstance(self.stamps, TimeParts) else self.stamps.of(times[""], rows)
        values = [
            self.cells.position_of(name, {part: column(k) for part, k in of.items()}, rows)
            if len(of) > 1
            else self.cells.of(name, column(of[""]), rows)
            for name, of in self.wanted.items()
            if name != TIME
        ]
        self.collector.add(np.column_stack([t, *values]), rows)

    def table(self, unit: str) -> Table:
        """All rows as a table; ``unit`` is what rows are called.  Its cells are judged by ``judge``."""
        found, numbers = self.collector.columns()
        t = found.pop(TIME)
        headers = {name: self.names[next(iter(of.values()))] for name, of in self.wanted.items()}
        notes = [*self.stamps.notes, *self.collector.notes()]
        stated = {TIME: self.stamps.stated} if self.stamps.stated else {}
        return Table(self.path, t, found, numbers, headers, self.stamps.clock, unit, notes, stated)

    def judge(self, table: Table) -> None:
        """Note cells that are no numbers.  Raises LogError where they say that the log is to be read differently."""
        self.cells.judge(table, self.log_map, len(table.t))


def columns_named(log_map: LogMap, names: Sequence[str], where: str) -> Wanted:
    """Positions of the columns that a map names.  Raises LogError naming all that are not there."""
    asked = {TIME: log_map.time.columns}
    asked |= {name: source.columns for name, source in log_map.sources.items() if source.column is not None}
    found: Wanted = {}
    problems = []
    for name, columns in asked.items():
        for part, column in columns.items():
            k = find_column(column, names)
            if k is not None:
                found.setdefault(name, {})[part] = k
                continue
            holds = "time" if name == TIME else meaning(name)
            holds = f"{WORDS.get(part, part)} of {holds}" if part else holds
            if isinstance(column, int):
                what, fix = f"the log has no column {column}", f"it has {len(names)} columns"
            elif len(same := columns_called(column, names)) > 1:
                shown = listed([str(k + 1) for k in same])
                what = f"column '{column}' is there {'twice' if len(same) == 2 else f'{len(same)} times'}"
                what, fix = f"{what}: columns {shown}", f"give its number in place of its name, such as {same[0] + 1}"
            else:
                what, fix = f"column '{column}' is missing from the log", closest(column, names)
            problems.append(Problem(what, where, f"the map says it holds {holds}", fix))
    for name, of in found.items():
        twice = next((k for k in of.values() if list(of.values()).count(k) > 1), None)
        if twice is not None:
            what = f"column '{names[twice]}' is named twice for {'time' if name == TIME else meaning(name)}"
            why = "each column holds one part of it"
            problems.append(Problem(what, where, why, "name another column for one of the parts"))
    if problems:
        raise LogError(*problems)
    return found
