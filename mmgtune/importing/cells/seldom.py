"""Columns logged more seldom than rows are written, each row holding what was new, as merged logs have them."""

from __future__ import annotations

import numpy as np

from ...arrays import BoolArray, FloatArray

SPARSE = 0.9
"""Share of rows with a value below which a column may be such."""
EVERY = 2.0
"""Rows from one value to the next, usually, from which on it is; else values are missing now and then."""


def is_seldom(known: BoolArray) -> bool:
    """Whether rows (n_rows,) with a value are those of a column logged more seldom than rows are written."""
    rows = np.flatnonzero(known)
    return 2 <= len(rows) < SPARSE * len(known) and float(np.median(np.diff(rows))) >= EVERY


def held(values: FloatArray, longest: float) -> FloatArray:
    """Such a column (n_rows,), each value standing until the next, but no longer than so many of its usual steps.

    Others are left as they are.
    """
    known = np.isfinite(values)
    if not is_seldom(known):
        return values
    last = np.maximum.accumulate(np.where(known, np.arange(len(values)), -1))
    since = np.arange(len(values)) - last
    stands = (last >= 0) & (since <= longest * float(np.median(np.diff(np.flatnonzero(known)))))
    return np.where(stands, values[last], np.nan)
