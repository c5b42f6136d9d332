"""When a quantity of a ship changed: a straight line in time with steps, each with an interval for when and how much.

    y_i = level + slope t_i + sum_k step_k [t_i after change k] + e_i

with one slope all along, as fouling that grows at a rate of its own and is cleaned off; errors e_i that are normal and
independent of each other, their standard deviations known but for a common factor.  A step is believed where the fall
of the weighted squares, by an F test, is less likely than ``LEVEL`` over all places and series that are looked at
(Bonferroni), so that of a whole fleet without any change one such report in twenty shows one.  Steps are looked for one
after the other, and in pairs where none shows alone: what goes and comes back hides itself from one step.

When: places k have weights proportional to RSS_k^(-dof/2), the posterior for a flat prior on place and the usual ones
on level, slope, step and variance; the interval is of the likeliest places that together have 95 %.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy import stats

from ..arrays import FloatArray

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
    p        probability of such a one anywhere where there is none
    """

    after: int
    first: int
    last: int
    size: float
    error: float
    p: float


@dataclass(frozen=True)
class Course:
    """What a series does.

    slope, slope_error  by unit of time, and half its 95 % interval
    grows    whether the slope is believed
    changes  in time
    fitted   (n,) the line with its steps
    """

    slope: float
    slope_error: float
    grows: bool
    changes: tuple[Change, ...]
    fitted: FloatArray


def course(t: FloatArray, y: FloatArray, error: FloatArray, looked_at: int = 1) -> Course | None:
    """What a series y (n,) at times t (n,) does; None for fewer than six dates, or for one that never moves.

    error      (n,) standard errors, NaN where unknown; none is trusted below their median
    looked_at  series of the fleet that are looked at
    """
    if len(t) < FEWEST or not np.ptp(y) > 1e-9 * max(1e-300, float(np.max(np.abs(y)))):
        return None
    known = error[np.isfinite(error) & (error > 0.0)]
    middle = float(np.median(known)) if len(known) else 1.0
    root = 1.0 / np.where(np.isfinite(error), np.maximum(error, middle), middle)
    level = LEVEL / looked_at
    found: dict[int, float] = {}
    while len(found) < MOST:
        more = _one_more(t, y, root, tuple(found), level) or _two_more(t, y, root, tuple(found), level)
        if not more:
            break
        found |= more
    places = tuple(sorted(found))
    theta, covariance, dof = _solution(t, y, root, places)
    half = stats.t.ppf(0.5 + SURE / 2.0, dof) * np.sqrt(np.diag(covariance))
    p_slope = 2.0 * stats.t.sf(abs(theta[1]) / max(np.sqrt(covariance[1, 1]), 1e-300), dof)
    changes = []
    for k, place in enumerate(places):
        first, last = _interval(t, y, root, places, place)
        changes.append(Change(place, first, last, float(theta[2 + k]), float(half[2 + k]), found[place]))
    return Course(float(theta[1]), float(half[1]), bool(p_slope < level), tuple(changes), _design(t, places) @ theta)


def _places(n: int, taken: Sequence[int]) -> list[int]:
    """Where a step may lie: two dates at each side of it, or it could be one date that is off."""
    edges = (0, *taken, n)
    return [k for k in range(2, n - 1) if all(abs(k - edge) >= 2 for edge in edges)]


def _one_more(t: FloatArray, y: FloatArray, root: FloatArray, taken: tuple[int, ...], level: float) -> dict[int, float]:
    return _best(t, y, root, taken, [(k,) for k in _places(len(t), taken)], level)


def _two_more(t: FloatArray, y: FloatArray, root: FloatArray, taken: tuple[int, ...], level: float) -> dict[int, float]:
    if len(t) > PAIRS or len(taken) + 2 > MOST:
        return {}
    pairs = [pair for pair in combinations(_places(len(t), taken), 2) if pair[1] - pair[0] >= 2]
    return _best(t, y, root, taken, pairs, level)


def _best(
    t: FloatArray,
    y: FloatArray,
    root: FloatArray,
    taken: tuple[int, ...],
    more: Sequence[tuple[int, ...]],
    level: float,
) -> dict[int, float]:
    """The likeliest of some further places with its probability by chance; nothing where that is too large."""
    if not more:
        return {}
    size = len(more[0])
    dof = len(t) - 2 - len(taken) - size
    if dof < 2:
        return {}
    before = _squares(t, y, root, taken)
    left = [_squares(t, y, root, (*taken, *places)) for places in more]
    best = int(np.argmin(left))
    F = (before - left[best]) / size / max(left[best] / dof, 1e-300)
    p = min(1.0, len(more) * float(stats.f.sf(F, size, dof)))
    return dict.fromkeys(more[best], p) if p < level else {}


def _design(t: FloatArray, places: Sequence[int]) -> FloatArray:
    steps = [(np.arange(len(t)) >= place).astype(float) for place in places]
    return np.column_stack([np.ones(len(t)), t - t.mean(), *steps])


def _squares(t: FloatArray, y: FloatArray, root: FloatArray, places: Sequence[int]) -> float:
    A = _design(t, places) * root[:, None]
    off = y * root - A @ np.linalg.lstsq(A, y * root, rcond=None)[0]
    return float(off @ off)


def _solution(
    t: FloatArray, y: FloatArray, root: FloatArray, places: Sequence[int]
) -> tuple[FloatArray, FloatArray, int]:
    """Level, slope and steps, their covariance, and degrees of freedom."""
    A = _design(t, places) * root[:, None]
    theta = np.linalg.lstsq(A, y * root, rcond=None)[0]
    off = y * root - A @ theta
    dof = len(t) - A.shape[1]
    covariance: FloatArray = np.linalg.pinv(A.T @ A) * float(off @ off) / dof
    return np.asarray(theta, dtype=float), covariance, dof


def _interval(t: FloatArray, y: FloatArray, root: FloatArray, places: tuple[int, ...], place: int) -> tuple[int, int]:
    """Numbers of dates a step lies between, the others where they are."""
    others = tuple(k for k in places if k != place)
    candidates = sorted({*_places(len(t), others), place})
    squares = np.array([_squares(t, y, root, (*others, k)) for k in candidates])
    dof = len(t) - 3 - len(others)
    weight = (squares.min() / np.maximum(squares, 1e-300)) ** (dof / 2.0)
    order = np.argsort(-weight)
    enough = int(np.searchsorted(np.cumsum(weight[order]) / weight.sum(), SURE)) + 1
    kept = [candidates[k] for k in order[:enough]]
    return min(kept) - 1, max(kept)
