"""The run folder of a validation on voyages: each file whole or not there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..backends import STATES
from ..fitting.journal import finished
from ..parquet_tables import write_table
from ..run_files import DRAWN_WINDOWS, VOYAGES, WINDOWS
from ..trial.parquet import GROUP_ROWS
from ..writing_results import place_for, write_record
from .result import VoyageValidation


def write_voyages(result: VoyageValidation, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write the windows, those that are drawn and, last, the result.  Returns its document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, VoyageValidation, folder, VOYAGES, overwrite=overwrite) as place:
        if result.table is not None:
            write_table(place / WINDOWS, result.columns(), GROUP_ROWS)
            write_table(place / DRAWN_WINDOWS, _drawn(result), GROUP_ROWS)
        document = write_record(result.to_dict(), place, VOYAGES)
        if not result.interrupted:
            finished(place)
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
