"""Reading Parquet logs, in batches of rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import LogError, Problem, reason
from ...limits import LOG_COLUMNS
from ...trial.footer import rows_of
from ..maps.mapping import LogMap
from .rows import Rows, Wanted, columns_named
from .table import Table

BATCH = 100_000
LONGEST = 200
"""Characters of a text that are looked at: numbers and times have fewer."""


def read_parquet(path: Path, log_map: LogMap) -> Table:
    """The columns of a Parquet log that a map names.  Raises LogError where it cannot be read or lacks one."""
    with being_read(path):
        schema = schema_of(path)
        names = list(schema.names)
        wanted = columns_named(log_map, names, str(path))
        gathered = Rows(path, log_map, names, wanted)
        row = 1
        _readable(schema, wanted, path)
        columns = sorted({names[k] for of in wanted.values() for k in of.values()})
        for batch in batches(path, schema, columns, BATCH):
            block = batch.to_pandas(use_threads=False)
            rows = np.arange(row, row + len(block), dtype=np.int64)
            row += len(block)
            gathered.add(partial(_column, block, names), rows)
    table = gathered.table("row")
    gathered.judge(table)
    return table


@contextmanager
def being_read(path: Path) -> Iterator[None]:
    """Raises LogError where a Parquet log turns out to be one that cannot be read."""
    import pyarrow as pa

    try:
        yield
    except (OSError, ValueError, pa.ArrowException) as error:
        why = reason(error)
        raise LogError(Problem("the Parquet log cannot be read", str(path), why, "copy it again")) from error


def schema_of(path: Path) -> Any:
    """Columns of a Parquet log by name and type.  Raises LogError for one of more columns or rows than are read."""
    file = _opened(path)
    LOG_COLUMNS.require(len(file.schema_arrow.names), str(path), LogError)
    rows_of(file.metadata, path.stat().st_size, str(path), LogError)
    return file.schema_arrow


def batches(path: Path, schema: Any, columns: Sequence[str], size: int) -> Iterator[Any]:
    """Some columns in batches of ``size`` rows, texts cut to what is looked at."""
    import pyarrow as pa

    texts = [name for name in columns if is_text(schema.field(name).type)]
    # A text stands in a file once, however many rows repeat it: it is cut before it is repeated.
    for batch in _opened(path, texts).iter_batches(size, columns=columns, use_threads=False):
        yield pa.RecordBatch.from_arrays([_shortened(one) for one in batch.columns], batch.schema.names)


def _opened(path: Path, repeated: Sequence[str] = ()) -> Any:
    import pyarrow.parquet as pq

    # No worker threads: one still starting when the program ends would abort it.
    return pq.ParquetFile(path, pre_buffer=False, page_checksum_verification=True, read_dictionary=list(repeated))


def _column(block: Any, names: Sequence[str], k: int) -> Any:
    return block[names[k]]


def _readable(schema: Any, wanted: Wanted, path: Path) -> None:
    """Raise LogError where a column needed is of a type that holds no numbers, times or texts, or is there twice."""
    import pyarrow as pa

    kinds = pa.types
    can = (kinds.is_floating, kinds.is_integer, kinds.is_decimal, kinds.is_boolean, kinds.is_null, kinds.is_temporal)
    problems = []
    for name, k in [(name, k) for name, of in wanted.items() for k in of.values()]:
        kind, header = schema.field(k).type, schema.names[k]
        if not is_text(kind) and not any(one(kind) for one in can):
            what = f"column '{header}' holds {str(kind)[:80]}, not numbers"
            problems.append(Problem(what, str(path), f"the map says it is '{name}'", "name another column"))
        if schema.names.count(header) > 1:
            problems.append(Problem(f"column '{header}' is there twice", str(path), fix="remove one of them"))
    if problems:
        raise LogError(*dict.fromkeys(problems))


def is_text(kind: Any) -> bool:
    import pyarrow as pa

    value = kind.value_type if pa.types.is_dictionary(kind) else kind
    return bool(pa.types.is_string(value) or pa.types.is_large_string(value))


def _shortened(column: Any) -> Any:
    """A column with the length of its texts bounded."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if not is_text(column.type):
        return column
    if not pa.types.is_dictionary(column.type):
        return pc.utf8_slice_codeunits(column, 0, LONGEST)
    short = pc.utf8_slice_codeunits(column.dictionary.cast(pa.string()), 0, LONGEST)
    return short.take(column.indices)
