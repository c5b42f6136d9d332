"""A calibration problem: candidates in the unit cube to J and residuals, all lanes in one call."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..arrays import FloatArray
from ..backends import WIDTH, Backend, Cases, Integrator
from ..model import Model
from .box import Box
from .initial import prior_weight

LANES_AT_ONCE = 512
"""Largest number of runs kept with their residuals at one time, but for the lanes of one block; bounds the memory."""


@dataclass(eq=False)
class FitProblem:
    """Model, cases, targets and box; counts how often it simulated the whole set for one candidate.

    sigma    (n_cases, 6) deviations of the measured initial states where these are estimated, None where they are held
    offsets  (n_cases, 6) offsets of the initial states in use where a call gives none; zero at first
    """

    model: Model
    cases: Cases
    box: Box
    backend: Backend
    integrator: Integrator = field(default_factory=Integrator)
    sigma: FloatArray | None = None
    offsets: FloatArray = field(init=False)
    evaluations: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        self.offsets = np.zeros((len(self.cases), 6))
        self.prior = np.zeros((len(self.cases), 6))  # weight of squared offsets beside J
        if self.sigma is not None:
            self.prior = prior_weight(self.sigma, self.cases.weight)

    @property
    def n_residuals(self) -> int:
        """Number of differences that count."""
        return self.cases.n_residuals

    @property
    def rows_of_cases(self) -> list[slice]:
        """Where the residuals of each case stand."""
        counts = (self.cases.rows >= 0).sum(axis=(1, 2))
        ends = np.cumsum(counts)
        return [slice(int(end - count), int(end)) for end, count in zip(ends, counts, strict=True)]

    def theta(self, unit: FloatArray) -> FloatArray:
        """Coefficient matrix (n_rows, n_candidates) at positions (n_targets, n_candidates) in the unit cube."""
        return self.model.matrix(self.box.names, self.box.from_unit(unit))

    def initial(self, n_candidates: int, offsets: FloatArray | None) -> FloatArray:
        """Initial states (n_cases, n_candidates, 6)."""
        if offsets is None:
            return np.repeat((self.cases.initial + self.offsets)[:, None], n_candidates, axis=1)
        return self.cases.initial[:, None] + offsets

    def costs(self, unit: FloatArray, offsets: FloatArray | None = None) -> FloatArray:
        """J of candidates (n_targets, n_candidates) -> (n_candidates,); inf where a run diverged.

        offsets  (n_cases, n_candidates, 6) of the initial states, the problem's own where None
        """
        return np.asarray(self.costs_by_case(unit, offsets).sum(axis=0))

    def costs_by_case(self, unit: FloatArray, offsets: FloatArray | None = None) -> FloatArray:
        """J of candidates by case, (n_cases, n_candidates); arguments as for ``costs``."""
        n_candidates = unit.shape[1]
        self.evaluations += n_candidates
        result = self.backend.run(
            self.model,
            self.theta(unit),
            self.cases,
            initial=self.initial(n_candidates, offsets),
            integrator=self.integrator,
        )
        return result.cost

    def residuals(self, unit: FloatArray, offsets: FloatArray | None = None) -> FloatArray:
        """Residuals of candidates (n_targets, n_candidates) -> (n_candidates, n_residuals); J is their sum of squares.

        Ordered by case, sample and channel.  A candidate that diverged has inf everywhere.
        """
        n_candidates = unit.shape[1]
        self.evaluations += n_candidates
        initial = self.initial(n_candidates, offsets)
        out = np.empty((self.n_residuals, n_candidates))
        chunk = max(WIDTH, LANES_AT_ONCE // len(self.cases))
        for first in range(0, n_candidates, chunk):
            rows = slice(first, first + chunk)
            result = self.backend.run(
                self.model,
                self.theta(unit[:, rows]),
                self.cases,
                initial=initial[:, rows],
                integrator=self.integrator,
                keep_residuals=True,
            )
            assert result.residuals is not None  # asked for
            out[:, rows] = result.residuals
            out[:, rows][:, result.diverged.any(axis=0)] = np.inf
        return out.T

    def jacobians(
        self, unit: FloatArray, offsets: FloatArray | None = None, step: float = 1e-6
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Residuals and their derivatives at points (n_targets, n_points) of the unit cube, by forward differences.

        -> residuals (n_points, n_residuals), derivatives by target (n_points, n_residuals, n_targets), and by the six
        initial offsets of the case a residual belongs to (n_points, n_residuals, 6; empty where they are held).
        Steps go inwards where a point is on the upper bound.  All points and columns run as lanes of one call.
        """
        n_targets, n_points = unit.shape
        extra = 0 if self.sigma is None else 6
        n_columns = 1 + n_targets + extra
        steps = np.where(unit + step > 1.0, -step, step)
        columns = np.repeat(unit[:, :, None], n_columns, axis=2)
        for k in range(n_targets):
            columns[k, :, 1 + k] += steps[k]
        base_offsets = np.repeat(self.offsets[:, None], n_points, axis=1) if offsets is None else offsets
        moved = np.repeat(base_offsets[:, :, None], n_columns, axis=2)
        if self.sigma is not None:
            for k in range(6):
                moved[:, :, 1 + n_targets + k, k] += step * self.sigma[:, None, k] * 1e3
        values = self.residuals(columns.reshape(n_targets, -1), moved.reshape(len(self.cases), -1, 6))
        values = values.T.reshape(-1, n_points, n_columns).transpose(1, 0, 2)
        base = values[:, :, :1]
        with np.errstate(invalid="ignore"):
            slopes = values[:, :, 1 : 1 + n_targets] - base
            slopes /= steps.T[:, None, :]
            by_offset = values[:, :, 1 + n_targets :] - base
            if self.sigma is not None:
                for case, rows in enumerate(self.rows_of_cases):
                    by_offset[:, rows] /= step * self.sigma[case] * 1e3
        return base[:, :, 0], slopes, by_offset

    def central_jacobian(self, unit: FloatArray, step: float = 1e-5) -> tuple[FloatArray, FloatArray]:
        """Residuals (n_residuals,) and derivatives (n_residuals, n_targets) at one point, by central differences.

        Looks a step beyond the bounds where the point is on one.
        """
        n = len(unit)
        columns = np.repeat(unit[:, None], 2 * n + 1, axis=1)
        columns[np.arange(n), 1 + np.arange(n)] += step
        columns[np.arange(n), 1 + n + np.arange(n)] -= step
        values = self.residuals(columns)
        return values[0], (values[1 : n + 1] - values[n + 1 :]).T / (2.0 * step)
