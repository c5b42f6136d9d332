"""Parts of a log that have times of their own, such as a sheet or a structure for each sensor, as one table.

A row of the table holds what was logged at its time; cells of what was not are empty, as in logs that programs merge.
Nothing is interpolated here: the importer brings each quantity to the time axis of the trial as it does for those.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import LogError
from ...phrases import listed
from ..cells.numerals import holds_numbers
from ..clock import Stamps
from ..maps.mapping import TimeSource

SAME = 0.01
"""Share of the shortest step up to which two times are one."""
REPEATED = 0.01
"""Share of the times of a part that may be there twice: which value belongs to which time is not known of more."""
COMMON = 0.5
"""Share of the longest part that all have to have in common."""


class Apart(Exception):
    """Parts whose times do not allow to put them together; the words say why."""


@dataclass(frozen=True, eq=False)
class Part:
    """A sheet, or a structure.

    times    as it holds them, a pandas column (n_rows,)
    names, columns  of what it logged: pandas columns (n_rows,)
    """

    name: str
    times: Any
    names: Sequence[str]
    columns: Sequence[Any]


@dataclass(frozen=True, eq=False)
class Joined:
    """One table of several parts, whose names are those of their columns.

    times    a pandas column (n_rows,), as the parts hold them
    columns  pandas columns (n_rows,), empty where a part has no such time
    note     what was done, in a sentence
    """

    times: Any
    names: list[str]
    columns: list[Any]
    note: str


def joined(parts: Sequence[Part], path: Path, source: TimeSource = TimeSource()) -> Joined:
    """Parts put together by their times.

    path    of the log, for messages
    source  how times are written, as the map says

    Raises Apart where a part has no times that rise, where times are there more than once, and where the parts have
    less than half of their time in common.
    """
    import pandas as pd

    stamps = Stamps(source, path)  # one for all: it counts dates from the first there is
    read = [_rising(one, stamps) for one in parts]
    steps = [float(np.median(np.diff(t))) for t, _ in read]
    begins, ends = max(float(t[0]) for t, _ in read), min(float(t[-1]) for t, _ in read)
    longest = max(float(t[-1] - t[0]) for t, _ in read)
    if ends - begins < COMMON * longest:
        spans = ", ".join(
            f"'{one.name}' has {t[0]:.10g} to {t[-1]:.10g} s" for one, (t, _) in zip(parts, read, strict=True)
        )
        raise Apart(f"they have too little time in common: {spans}")
    every = np.concatenate([t for t, _ in read])
    order = np.argsort(every, kind="stable")
    anew = np.concatenate([[True], np.diff(every[order]) > SAME * min(steps)])
    row = np.empty(len(every), dtype=np.int64)
    row[order] = np.cumsum(anew) - 1
    count = int(row.max()) + 1
    texts = not all(holds_numbers(one.times) for one in parts)
    times = np.full(count, None, dtype=object) if texts else np.full(count, np.nan)
    names: list[str] = []
    columns: list[Any] = []
    last = 0
    for part, (t, kept) in zip(parts, read, strict=True):
        places = row[last : last + len(t)]
        last += len(t)
        # Where several parts have a time it is as the first of them says it.
        new = np.array([one is None for one in times[places]]) if texts else np.isnan(times[places])
        own = part.times.astype("string") if texts else part.times
        times[places[new]] = own.to_numpy(dtype=object if texts else np.float64, na_value=None if texts else np.nan)[
            kept
        ][new]
        for name, column in zip(part.names, part.columns, strict=True):
            numeric = holds_numbers(column)
            cells = np.full(count, np.nan) if numeric else np.full(count, None, dtype=object)
            values = column.to_numpy(dtype=np.float64, na_value=np.nan) if numeric else column.to_numpy(dtype=object)
            cells[places] = values[kept]
            names.append(name)
            columns.append(pd.Series(cells, dtype="float64" if numeric else "string"))
    return Joined(pd.Series(times, dtype="string" if texts else "float64"), names, columns, _told(parts, read, count))


def _rising(part: Part, stamps: Stamps) -> tuple[FloatArray, IntArray]:
    """Times [s, or as they are counted] of a part that rise, and the rows that they stand in.  Raises Apart."""
    try:
        t = stamps.of(part.times, np.arange(len(part.times), dtype=np.int64))
    except LogError as error:
        raise Apart(f"the times of '{part.name}' cannot be read: {error.problems[0].what}") from error
    kept = np.flatnonzero(np.isfinite(t))
    if len(kept) < 2:
        raise Apart(f"'{part.name}' has no times")
    steps = np.diff(t[kept])
    if (steps < 0.0).any():
        raise Apart(f"the times of '{part.name}' fall back, from {t[kept[:-1]][steps < 0.0][0]:.10g}")
    if (steps == 0.0).sum() > REPEATED * len(steps):
        raise Apart(f"{(steps == 0.0).sum()} of the times of '{part.name}' are there more than once")
    kept = kept[np.concatenate([[True], steps > 0.0])]
    return t[kept], kept


def _told(parts: Sequence[Part], read: Sequence[tuple[FloatArray, IntArray]], count: int) -> str:
    shown = listed([f"'{one.name}'" for one in parts], 8)
    if all(len(t) == count for t, _ in read):
        return f"{shown} have the same times and are put together"
    return (
        f"{shown} have times of their own ({', '.join(str(len(t)) for t, _ in read[:8])} of them) and are put together "
        f"by these: each of the {count} rows holds what was logged at its time"
    )
