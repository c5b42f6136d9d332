"""Gaps in what was measured, bridged."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray


def bridged(t: FloatArray, *series: FloatArray) -> FloatArray | None:
    """Series (n_samples,) that count together, as columns (n_samples, n_series), their gaps bridged linearly in time.

    Before the first sample that is whole and after the last they are held.  None where no sample is.
    """
    whole = np.isfinite(series).all(axis=0)
    if not whole.any():
        return None
    return np.column_stack([np.interp(t, t[whole], values[whole]) for values in series])
