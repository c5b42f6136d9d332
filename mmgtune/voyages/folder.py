"""The run folder of a validation on voyages: each file whole or not there."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import BoolArray
from ..backends import STATES
from ..files import atomic, write_text
from ..fitting.journal import finished
from ..trial.parquet import GROUP_ROWS
from .result import VoyageValidation

RESULT = "voyages.json"


def write_voyages(result: VoyageValidation, folder: Path) -> dict[str, Any]:
    """Write the windows, those that are drawn and, last, the result.  Returns its document."""
    if result.table is not None:
        write_table(folder / "windows.parquet", result.columns())
        write_table(folder / "drawn.parquet", _drawn(result))
    document = {**result.to_dict(), "out": str(folder)}
    write_text(folder / RESULT, json.dumps(document, indent=1, allow_nan=False, ensure_ascii=False) + "\n")
    if not result.interrupted:
        finished(folder)
    return document


def _drawn(result: VoyageValidation) -> dict[str, Any]:
    """Columns of drawn.parquet: the windows that are drawn, as measured and as every model has them."""
    assert result.table is not None
    parts: dict[str, list[Any]] = {name: [] for name in ("window", "model", "measured", "t", *STATES, "delta")}
    for one in result.drawn:
        for name, states, is_measured in (
            ("", one.measured, True),
            *((name, states, False) for name, states in one.states.items()),
        ):
            n = len(one.t)
            parts["window"].append(np.full(n, result.table.ids[one.place], dtype=object))
            parts["model"].append(np.full(n, name, dtype=object))
            parts["measured"].append(np.full(n, is_measured))
            parts["t"].append(one.t)
            for state, values in zip(STATES, states[:n].T, strict=True):
                parts[state].append(values)
            parts["delta"].append(one.delta)
    return {name: np.concatenate(values) for name, values in parts.items() if values}


def write_table(path: Path, columns: dict[str, Any]) -> None:
    """Columns of numbers, truths and texts (n_rows,) to a Parquet file, whole or not at all.

    Made of their buffers: what pyarrow does with arrays by itself would load pandas, which takes longer than the rest.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    with atomic(path) as part:
        table = pa.table({name: _column(np.asarray(values)) for name, values in columns.items()})
        pq.write_table(table, part, compression="zstd", row_group_size=GROUP_ROWS, write_page_checksum=True)


def _column(values: np.ndarray) -> Any:
    """An Arrow array of an array (n_rows,)."""
    import pyarrow as pa

    n = len(values)
    if values.dtype == object:
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
