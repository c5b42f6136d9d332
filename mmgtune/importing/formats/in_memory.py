"""Columns that are in memory as a whole, of workbooks and MATLAB files, as the table of a log."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..maps.mapping import LogMap
from .rows import Rows, columns_named
from .table import Table


def table_of(
    path: Path, log_map: LogMap, names: Sequence[str], columns: Sequence[Any], first: int, unit: str, where: str
) -> Table:
    """The columns that a map names.

    names, columns  (n_columns,) of the log: names, and pandas columns of one length
    first, unit     number of the first row in the file, and what rows are called there
    where           the header is, for messages

    Raises LogError where the log lacks a column, or a column holds something else than numbers.
    """
    gathered = Rows(path, log_map, names, columns_named(log_map, names, where))
    rows = first + np.arange(len(columns[0]) if columns else 0, dtype=np.int64)
    gathered.add(columns.__getitem__, rows)
    table = gathered.table(unit)
    gathered.judge(table)
    return table
