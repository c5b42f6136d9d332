"""The quadratic model of a sum of squares around a point, with the offsets of initial states eliminated exactly.

A case's six offsets touch its own residuals only; those that would leave their range are held at its end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..first_states import LARGEST
from .bounded import bounded_steps
from .problem import FitProblem


class _Cases(NamedTuple):
    """Halves of the derivatives that the quadratic model of the cases is made of, before any offset is held.

    at         (n_cases, 6) the offsets where it was made
    curvature  (n_cases, 6, 6) of what is minimised by these, the prior among them
    cross      (n_cases, 6, n_targets) halves of second derivatives by offsets and targets
    slope      (n_cases, 6) its first derivatives by the offsets
    """

    at: FloatArray
    curvature: FloatArray
    cross: FloatArray
    slope: FloatArray


@dataclass(frozen=True, eq=False)
class _Offsets:
    """The offsets of initial states in the quadratic model, those that would leave their range held at its end.

    Entries of a held offset are zero, but for 1 on the diagonal of the curvature.

    free       (n_cases, 6) which are not held
    to_end     (n_cases, 6) how far those that are held move
    whole      (n_cases, 6, 6) halves of second derivatives, with those of what is held
    curvature  (n_cases, 6, 6) halves of second derivatives
    cross      (6 n_cases, n_targets) halves of second derivatives by offsets and targets
    by_held    (n_targets,) half of what the held ones add to the derivatives by the targets
    alone      (6 n_cases,) best step against their slopes where the targets stand
    by_target  (6 n_cases, n_targets) best step for a unit step of each target
    promised   fall of what is minimised by the offsets alone
    """

    free: BoolArray
    to_end: FloatArray
    whole: FloatArray
    curvature: FloatArray
    cross: FloatArray
    by_held: FloatArray
    alone: FloatArray
    by_target: FloatArray
    promised: float

    @classmethod
    def of(cls, cases: _Cases, limit: FloatArray | None, damping: float, step: FloatArray | None) -> _Offsets:
        """How the offsets move with the targets.

        limit  (n_cases, 6) the ends of their ranges, None where none is held
        step   (n_targets,) of the targets that says which would leave it; None for none
        """
        at, whole, cross, slope = cases
        if damping:
            whole = whole + damping * whole * np.eye(6)
        there = slope if step is None else slope + cross @ step
        free, to_end = np.ones(at.shape, dtype=bool), np.zeros(at.shape)
        curvature, pull = whole, slope
        solved = np.linalg.solve(whole, np.concatenate([slope[..., None], cross], axis=2))
        if limit is not None:
            end = at - solved[..., 0] - (0.0 if step is None else solved[..., 1:] @ step)
            leaving = np.flatnonzero(np.any(np.abs(end) > limit, axis=1))
            if len(leaving):
                width = 2.0 * limit[leaving]
                unit = bounded_steps(
                    whole[leaving] * width[:, :, None] * width[:, None],
                    there[leaving] * width,
                    np.clip(at[leaving] / width + 0.5, 0.0, 1.0),
                )
                free[leaving] = (unit > 0.0) & (unit < 1.0)
                to_end[leaving] = np.where(free[leaving], 0.0, (unit - 0.5) * width - at[leaving])
                curvature = np.where(free[:, :, None] & free[:, None], whole, np.eye(6) * ~free[:, None])
                pull = np.where(free, slope + (whole @ to_end[..., None])[..., 0], 0.0)
                cross = np.where(free[..., None], cross, 0.0)
                solved = np.linalg.solve(curvature, np.concatenate([pull[..., None], cross], axis=2))
        moved = to_end - solved[..., 0]
        shape = (6 * len(at), cross.shape[2])
        return cls(
            free,
            to_end,
            whole,
            curvature,
            cross.reshape(shape),
            to_end.reshape(-1) @ cases.cross.reshape(shape),
            solved[..., 0].reshape(-1),
            solved[..., 1:].reshape(shape),
            -float(np.sum(moved * (2.0 * slope + (whole @ moved[..., None])[..., 0]))),
        )

    def move(self, step: FloatArray) -> FloatArray:
        """(n_cases, 6) how far the offsets move beside a step (n_targets,) of the targets."""
        return self.to_end - (self.alone + self.by_target @ step).reshape(-1, 6)


class _Plain(NamedTuple):
    """What a quadratic model is made of, whatever of it is held: halves of derivatives by targets, and of the cases."""

    hessian: FloatArray
    gradient: FloatArray
    cases: _Cases | None


class Quadratic:
    """The quadratic model of what is minimised around one point, with the offsets of initial states eliminated.

    hessian, gradient  by target, halves of the second and first derivatives
    settling           fall of what is minimised that offsets alone promise
    """

    def __init__(
        self,
        problem: FitProblem,
        d: FloatArray,
        residuals: FloatArray,
        jacobian: FloatArray,
        by_offset: FloatArray,
        holding: bool = False,
        damping: float = 0.0,
        step: FloatArray | None = None,
        plain: _Plain | None = None,
    ):
        self.residuals, self._d = residuals, d
        self._problem, self._jacobian, self._by_offset = problem, jacobian, by_offset
        self._rows = problem.rows_of_cases
        self._limit = None if problem.sigma is None else LARGEST * problem.sigma
        self._holding, self._damping = holding, damping
        self._plain = plain or _Plain(jacobian.T @ jacobian, jacobian.T @ residuals, self._cases())
        self.hessian, self.gradient, self.settling = self._plain.hessian, self._plain.gradient, 0.0
        self._own: _Offsets | None = None
        if self._plain.cases is not None:
            own = self._own = _Offsets.of(self._plain.cases, self._limit if holding else None, damping, step)
            self.hessian = self.hessian - own.cross.T @ own.by_target
            self.gradient = self.gradient + own.by_held - own.alone @ own.cross
            self.settling = own.promised

    def _cases(self) -> _Cases | None:
        """The cases with all offsets free."""
        if self._limit is None:
            return None
        of_cases = [(self._by_offset[rows].T, rows) for rows in self._rows]
        return _Cases(
            self._d,
            np.array([by_row @ by_row.T for by_row, _ in of_cases]) + self._problem.prior[:, None] * np.eye(6),
            np.array([by_row @ self._jacobian[rows] for by_row, rows in of_cases]),
            self._slope(self._d, self.residuals),
        )

    def _slope(self, d: FloatArray, residuals: FloatArray) -> FloatArray:
        """(n_cases, 6) halves of the first derivatives by the offsets d, of which the residuals are."""
        return np.array([self._by_offset[rows].T @ residuals[rows] for rows in self._rows]) + self._problem.prior * d

    def with_residuals(self, d: FloatArray, residuals: FloatArray) -> Quadratic:
        """The model with the same derivatives around a point nearby."""
        cases = self._plain.cases
        if cases is not None:
            cases = cases._replace(at=d, slope=self._slope(d, residuals))
        plain = _Plain(self._plain.hessian, self._jacobian.T @ residuals, cases)
        return Quadratic(self._problem, d, residuals, self._jacobian, self._by_offset, self._holding, plain=plain)

    def damped(self, damping: float) -> Quadratic:
        """The model with steps of the offsets damped."""
        return self if self._own is None else self._again(damping, None)

    def about(self, step: FloatArray) -> Quadratic:
        """The model with the offsets held that would leave their range after a step (n_targets,) of the targets."""
        if not self._holding or self._own is None or self._limit is None or self._holds_after(step, self._own):
            return self
        return self._again(self._damping, step)

    def _holds_after(self, step: FloatArray, own: _Offsets) -> bool:
        """Whether after a step the offsets to hold are those that are held: the others are within their range, and
        these would go on beyond it."""
        assert self._plain.cases is not None  # there are offsets
        assert self._limit is not None
        moved = own.move(step)
        end = self._d + moved
        if np.any(np.abs(np.where(own.free, end, 0.0)) > self._limit):
            return False
        slope = self._plain.cases.slope + self._plain.cases.cross @ step + (own.whole @ moved[..., None])[..., 0]
        return not np.any(np.where(own.free, 0.0, slope * np.sign(end)) > 0.0)

    def _again(self, damping: float, step: FloatArray | None) -> Quadratic:
        given = (self._problem, self._d, self.residuals, self._jacobian, self._by_offset)
        return Quadratic(*given, self._holding, damping, step, self._plain)

    def offsets(self, step: FloatArray) -> FloatArray:
        """(n_cases, 6) best offsets after a step (n_targets,) of the targets, kept within their limit."""
        return self._d if self._own is None else self.limited(self._d + self._own.move(step))

    def limited(self, offsets: FloatArray) -> FloatArray:
        """Offsets kept within their limit."""
        return offsets if self._limit is None else np.clip(offsets, -self._limit, self._limit)

    @property
    def scale(self) -> FloatArray:
        """(n_targets,) scale of steps: the length of the change of the residuals by each target."""
        return np.sqrt(np.maximum(np.diag(self.hessian), 0.0))

    def slope(self, steps: FloatArray, shifts: FloatArray) -> FloatArray:
        """First-order change of the residuals by steps (n_targets, k) and shifts of the offsets (n_cases, k, 6)."""
        change = self._jacobian @ steps
        if self._own is not None:
            for rows, own in zip(self._rows, shifts, strict=True):
                change[rows] += self._by_offset[rows] @ own.T
        return change

    def bend(self, curved: FloatArray, damping: float, free: BoolArray) -> tuple[FloatArray, FloatArray]:
        """Step and shift that undo a second derivative of the residuals, by least squares over the free targets."""
        own, gradient = self._own, self._jacobian.T @ curved
        pull = np.zeros((0, 6))
        if own is not None:
            pull = np.array([self._by_offset[rows].T @ curved[rows] for rows in self._rows]) * own.free
            gradient = gradient - pull.reshape(-1) @ own.by_target
        hessian = self.hessian[np.ix_(free, free)]
        damped = hessian + damping * np.diag(np.maximum(np.diag(hessian), 1e-300))
        step = np.zeros(len(gradient))
        step[free] = -np.linalg.lstsq(damped, gradient[free], rcond=1e-14)[0]
        if own is None:
            return step, np.zeros_like(self._d)
        pulled = np.linalg.solve(own.curvature, pull[..., None])[..., 0]
        return step, -(pulled + (own.by_target @ step).reshape(-1, 6))


def flat_where_lost(derivatives: FloatArray) -> FloatArray:
    """Derivatives with 0 for those that are not finite; the usual case costs one pass and no copy."""
    with np.errstate(invalid="ignore", over="ignore"):
        whole = bool(np.isfinite(derivatives.sum()))
    if whole:
        return derivatives
    return np.where(np.isfinite(derivatives), derivatives, 0.0)
