"""What L_MSE divides by where logs are too long to be held: spread gathered window by window."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES


class Spread:
    """Standard deviation of each state over windows, positions counted from the start of each.

    Over a voyage the spread of a position is the length of the way, beside which no error of a window shows.  Headings
    are wrapped to one turn, as ``objective.spread`` does.
    """

    def __init__(self) -> None:
        self._count = np.zeros(6)
        self._mean = np.zeros(6)
        self._squares = np.zeros(6)

    def add(self, motion: FloatArray) -> None:
        """Windows (n_windows, T, 6) more, NaN where nothing was measured."""
        values = np.array(motion)
        values[:, :, :2] -= motion[:, :1, :2]
        values[:, :, 2] = np.arctan2(np.sin(motion[:, :, 2]), np.cos(motion[:, :, 2]))
        rows = values.reshape(-1, 6)
        there = np.isfinite(rows)
        count = there.sum(axis=0)
        mean = np.where(there, rows, 0.0).sum(axis=0) / np.maximum(count, 1)
        squares = np.where(there, rows - mean, 0.0) ** 2
        total = self._count + count
        apart = mean - self._mean
        share = np.divide(count, total, out=np.zeros(6), where=total > 0)
        self._squares += squares.sum(axis=0) + apart**2 * self._count * share
        self._mean += apart * share
        self._count = total

    def sigma(self) -> dict[str, float]:
        """By state, in SI units."""
        return dict(zip(STATES, np.sqrt(self._squares / np.maximum(self._count, 1)).tolist(), strict=True))
