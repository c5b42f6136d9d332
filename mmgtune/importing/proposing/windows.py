"""Columns of a log seen through windows: what they are on average, and how fast they change."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from ...arrays import FloatArray
from ...trial.motion_checks import spikes
from ..clock import uniform
from ..mapping import TimeSource
from ..record import unwrapped

MOST = 120
"""Windows of a log."""
ROWS = 12_000
"""Rows that are looked at, spread over the log."""


class Windows:
    """A log in windows of equal numbers of rows.

    t        (n_rows,) time [s], strictly increasing
    columns  (n_rows,) each, spikes taken out, angles that wrap unwrapped
    periods  of each column: what it wraps by (360 or 2 pi, in its own unit), 0 where it does not
    """

    def __init__(self, t: FloatArray, columns: Sequence[FloatArray]):
        even = uniform(t[np.isfinite(t)], TimeSource()) if np.isfinite(t).all() else None
        t = even[0] if even is not None else t
        known = np.isfinite(t)
        best = np.maximum.accumulate(np.where(known, t, -np.inf))
        kept = np.flatnonzero(known & (np.concatenate([[True], t[1:] > best[:-1]])))
        kept = kept[:: max(1, len(kept) // ROWS)]
        self.t = t[kept]
        self.rows = kept
        self.periods = [period(one[kept]) for one in columns]
        self.columns = [_clean(one[kept], turn) for one, turn in zip(columns, self.periods, strict=True)]
        count = int(np.clip(len(kept) // 6, 2, MOST))
        self.edges = np.unique(np.linspace(0, max(1, len(kept) - 1), count + 1).astype(np.intp))

    def at_edges(self, values: FloatArray) -> FloatArray:
        """(n_windows + 1,) what values (n_rows,) are around the edges."""
        half = max(0, int(np.diff(self.edges).min(initial=1)) // 4)
        return np.array([_middle(values[max(0, k - half) : k + half + 1]) for k in self.edges])

    def slope(self, values: FloatArray) -> FloatArray:
        """(n_windows,) change per second."""
        half = max(0, int(np.diff(self.edges).min(initial=1)) // 4)
        at = np.array([_middle(self.t[max(0, k - half) : k + half + 1]) for k in self.edges])
        return np.asarray(np.diff(self.at_edges(values)) / np.diff(at))

    def mean(self, values: FloatArray) -> FloatArray:
        """(n_windows,) mean of values (n_rows,)."""
        known = np.isfinite(values)
        sums, counts = (
            np.concatenate([[0.0], np.cumsum(one)]) for one in (np.where(known, values, 0.0), known.astype(np.float64))
        )
        first, last = self.edges[:-1], self.edges[1:]
        number = counts[last] - counts[first]
        return np.where(number > 0, (sums[last] - sums[first]) / np.maximum(number, 1.0), np.nan)

    @property
    def enough(self) -> bool:
        """Whether there is a motion to look at."""
        return len(self.edges) > 8


def period(values: FloatArray) -> float:
    """What a column wraps by: 360 or 2 pi where it jumps by about that and spans no more, else 0."""
    known = values[np.isfinite(values)]
    if len(known) < 10:
        return 0.0
    steps, span = np.abs(np.diff(known)), float(np.ptp(known))
    for turn in (360.0, 2.0 * np.pi):
        if span <= 1.02 * turn and span > 0.8 * turn:
            jumps = steps > 0.7 * turn
            if 0 < jumps.sum() < 0.1 * len(steps) and np.median(steps) < 0.05 * turn:
                return turn
    return 0.0


def _clean(values: FloatArray, turn: float) -> FloatArray:
    out = unwrapped(values, turn) if turn else np.array(values)
    if np.isfinite(out).sum() > 10:
        out[spikes(out, share=0.02)] = np.nan
    return out


def _middle(values: FloatArray) -> float:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        return float(np.nanmedian(values)) if len(values) else float("nan")
