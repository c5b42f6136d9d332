"""Times that begin anew after a day or an hour, made to go on."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

DAY, HOUR = 86400.0, 3600.0


class Periods:
    """How often times have begun anew so far; blocks of rows follow each other."""

    def __init__(self) -> None:
        self._turns = 0.0
        self._last = np.nan

    def over_midnight(self, seconds: FloatArray) -> FloatArray:
        """Seconds of the day (n_rows,) without the fall at midnight."""
        return self._unwrapped(seconds, DAY, back=True)

    def over_the_hour(self, seconds: FloatArray) -> FloatArray:
        """Seconds of a stopwatch (n_rows,) without the fall after 59:59.

        A rise of more than half an hour undoes a fall, but is a gap where there was none.
        """
        return self._unwrapped(seconds, HOUR, back=False)

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
