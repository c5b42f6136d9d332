"""Stated indices beside what models make of them, for the terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def stated_table(rows: Sequence[Mapping[str, Any]], which: Sequence[str] = ("before", "after")) -> list[str]:
    """Lines of a table: stated with its tolerance, then each simulation, in the units people read.

    rows   as ``IndexComparison.to_dict`` gives them
    which  names of the simulations
    """
    width = max([12, *(len(f"{row['trial']} ({row['role']})") for row in rows)]) + 2
    head = f"{'trial':<{width}}{'index':<26}{'stated':>22}" + "".join(f"{name[-14:]:>16}" for name in which)
    lines = [head, ""]
    for row in rows:
        mark = "*" if row["assumed_tolerance"] else " "
        unit = row["unit"]
        stated = f"{row['stated']:.4g} +- {row['tolerance']:.2g}{mark} {unit:<3}"
        made = "".join(f"{'never' if row[name] is None else format(row[name], '.4g'):>16}" for name in which)
        called = f"{row['trial']} ({row['role']})"
        lines.append(f"{called:<{width}}{row['words']:<26}{stated:>22}{made}")
    if any(row["assumed_tolerance"] for row in rows):
        lines.append("* tolerance assumed by mmgtune, none is given")
    return lines
