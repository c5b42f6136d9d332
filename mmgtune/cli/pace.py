"""How long work still takes, from how fast it went lately.

Measured from the first report on: what a resumed run had done before, and what had to be compiled, tells nothing of
the pace.
"""

from __future__ import annotations

import time
from collections import deque

from ..units import in_time

LEAST = 2.0
"""Seconds that have to be measured before anything is said."""

LATELY = 0.5
"""Share of the time since the first report that the pace is taken from, the last of it."""


class Pace:
    """Work done by times at which it was reported."""

    def __init__(self) -> None:
        self._first: float | None = None
        self._marks: deque[tuple[float, float]] = deque()

    def left(self, done: float, rest: float) -> str:
        """About how long the rest takes, in words: "about 3 min left"; "" where that is not known yet.

        done, rest  in the same unit; done counts up, and where it falls the measuring begins anew
        """
        now = time.monotonic()
        if self._first is None or done < self._marks[-1][1]:
            self._first = now
            self._marks.clear()
        self._marks.append((now, done))
        since = now - LATELY * (now - self._first)
        while len(self._marks) > 2 and self._marks[1][0] <= since:
            self._marks.popleft()
        began, before = self._marks[0]
        if rest <= 0.0 or done <= before or now - self._first < LEAST:
            return ""
        return f"about {in_time((now - began) / (done - before) * rest)} left"
