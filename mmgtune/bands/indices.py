"""A band on one number of a manoeuvre, with the particles that never reach it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..documents import finite
from .quantiles import central, quantiles


@dataclass(frozen=True)
class IndexBand:
    """A number as particles have it.

    mean, deviation  of the particles that reach it; None where none does, the deviation where fewer than two do
    low, median, high  of all particles, those that never reach it beyond all others; None where such a one is meant
    reached, particles  how many reach it, of how many
    """

    mean: float | None
    deviation: float | None
    low: float | None
    median: float | None
    high: float | None
    reached: int
    particles: int

    @property
    def half(self) -> float | None:
        """Half the width of the band, what stands behind ±; None without both ends, and of one particle."""
        if self.low is None or self.high is None or self.particles < 2:
            return None
        return 0.5 * (self.high - self.low)

    def times(self, factor: float) -> IndexBand:
        """The band in another unit, in which a number is ``factor`` times as large."""

        def scaled(value: float | None) -> float | None:
            return None if value is None else factor * value

        return IndexBand(
            scaled(self.mean), scaled(self.deviation), scaled(self.low), scaled(self.median), scaled(self.high),
            self.reached, self.particles,
        )  # fmt: skip

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "mean": self.mean,
            "half_width": self.half,
            "deviation": self.deviation,
            "low": self.low,
            "median": self.median,
            "high": self.high,
            "reached": self.reached,
            "particles": self.particles,
        }


def index_band(values: FloatArray, level: float, *, endless: bool = True) -> IndexBand:
    """The band that holds ``level`` of particles (n_particles,), NaN of those that never reach the number.

    endless  whether not to reach it is to lie above all that do, as with an advance or an overshoot; else such a
             particle lies on an unknown side, and both ends count it as beyond
    """
    known = np.isfinite(values)
    of = values[known]
    low, high = central(level)
    last = quantiles(np.where(known, values, np.inf), (low, 0.5, high))
    first = last if endless else quantiles(np.where(known, values, -np.inf), (low, 0.5, high))
    middle = float(last[1]) if endless or known.all() else float(np.median(of)) if len(of) else math.inf
    return IndexBand(
        mean=float(of.mean()) if len(of) else None,
        deviation=float(of.std(ddof=1)) if len(of) > 1 else None,
        low=finite(float(first[0])),
        median=finite(middle),
        high=finite(float(last[2])),
        reached=int(known.sum()),
        particles=len(values),
    )
