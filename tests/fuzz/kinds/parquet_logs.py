"""Logs as Parquet: of other types, nested, compressed otherwise, with odd numbers, or damaged."""

from __future__ import annotations

import io
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from tests.importing.made import MAP, logged, turn

from ..mutating import mutated_bytes, odd_text, pick, several
from . import Files, Kind
from .csv_logs import imports

ODD = (np.nan, np.inf, -np.inf, 1e300, -1e300, 1e308, 1e9, -1e9, 1e-300, 0.0, 2.0**63)


def odd_values(rng: np.random.Generator, columns: dict[str, Any]) -> dict[str, Any]:
    """Some rows of a column, or all from somewhere on, of an odd value or scaled."""
    name = pick(rng, list(columns))
    values = np.array(columns[name])
    if not len(values) or values.dtype.kind != "f":
        return columns
    first = int(rng.integers(len(values)))
    rows = slice(first, first + int(pick(rng, (1, 2, len(values)))))
    with np.errstate(over="ignore"):
        values[rows] = pick(rng, ODD) if rng.random() < 0.5 else values[rows] * pick(rng, (-1.0, 10.0, 1e9, 1e300))
    return {**columns, name: values}


def other_type(rng: np.random.Generator, columns: dict[str, Any]) -> dict[str, Any]:
    """A column of something else than numbers."""
    name = pick(rng, list(columns))
    n = len(columns[name])
    made = pick(
        rng,
        (
            lambda: pa.array([odd_text(rng).encode("utf-8", "replace").decode() for _ in range(n)]),
            lambda: pa.array([None] * n),
            lambda: pa.array([[1.0]] * n),
            lambda: pa.array([{"a": 1}] * n),
            lambda: pa.array([True] * n),
            lambda: pa.array(np.arange(n), pa.timestamp("ns")),
            lambda: pa.array([k * 10**9 for k in range(n)], pa.int64()),
            lambda: pa.array([2**64 - 1] * n, pa.uint64()),
            lambda: pa.array(np.arange(n, dtype=np.float16)),
            lambda: pa.array([b"\xff"] * n),
            lambda: pa.array(["1"] * n).dictionary_encode(),
            lambda: pa.array(range(n), pa.duration("s")),
            lambda: pa.array(range(n), pa.date64()),
            lambda: pa.array(np.arange(n), pa.timestamp("us", "Pacific/Chatham")),
            lambda: pa.array([2**62] * n, pa.timestamp("us")),
            lambda: pa.array(range(n), pa.time32("s")),
            lambda: pa.array([Decimal("1.5")] * n, pa.decimal128(38, 20)),
            lambda: pa.array([Decimal(10**70)] * n, pa.decimal256(76, 3)),
            lambda: pa.array([[("a", 1.0)]] * n, pa.map_(pa.string(), pa.float64())),
            lambda: pa.array([{"a": [{"b": None}]}] * n),
            lambda: pa.array([[0.0, 1.0]] * n, pa.list_(pa.float64(), 2)),
            lambda: pa.array([b"1234"] * n, pa.binary(4)),
            lambda: pa.array([None if k % 2 else float(k) for k in range(n)]).dictionary_encode(),
            lambda: pa.array([2**63 - 1 - k for k in range(n)], pa.int64()),
            lambda: pa.array([1e-320 * k for k in range(n)]),
            lambda: pa.array(np.full(n, 3e38, dtype=np.float32)),
        ),
    )()
    return {**columns, name: made}


def shorter(rng: np.random.Generator, columns: dict[str, Any]) -> dict[str, Any]:
    """Only the first rows, or one, or none; or without a column."""
    if rng.random() < 0.3:
        gone = pick(rng, list(columns))
        return {name: values for name, values in columns.items() if name != gone} or columns
    rows = int(pick(rng, (0, 1, 2, 19, 20, 21)))
    return {name: values[:rows] for name, values in columns.items()}


def written(rng: np.random.Generator, columns: dict[str, Any], metadata: dict[bytes, bytes] | None = None) -> bytes:
    """A file of the columns, in one of many ways."""
    file = io.BytesIO()
    table = pa.table(columns).replace_schema_metadata(metadata)
    if rng.random() < 0.1:  # a name twice, or one that is none
        names = list(table.column_names)
        names[int(rng.integers(len(names)))] = pick(rng, (*names, "", "\x00", "x [m]", "X", " t", "t\n"))
        table = table.rename_columns(names)
    pq.write_table(
        table,
        file,
        compression=pick(rng, ("zstd", "snappy", "none", "gzip")),
        use_dictionary=bool(rng.random() < 0.5),
        row_group_size=int(pick(rng, (1, 7, 1000))),
    )
    return file.getvalue()


def make(rng: np.random.Generator) -> Files:
    """A log with something wrong in its columns or bytes."""
    columns: dict[str, Any] = {name: values[:120] for name, values in logged(turn()).items()}
    how = rng.random()
    if how < 0.6:
        columns = several(rng, columns, [odd_values, odd_values, other_type, shorter])
    content = written(rng, columns)
    if how > 0.5:
        content = several(rng, content, [mutated_bytes])
    return {"log.parquet": content, "map.toml": MAP.encode()}


def run(folder: Path) -> str:
    """Import it."""
    return imports(folder, "log.parquet")


KIND = Kind("parquet", make, run)
