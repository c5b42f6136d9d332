"""What differs from voyage to voyage: values of each voyage beside one value for all, and which of the two is believed.

A crew, the sea and the months change some things between voyages and leave the ship's coefficients as they are: the
current, and the resistance of a hull that fouls.  At the common solution the problem is made linear with a value of
each voyage for these, by Gauss-Newton, while targets, causes and initial states are re-tuned alongside.  All patterns
are then restrictions of one linear problem.
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...fitting.quadratic import flat_where_lost
from ...units import NORMAL_95
from ..bench import noise as noises
from ..bench.workbench import Point, Workbench
from ..searching.refit import ENOUGH
from ..signatures.linear import STEP, basis, blocks_of, measured_rows, offset_derivatives
from ..signatures.wording import quantity

ITERATIONS = 3
"""Gauss-Newton steps before noise is estimated again, and after."""

Pattern = Literal["none", "one", "each", "trend"]
PATTERNS: dict[Pattern, str] = {
    "none": "none, or what the re-tuned model has",
    "one": "one for all voyages",
    "each": "one for each voyage",
    "trend": "a trend from voyage to voyage",
}
"""Patterns of difference between voyages, in words."""


@dataclass(frozen=True)
class Quantity:
    """Something that may differ from voyage to voyage: parameters of an effect.

    absorbed  the coefficient that has the same effect for all voyages, "" for none
    trends    whether it may grow with the voyages
    """

    tag: str
    parameters: tuple[str, ...]
    absorbed: str = ""
    trends: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters as targets."""
        return tuple(f"effects.{self.tag}.{name}" for name in self.parameters)


QUANTITIES = (
    Quantity("current", ("north", "east")),
    Quantity("resistance", ("factor",), absorbed="hull.R_0", trends=True),
)
"""Quantities that may differ between voyages."""

LEG_NAMES = tuple(name for one in QUANTITIES for name in one.names)


@dataclass(frozen=True, eq=False)
class Difference:
    """How one quantity differs between voyages.

    pattern   that is believed
    evidence  gain in chi-squared over its inflation less its cost by BIC, by pattern, beside the others as believed
    unit      of the parameters
    values    (n_voyages, n_parameters) one for each voyage; relative to their mean where ``relative``
    stderr    of them, likewise; NaN where the windows of a voyage do not tell
    common    value for all voyages with standard errors, None where a coefficient has the same effect
    trend     change per voyage with its standard error, by parameter; empty where it cannot have one
    explained share of the error above noise that the pattern removes, beside the others as believed
    """

    quantity: Quantity
    pattern: Pattern
    evidence: Mapping[Pattern, float]
    unit: str
    voyages: tuple[str, ...]
    values: FloatArray
    stderr: FloatArray
    common: tuple[tuple[float, float], ...] | None
    trend: tuple[tuple[float, float], ...]
    relative: bool
    explained: float

    @property
    def sentence(self) -> str:
        """In words."""
        return _current(self) if self.quantity.tag == "current" else _resistance(self)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        parameters = self.quantity.parameters
        return {
            "quantity": self.quantity.tag,
            "pattern": self.pattern,
            "pattern_in_words": PATTERNS[self.pattern],
            "evidence": dict(self.evidence),
            "share_of_error_explained": self.explained,
            "unit": self.unit,
            "relative_to_mean": self.relative,
            "for_all": _told(parameters, self.common) if self.common else None,
            "trend_per_voyage": _told(parameters, self.trend) if self.trend else None,
            "by_voyage": [
                {"voyage": name, **_told(parameters, list(zip(row, errors, strict=True)))}
                for name, row, errors in zip(self.voyages, self.values.tolist(), self.stderr.tolist(), strict=True)
            ],
            "sentence": self.sentence,
        }


def _told(names: Sequence[str], pairs: Sequence[tuple[float, float]]) -> dict[str, Any]:
    return {
        name: {"value": value, "stderr": error if math.isfinite(error) else None}
        for name, (value, error) in zip(names, pairs, strict=True)
    }


