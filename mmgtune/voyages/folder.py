"""The run folder of a validation on voyages: each file whole or not there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..backends import STATES
from ..documents import write_json
from ..errors import must_be_a
from ..files import all_or_none, path_of, refuse_existing
from ..fitting.journal import finished
from ..parquet_tables import write_table
from ..trial.parquet import GROUP_ROWS
from .result import VoyageValidation

RESULT = "voyages.json"


@all_or_none()
def write_voyages(result: VoyageValidation, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write the windows, those that are drawn and, last, the result.  Returns its document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    folder = path_of(folder)
    must_be_a(result, VoyageValidation, "result")
    refuse_existing([folder / RESULT], overwrite)
    if result.table is not None:
        write_table(folder / "windows.parquet", result.columns(), GROUP_ROWS)
        write_table(folder / "drawn.parquet", _drawn(result), GROUP_ROWS)
    document = {**result.to_dict(), "out": str(folder)}
    write_json(document, folder / RESULT)
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
