"""Reading Parquet logs, in batches of rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import LogError, Problem
from .clock import Stamps
from .mapping import LogMap
from .table import TIME, Cells, Collector, Table
from .text import columns_named

BATCH = 100_000


def read_parquet(path: Path, log_map: LogMap) -> Table:
    """The columns of a Parquet log that a map names.  Raises LogError where it cannot be read or lacks one."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        # No worker threads: one still starting when the program ends would abort it.
        file = pq.ParquetFile(path, pre_buffer=False)
        names = list(file.schema_arrow.names)
        wanted = columns_named(log_map, names, path, str(path))
        order = list(wanted)
        collector, cells, stamps = Collector(order), Cells(log_map), Stamps(log_map.time, path)
        row = 1
        columns = sorted({names[k] for k in wanted.values()})
        for batch in file.iter_batches(BATCH, columns=columns, use_threads=False):
            block = batch.to_pandas(use_threads=False)
            rows = np.arange(row, row + len(block), dtype=np.int64)
            row += len(block)
            t = stamps.of(block[names[wanted[TIME]]], rows)
            values = [cells.of(name, block[names[wanted[name]]], rows) for name in order[1:]]
            collector.add(np.column_stack([t, *values]), rows)
    except (OSError, ValueError, pa.ArrowException) as error:
        why = (str(error).splitlines() or [""])[0]
        raise LogError(Problem("the Parquet log cannot be read", str(path), why, "copy it again")) from error
    found, numbers = collector.columns()
    t = found.pop(TIME)
    headers = {name: names[k] for name, k in wanted.items()}
    table = Table(path, t, found, numbers, headers, stamps.clock, "row", [*stamps.notes, *collector.notes()])
    cells.judge(table, log_map, len(t))
    return table