def _current(one: Difference) -> str:
    known = np.isfinite(one.stderr).all(axis=1)
    speed = np.hypot(*one.values[known].T) if known.any() else np.zeros(1)
    if one.pattern == "each":
        return f"The current differed from voyage to voyage: {speed.min():.2g} to {speed.max():.2g} m/s."
    if one.pattern == "one" and one.common:
        (north, e_north), (east, e_east) = one.common
        towards = math.degrees(math.atan2(east, north)) % 360.0
        size = quantity(math.hypot(north, east), NORMAL_95 * max(e_north, e_east), "m/s")
        return f"One current sets through all voyages, of {size} towards {towards:.0f}°: none shows to differ."
    return "No current shows in these voyages beyond what was measured."


def _resistance(one: Difference) -> str:
    n = len(one.voyages)
    if one.pattern == "trend":
        ((slope, error),) = one.trend
        word = "grew" if slope > 0.0 else "fell"
        size = quantity(100.0 * abs(slope), 100.0 * NORMAL_95 * error, "%")
        return f"Resistance {word} by {size} per voyage ({n} voyages)."
    if one.pattern == "each":
        off = 100.0 * (one.values - 1.0)
        return (
            f"Resistance differed from voyage to voyage: {np.nanmin(off):+.0f} to {np.nanmax(off):+.0f} % of its mean."
        )
    return f"Resistance was the same in all {n} voyages, as far as these windows tell."


def differences(bench: Workbench, point: Point, voyages: Sequence[str]) -> tuple[Difference, ...]:
    """What differs between voyages, at a fitted point.

    voyages  ids in their order; the windows of ``bench.trials`` are parts of them

    Nothing where there are fewer than three voyages, and of quantities that are no part of the problem.
    """
    if len(voyages) < 3:
        return ()
    asked = [q for q in QUANTITIES if set(q.names) <= set(bench.box.names) and not set(q.names) & set(bench.targets)]
    if bench.options.effects:
        asked = [q for q in asked if q.tag in bench.options.effects]
    if not asked:
        return ()
    own = copy.copy(bench)  # with a noise model of its own
    leg = np.array([voyages.index(trial.whole) for trial in bench.trials])
    held = _Held.at(own, point, asked, leg, len(voyages))
    for again in (False, True):
        for _ in range(ITERATIONS):
            linear = held.linear()
            if linear is None:
                return ()
            held = held.moved(linear)
        if again:
            break
        linear = held.linear()
        if linear is None:
            return ()
        left = linear.left_by(held.full)[linear.measured]
        own.know(noises.estimate(own.problem.cases, own.noise.restore(left)))
    linear = held.linear()
    return () if linear is None else _believed(held, linear, tuple(voyages))


