"""A calibration problem: candidates in the unit cube to J and residuals, all lanes in one call."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ..backends import Backend, Cases, Integrator
from ..model import Model
from .box import Box

FloatArray = npt.NDArray[np.float64]

LANES_AT_ONCE = 4096
"""Largest number of runs kept with their residuals at one time; bounds the memory a Jacobian takes."""


@dataclass(eq=False)
class FitProblem:
    """Model, cases, targets and box; counts how often it simulated the whole set for one candidate."""

    model: Model
    cases: Cases
    box: Box
    backend: Backend
    integrator: Integrator = field(default_factory=Integrator)
    evaluations: int = 0

    def __post_init__(self) -> None:
        self.mask: npt.NDArray[np.bool_] = self.cases.weight > 0.0
        self._root = np.sqrt(self.cases.weight[self.mask])
        self._target = self.cases.target[self.mask]

    @property
    def n_residuals(self) -> int:
        """Number of differences that count."""
        return int(self.mask.sum())

    def theta(self, unit: FloatArray) -> FloatArray:
        """Coefficient matrix (n_rows, n_candidates) at positions (n_targets, n_candidates) in the unit cube."""
        return self.model.matrix(self.box.names, self.box.from_unit(unit))

    def costs(self, unit: FloatArray) -> FloatArray:
        """J of candidates (n_targets, n_candidates) -> (n_candidates,); inf where a run diverged."""
        self.evaluations += unit.shape[1]
        result = self.backend.run(self.model, self.theta(unit), self.cases, integrator=self.integrator)
        return np.asarray(result.cost.sum(axis=0))

    def residuals(self, unit: FloatArray) -> FloatArray:
        """Residuals of candidates (n_targets, n_candidates) -> (n_candidates, n_residuals); J is their sum of squares.

        Ordered by case, sample and channel.  A candidate that diverged has inf everywhere.
        """
        n_candidates = unit.shape[1]
        out = np.empty((n_candidates, self.n_residuals))
        chunk = max(1, LANES_AT_ONCE // len(self.cases))
        for first in range(0, n_candidates, chunk):
            part = unit[:, first : first + chunk]
            self.evaluations += part.shape[1]
            result = self.backend.run(
                self.model, self.theta(part), self.cases, integrator=self.integrator, keep_states=True
            )
            assert result.states is not None  # asked for
            for k in range(part.shape[1]):
                with np.errstate(invalid="ignore", over="ignore"):
                    out[first + k] = (result.states[:, k][self.mask] - self._target) * self._root
                if result.diverged[:, k].any():
                    out[first + k] = np.inf
        return out

    def jacobians(self, unit: FloatArray, step: float = 1e-6) -> tuple[FloatArray, FloatArray]:
        """Residuals and their derivatives at points (n_targets, n_points) of the unit cube, by forward differences.

        -> (n_points, n_residuals), (n_points, n_residuals, n_targets).  Steps go inwards where a point is on the
        upper bound.  All points and columns run as lanes of one call.
        """
        n_targets, n_points = unit.shape
        steps = np.where(unit + step > 1.0, -step, step)
        columns = np.repeat(unit[:, :, None], n_targets + 1, axis=2)
        for k in range(n_targets):
            columns[k, :, k + 1] += steps[k]
        values = self.residuals(columns.reshape(n_targets, -1)).reshape(n_points, n_targets + 1, -1)
        base = values[:, 0]
        with np.errstate(invalid="ignore"):
            slopes = (values[:, 1:] - base[:, None]) / steps.T[:, :, None]
        return base, slopes.transpose(0, 2, 1)

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
