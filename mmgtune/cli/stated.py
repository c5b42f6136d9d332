"""Stated indices beside what models make of them, for the terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from .output import table


def stated_table(rows: Sequence[Mapping[str, Any]], which: Sequence[str] = ("before", "after")) -> list[str]:
    """Lines of a table: stated with its tolerance, then each simulation, in the units people read.

    rows   as ``IndexComparison.to_dict`` gives them
    which  names of the simulations
    """
    cells = []
    for row in rows:
        mark = "*" if row["assumed_tolerance"] else " "
        stated = f"{row['stated']:.4g} +- {row['tolerance']:.2g}{mark} {row['unit']:<3}"
        made = ("never" if row[name] is None else format(row[name], ".4g") for name in which)
        cells.append((f"{row['trial']} ({row['role']})", row["words"], stated, *made))
    head, *rest = table(("trial", "index", "stated", *(name[-14:] for name in which)), cells, words=(0, 1))
    lines = [head, "", *rest]
    if any(row["assumed_tolerance"] for row in rows):
        lines.append("* tolerance assumed by mmgtune, none is given")
    return lines