@dataclass(frozen=True, eq=False)
class _Held:
    """The point at which the problem is made linear.

    unit    (n_free,) position of what is free for all voyages alike
    values  (n_voyages, n_names) of what has a value of each voyage, in the unit cube
    common  (n_names,) that of all voyages before
    offsets (n_cases, 6) of the initial states
    """

    bench: Workbench
    point: Point
    asked: Sequence[Quantity]
    leg: IntArray
    unit: FloatArray
    values: FloatArray
    common: FloatArray
    offsets: FloatArray

    @classmethod
    def at(cls, bench: Workbench, point: Point, asked: Sequence[Quantity], leg: IntArray, n: int) -> _Held:
        names = [name for q in asked for name in q.names]
        null = bench.null(names)
        common = np.array(
            [
                point.unit[point.names.index(name)] if name in point.names else float(z)
                for name, z in zip(names, null, strict=True)
            ]
        )
        free = np.array([z for name, z in zip(point.names, point.unit, strict=True) if name not in names])
        return cls(bench, point, asked, leg, free, np.repeat(common[None], n, axis=0), common, point.offsets)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(name for q in self.asked for name in q.names)

    @property
    def free(self) -> tuple[str, ...]:
        """What is free for all voyages alike."""
        return tuple(name for name in self.point.names if name not in self.names)

    @property
    def full(self) -> tuple[Pattern, ...]:
        return tuple("each" for _ in self.asked)

    def retuned(self, q: Quantity) -> bool:
        """Whether a coefficient that is free does the same as one value for all."""
        return q.absorbed in self.free

    def design(self, q: Quantity, pattern: Pattern) -> FloatArray:
        """(n_voyages, k) how a parameter of each voyage follows from what is fitted for a pattern."""
        n = len(self.values)
        ones = np.zeros((n, 0)) if self.retuned(q) else np.ones((n, 1))
        if pattern == "none":
            return np.zeros((n, 0))
        if pattern == "one":
            return ones
        steps = np.arange(n)[:, None] - 0.5 * (n - 1)
        if pattern == "trend":
            return np.hstack([ones, steps])
        if self.retuned(q):  # all but their mean
            return np.asarray(np.linalg.svd(np.eye(n) - 1.0 / n)[0][:, : n - 1])
        return np.eye(n)

    def patterns(self, q: Quantity) -> list[Pattern]:
        """What there may be, the simplest first."""
        found: list[Pattern] = []
        if self.retuned(q) or not set(q.names) & set(self.point.names):
            found.append("none")
        if not self.retuned(q):
            found.append("one")
        if q.trends:
            found.append("trend")
        return [*found, "each"]

    def linear(self) -> _Linear | None:
        """The problem made linear here; None where a simulation diverges."""
        names = (*self.free, *self.names)
        problem = self.bench.problem_of(names, self.point.integrator).with_offsets(self.offsets)
        n_rows = problem.n_residuals
        columns = np.zeros((n_rows, 1 + len(names)))
        for k, own in enumerate(self.values):
            at = np.concatenate([self.unit, own])
            moved = np.repeat(at[:, None], 1 + len(names), axis=1)
            moved[np.arange(len(names)), 1 + np.arange(len(names))] += STEP
            runs = problem.residuals(moved).T
            for case in np.flatnonzero(self.leg == k):
                rows = problem.rows_of_cases[case]
                columns[rows] = runs[rows]
        if not np.isfinite(columns[:, 0]).all():
            return None
        columns[:, 1:] = flat_where_lost((columns[:, 1:] - columns[:, :1]) / STEP)
        by_offset = self.bench.noise.apply(
            flat_where_lost(offset_derivatives(self.bench, replace(self.point, offsets=self.offsets)))
        )
        columns = self.bench.noise.apply(columns)
        left = problem.without_offsets(columns, by_offset, problem.prior, self.offsets)
        first, blocks = blocks_of(problem)
        leg = np.repeat(self.leg, np.diff(np.append(first, len(left))))
        inside = np.array([0.0 < z < 1.0 for z in self.unit], dtype=bool)

        def moves(change: FloatArray) -> FloatArray:
            """(n_cases, 6) offsets that go with residuals that change by so much."""
            found = self.offsets.copy()
            for case, rows in enumerate(problem.rows_of_cases):
                root = np.sqrt(problem.prior[case])
                A = np.vstack([by_offset[rows], np.diag(root)])
                b = np.concatenate([columns[rows, 0] + change[rows], root * self.offsets[case]])
                found[case] -= np.linalg.lstsq(A, b, rcond=1e-12)[0]
            return found

        at_rows = problem.by_row(self.leg)
        return _Linear(
            held=self,
            residual=left[:, 0],
            by_free=left[:, 1 : 1 + len(self.free)],
            by_leg=left[:, 1 + len(self.free) :],
            leg=leg,
            inside=inside,
            cases=first,
            blocks=blocks,
            raw=columns,
            raw_leg=at_rows,
            moves=moves,
        )

    def moved(self, linear: _Linear) -> _Held:
        """With the solution of the linear problem, a value for each voyage."""
        step, values = linear.solve(self.full)
        unit, values = np.clip(self.unit + step, 0.0, 1.0), np.clip(values, 0.0, 1.0)
        own = linear.raw[:, 1 + len(unit) :] * (values - self.values)[linear.raw_leg]
        change = linear.raw[:, 1 : 1 + len(unit)] @ (unit - self.unit) + own.sum(axis=1)
        return replace(self, unit=unit, values=values, offsets=linear.moves(change))


