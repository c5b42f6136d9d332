"""Types of arrays, as annotations name them; shapes stand in the docstrings."""

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
