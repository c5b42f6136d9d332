"""How long work still takes, from how fast it went lately.

Measured from the first report on: what a resumed run had done before, and what had to be compiled, tells nothing of
the pace.
"""

from __future__ import annotations

import time
from collections import deque

from ..hooks import EVALUATIONS
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
        """About how long the rest takes, in words: "about 3 min left"; "" where that is not known yet."""
        seconds = self.seconds(done, rest)
        return "" if seconds is None else f"about {in_time(seconds)} left"

    def seconds(self, done: float, rest: float) -> float | None:
        """The same as a number [s]; None where it is not known yet.

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
            return None
        return (now - began) / (done - before) * rest


class Work:
    """Work that is counted by a noun: what is done of it, and how long the rest takes."""

    def __init__(self, noun: str) -> None:
        self.noun = noun
        self._pace = Pace()
        self._done = self._total = 0
        self._over: float | None = None

    @property
    def of_phase(self) -> bool:
        """Whether it is part of a phase; other work goes on over several."""
        return self.noun == EVALUATIONS

    def reached(self, done: int, total: int) -> None:
        """So much is done."""
        seconds = self._pace.seconds(done, total - done)
        if seconds is not None:
            self._over = time.monotonic() + seconds
        elif done != self._done:
            self._over = None
        self._done, self._total = done, total

    def words(self, so_far: str) -> str:
        """What is done, and about how long the rest takes, or where nobody knows ``so_far``."""
        rest = 0.0 if self._over is None else self._over - time.monotonic()
        left = f"about {in_time(rest)} left" if rest > 0.0 else so_far
        if not self.of_phase:
            return f"{self._done} of {self._total} {self.noun} done, {left}"
        if self._done > self._total:
            return f"more than the usual {self._total} {self.noun}, {so_far}"
        return f"{self._done} {self.noun}, {f'{left} of it' if rest > 0.0 else so_far}"
