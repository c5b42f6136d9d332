"""The numbers behind the figures of motions: where the ship was, and how far off the simulation is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..manoeuvres.named import in_order
from .blocks import Cell, Table, cells
from .figures.tracks import distance_from
from .tables import tone
from .wording import NONE, PRINCIPAL, change, clean, fixed, index_words, is_index, number, percent

if TYPE_CHECKING:
    from .figures.tracks import Motion


def distances(
    results: Sequence[Mapping[str, Any]], motions: Mapping[str, Mapping[str, Motion]], words: Mapping[str, str]
) -> Table:
    """Greatest and final distance off track of every trial, of each of the runs that are named."""
    runs = [which for which in words if which != "measured"]
    rows = []
    for row in results:
        found = motions.get(str(row["id"]), {})
        line: list[str | Cell] = [clean(row["id"])]
        for which in runs:
            gap = np.empty(0)
            if which in found and "measured" in found:
                _, gap = distance_from(found[which], found["measured"])
            gap = gap[np.isfinite(gap)]
            line += [fixed(float(gap.max()), 1), fixed(float(gap[-1]), 1)] if len(gap) else [NONE, NONE]
        rows.append(cells(*line))
    heads = tuple(f"{end}, {words[which]} [m]" for which in runs for end in ("greatest", "last"))
    table_of = Table("distances-table", "Distance off track", ("trial", *heads), tuple(rows), range(1, 1 + len(heads)))
    return replace(table_of, raw=True)


def index_errors(results: Sequence[Mapping[str, Any]]) -> Table | None:
    """The mean absolute error of every index over the trials, before and after; None where there are none."""
    errors: dict[str, list[tuple[float, float]]] = {}
    for row in results:
        values = row.get("indices") or {}
        measured, before, after = (values.get(which) or {} for which in ("measured", "before", "after"))
        for key in filter(is_index, measured):
            true, first, last = (number(part.get(key)) for part in (measured, before, after))
            if true is not None and first is not None and last is not None:
                relative = 1.0 if index_words(key)[1] == "deg" else 100.0 / abs(true) if true else None
                if relative is not None:
                    errors.setdefault(key, []).append((abs(first - true) * relative, abs(last - true) * relative))
    rows = []
    for key in in_order(errors):
        pairs = errors[key]
        if key not in PRINCIPAL and errors.keys() & set(PRINCIPAL):
            continue
        words, unit = index_words(key)
        first, last = (sum(pair[side] for pair in pairs) / len(pairs) for side in (0, 1))
        mark = "\u00a0deg" if unit == "deg" else "\u00a0%"
        moved = change(first, last)
        rows.append(
            cells(
                words,
                str(len(pairs)),
                fixed(first, 1) + mark,
                fixed(last, 1) + mark,
                Cell(percent(moved), tone(moved, 1.0)),
            )
        )
    if not rows:
        return None
    return Table(
        "index-errors-table",
        "Mean size of the error over the trials",
        ("index", "trials", "before", "after", "change"),
        tuple(rows),
        numeric=range(1, 5),
    )
