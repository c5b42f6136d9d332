"""Columns that are in memory as a whole, of workbooks and MATLAB files, as the table of a log."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .clock import Stamps
from .mapping import LogMap
from .table import TIME, Cells, Collector, Table
from .text import columns_named


def table_of(
    path: Path, log_map: LogMap, names: Sequence[str], columns: Sequence[Any], first: int, unit: str, where: str
) -> Table:
    """The columns that a map names.

    names, columns  (n_columns,) of the log: names, and pandas columns of one length
    first, unit     number of the first row in the file, and what rows are called there
    where           the header is, for messages

    Raises LogError where the log lacks a column, or a column holds something else than numbers.
    """
    wanted = columns_named(log_map, list(names), path, where)
    order = list(wanted)
    cells, collector = Cells(log_map), Collector([TIME, *order[1:]])
    stamps = Stamps(log_map.time, path, log_map.decimal)
    rows = first + np.arange(len(columns[0]) if columns else 0, dtype=np.int64)
    values = [
        stamps.of(columns[wanted[TIME]], rows),
        *(cells.of(name, columns[wanted[name]], rows) for name in order[1:]),
    ]
    collector.add(np.column_stack(values), rows)
    found, numbers = collector.columns()
    t = found.pop(TIME)
    headers = {name: names[k] for name, k in wanted.items()}
    table = Table(path, t, found, numbers, headers, stamps.clock, unit, [*stamps.notes, *collector.notes()])
    cells.judge(table, log_map, len(t))
    return table
