"""Columns of a log seen through windows: what they are on average, and how fast they change."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...trial.checks.motion_checks import spikes
from ...trial.headings import unwrapped
from ..cells.seldom import held
from ..clock import uniform
from ..maps.mapping import TimeSource

MOST = 120
"""Windows of a log."""
FEW = 12
"""Windows of a log of few rows, if these are three in each: of runs logged every ten seconds."""
ROWS, PARTS, PART = 12_000, 12, 400
"""Rows of a log that is looked at as a whole; of a longer one, so many parts of so many rows in which most happens,
since manoeuvres are shorter than a hundredth of a day."""
SELDOM = 3.0
"""For so many of its usual steps a value of a column logged seldom stands."""
PAUSE = 10.0
"""Usual steps from row to row; over a longer one a log paused, and what a ship did meanwhile is not in it."""


class Windows:
    """A log in windows of equal numbers of rows; what a window is over a pause longer than itself is not known.

    t        (n_rows,) time [s], strictly increasing
    columns  (n_rows,) each, what is logged seldom held from one value to the next, spikes taken out, angles that wrap
             unwrapped
    periods  of each column: what it wraps by (360 or 2 pi, in its own unit), 0 where it does not
    """

    def __init__(self, t: FloatArray, columns: Sequence[FloatArray]):
        even = uniform(t[np.isfinite(t)], TimeSource()) if np.isfinite(t).all() else None
        t = even[0] if even is not None else t
        known = np.isfinite(t)
        best = np.maximum.accumulate(np.where(known, t, -np.inf))
        kept = np.flatnonzero(known & (np.concatenate([[True], t[1:] > best[:-1]])))
        columns = [held(one[kept], SELDOM) for one in columns]
        busy = _busiest(columns, len(kept))
        kept, columns = kept[busy], [one[busy] for one in columns]
        self.t = t[kept]
        self.rows = kept
        resumed = np.zeros(len(kept), bool)
        if len(kept) > 1:
            steps = np.diff(self.t)
            resumed[1:] = steps > PAUSE * np.median(steps)
        self.periods = [period(one, resumed) for one in columns]
        self.columns = [_clean(one, turn) for one, turn in zip(columns, self.periods, strict=True)]
        count = int(np.clip(max(len(kept) // 6, min(FEW, len(kept) // 3)), 2, MOST))
        self.edges = np.unique(np.linspace(0, max(1, len(kept) - 1), count + 1).astype(np.intp))
        self.pauses = self._pauses(resumed)

    def _pauses(self, resumed: BoolArray) -> BoolArray:
        """(n_windows,) whether a window, or what is taken around its edges, holds a pause longer than a window is."""
        found = np.zeros(len(self.edges) - 1, bool)
        if not resumed.any():
            return found
        usual = float(np.median(np.diff(self.t[self.edges])))
        half = self._half
        for k in np.flatnonzero(resumed):
            if self.t[k] - self.t[k - 1] > usual:
                found |= (self.edges[:-1] - half < k) & (k <= self.edges[1:] + half)
        return found if found.mean() < 0.5 else np.zeros_like(found)

    @property
    def _half(self) -> int:
        """Rows on either side of an edge that are taken with it."""
        return int(np.diff(self.edges).min()) // 4 if len(self.edges) > 1 else 0

    def at_edges(self, values: FloatArray) -> FloatArray:
        """(n_windows + 1,) what values (n_rows,) are around the edges."""
        around = self.edges[:, None] + np.arange(-self._half, self._half + 1)
        there = (around >= 0) & (around < len(values))
        return _middles(np.where(there, values[np.where(there, around, 0)], np.nan))

    @cached_property
    def _times(self) -> FloatArray:
        """(n_windows + 1,) when the edges are."""
        return self.at_edges(self.t)

    def slope(self, values: FloatArray) -> FloatArray:
        """(n_windows,) change per second."""
        return np.where(self.pauses, np.nan, np.diff(self.at_edges(values)) / np.diff(self._times))

    def mean(self, values: FloatArray) -> FloatArray:
        """(n_windows,) mean of values (n_rows,)."""
        known = np.isfinite(values)
        sums, counts = (
            np.concatenate([[0.0], np.cumsum(one)]) for one in (np.where(known, values, 0.0), known.astype(np.float64))
        )
        first, last = self.edges[:-1], self.edges[1:]
        number = counts[last] - counts[first]
        return np.where((number > 0) & ~self.pauses, (sums[last] - sums[first]) / np.maximum(number, 1.0), np.nan)

    @property
    def enough(self) -> bool:
        """Whether there is a motion to look at."""
        return len(self.edges) > 8


def _busiest(columns: Sequence[FloatArray], n_rows: int) -> IntArray:
    """Rows of the parts of a long log in which columns change most, beside how much they change in all; every row of
    another."""
    if n_rows <= ROWS:
        return np.arange(n_rows)
    parts = np.arange(n_rows // PART * PART).reshape(-1, PART)
    busy = np.zeros(len(parts))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of columns without numbers in a part
        for one in columns:
            spread = np.nanstd(one)
            if spread > 0.0:
                busy += np.nan_to_num(np.nanstd(one[parts], axis=1) / spread)
    return np.asarray(parts[np.sort(np.argsort(-busy, kind="stable")[:PARTS])]).ravel()


def period(values: FloatArray, resumed: BoolArray) -> float:
    """What a column wraps by: 360 or 2 pi where it jumps by about that and spans no more, else 0.

    resumed  (n_rows,) rows after a pause: over one a speed may change by 6.3 kn, which is no angle that wraps
    """
    there = np.isfinite(values)
    known = values[there]
    if len(known) < 10:
        return 0.0
    paused = np.diff(np.cumsum(resumed)[there]) > 0
    steps, span = np.abs(np.diff(known))[~paused], float(np.ptp(known))
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


def _middles(values: FloatArray) -> FloatArray:
    """(n,) medians of rows (n, k), without what is NaN; NaN where nothing else is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        return np.asarray(np.nanmedian(values, axis=1))
