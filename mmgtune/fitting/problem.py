"""A calibration problem: candidates in the unit cube to J and residuals, all lanes in one call."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Self, TypeVar

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..backends import WIDTH, Backend, Cases, Integrator
from ..first_states import prior_weight
from ..model import Model
from ..predictor import PhysicsPredictor, Prediction
from .box import Box, base_of, group_of
from .terms import Term

PerCase = TypeVar("PerCase", FloatArray, IntArray)

LANES_AT_ONCE = 512
"""Largest number of runs kept with their residuals at one time, but for the lanes of one block; bounds the memory."""

FORWARD = 1e-6
"""Step of forward differences, of a target in the unit cube; a thousand times as much of the deviation of an offset."""

CENTRAL, CENTRAL_OFFSET = 1e-5, 1e-2
"""Steps of central differences: of a target in the unit cube, and of an offset in deviations of the initial states."""


@dataclass
class Counter:
    """How often the whole set was simulated for one candidate; shared by a problem and those derived from it."""

    evaluations: int = 0


@dataclass(frozen=True, eq=False)
class FitProblem:
    """Model, cases, targets, box and terms.

    ``with_...``, ``estimated`` and ``from_measured`` give another problem; only ``counter`` changes.

    sigma    (n_cases, 6) deviations of the measured initial states where these are estimated, None where they are held
    offsets  (n_cases, 6) offsets of the initial states in use where a call gives none
    prior    (n_cases, 6) weight of squared offsets beside J; zero where initial states are held
    terms    rows of residuals besides those of the cases, behind them in this order
    weight   of the squares of these rows beside J
    groups   (n_cases) groups each case belongs to: a target "coefficient@group" is of these cases alone
    """

    model: Model
    cases: Cases
    box: Box
    backend: Backend
    integrator: Integrator
    sigma: FloatArray | None
    offsets: FloatArray
    prior: FloatArray
    terms: tuple[Term, ...] = ()
    weight: float = 1.0
    groups: tuple[frozenset[str], ...] = ()
    counter: Counter = field(default_factory=Counter)

    @classmethod
    def of(
        cls,
        model: Model,
        cases: Cases,
        box: Box,
        backend: Backend,
        integrator: Integrator = Integrator(),
        sigma: FloatArray | None = None,
        terms: tuple[Term, ...] = (),
    ) -> Self:
        """The problem with offsets of zero and the prior that the noise of the initial states calls for."""
        none = np.zeros((len(cases), 6))
        prior = none if sigma is None else prior_weight(sigma, cases.weight)
        return cls(model, cases, box, backend, integrator, sigma, none, prior, terms)

    def with_offsets(self, offsets: FloatArray) -> Self:
        """Initial states begin (n_cases, 6) off the measured ones where a call does not say otherwise."""
        return replace(self, offsets=offsets)

    def with_weight(self, weight: float) -> Self:
        """The problem with another weight of the terms."""
        return replace(self, weight=weight)

    def with_cases(self, cases: Cases) -> Self:
        """Other cases, such as the same trials with other weights or inputs; what is given by case must fit them."""
        return replace(self, cases=cases)

    def with_integrator(self, integrator: Integrator) -> Self:
        """The problem simulated by another integrator."""
        return replace(self, integrator=integrator)

    def with_targets(self, model: Model, box: Box) -> Self:
        """The problem with other free coefficients, of a model of the same ship."""
        return replace(self, model=model, box=box)

    def with_groups(self, groups: Sequence[frozenset[str]]) -> Self:
        """The problem with cases that belong to these groups."""
        return replace(self, groups=tuple(groups))

    def with_prior(self, sigma: FloatArray, prior: FloatArray) -> Self:
        """Initial states estimated, (n_cases, 6) deviations and weights of squared offsets given apart."""
        return replace(self, sigma=sigma, prior=prior)

    def estimated(self, sigma: FloatArray) -> Self:
        """Initial states estimated within deviations (n_cases, 6), beginning with no offsets."""
        none = np.zeros_like(self.offsets)
        return replace(self, sigma=sigma, offsets=none, prior=prior_weight(sigma, self.cases.weight))

    def from_measured(self) -> Self:
        """Runs begin at the measured initial states; the opposite of ``estimated``."""
        none = np.zeros_like(self.offsets)
        return replace(self, sigma=None, offsets=none, prior=none)

    @property
    def evaluations(self) -> int:
        """How often this problem and those it shares its counter with simulated the whole set for one candidate."""
        return self.counter.evaluations

    def asked(self) -> list[Any]:
        """Numbers and texts that identify this problem in a journal."""
        box = (self.box.names, self.box.low, self.box.high)
        method = (self.model.tags, self.backend.name, self.integrator)
        found: list[Any] = [*box, *method, self.model.base, self.cases.sha256, self.sigma, self.offsets, self.prior]
        if self.model.ties:
            found.append(self.model.ties)
        if self.groups:
            found += [sorted(groups) for groups in self.groups]
        if self.terms:
            found += [self.weight, *(part for term in self.terms for part in term.asked(self))]
        return found

    @property
    def n_residuals(self) -> int:
        """Number of differences between simulated and measured motion that count."""
        return self.cases.n_residuals

    @cached_property
    def rows_of_cases(self) -> list[slice]:
        """Where the residuals of each case stand."""
        counts = (self.cases.rows >= 0).sum(axis=(1, 2))
        ends = np.cumsum(counts)
        return [slice(int(end - count), int(end)) for end, count in zip(ends, counts, strict=True)]

    def theta(self, unit: FloatArray) -> FloatArray:
        """Coefficient matrix (n_rows, n_candidates) at positions (n_targets, n_candidates) in the unit cube.

        (n_rows, n_cases, n_candidates) where targets are of groups of cases.
        """
        values = self.box.from_unit(unit)
        if not self.grouped:
            return self.model.matrix(self.box.names, values)
        n_candidates = unit.shape[1]
        theta = np.empty((len(self.model.base), len(self.cases), n_candidates))
        for names, cases in self._alike:
            own = values[np.array([self._places[case] for case in cases], dtype=np.intp)]
            made = self.model.matrix(names, own.transpose(1, 0, 2).reshape(len(names), -1))
            theta[:, cases] = made.reshape(len(theta), len(cases), n_candidates)
        return theta

    @cached_property
    def _places(self) -> list[list[int]]:
        """The targets that are coefficients of each case."""
        return [np.flatnonzero(own).tolist() for own in self._own]

    @cached_property
    def _alike(self) -> list[tuple[list[str], list[int]]]:
        """Cases with the same coefficients among their targets, whatever group these are of: their names, and which."""
        found: dict[tuple[str, ...], list[int]] = {}
        for case, places in enumerate(self._places):
            found.setdefault(tuple(base_of(self.box.names[k]) for k in places), []).append(case)
        return [(list(names), cases) for names, cases in found.items()]

    @cached_property
    def grouped(self) -> bool:
        """Whether any target is of a group of cases."""
        return any(group_of(name) for name in self.box.names)

    def _is_of(self, k: int, case: int) -> bool:
        """Whether target ``k`` is a coefficient of a case."""
        return bool(self._own[case, k])

    @cached_property
    def _own(self) -> BoolArray:
        """(n_cases, n_targets) which targets are coefficients of which case."""
        groups = [group_of(name) for name in self.box.names]
        return np.array([[not group or group in own for group in groups] for own in self.groups], dtype=bool)

    def initial(self, n_candidates: int, offsets: FloatArray | None) -> FloatArray:
        """Initial states (n_cases, n_candidates, 6)."""
        if offsets is None:
            return np.repeat((self.cases.initial + self.offsets)[:, None], n_candidates, axis=1)
        return self.cases.initial[:, None] + offsets

    def predictor(self, unit: FloatArray) -> PhysicsPredictor:
        """Candidates (n_targets, n_candidates) as members of a predictor; of one case where targets are of groups."""
        theta = self.theta(unit)
        if theta.ndim == 3:
            (theta,) = theta.transpose(1, 0, 2)
        return PhysicsPredictor(self.model, theta, self.integrator, self.backend.name)

    def states(self, unit: FloatArray, offsets: FloatArray | None = None) -> Prediction:
        """Motion of candidates (n_targets, n_candidates) on every case; offsets as for ``costs``."""
        result = self.backend.run(
            self.model,
            self.theta(unit),
            self.cases,
            initial=self.initial(unit.shape[1], offsets),
            integrator=self.integrator,
            keep_states=True,
        )
        return Prediction(result.states, result.diverged)

    def costs(self, unit: FloatArray, offsets: FloatArray | None = None) -> FloatArray:
        """Objective value (J plus weighted terms) per candidate, (n_targets, n_candidates) -> (n_candidates,).

        offsets  (n_cases, n_candidates, 6) of the initial states, the problem's own where None
        inf where a run diverged.
        """
        J = self.misfit(unit, offsets)
        return J + self.weight * sum(self.squares(unit).values()) if self.terms else J

    def misfit(self, unit: FloatArray, offsets: FloatArray | None = None) -> FloatArray:
        """J alone; arguments as for ``costs``."""
        return np.asarray(self.costs_by_case(unit, offsets).sum(axis=0))

    def squares(self, unit: FloatArray) -> dict[str, FloatArray]:
        """Sum of squares of the rows of each term (n_candidates,), by name, not weighed."""
        return {term.name: np.sum(term.residuals(self, unit) ** 2, axis=0) for term in self.terms}

    def costs_by_case(self, unit: FloatArray, offsets: FloatArray | None = None) -> FloatArray:
        """J of candidates by case, (n_cases, n_candidates); arguments as for ``costs``."""
        n_candidates = unit.shape[1]
        self.counter.evaluations += n_candidates
        if not len(self.cases):
            return np.zeros((0, n_candidates))
        result = self.backend.run(
            self.model,
            self.theta(unit),
            self.cases,
            initial=self.initial(n_candidates, offsets),
            integrator=self.integrator,
        )
        return result.cost

    def residuals(self, unit: FloatArray, offsets: FloatArray | None = None) -> FloatArray:
        """Residuals of candidates (n_targets, n_candidates) -> (n_candidates, n_rows); ``costs`` sums their squares.

        Ordered by case, sample and channel; rows of the terms follow, by the root of their weight.  A candidate that
        diverged has inf in all of its cases.
        """
        n_candidates = unit.shape[1]
        self.counter.evaluations += n_candidates
        initial = self.initial(n_candidates, offsets)
        chunk = max(WIDTH, LANES_AT_ONCE // max(len(self.cases), 1))
        if n_candidates <= chunk and not self.terms and len(self.cases):
            return self._simulated(unit, initial).T
        beside = self._beside(unit)
        out = np.empty((self.n_residuals + len(beside), n_candidates))
        out[self.n_residuals :] = beside
        if not len(self.cases):
            return out.T
        for first in range(0, n_candidates, chunk):
            rows = slice(first, first + chunk)
            out[: self.n_residuals, rows] = self._simulated(unit[:, rows], initial[:, rows])
        return out.T

    def _simulated(self, unit: FloatArray, initial: FloatArray) -> FloatArray:
        """Residuals of the cases (n_residuals, n_candidates), from initial states (n_cases, n_candidates, 6)."""
        result = self.backend.run(
            self.model,
            self.theta(unit),
            self.cases,
            initial=initial,
            integrator=self.integrator,
            keep_residuals=True,
        )
        result.residuals[:, result.diverged.any(axis=0)] = np.inf
        return result.residuals

    def _beside(self, unit: FloatArray) -> FloatArray:
        """Rows of the terms by the root of their weight (n_rows, n_candidates); equal candidates are run once."""
        if not self.terms:
            return np.zeros((0, unit.shape[1]))
        apart, of = np.unique(unit, axis=1, return_inverse=True)
        rows = np.vstack([term.residuals(self, apart) for term in self.terms])
        return np.asarray(np.sqrt(self.weight) * rows[:, of.reshape(-1)])

    def jacobians(
        self, unit: FloatArray, offsets: FloatArray | None = None, slopes: Integrator | None = None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Residuals and their derivatives at points (n_targets, n_points) of the unit cube, by forward differences.

        slopes  integrator of the derivatives; the problem's own where None, and where that one diverges at the point

        -> residuals (n_points, n_rows), derivatives by target (n_points, n_rows, n_targets), and by the six initial
        offsets of the case a residual belongs to (n_points, n_rows, 6; empty where they are held).
        Steps go inwards where a point is on the upper bound.  All points and columns run as lanes of one call;
        values of different groups of cases are moved in the same lanes.
        """
        offsets = np.repeat(self.offsets[:, None], unit.shape[1], axis=1) if offsets is None else offsets
        if slopes is not None:
            base, derivatives, by_offset = self.with_integrator(slopes).jacobians(unit, offsets)
            lost = ~np.isfinite(base).all(axis=1)
            if lost.any():
                _, derivatives[lost], by_offset[lost] = self.jacobians(unit[:, lost], offsets[:, lost])
            return self.residuals(unit, offsets), derivatives, by_offset
        n_targets, n_points = unit.shape
        together = self._moved_together()
        n_moved = len(together)
        extra = 0 if self.sigma is None else 6
        n_columns = 1 + n_moved + extra
        steps = np.where(unit + FORWARD > 1.0, -FORWARD, FORWARD)
        columns = np.repeat(unit[:, :, None], n_columns, axis=2)
        for i, moved_here in enumerate(together):
            columns[moved_here, :, 1 + i] += steps[moved_here]
        moved = np.repeat(offsets[:, :, None], n_columns, axis=2)
        if self.sigma is not None:
            self._move_offsets(moved[:, :, 1 + n_moved :])
        n_lanes = n_points * n_columns
        values = self.residuals(columns.reshape(n_targets, n_lanes), moved.reshape(len(self.cases), n_lanes, 6))
        values = values.T.reshape(-1, n_points, n_columns).transpose(1, 0, 2)
        base = values[:, :, :1]
        with np.errstate(invalid="ignore"):
            derivatives = values[:, :, 1 : 1 + n_moved] - base
            if self.grouped:
                derivatives = self._apart(derivatives, together)
            derivatives /= steps.T[:, None, :]
            by_offset = values[:, :, 1 + n_moved :] - base
            if self.sigma is not None:
                by_offset[:, : self.n_residuals] /= self.by_row(FORWARD * self.sigma * 1e3)
        return base[:, :, 0], derivatives, by_offset

    def offset_slopes(self, unit: FloatArray, offsets: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals (n_rows,) and derivatives (n_rows, 6) by the offsets alone, as of ``jacobians``, at one point."""
        assert self.sigma is not None  # asked where initial states are estimated
        moved = np.repeat(offsets[:, None], 7, axis=1)
        self._move_offsets(moved[:, None, 1:])
        values = self.residuals(np.repeat(unit[:, None], 7, axis=1), moved).T
        with np.errstate(invalid="ignore"):
            slopes = values[:, 1:] - values[:, :1]
            slopes[: self.n_residuals] /= self.by_row(FORWARD * self.sigma * 1e3)
        return values[:, 0], slopes

    def _move_offsets(self, moved: FloatArray) -> None:
        """Move offset k in column k of (n_cases, n_points, 6, 6)."""
        assert self.sigma is not None  # asked where initial states are estimated
        for k in range(6):
            moved[:, :, k, k] += FORWARD * self.sigma[:, None, k] * 1e3

    def by_row(self, of_cases: PerCase) -> PerCase:
        """Values by case (n_cases, ...) repeated for each residual of the case (n_residuals, ...)."""
        return np.repeat(of_cases, [rows.stop - rows.start for rows in self.rows_of_cases], axis=0)

    def _moved_together(self) -> list[list[int]]:
        """Indices of targets that can be varied in the same lane, as no case has two of them: values of one coefficient
        for different groups."""
        if not self.grouped:
            return [[k] for k in range(len(self.box))]
        found: dict[tuple[str, str], list[int]] = {}
        for k, name in enumerate(self.box.names):
            found.setdefault((base_of(name), group_of(name).partition(":")[0]), []).append(k)
        return list(found.values())

    def _apart(self, moved: FloatArray, together: Sequence[Sequence[int]]) -> FloatArray:
        """Differences by target (n_points, n_rows, n_targets), from those of targets moved together (n_points, n_rows,
        n_moved)."""
        apart = np.zeros((*moved.shape[:2], len(self.box)))
        for i, targets in enumerate(together):
            for k in targets:
                for case, rows in enumerate(self.rows_of_cases):
                    if self._is_of(k, case):
                        apart[:, rows, k] = moved[:, rows, i]
                apart[:, self.n_residuals :, k] = moved[:, self.n_residuals :, i]
        return apart

    def central_jacobian(self, unit: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals (n_rows,) and derivatives (n_rows, n_targets) at one point, by central differences.

        Looks a step beyond the bounds where the point is on one.
        """
        n = len(unit)
        columns = np.repeat(unit[:, None], 2 * n + 1, axis=1)
        columns[np.arange(n), 1 + np.arange(n)] += CENTRAL
        columns[np.arange(n), 1 + n + np.arange(n)] -= CENTRAL
        values = self.residuals(columns)
        return values[0], (values[1 : n + 1] - values[n + 1 :]).T / (2.0 * CENTRAL)

    def central_offsets(self, unit: FloatArray) -> FloatArray:
        """Derivatives (n_rows, 6) of residuals by the initial offsets of their case, by central differences.

        Initial states must be estimated.
        """
        assert self.sigma is not None  # asked of such problems only
        moved = np.repeat(self.offsets[:, None], 12, axis=1)
        for k in range(6):
            moved[:, k, k] += CENTRAL_OFFSET * self.sigma[:, k]
            moved[:, 6 + k, k] -= CENTRAL_OFFSET * self.sigma[:, k]
        values = self.residuals(np.repeat(unit[:, None], 12, axis=1), moved)
        slopes = (values[:6] - values[6:]).T
        slopes[: self.n_residuals] /= self.by_row(2.0 * CENTRAL_OFFSET * self.sigma)
        return slopes

    def without_offsets(
        self, values: FloatArray, by_offset: FloatArray, prior: FloatArray, offsets: FloatArray | None = None
    ) -> FloatArray:
        """Columns (n_rows, k) less what initial offsets explain of them, six rows longer for each case.

        by_offset  (n_rows, 6) derivatives of the residuals by the offsets of their case
        prior      (n_cases, 6) weight of squared offsets beside squared residuals
        offsets    (n_cases, 6) where the first column is the residuals at these offsets; None where no column is

        The rows added are what is known of the offsets themselves: without them the rest would count for less than it
        says.  Whatever is fitted to the columns that come back is fitted together with the offsets.
        """
        left = np.empty((len(values) + 6 * len(self.cases), values.shape[1]))
        for case, rows in enumerate(self.rows_of_cases):
            root = np.sqrt(prior[case])
            own = left[rows.start + 6 * case : rows.stop + 6 * (case + 1)]
            own[:-6], own[-6:] = values[rows], 0.0
            if offsets is not None:
                own[-6:, 0] = root * offsets[case]
            Q, _ = np.linalg.qr(np.vstack([by_offset[rows], np.diag(root)]))
            own -= Q @ (Q.T @ own)
        beside = values[self.n_residuals :]
        left[len(left) - len(beside) :] = beside
        return left
