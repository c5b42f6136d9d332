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

    def __init__(
        self, count: FloatArray | None = None, mean: FloatArray | None = None, squares: FloatArray | None = None
    ) -> None:
        self._count = np.zeros(6) if count is None else count
        self._mean = np.zeros(6) if mean is None else mean
        self._squares = np.zeros(6) if squares is None else squares

    @property
    def state(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(6,) each: samples, their mean, and the sum of squares about it; what it can be made from again."""
        return self._count, self._mean, self._squares

    def add(self, motion: FloatArray) -> None:
        """Windows (n_windows, T, 6) more, NaN where nothing was measured."""
        values = np.array(motion)
        values[:, :, :2] -= motion[:, :1, :2]
        values[:, :, 2] = np.arctan2(np.sin(motion[:, :, 2]), np.cos(motion[:, :, 2]))
        rows = values.reshape(-1, 6)
        there = np.isfinite(rows)
        count = there.sum(axis=0)
        mean = np.where(there, rows, 0.0).sum(axis=0) / np.maximum(count, 1)
        squares = (np.where(there, rows - mean, 0.0) ** 2).sum(axis=0)
        self.join(Spread(count.astype(float), mean, squares))

    def join(self, other: Spread) -> None:
        """What another has gathered, too."""
        count, mean, squares = other.state
        total = self._count + count
        apart = mean - self._mean
        share = np.divide(count, total, out=np.zeros(6), where=total > 0)
        self._squares = self._squares + squares + apart**2 * self._count * share
        self._mean = self._mean + apart * share
        self._count = total

    def sigma(self) -> dict[str, float]:
        """By state, in SI units."""
        return dict(zip(STATES, np.sqrt(self._squares / np.maximum(self._count, 1)).tolist(), strict=True))
