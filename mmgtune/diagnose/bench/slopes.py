"""Derivatives by less work than the simulation itself: a search needs only to know which way to go."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...backends import Integrator
from ...fitting.problem import FitProblem

METHODS = ("euler", "heun")
"""Methods of integration, the least work first."""

NEARLY = 0.05
"""Share of its length by which the derivative by any target or initial state may differ."""


def quick_slopes(problem: FitProblem, unit: FloatArray) -> Integrator | None:
    """The integrator with the least work whose derivatives at a point (n_targets,) are nearly those of a problem's own;
    None where none is."""
    own = _derivatives(problem, unit)
    least = NEARLY * np.linalg.norm(own, axis=0)
    for name in METHODS:
        by = Integrator(name)
        if len(by.tableau[0]) >= len(problem.integrator.tableau[0]) * problem.integrator.substeps:
            break
        with np.errstate(invalid="ignore"):  # where a run is lost
            off = np.linalg.norm(_derivatives(problem.with_integrator(by), unit) - own, axis=0)
        if np.all(off <= least):
            return by
    return None


def _derivatives(problem: FitProblem, unit: FloatArray) -> FloatArray:
    """(n_residuals, n) by each target, and by each initial offset that is estimated; NaN where a run is lost."""
    _, by_target, by_offset = problem.jacobians(unit[:, None])
    return np.concatenate([by_target[0], by_offset[0]], axis=1)
