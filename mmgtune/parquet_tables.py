"""Columns written as Parquet, without what pyarrow would load for it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .arrays import BoolArray
from .files import atomic


def write_table(
    path: Path,
    columns: Mapping[str, Any],
    group_rows: int | None = None,
    *,
    overwrite: bool = True,
    metadata: Mapping[bytes, bytes] | None = None,
) -> None:
    """Columns of numbers, truths and texts (n_rows,) to a Parquet file, whole or not at all.

    group_rows  rows of a group; as many as pyarrow takes by itself where None
    metadata    of the schema, to be read beside the columns
    Made of their buffers: what pyarrow does with arrays by itself would load pandas, which takes longer than the rest.
    Raises OutputError where the file exists and ``overwrite`` is false, or the system refuses to write.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    with atomic(path, overwrite) as part:
        made = {name: _column(np.asarray(values)) for name, values in columns.items()}
        schema = pa.schema([(name, column.type) for name, column in made.items()], metadata=metadata)
        batch = pa.RecordBatch.from_arrays(list(made.values()), schema=schema)
        table = pa.Table.from_batches([batch])
        pq.write_table(table, part, compression="zstd", row_group_size=group_rows, write_page_checksum=True)


def _column(values: np.ndarray) -> Any:
    """An Arrow array of an array (n_rows,)."""
    import pyarrow as pa

    n = len(values)
    if values.dtype.kind in "OU":
        raw = [str(one).encode("utf-8", "replace") for one in values]
        ends = np.concatenate([[0], np.cumsum([len(one) for one in raw])]).astype("<i8")
        return pa.Array.from_buffers(pa.large_string(), n, [None, pa.py_buffer(ends), pa.py_buffer(b"".join(raw))])
    if values.dtype == bool:
        return pa.Array.from_buffers(pa.bool_(), n, [None, pa.py_buffer(_bits(values))])
    kind = pa.int64() if values.dtype.kind == "i" else pa.float64()
    whole = np.ascontiguousarray(values, dtype="<i8" if values.dtype.kind == "i" else "<f8")
    return pa.Array.from_buffers(kind, n, [None, pa.py_buffer(whole)])


def _bits(values: BoolArray) -> bytes:
    return np.packbits(values, bitorder="little").tobytes()
