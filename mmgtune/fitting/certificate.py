"""Why to believe that the optimum is one: who agrees on it, and what the gradient says at it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..displayed import Brief
from .cmaes import Restart
from .least_squares import LeastSquaresResult
from .problem import FitProblem

TOLERANCE = 1e-4
"""Relative difference of J within which two ends count as the same optimum."""

LEAST_J = 1e-12
"""J below which all are the same: of trials that the profile itself has made."""


@dataclass(frozen=True)
class ActiveBound:
    """A target held by its bound, and how much J would fall if it were wider by 1 % of the pre-determined value."""

    name: str
    side: str
    gain_per_percent: float


@dataclass(frozen=True, eq=False, repr=False)
class Certificate(Brief):
    """Agreement of independent searches on J, and the conditions of a bounded minimum.

    projected_gradient  largest slope of J along a free target, over its box width, relative to J [-]
    step_gain           relative fall of J that one more Gauss-Newton step predicts [-]
    """

    restarts: int
    restarts_agreeing: int
    starts: int
    starts_agreeing: int
    J_cmaes: float | None
    J_least_squares: float
    projected_gradient: float
    step_gain: float
    active: tuple[ActiveBound, ...]
    sentences: tuple[str, ...]

    def agreement(self) -> dict[str, Any]:
        """The part of the JSON called agreement."""
        difference = None
        if self.J_cmaes is not None:
            difference = abs(self.J_cmaes - self.J_least_squares) / max(self.J_least_squares, 1e-300)
        return {
            "restarts": self.restarts,
            "restarts_agreeing": self.restarts_agreeing,
            "starts": self.starts,
            "starts_agreeing": self.starts_agreeing,
            "tolerance": TOLERANCE,
            "J_cmaes": self.J_cmaes,
            "J_least_squares": self.J_least_squares,
            "relative_difference": difference,
        }

    def to_dict(self) -> dict[str, Any]:
        """The part of the JSON called certificate."""
        return {
            "projected_gradient": self.projected_gradient,
            "step_gain": self.step_gain,
            "active": [asdict(bound) for bound in self.active],
            "sentences": list(self.sentences),
        }


def certify(
    problem: FitProblem,
    unit: FloatArray,
    J: float,
    J_before: float,
    starts: list[LeastSquaresResult],
    restarts: list[Restart],
    J_cmaes: float | None,
    ridge: float,
    anchor: FloatArray,
) -> Certificate:
    """The certificate at a point of the unit cube (n_targets,) with value J.

    ridge, anchor  weight of the squared distance from a point of the cube, 0 where the fit is not regularised.  The
                   cost is J with that added, here as in the search

    Agreement is relative to J, or to a 1e-9th of J before tuning where J is smaller than that (noise-free trials), but
    never to less than LEAST_J.
    """

    def cost(value: float, at: FloatArray) -> float:
        return value + ridge * float(np.sum((at - anchor) ** 2))

    J = cost(J, unit)
    floor = max(J, 1e-9 * J_before, LEAST_J)
    residuals, jacobian = problem.central_jacobian(unit)
    if ridge > 0.0:
        residuals = np.concatenate([residuals, np.sqrt(ridge) * (unit - anchor)])
        jacobian = np.vstack([jacobian, np.sqrt(ridge) * np.eye(len(unit))])
    gradient = 2.0 * jacobian.T @ residuals
    low, high = unit <= 0.0, unit >= 1.0
    active = (low & (gradient > 0.0)) | (high & (gradient < 0.0))
    free = ~active
    per_percent = 0.01 * problem.box.relative / problem.box.width
    bounds = tuple(
        ActiveBound(name, problem.box.bound_at(i, unit[i]) or "", float(abs(gradient[i]) * per_percent[i]))
        for i, name in enumerate(problem.box.names)
        if active[i]
    )
    step = np.linalg.lstsq(jacobian[:, free], residuals, rcond=1e-10)[0] if free.any() else np.zeros(0)
    gain = float(np.sum((jacobian[:, free] @ step) ** 2)) / floor
    slope = float(np.abs(gradient[free]).max() / floor) if free.any() else 0.0

    def agreeing(values: list[float]) -> int:
        return sum(value - J <= TOLERANCE * floor for value in values)

    J_starts = [cost(start.J, start.unit) for start in starts]
    result = Certificate(
        restarts=len(restarts),
        restarts_agreeing=agreeing([restart.J for restart in restarts]),
        starts=len(starts),
        starts_agreeing=agreeing(J_starts),
        J_cmaes=J_cmaes,
        J_least_squares=min(start.J for start in starts),
        projected_gradient=slope,
        step_gain=gain,
        active=bounds,
        sentences=(),
    )
    others = sorted({f"{value:.6g}" for value in J_starts if value - J > TOLERANCE * floor}, key=float)
    return replace(result, sentences=_sentences(result, others))


def _sentences(c: Certificate, others: list[str]) -> tuple[str, ...]:
    sentences = []
    if c.restarts:
        sentences.append(
            f"{c.restarts_agreeing} of {c.restarts} CMA-ES restarts end within {TOLERANCE:g} of the best J."
        )
    sentences.append(f"{c.starts_agreeing} of {c.starts} least-squares starts end within {TOLERANCE:g} of the best J.")
    if others:
        sentences.append(f"Other ends of starts, with a higher J: {', '.join(others[:5])}.")
    sentences.append(
        f"One more Gauss-Newton step would lower the cost by {c.step_gain:.1e} of itself; "
        f"largest slope along a free coefficient {c.projected_gradient:.1e} J per box width."
    )
    for bound in sorted(c.active, key=lambda b: -b.gain_per_percent):
        sentences.append(
            f"{bound.name} is held by its {'lower' if bound.side == 'low' else 'upper'} bound: "
            f"1 % more room would lower J by {bound.gain_per_percent:.3g}."
        )
    return tuple(sentences)
