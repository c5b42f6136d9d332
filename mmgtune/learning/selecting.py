"""Forward selection: terms chosen one by one by what they explain on runs that they were not fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray

PARTS = 5
"""Parts the runs are left out in, one after the other."""

MOST = 4
"""Terms chosen at most."""

LEAST, LEAST_OF_ALL = 0.02, 0.005
"""Share of the squares that are left, and of all, that one more term has to explain."""

NOTHING = 1e-6
"""Share of the squares with which nothing is left to explain."""

ALIKE = 0.05
"""Terms whose share is less than this below the best do about as well."""

RIDGE = 1e-9
"""Added to the diagonal of normal equations of columns of length one: terms may all but agree."""

SINGULAR = 1e-5
"""Least square of what a column of length one has beyond others: with less its factor says nothing."""


@dataclass(frozen=True, eq=False)
class Chosen:
    """A term that was chosen.

    column  its place
    factor  on its column, with what was there before it free
    spread  standard deviation of the factor over the parts left out, over its size
    share   of the squares that were left before it, what it explains on unseen runs; shares (n_components,) of each
            component's own, 0 of one that hardly has any
    alike   other columns that do about as well, with their share
    """

    column: int
    factor: float
    spread: float
    share: float
    shares: FloatArray
    alike: tuple[tuple[int, float], ...]


@dataclass(frozen=True, eq=False)
class Selection:
    """What was selected: the share that the columns given explain, and the terms beyond them."""

    given: float
    chosen: tuple[Chosen, ...]


def select(
    y: FloatArray,
    columns: FloatArray,
    families: Sequence[str],
    *,
    given: Sequence[int],
    one_way: BoolArray,
    most: FloatArray,
    run: IntArray,
) -> Selection:
    """Columns that give y, the best first.

    y         (n, n_components)
    columns   (n, n_components, n_columns)
    families  of which one column at most is chosen
    given     columns that are there from the first: what others explain counts beyond these
    one_way   (n_columns,) columns whose factor is positive
    most      (n_columns,) largest size of each factor
    run       (n,) run of each row: these are left out as a whole
    """
    # Columns of like size, so that normal equations are as well conditioned as they can be.
    size = np.sqrt(np.einsum("ncp,ncp->p", columns, columns))
    sums = _Sums(y, columns / size, _parts(run))
    family = np.unique(families, return_inverse=True)[1]
    have = [*given]
    before = sums.explained(have)
    at_first = _share(before, sums.squares)
    chosen: list[Chosen] = []
    while len(chosen) < MOST and sums.squares.sum() - before.sum() > NOTHING * sums.squares.sum():
        free = ~np.isin(family, family[have])
        if not free.any():
            break
        whole = sums.next_factors(have, None)
        fits = free & (np.abs(whole) <= most * size) & ~(one_way & (whole <= 0.0))
        after = sums.explained_by_next(have)
        shares = np.where(fits, (after.sum(axis=0) - before.sum()) / (sums.squares.sum() - before.sum()), -np.inf)
        best = int(np.argmax(shares))
        gain = float(after[:, best].sum() - before.sum()) / float(sums.squares.sum())
        if not (shares[best] > LEAST and gain > LEAST_OF_ALL):
            break
        factors = [sums.next_factors(have, one)[best] for one in range(sums.count)]
        alike: dict[int, tuple[int, float]] = {}  # the best of each family
        for k in np.argsort(-shares).tolist():
            if shares[k] > shares[best] - ALIKE and family[k] != family[best]:
                alike.setdefault(int(family[k]), (k, float(shares[k])))
        left = sums.squares - before
        counts = sums.squares > NOTHING * sums.squares.sum()
        chosen.append(
            Chosen(
                best,
                float(whole[best] / size[best]),
                float(np.std(factors) / abs(whole[best])),
                float(shares[best]),
                np.where(counts, (after[:, best] - before) / np.where(counts, left, 1.0), 0.0),
                tuple(alike.values()),
            )
        )
        have.append(best)
        before = after[:, best]
    return Selection(at_first, tuple(chosen))


def _share(explained: FloatArray, squares: FloatArray) -> float:
    return float(explained.sum() / squares.sum())


def _parts(run: IntArray) -> IntArray:
    """(n,) part of each row: runs in turn."""
    names, place = np.unique(run, return_inverse=True)
    return np.asarray(place % min(PARTS, max(2, len(names))))


class _Sums:
    """Normal equations of the parts, and fits without one of them.

    squares  (n_components,) of y
    """

    def __init__(self, y: FloatArray, columns: FloatArray, part: IntArray):
        self.count = int(part.max(initial=0)) + 1
        parts = [part == one for one in range(self.count)]
        self.A = np.array([[own.T @ own for own in np.moveaxis(columns[of], 1, 0)] for of in parts])
        self.b = np.array([np.einsum("ncp,nc->cp", columns[of], y[of]) for of in parts])
        self.squares: FloatArray = np.sum(y * y, axis=0)

    def _others(self, without: int | None) -> tuple[FloatArray, FloatArray]:
        """Normal equations of all parts but one; of all where it is the only one."""
        A, b = self.A.sum(axis=(0, 1)), self.b.sum(axis=(0, 1))
        if without is not None and self.count > 1:
            A, b = A - self.A[without].sum(axis=0), b - self.b[without].sum(axis=0)
        return A + RIDGE * np.eye(len(A)), b

    def next_factors(self, have: list[int], without: int | None) -> FloatArray:
        """(n_columns,) factor of each column, were it fitted beside those there are."""
        return self._beside(have, without)[0]

    def explained(self, have: list[int]) -> FloatArray:
        """(n_components,) squares that columns explain where they were not fitted."""
        gone = np.zeros(len(self.squares))
        if have:
            at = np.ix_(have, have)
            for one in range(self.count):
                A, b = self._others(one)
                f = np.linalg.solve(A[at], b[have])
                gone += [2.0 * f @ own[have] - f @ of[at] @ f for of, own in zip(self.A[one], self.b[one], strict=True)]
        return gone

    def explained_by_next(self, have: list[int]) -> FloatArray:
        """(n_components, n_columns) the same with each column beside those there are."""
        gone = np.zeros((len(self.squares), self.A.shape[-1]))
        for one in range(self.count):
            factor, others = self._beside(have, one)
            for k, (A, b) in enumerate(zip(self.A[one], self.b[one], strict=True)):
                linear = b[have] @ others + b * factor
                square = np.sum(others * (A[np.ix_(have, have)] @ others), axis=0) + factor**2 * np.diag(A)
                mixed = 2.0 * factor * np.sum(others * A[have], axis=0)
                gone[k] += 2.0 * linear - square - mixed
        return gone

    def _beside(self, have: list[int], without: int | None) -> tuple[FloatArray, FloatArray]:
        """Factor of each column, (n_columns,), and of those there are beside it, (n_have, n_columns)."""
        A, b = self._others(without)
        if not have:
            return b / np.diag(A), np.zeros((0, len(b)))
        solved = np.linalg.solve(A[np.ix_(have, have)], np.column_stack([b[have], A[have]]))
        alone, along = solved[:, 0], solved[:, 1:]
        left = np.maximum(np.diag(A) - np.sum(A[have] * along, axis=0), SINGULAR)
        factor = (b - A[have].T @ alone) / left
        return factor, alone[:, None] - along * factor
