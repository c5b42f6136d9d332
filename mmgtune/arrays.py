"""Array type aliases and a few small helpers; shapes stand in the docstrings."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]


def numbers_of(given: Any) -> FloatArray | None:
    """Real numbers as an array of floats, of whatever shape; None for what holds anything else."""
    try:
        found = np.asarray(given)
        return found.astype(np.float64) if found.dtype.kind in "biufO" else None
    except (TypeError, ValueError, OverflowError):  # parts of different lengths, objects, numbers that no float holds
        return None


def runs_of_true(flags: BoolArray) -> list[tuple[int, int]]:
    """First place of each unbroken run of what is true of (n,) flags, and the place behind it."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def robust_deviation(off: FloatArray) -> float:
    """Standard deviation of what is normally distributed about zero, as most of the values do; any may be elsewhere.

    1.4826 times the median of their sizes: half of what is normal lies within 0.6745 standard deviations.
    """
    return 1.4826 * float(np.median(np.abs(off)))
