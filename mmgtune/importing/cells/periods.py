"""Times that begin anew after a day or an hour, made to go on."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray

DAY, HOUR = 86400.0, 3600.0
HALF = 12.0 * HOUR


class Periods:
    """How often times have begun anew so far; blocks of rows follow each other."""

    def __init__(self) -> None:
        self._turns = 0.0
        self._last = np.nan
        self._halves = 0.0
        self._hour = np.nan

    def over_midnight(self, seconds: FloatArray) -> FloatArray:
        """Seconds of the day (n_rows,) without the fall at midnight, nor that of a clock of twelve hours at one."""
        return self._unwrapped(self._of_24_hours(seconds), DAY, back=True)

    def over_the_hour(self, seconds: FloatArray) -> FloatArray:
        """Seconds of a stopwatch (n_rows,) without the fall after 59:59.

        A rise of more than half an hour undoes a fall, but is a gap where there was none.
        """
        return self._unwrapped(seconds, HOUR, back=False)

    def _of_24_hours(self, seconds: FloatArray) -> FloatArray:
        """Times (n_rows,) half a day on after each step from the hour of twelve to that of one; as they are where an
        hour is one that only a clock of 24 hours shows."""
        out = np.array(seconds)
        known = np.flatnonzero(np.isfinite(seconds))
        if len(known):
            hours = np.floor(seconds[known] / HOUR)
            if hours.min() < 1.0 or hours.max() > 12.0:
                return out
            before = np.concatenate([[hours[0] if np.isnan(self._hour) else self._hour], hours[:-1]])
            turned = ((before == 12.0) & (hours == 1.0)).astype(float) - ((before == 1.0) & (hours == 12.0))
            halves = self._halves + np.cumsum(turned)
            out[known] = seconds[known] + HALF * halves
            self._halves, self._hour = float(halves[-1]), float(hours[-1])
        return out

    def _unwrapped(self, seconds: FloatArray, period: float, back: bool) -> FloatArray:
        """Seconds (n_rows,) without falls of a period; ``back``: it may go back beyond where it began."""
        out = np.array(seconds)
        known = np.flatnonzero(np.isfinite(seconds))
        if len(known):
            values = seconds[known]
            before = np.concatenate([[values[0] if np.isnan(self._last) else self._last], values[:-1]])
            rise = values - before
            turns = self._turns + np.cumsum(np.where(rise < -period / 2.0, 1.0, 0.0) - (rise > period / 2.0))
            if not back:
                turns = turns - np.minimum(0.0, np.minimum.accumulate(turns))
            out[known] = values + period * turns
            self._turns, self._last = float(turns[-1]), float(values[-1])
        return out
