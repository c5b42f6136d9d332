"""What differed from run to run, as a table in the report of a diagnosis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...units import DIMENSIONLESS, NORMAL_95, read_as
from ..blocks import Block, Prose, Table, cells
from ..wording import NONE, clean, number, shown


def of_runs(cause: Mapping[str, Any]) -> list[Block]:
    """The table of a cause, as ``Cause.to_dict`` has it; nothing where it is the same in all runs."""
    found = cause.get("by_run")
    if not found:
        return []
    largest = max((abs(number(row["size"]) or 0.0) for row in found["values"]), default=0.0)
    unit, factor = read_as(clean(found["unit"]), largest)
    head = "size" if found["unit"] in DIMENSIONLESS else f"size [{unit}]"
    directed = any(number(row["direction_deg"]) is not None for row in found["values"])
    apart = any(number(row.get("from_mean")) is not None for row in found["values"])
    rows = []
    for row in found["values"]:
        direction = number(row["direction_deg"])
        size = shown(None if row["size"] is None else factor * row["size"], 3), _half(row["size_stderr"], factor)
        where = (NONE if direction is None else f"{direction:.0f}°", _half(row["direction_stderr_deg"], 1.0))
        off, error = row.get("from_mean"), row.get("from_mean_stderr")
        beside = shown(None if off is None else factor * off, 3), _half(error, factor)
        rows.append(cells(clean(row["group"]), *size, *(where if directed else ()), *(beside if apart else ())))
    what = f"{clean(cause['effect']).capitalize()} of each {clean(found['by'])}, with its 95 % half width"
    return [
        Prose((clean(cause["sentence"]) + ".",)),
        Table(
            f"{clean(cause['effect'])}-of-runs",
            what,
            (
                clean(found["by"]),
                head,
                "±",
                *(("direction", "± [°]") if directed else ()),
                *(("from the mean of all", "±") if apart else ()),
            ),
            tuple(rows),
            tuple(range(1, 3 + 2 * directed + 2 * apart)),
        ),
    ]


def parameters_of(candidate: Mapping[str, Any]) -> list[str]:
    """Parameters of a hypothesis, and that each run has its own where it does; records of older versions do not say."""
    return [*candidate["parameters"], *(["of each run"] if candidate.get("by") else [])]


def _half(stderr: Any, factor: float) -> str:
    error = number(stderr)
    return NONE if error is None else shown(NORMAL_95 * factor * error, 2)