@dataclass(frozen=True, eq=False)
class _Linear:
    """The linear problem: rows as in ``linear.Linear``.

    residual  (n_rows,) where it was made linear
    by_free   (n_rows, n_free), by_leg (n_rows, n_names) derivatives
    leg       (n_rows,) voyage of each row
    inside    (n_free,) which are within their bounds
    cases     first rows of the windows; blocks: of pieces of about a minute
    raw       (n_residuals, 1 + n_free + n_names) residual and derivatives before initial states took their part
    raw_leg   (n_residuals,) voyage of each of its rows
    moves     change of those residuals -> offsets of the initial states
    """

    held: _Held
    residual: FloatArray
    by_free: FloatArray
    by_leg: FloatArray
    leg: IntArray
    inside: BoolArray
    cases: IntArray
    blocks: IntArray
    raw: FloatArray
    raw_leg: IntArray
    moves: Callable[[FloatArray], FloatArray]

    @property
    def measured(self) -> BoolArray:
        """(n_rows,) which rows are residuals; the others are offsets."""
        return measured_rows(self.cases, len(self.residual))

    def columns(self, patterns: Sequence[Pattern]) -> FloatArray:
        """(n_rows, k) what the parameters of patterns change."""
        found, i = [], 0
        for q, pattern in zip(self.held.asked, patterns, strict=True):
            E = self.held.design(q, pattern)
            for _ in q.names:
                found.append(E[self.leg] * self.by_leg[:, i : i + 1])
                i += 1
        return np.hstack(found)

    @property
    def start(self) -> FloatArray:
        """(n_rows,) the residual as it would be with the common values."""
        off = self.held.common - self.held.values
        return np.asarray(self.residual + np.sum(self.by_leg * off[self.leg], axis=1))

    def solution(self, patterns: Sequence[Pattern]) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Matrix (n_rows, n), solution (n,) and residual (n_rows,)."""
        A = np.hstack([self.by_free[:, self.inside], self.columns(patterns)])
        size = np.linalg.norm(A, axis=0)
        scale = np.where(size > 0.0, size, 1.0)
        x = np.linalg.lstsq(A / scale, -self.start, rcond=1e-9)[0] / scale
        return A, x, self.start + A @ x

    def left_by(self, patterns: Sequence[Pattern]) -> FloatArray:
        """(n_rows,) the residual with the best values of patterns."""
        return self.solution(patterns)[2]

    def solve(self, patterns: Sequence[Pattern]) -> tuple[FloatArray, FloatArray]:
        """Step of what is free (n_free,), values (n_voyages, n_names) in the unit cube."""
        x = self.solution(patterns)[1]
        step = np.zeros(len(self.inside))
        n_free = int(self.inside.sum())
        step[self.inside] = x[:n_free]
        return step, self.held.common + self.spread(patterns, np.eye(len(x))[n_free:] @ x)

    def spread(self, patterns: Sequence[Pattern], x: FloatArray) -> FloatArray:
        """(n_voyages, n_names) from what is fitted for patterns."""
        values, at = [], 0
        for q, pattern in zip(self.held.asked, patterns, strict=True):
            E = self.held.design(q, pattern)
            for _ in q.names:
                values.append(E @ x[at : at + E.shape[1]])
                at += E.shape[1]
        return np.column_stack(values)

    def inflation(self) -> float:
        """Variance of noise along what voyages may have of their own, over that of independent noise; at least 1."""
        Q0 = basis(self.by_free[:, self.inside])
        own = self.columns(self.held.full)
        Q = basis(own - Q0 @ (Q0.T @ own))
        by_block = np.add.reduceat(Q * self.left_by(self.held.full)[:, None], self.blocks, axis=0)
        return max(1.0, float(np.sum(by_block**2)) / max(1, int(Q.shape[1])))


def _believed(held: _Held, linear: _Linear, voyages: tuple[str, ...]) -> tuple[Difference, ...]:
    """The patterns with the most evidence, each simplified as long as the loss of evidence is not decisive."""
    inflation = linear.inflation()
    price = math.log(held.bench.problem.n_residuals)

    def evidence(patterns: Sequence[Pattern]) -> float:
        k = sum(len(q.names) * held.design(q, one).shape[1] for q, one in zip(held.asked, patterns, strict=True))
        left = linear.left_by(patterns)
        return float(-(left @ left) / inflation - k * price)

    known = {patterns: evidence(patterns) for patterns in itertools.product(*map(held.patterns, held.asked))}
    chosen = max(known, key=lambda patterns: known[patterns])
    for i, q in enumerate(held.asked):
        for simpler in held.patterns(q)[: held.patterns(q).index(chosen[i])]:
            other = (*chosen[:i], simpler, *chosen[i + 1 :])
            if known[chosen] - known[other] < ENOUGH:
                chosen = other
                break
    return tuple(_difference(held, linear, voyages, chosen, known, inflation, i) for i in range(len(held.asked)))


def _difference(
    held: _Held,
    linear: _Linear,
    voyages: tuple[str, ...],
    chosen: Sequence[Pattern],
    known: Mapping[tuple[Pattern, ...], float],
    inflation: float,
    i: int,
) -> Difference:
    q = held.asked[i]
    simplest = (*chosen[:i], held.patterns(q)[0], *chosen[i + 1 :])
    beside = {one: known[(*chosen[:i], one, *chosen[i + 1 :])] - known[simplest] for one in held.patterns(q)}

    before, after = (float(np.sum(linear.left_by(patterns) ** 2)) for patterns in (simplest, chosen))
    above = before - held.bench.problem.n_residuals
    explained = min(1.0, max(0.0, (before - after) / above)) if above > 0.0 else 0.0

    def fitted(pattern: Pattern) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Per name: values (n_voyages, n_names), their deviations, and the last fitted number with its deviation."""
        patterns = (*chosen[:i], pattern, *chosen[i + 1 :])
        A, x, _ = linear.solution(patterns)
        covariance = _covariance(A, inflation)
        n_free = int(linear.inside.sum())
        at = n_free + sum(
            len(one.names) * held.design(one, p).shape[1] for one, p in zip(held.asked[:i], patterns[:i], strict=True)
        )
        E = held.design(q, pattern)
        values, errors, last = [], [], []
        for name in q.names:
            rows = slice(at, at + E.shape[1])
            at += E.shape[1]
            width = float(held.bench.box.width[held.bench.box.names.index(name)])
            low = float(held.bench.box.low[held.bench.box.names.index(name)])
            base = low + width * float(held.common[held.names.index(name)])
            values.append(base + width * (E @ x[rows]))
            deviation = width * np.sqrt(np.maximum(np.diag(E @ covariance[rows, rows] @ E.T), 0.0))
            own = linear.by_leg[:, held.names.index(name)]
            shows = [bool(np.any(own[linear.leg == k])) for k in range(len(voyages))]
            errors.append(np.where(shows, deviation, np.nan))
            last.append((width * float(x[rows][-1]), width * float(np.sqrt(max(covariance[rows, rows][-1, -1], 0.0)))))
        return np.column_stack(values), np.column_stack(errors), np.array(last)

    values, stderr, _ = fitted("each")
    common = None
    if not held.retuned(q):
        one, error, _ = fitted("one")
        common = tuple(zip(one[0].tolist(), error[0].tolist(), strict=True))
    trend: tuple[tuple[float, float], ...] = ()
    if q.trends:
        lines, _, slopes = fitted("trend")
        trend = tuple((float(s / m), float(e / m)) for (s, e), m in zip(slopes, lines.mean(axis=0), strict=True))
    if q.absorbed:
        mean = np.nanmean(values, axis=0)
        values, stderr = values / mean, stderr / mean
        # All are shares of what is absorbed, which is known no better than it is.
        doubt = _doubt(held, linear, q, chosen, inflation)
        stderr = np.hypot(stderr, (values - 1.0) * doubt)
        trend = tuple((slope, math.hypot(error, slope * doubt)) for slope, error in trend)
    return Difference(
        q, chosen[i], beside, _unit(held, q), voyages, values, stderr, common, trend, bool(q.absorbed), explained
    )


