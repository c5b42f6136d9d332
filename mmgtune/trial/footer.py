"""What a Parquet file's footer says that reading it would take, held against the limits before it is read."""

from __future__ import annotations

from typing import Any

from ..errors import MmgtuneError, Problem
from ..limits import FOOTER_VALUES, FREE_ROWS, PARQUET_BYTES, ROWS_PER_BYTE, Limit


def rows_of(metadata: Any, size: int, where: str, error: type[MmgtuneError], unpacked: Limit = PARQUET_BYTES) -> int:
    """The rows of a file, from its footer (``pyarrow.parquet.FileMetaData``).

    size      of the file [bytes]
    unpacked  the most it may expand to

    Raises ``error`` where the file would expand beyond the limits; ValueError where the footer contradicts itself.
    """
    FOOTER_VALUES.require(metadata.num_row_groups * metadata.num_columns, where, error)
    groups = [metadata.row_group(k) for k in range(metadata.num_row_groups)]
    rows: int = sum(one.num_rows for one in groups)
    if rows != metadata.num_rows or any(one.num_rows < 0 or one.total_byte_size < 0 for one in groups):
        raise ValueError("its footer contradicts itself")
    most = FREE_ROWS + ROWS_PER_BYTE * size
    if rows > most:
        why = f"no measurement packs {rows} rows into {size} bytes; the limit for a file of this size is {most} rows"
        raise error(
            Problem("the file expands far beyond what it can hold", where, why, "do not use it: ask its source")
        )
    unpacked.require(sum(one.total_byte_size for one in groups), where, error, "unpacked")
    return rows
