"""What trials visit, sample by sample: an effect is believed only where they visit what it is about."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, robust_deviation
from ..units import DEG

MOMENT = 5.0
"""Time [s] that trials must stay beyond a value for it to count as visited."""

SPEEDS = 0.1
"""Share by which speed must vary to say how something changes with it."""

FEW = 20
"""Samples below which noise is not told from motion."""


@dataclass(frozen=True, eq=False)
class Visited:
    """Samples of all trials, one after the other; NaN where a channel has a gap.

    seconds   (n,) each stands for
    rudder    (n,) logged rudder angle [rad], the mean where there are several rudders, positive to starboard
    speed     (n,) over ground, sqrt(u^2 + v_m^2) [m/s]
    ahead     (n,) u [m/s]
    rate      (n,) r L / U [-], positive to starboard; NaN near rest
    drift     (n,) beta = atan2(-v_m, u) [rad]; NaN near rest
    shaft     (n,) revolutions of the propellers, their mean [1/s]
    antenna   forward and to starboard of midship [m], from which all positions were moved there; zeros where they were
              not, or from several
    """

    seconds: FloatArray
    rudder: FloatArray
    speed: FloatArray
    ahead: FloatArray
    rate: FloatArray
    drift: FloatArray
    shaft: FloatArray
    antenna: tuple[float, float] = (0.0, 0.0)

    def span(self, values: FloatArray) -> tuple[float, float]:
        """Lowest and highest of some values (n,) beyond which no more than ``MOMENT`` is spent; NaN without any."""
        known = np.isfinite(values)
        if not known.any():
            return float("nan"), float("nan")
        order = np.argsort(values[known])
        ranked, seconds = values[known][order], np.cumsum(self.seconds[known][order])
        short = min(MOMENT, 0.25 * float(seconds[-1]))  # of short records, what a quarter of them is beyond
        last = len(ranked) - 1
        low = int(np.searchsorted(seconds, short))
        high = int(np.searchsorted(seconds, seconds[-1] - short))
        return float(ranked[min(low, last)]), float(ranked[min(high, last)])

    @property
    def largest_rudder(self) -> float:
        """Rudder angle [rad] to either side that trials go up to."""
        return self.span(np.abs(self.rudder))[1]

    def varies(self, values: FloatArray) -> float:
        """How far positive values (n,) vary, as a share of the highest; 0 without any."""
        low, high = self.span(values)
        return (high - low) / high if high > 0.0 else 0.0

    @property
    def rudder_noise(self) -> float:
        """Standard deviation [rad] of white noise in the log of the rudder; 0 of one that has none, or too few samples.

        By differences of the second to the fourth order, which a rudder that rests, or turns evenly, does not have: the
        least of the three, as motion shows in them unevenly.  Half of the samples may be anything else.
        """
        known = self.rudder[np.isfinite(self.rudder)]
        if len(known) < FEW:
            return 0.0
        return min(robust_deviation(np.diff(known, k)) / math.sqrt(math.comb(2 * k, k)) for k in (2, 3, 4))

    def lacking_rudder(self, angle: float) -> str:
        """Rudder angles beyond one [rad], in words, where trials do not go so far; "" where they do."""
        if self.largest_rudder > angle:
            return ""
        return f"rudder angles beyond {angle / DEG:.0f} deg (these go to {self.largest_rudder / DEG:.0f} deg)"

    @property
    def lacking_speeds(self) -> str:
        """What trials would have to visit to say how something changes with speed; "" where they do."""
        return "" if self.varies(self.speed) > SPEEDS else f"speeds that differ by {100.0 * SPEEDS:.0f} %"

    @property
    def advance(self) -> FloatArray:
        """(n,) u / n [m], the advance ratio but for the diameter; NaN where the shaft stands."""
        turning = np.abs(self.shaft) > 1e-3 * float(np.nanmax(np.abs(self.shaft), initial=1e-12))
        return np.where(turning, self.ahead / np.where(turning, self.shaft, 1.0), np.nan)
