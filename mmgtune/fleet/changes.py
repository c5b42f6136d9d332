"""When a quantity of a ship changed: a level or a straight line in time, with steps, each with an interval.

    y_i = level + slope t_i + sum_k step_k [t_i after change k] + e_i

with one slope all along, as fouling that grows at a rate of its own and is cleaned off, or none; errors e_i that are
normal and independent of each other, their standard deviations known but for a common factor.  A step is believed where
the fall of the weighted squares, by an F test, is less likely than ``LEVEL`` over all places and series that are looked
at (Bonferroni), so that of twenty fleets without any change one shows one.  Steps are looked for one after the other,
and in pairs where none shows alone: what goes and comes back hides itself from one step.  That is done with a slope and
without one.  Steps of a level alone are taken where their BIC, a step counting as two numbers, is below that of the
line by what makes them likelier by one over the probability above; else the line is, with its steps.

When: places k have weights proportional to RSS_k^(-dof/2), the posterior for a flat prior on place and the usual ones
on level, slope, step and variance; the interval is of the likeliest places that together have 95 %.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy import special

from ..arrays import FloatArray, IntArray

LEVEL = 0.05
"""Probability of one false alarm over all that is looked at."""

FEWEST = 6
"""Dates from which a change is looked for."""

MOST = 6
"""Changes looked for in a series."""

PAIRS = 80
"""Dates up to which pairs of changes are looked for: their number grows with the square."""

SURE = 0.95
"""Of intervals."""


@dataclass(frozen=True)
class Change:
    """A step between two dates.

    after    number of the first date behind it
    first, last  numbers of dates it lies between: after the first of them, not after the last
    size, error  of the step, and half its 95 % interval
    p        probability of such a one anywhere in the series where there is none
    """

    after: int
    first: int
    last: int
    size: float
    error: float
    p: float


@dataclass(frozen=True, eq=False)
class Course:
    """What a series does.

    slope, slope_error  by unit of time, and half its 95 % interval; 0 where there is none
    grows    whether the slope is believed
    changes  in time
    fitted   (n,) the line with its steps
    """

    slope: float
    slope_error: float
    grows: bool
    changes: tuple[Change, ...]
    fitted: FloatArray

    def exponential(self) -> Course:
        """The course of exp(y), for that of y: steps, slope and errors to first order, where each stands."""

        def of(change: Change) -> Change:
            behind = math.exp(self.fitted[change.after])
            before = math.exp(self.fitted[change.after] - change.size)
            return replace(change, size=behind - before, error=change.error * behind)

        fitted = np.exp(self.fitted)
        middle = float(fitted.mean())
        return Course(self.slope * middle, self.slope_error * middle, self.grows, tuple(map(of, self.changes)), fitted)


@dataclass(frozen=True, eq=False)
class _Series:
    """Times from their middle, values and roots of weights (n,), and whether there is a slope."""

    t: FloatArray
    y: FloatArray
    root: FloatArray
    sloping: bool

    def __len__(self) -> int:
        return len(self.t)

    @property
    def n_plain(self) -> int:
        """Numbers besides those of steps."""
        return 1 + self.sloping

    def design(self, places: Sequence[int]) -> FloatArray:
        """(n, n_plain + n_places)."""
        steps = [(np.arange(len(self)) >= place).astype(float) for place in places]
        line = [self.t] if self.sloping else []
        return np.column_stack([np.ones(len(self)), *line, *steps])

    def solved(self, places: Sequence[int]) -> tuple[FloatArray, float, FloatArray]:
        """Numbers, weighted squares that are left, and the weighted design."""
        A = self.design(places) * self.root[:, None]
        theta = np.linalg.lstsq(A, self.y * self.root, rcond=None)[0]
        off = self.y * self.root - A @ theta
        return np.asarray(theta), float(off @ off), A

    def squares(self, places: Sequence[int]) -> float:
        """What is left with steps at some places."""
        return self.solved(places)[1]

    def dof(self, n_places: int) -> int:
        """Degrees of freedom that are left."""
        return len(self) - self.n_plain - n_places

    def bic(self, places: Sequence[int]) -> float:
        """Bayesian information criterion."""
        n = len(self)
        return n * math.log(max(self.squares(places), 1e-300) / n) + (self.n_plain + 2 * len(places)) * math.log(n)


def course(t: FloatArray, y: FloatArray, error: FloatArray, looked_at: int = 1) -> Course | None:
    """What a series y (n,) at times t (n,) does; None for fewer than six dates, or for one that never moves.

    error      (n,) standard errors, NaN where unknown; none is trusted below their median
    looked_at  series of the fleet that are looked at
    """
    if len(t) < FEWEST or not np.ptp(y) > 1e-9 * max(1e-300, float(np.max(np.abs(y)))):
        return None
    known = error[np.isfinite(error) & (error > 0.0)]
    middle = float(np.median(known)) if len(known) else 1.0
    root = middle / np.where(np.isfinite(error), np.maximum(error, middle), middle)
    level = 0.5 * LEVEL / looked_at  # two kinds of line are looked at
    either = [_Series(t - t.mean(), y, root, sloping) for sloping in (False, True)]
    found = [_searched(one, level) for one in either]
    level_alone, line = (one.bic(sorted(places)) for one, places in zip(either, found, strict=True))
    # A line looks like a staircase: steps of a level must be much the likelier, or there would be false alarms.
    margin = 2.0 * math.log(1.0 / level) if found[0] else 0.0
    best = 0 if level_alone + margin < line else 1
    return _described(either[best], found[best], level)


def _searched(series: _Series, level: float) -> dict[int, float]:
    """Places of steps, each with its probability by chance."""
    found: dict[int, float] = {}
    while len(found) < MOST:
        more = _one_more(series, tuple(found), level) or _two_more(series, tuple(found), level)
        if not more:
            break
        found |= more
    return found


def _described(series: _Series, found: dict[int, float], level: float) -> Course:
    places = tuple(sorted(found))
    theta, left, A = series.solved(places)
    dof = series.dof(len(places))
    error = np.sqrt(np.diag(np.linalg.pinv(A.T @ A)) * left / dof)
    half = special.stdtrit(dof, 0.5 + SURE / 2.0) * error
    changes = tuple(
        Change(
            place,
            *_interval(series, places, place),
            float(theta[series.n_plain + k]),
            float(half[series.n_plain + k]),
            found[place],
        )
        for k, place in enumerate(places)
    )
    fitted = series.design(places) @ theta
    if not series.sloping:
        return Course(0.0, 0.0, False, changes, fitted)
    p = 2.0 * special.stdtr(dof, -abs(theta[1]) / max(error[1], 1e-300))
    return Course(float(theta[1]), float(half[1]), bool(p < level), changes, fitted)


def _places(n: int, taken: Sequence[int]) -> list[int]:
    """Where a step may lie: two dates at each side of it, or it could be one date that is off."""
    edges = (0, *taken, n)
    return [k for k in range(2, n - 1) if all(abs(k - edge) >= 2 for edge in edges)]


def _one_more(series: _Series, taken: tuple[int, ...], level: float) -> dict[int, float]:
    return _best(series, taken, [(k,) for k in _places(len(series), taken)], level)


def _two_more(series: _Series, taken: tuple[int, ...], level: float) -> dict[int, float]:
    if len(series) > PAIRS or len(taken) + 2 > MOST:
        return {}
    pairs = [pair for pair in combinations(_places(len(series), taken), 2) if pair[1] - pair[0] >= 2]
    return _best(series, taken, pairs, level)


def _best(series: _Series, taken: tuple[int, ...], more: Sequence[tuple[int, ...]], level: float) -> dict[int, float]:
    """The likeliest of some further places with its probability by chance; nothing where that is too large."""
    if not more:
        return {}
    size = len(more[0])
    dof = series.dof(len(taken) + size)
    if dof < 2:
        return {}
    before, falls = _falls(series, taken, np.array(more))
    best = int(np.argmax(falls))
    F = falls[best] / size / max((before - falls[best]) / dof, 1e-300)
    p = min(1.0, len(more) * float(special.fdtrc(size, dof, F)))
    return dict.fromkeys(more[best], p) if p < level else {}


def _falls(series: _Series, taken: tuple[int, ...], more: IntArray) -> tuple[float, FloatArray]:
    """Weighted squares that are left, and by how much each of further places (n_ways, 1 or 2) lowers them.

    A step is looked at less what the line and the steps taken already make of it, so that its share is its own.
    """
    Q = np.linalg.qr(series.design(taken) * series.root[:, None])[0]
    y = series.y * series.root
    y = y - Q @ (Q.T @ y)
    n = len(series)
    steps = np.tril(np.ones((n, n))) * series.root[:, None]  # column k: 1 from date k on
    steps = steps - Q @ (Q.T @ steps)
    inner, along = steps.T @ steps, steps.T @ y
    G, a = inner[more[:, :, None], more[:, None, :]], along[more]
    if more.shape[1] == 1:
        return float(y @ y), a[:, 0] ** 2 / np.maximum(G[:, 0, 0], 1e-300)
    determinant = G[:, 0, 0] * G[:, 1, 1] - G[:, 0, 1] ** 2
    fall = G[:, 1, 1] * a[:, 0] ** 2 - 2.0 * G[:, 0, 1] * a[:, 0] * a[:, 1] + G[:, 0, 0] * a[:, 1] ** 2
    safe = determinant > 1e-12 * G[:, 0, 0] * G[:, 1, 1]
    return float(y @ y), np.where(safe, fall / np.where(safe, determinant, 1.0), 0.0)


def _interval(series: _Series, places: tuple[int, ...], place: int) -> tuple[int, int]:
    """Numbers of dates a step lies between, the others where they are."""
    others = tuple(k for k in places if k != place)
    candidates = sorted({*_places(len(series), others), place})
    squares = np.array([series.squares((*others, k)) for k in candidates])
    dof = series.dof(len(places))
    weight = (squares.min() / np.maximum(squares, 1e-300)) ** (dof / 2.0)
    order = np.argsort(-weight)
    enough = int(np.searchsorted(np.cumsum(weight[order]) / weight.sum(), SURE)) + 1
    kept = [candidates[k] for k in order[:enough]]
    return min(kept) - 1, max(kept)
