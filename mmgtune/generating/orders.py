"""Orders to ships side by side with a port and a starboard rudder and a bow thruster: (3, n_lanes) each."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

BEGIN = 5.0
"""Time [s] at which turning circles and zigzags begin."""

EVERY = 20.0
"""Time [s] for which orders at random hold: Wakita et al., section 5.1."""

MEAN, SPREAD = np.array([np.radians(-80.0), np.radians(80.0), 0.0]), np.array([np.radians(30.0)] * 2 + [15.0])
"""Of orders at random: port rudder, starboard rudder [rad], bow thruster [1/s]; section 5.1 there."""


class Zigzags:
    """Both rudders put over together, to the other side whenever the ship has turned ``check`` [rad] to theirs.

    rudder, check, heading  (n_lanes,) [rad]; an infinite check is a turning circle
    """

    def __init__(self, rudder: FloatArray, check: FloatArray, heading: FloatArray):
        self.rudder, self.check, self.heading = rudder, check, heading
        self.side = np.zeros_like(rudder)

    def orders(self, t: float, states: FloatArray) -> FloatArray:
        """See ``Commander``."""
        if t >= BEGIN:
            self.side = np.where(self.side == 0.0, 1.0, self.side)
            passed = self.side * (states[2] - self.heading) >= self.check
            self.side = np.where(passed, -self.side, self.side)
        return together(self.side * self.rudder)


class AtRandom:
    """Orders drawn anew every ``EVERY`` seconds; those beyond the limits are cut there by the actuators."""

    def __init__(self, rng: np.random.Generator, n_lanes: int, seconds: float):
        draws = int(seconds // EVERY) + 1
        self.drawn = MEAN[:, None] + SPREAD[:, None] * rng.standard_normal((draws, 3, n_lanes))

    def orders(self, t: float, states: FloatArray) -> FloatArray:
        """See ``Commander``."""
        drawn: FloatArray = self.drawn[min(int((t + 1e-9) // EVERY), len(self.drawn) - 1)]
        return drawn


def together(rudder: FloatArray) -> FloatArray:
    """One angle to both rudders."""
    return np.stack([rudder, rudder, 0.0 * rudder])
