"""Records cut where time jumps forward: the clock was set, or the logger was off."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..errors import LogError
from ..limits import LOG_PARTS
from .maps.mapping import LogMap
from .record import Record, Series

LONG = 1000.0
"""Steps without a row beyond which what follows is another record: a hole that no trial goes across."""

SILENT = 100
"""Such steps where what was logged before or behind lasted no longer: runs in one file, with a quarter of an hour
between them."""


def cut_at_jumps(record: Record, log_map: LogMap, step: float | None) -> list[Record]:
    """A record in parts between the jumps of its time, in their order; as it is where it has none.

    step  of the trials [s], None for the map's or the record's own

    A jump is a hole in all series at once that is longer than LONG steps, and than the map bridges, or than SILENT
    steps and than what was logged before it or behind it.  Raises LogError where there are more than the program goes
    through.
    """
    times = [one.t for one in record.series.values()]
    lead = record.series.get("latitude", record.series.get("x"))
    if lead is None or len(lead.t) < 2:
        return [record]
    own = float(np.median(np.diff(lead.t)))
    t = np.unique(np.concatenate(times))
    apart = np.diff(t)
    own = max(own, step or log_map.step or own)
    before = np.flatnonzero(apart > max(SILENT, log_map.gap) * own)
    ends = np.concatenate([[-1], before, [len(t) - 1]])
    lasted = t[ends[1:]] - t[ends[:-1] + 1]
    shorter = np.minimum(lasted[:-1], lasted[1:])
    before = before[apart[before] > np.minimum(max(LONG, log_map.gap) * own, shorter)]
    if not len(before):
        return [record]
    LOG_PARTS.require(len(before) + 1, str(record.path), LogError, f"time jumps forward {len(before)} times")
    k = int(before[0])
    how = "once" if len(before) == 1 else f"{len(before)} times"
    note = (
        f"time jumps forward {how}, by up to {apart[before].max():.6g} s, first from {t[k]:.12g} to {t[k + 1]:.12g} s: "
        "the record is cut there"
    )
    bounds = [-np.inf, *t[before + 1].tolist(), np.inf]
    parts = []
    for first, last in pairwise(bounds):
        series = {name: _between(one, first, last) for name, one in record.series.items()}
        parts.append(Record(record.path, {name: one for name, one in series.items() if len(one.t)}, {}, [note]))
    for part in parts:
        part.notes[:0] = record.notes
        part.coarse.update(record.coarse)
    parts[0].spikes.update(record.spikes)
    return parts


def _between(one: Series, first: float, last: float) -> Series:
    """The samples of a series at times from ``first`` to before ``last``."""
    rows = slice(*np.searchsorted(one.t, [first, last]).tolist())
    return Series(
        one.t[rows],
        one.values[rows],
        None if one.printed is None else one.printed[rows],
        None if one.coarse is None else one.coarse[rows],
    )
