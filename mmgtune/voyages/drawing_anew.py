"""Intervals by drawing groups of windows anew."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray

DRAWS = 1000
SEED = 1
"""The same windows have the same intervals."""
LEAST_GROUPS = 3
"""Groups below which there is no interval."""


class Draws:
    """How often each group is in each of DRAWS samples of as many groups, with replacement.

    group  (n_windows,) which group each window is of, from 0
    """

    def __init__(self, group: IntArray):
        self.group = group
        self.n_groups = int(group.max()) + 1 if len(group) else 0
        rng = np.random.default_rng(SEED)
        if self.n_groups:
            self._times = rng.multinomial(self.n_groups, np.full(self.n_groups, 1.0 / self.n_groups), size=DRAWS)
        else:
            self._times = np.zeros((DRAWS, 0), dtype=np.int64)

    def mean(self, values: FloatArray, some: BoolArray) -> tuple[float, tuple[float, float] | None]:
        """Mean of some values (n_windows,) and its 95 % interval; None where fewer than LEAST_GROUPS have any."""
        if not some.any():
            return float("nan"), None
        sums = np.bincount(self.group[some], values[some], self.n_groups)
        counts = np.bincount(self.group[some], minlength=self.n_groups).astype(float)
        mean = float(sums.sum() / counts.sum())
        if (counts > 0).sum() < LEAST_GROUPS:
            return mean, None
        drawn_counts = self._times @ counts
        there = drawn_counts > 0
        drawn = (self._times @ sums)[there] / drawn_counts[there]
        low, high = np.percentile(drawn, [2.5, 97.5])
        return mean, (float(low), float(high))