def _covariance(A: FloatArray, inflation: float) -> FloatArray:
    """Covariance (n, n) of least-squares values of a matrix (n_rows, n) for noise of variance ``inflation``."""
    size = np.linalg.norm(A, axis=0)
    scale = np.where(size > 0.0, size, 1.0)
    inverse = np.linalg.pinv((A / scale).T @ (A / scale), rcond=1e-12)
    return np.asarray(inflation * inverse / np.outer(scale, scale))


def _doubt(held: _Held, linear: _Linear, q: Quantity, chosen: Sequence[Pattern], inflation: float) -> float:
    """Relative standard error of the coefficient that absorbs a quantity; 0 where it is held."""
    if not held.retuned(q):
        return 0.0
    at = held.free.index(q.absorbed)
    if not linear.inside[at]:
        return 0.0
    A, _, _ = linear.solution(chosen)
    k = int(linear.inside[:at].sum())
    variance = _covariance(A, inflation)[k, k]
    box = held.bench.sub_box([q.absorbed])
    value = float(box.low[0] + box.width[0] * held.unit[at])
    return float(box.width[0] * math.sqrt(max(float(variance), 0.0)) / max(abs(value), 1e-12))


def _unit(held: _Held, q: Quantity) -> str:
    effect = next(one for one in held.bench.model.effects if one.tag == q.tag)
    return str(effect.parameters[q.parameters[0]].unit)
