"""Intervals of a number over things that are few, such as runs: how it differs where these are drawn anew."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from .arrays import IntArray

DRAWS = 2000
"""Samples that an interval is made from."""


def interval_of(number_of: Callable[[IntArray], float], n: int, seed: int | Sequence[int]) -> tuple[float, float]:
    """95 % interval of a number over n things, by drawing as many of them with replacement (Efron 1979).

    number_of  (n,) which things were drawn -> the number over these
    seed       the same gives the same interval
    """
    picks = np.random.default_rng(seed).integers(n, size=(DRAWS, n))
    low, high = np.percentile([number_of(pick) for pick in picks], [2.5, 97.5])
    return float(low), float(high)
