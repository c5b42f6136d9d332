"""Where particles lie: quantiles along their axis.

The k-th smallest of n particles stands at the probability k / (n + 1): a further draw from where they came from lies
below it with just that probability (Weibull 1939; Hyndman & Fan 1996, type 6).  So a band from
one particle to another holds what it says, however few there are, and nearly so between them; the widest goes from the
least to the greatest and holds (n - 1) / (n + 1); wider ones are not made up.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..arrays import FloatArray


def quantiles(values: FloatArray, probabilities: Sequence[float]) -> FloatArray:
    """(n_probabilities, ...) quantiles of particles (n_particles, ...), beyond the outermost these themselves.

    Infinite values count as beyond all others.  Raises ValueError where there is no particle.
    """
    n = len(values)
    if not n:
        raise ValueError("no particle, no quantile")
    ordered = np.sort(values, axis=0)
    place = np.clip(np.asarray(probabilities, dtype=float) * (n + 1) - 1.0, 0.0, n - 1.0)
    below = np.floor(place).astype(np.int64)
    above = np.minimum(below + 1, n - 1)
    share = (place - below).reshape(-1, *[1] * (values.ndim - 1))
    low, high = ordered[below], ordered[above]
    with np.errstate(invalid="ignore"):  # of two infinite neighbours, or a share of 0 of one
        between = low + share * (high - low)
    return np.asarray(np.where((share == 0.0) | (low == high), low, between))


def central(level: float) -> tuple[float, float]:
    """Both ends of the band in the middle that holds a share ``level``."""
    return 0.5 * (1.0 - level), 0.5 * (1.0 + level)


def widest(n: int) -> float:
    """Share that the band from the least to the greatest of n particles holds; no band of theirs can hold more."""
    return (n - 1) / (n + 1)


def fan(particles: FloatArray, level: float) -> Mapping[str, FloatArray]:
    """What is drawn of particles (n_particles, ...): mean, median, the middle half, and the band that holds ``level``.

    -> mean, low, q25, median, q75, high, (...) each
    """
    low, high = central(level)
    found = quantiles(particles, (low, 0.25, 0.5, 0.75, high))
    return {
        "mean": np.asarray(particles.mean(axis=0)),
        **dict(zip(("low", "q25", "median", "q75", "high"), found, strict=True)),
    }
