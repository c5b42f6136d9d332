"""The problem with values of each voyage, made linear at a point: all patterns of difference are restrictions of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...fitting.quadratic import flat_where_lost
from ..bench.workbench import Point, Workbench
from ..signatures.linear import STEP, basis, blocks_of, measured_rows, offset_derivatives
from .difference import Pattern, Quantity


@dataclass(frozen=True, eq=False)
class ByVoyage:
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
    def at(cls, bench: Workbench, point: Point, asked: Sequence[Quantity], leg: IntArray, n: int) -> ByVoyage:
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

    def linear(self) -> LinearByVoyage | None:
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
        return LinearByVoyage(
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

    def moved(self, linear: LinearByVoyage) -> ByVoyage:
        """With the solution of the linear problem, a value for each voyage."""
        step, values = linear.solve(self.full)
        unit, values = np.clip(self.unit + step, 0.0, 1.0), np.clip(values, 0.0, 1.0)
        own = linear.raw[:, 1 + len(unit) :] * (values - self.values)[linear.raw_leg]
        change = linear.raw[:, 1 : 1 + len(unit)] @ (unit - self.unit) + own.sum(axis=1)
        return replace(self, unit=unit, values=values, offsets=linear.moves(change))


@dataclass(frozen=True, eq=False)
class LinearByVoyage:
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

    held: ByVoyage
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
