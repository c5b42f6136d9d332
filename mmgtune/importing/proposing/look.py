"""The motion of one log under a reading of its position and heading."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...physics.frame import to_ship
from .bearings import Track
from .sampling import Sample
from .windows import Windows


class Look:
    """A log as far as it is read.

    north, east, ahead, abeam, speed  velocities over the ground [m/s], from the positions, (n_windows,)
    psi, rate                         heading [rad] and its slope [rad/s], (n_windows,)
    noise                             standard deviation of those velocities [m/s], from neighbours
    """

    def __init__(self, sample: Sample, windows: Windows, track: Track):
        self.sample, self.windows, self.track = sample, windows, track
        x, y = track.position(windows.columns)
        heading = track.heading(windows.columns)
        self.heading = heading
        self.north, self.east = windows.slope(x), windows.slope(y)
        self.psi, self.rate = windows.mean(heading), windows.slope(heading)
        self.ahead, self.abeam = (np.asarray(one) for one in to_ship(self.psi, self.north, self.east))
        self.speed = np.hypot(self.north, self.east)
        bends = [np.diff(one, n=2) for one in (self.north, self.east)]
        self.noise = max((float(np.nanmedian(np.abs(one))) / 1.65 for one in bends if len(one)), default=0.0)

    def mean(self, k: int) -> FloatArray:
        """(n_windows,) means of a column."""
        return self.windows.mean(self.windows.columns[k])

    @property
    def usual_speed(self) -> float:
        """Root mean square of the speed [m/s]."""
        return float(np.sqrt(np.nanmean(self.speed**2))) if np.isfinite(self.speed).any() else 0.0

    def rate_now(self) -> FloatArray:
        """Slope of the heading (n_rows,) [rad/s], over strides long enough to see through noise."""
        edges = self.windows.edges
        middle = 0.5 * (self.windows.t[edges[1:]] + self.windows.t[edges[:-1]])
        known = np.isfinite(self.rate)
        return (
            np.interp(self.windows.t, middle[known], self.rate[known]) if known.any() else np.zeros(len(self.windows.t))
        )
