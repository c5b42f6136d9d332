"""Everything around a fitted point made linear: what an effect would change that re-tuning cannot imitate.

Signatures are differences over a typical size of the effect, not derivatives at its null: a lag of the rudder or a rate
limit has no slope there.  They are whitened, and freed of what the initial states and the free coefficients explain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..fitting.box import parameter_of
from ..fitting.least_squares import flat_where_lost
from ..fitting.problem import FitProblem
from ..profile import scale_of
from .inputs import wander
from .workbench import Point, Workbench

FloatArray = npt.NDArray[np.float64]

STEP = 1e-5
"""Step of derivatives, in the unit cube."""

BLOCK = 60.0
"""Length [s] of the pieces noise is resampled in."""

SAME = 1e-5
"""Directions whose signatures are shorter than this share of the longest are numerical noise."""


@dataclass(frozen=True, eq=False)
class Linear:
    """The problem made linear at a point.  Rows: whitened residuals of each trial, then its six initial offsets.

    residual    (n_rows,) less what free coefficients and initial states explain
    names       parameters with a signature
    signature   (n_rows, n_names) likewise, for one typical size of each
    share       (n_names,) of the signature's length that re-tuning leaves
    noise       (n_rows,) the residual less all signatures: hardly anything but noise
    wander      (n_rows, DRAWS) what other noise of the logged inputs would change
    blocks      first rows of pieces of about a minute of one trial
    cases       first rows of the trials
    """

    residual: FloatArray
    names: tuple[str, ...]
    signature: FloatArray
    share: FloatArray
    noise: FloatArray
    wander: FloatArray
    blocks: npt.NDArray[np.int64]
    cases: npt.NDArray[np.int64]

    def columns(self, names: Sequence[str]) -> FloatArray:
        """Signatures of some parameters, (n_rows, n_parameters)."""
        return np.asarray(self.signature[:, [self.names.index(name) for name in names]])

    def chance(self, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What noise has along orthonormal directions Q (n_rows, k): by block (n_blocks, k), by trial and draw of the
        input noise (n_cases, DRAWS, k)."""
        by_block = np.add.reduceat(Q * self.noise[:, None], self.blocks, axis=0)
        ends = np.append(self.cases[1:], len(Q))
        by_trial = [self.wander[a:b].T @ Q[a:b] for a, b in zip(self.cases, ends, strict=True)]
        return by_block, np.array(by_trial)

    def inflation(self, Q: FloatArray) -> float:
        """Variance of noise along directions Q over that of independent noise of variance 1; at least 1."""
        by_block, by_trial = self.chance(Q)
        memory = max(1.0, float(np.sum(by_block**2)) / int(Q.shape[1]))
        return memory + float(np.sum(np.mean(by_trial**2, axis=1))) / int(Q.shape[1])


def typical(bench: Workbench, name: str) -> float:
    """A typical size of a parameter as a step in the unit cube."""
    parameter = parameter_of(bench.model, name)
    assert parameter is not None  # asked of parameters of effects only
    i = bench.box.names.index(name)
    size = {direction: first for first, direction in bench.box.polar}.get(i)
    if size is not None:  # the second component of a size
        return typical(bench, bench.box.names[size])
    return float(parameter.typical(scale_of(bench.model.profile)) / bench.box.width[i])


def linearise(bench: Workbench, point: Point, absent: Sequence[str] = (), apart: Sequence[str] = ()) -> Linear:
    """The problem made linear at ``point``.

    absent  parameters at their null that get a signature over a typical size
    apart   parameters that are free in the point and get a signature, by their derivative, instead of being re-tuned
    """
    wanted = tuple(dict.fromkeys(name for name in absent if name not in point.names))
    names = (*point.names, *wanted)
    problem = bench.problem_of(names, point.integrator)
    problem.offsets = point.offsets
    at = np.concatenate([point.unit, bench.null(wanted)])
    n_free = len(point.names)
    size = np.array([typical(bench, name) for name in wanted])
    plus = np.concatenate([np.full(n_free, STEP), size])
    minus = plus.copy()
    beyond = np.arange(len(names)) >= n_free  # derivatives may look over a bound, typical sizes may not
    plus[beyond & (at + plus > 1.0)] = 0.0
    minus[beyond & (at - minus < 0.0)] = 0.0
    columns = np.repeat(at[:, None], 1 + 2 * len(names), axis=1)
    columns[np.arange(len(names)), 1 + np.arange(len(names))] += plus
    columns[np.arange(len(names)), 1 + len(names) + np.arange(len(names))] -= minus
    runs = problem.residuals(columns).T
    lost = np.asarray(~np.isfinite(runs).all(axis=0))
    runs[:, lost] = runs[:, :1]  # a run that diverged says nothing: its side of the difference is left out
    plus[lost[1 : 1 + len(names)]] = 0.0
    minus[lost[1 + len(names) :]] = 0.0
    values = bench.noise.apply(runs)
    slopes = (values[:, 1 : 1 + len(names)] - values[:, 1 + len(names) :]) / np.maximum(plus + minus, 1e-300)
    for i, name in enumerate(names):
        if parameter_of(bench.model, name) is not None:
            slopes[:, i] *= typical(bench, name)
    by_offset = bench.noise.apply(flat_where_lost(_offset_derivatives(bench, point)))

    left = without_offsets(
        problem, np.column_stack([values[:, 0], slopes, wander(bench, point)]), by_offset, point.offsets
    )
    free = np.array([name not in apart and 0.0 < z < 1.0 for name, z in zip(point.names, point.unit, strict=True)])
    Q = basis(left[:, 1 : 1 + n_free][:, free])
    left -= Q @ (Q.T @ left)
    chosen = (*apart, *wanted)
    at_chosen = [1 + names.index(name) for name in chosen]
    signature = left[:, at_chosen]
    length = np.linalg.norm(slopes[:, [i - 1 for i in at_chosen]], axis=0)
    every = basis(signature)
    first, blocks = _rows(problem)
    return Linear(
        residual=left[:, 0],
        names=chosen,
        signature=signature,
        share=np.linalg.norm(signature, axis=0) / np.maximum(length, 1e-300),
        noise=left[:, 0] - every @ (every.T @ left[:, 0]),
        wander=left[:, 1 + len(names) :],
        blocks=blocks,
        cases=first,
    )


def _offset_derivatives(bench: Workbench, point: Point) -> FloatArray:
    """Derivatives of the residuals by the initial offsets of their own case, (n_residuals, 6)."""
    problem = bench.problem_of(point.names, point.integrator)
    _, _, by_offset = problem.jacobians(point.unit[:, None], point.offsets[:, None])
    return np.asarray(by_offset[0])


def without_offsets(problem: FitProblem, values: FloatArray, S: FloatArray, offsets: FloatArray) -> FloatArray:
    """Columns (n_residuals, k) with a row for each offset of an initial state added, less what offsets explain.

    The first column is the residual; the rows added are offsets over their deviations.
    """
    parts = []
    for case, rows in enumerate(problem.rows_of_cases):
        root = np.sqrt(problem.prior[case])
        added = np.zeros((6, values.shape[1]))
        added[:, 0] = root * offsets[case]
        Q, _ = np.linalg.qr(np.vstack([S[rows], np.diag(root)]))
        own = np.vstack([values[rows], added])
        parts.append(own - Q @ (Q.T @ own))
    return np.vstack(parts)


def basis(columns: FloatArray) -> FloatArray:
    """An orthonormal basis of the span of columns; directions that no motion shows are left out."""
    length = np.linalg.norm(columns, axis=0)
    shown = columns[:, length > SAME * length.max(initial=0.0)]
    if shown.shape[1] == 0:
        return shown
    shown = shown / np.linalg.norm(shown, axis=0)
    if shown.shape[1] == 1:
        return np.asarray(shown)
    square, vectors = np.linalg.eigh(shown.T @ shown)
    kept = square > SAME**2 * square[-1]
    return np.asarray(shown @ (vectors[:, kept] / np.sqrt(square[kept])))


def _rows(problem: FitProblem) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """First row of each trial, and of each block; the rows of a trial's offsets belong to its last."""
    first, blocks, row = [], [], 0
    for case, rows in enumerate(problem.rows_of_cases):
        n = rows.stop - rows.start
        t = problem.cases.t[case, : problem.cases.n_samples[case]]
        pieces = max(1, round(float(t[-1] - t[0]) / BLOCK))
        first.append(row)
        blocks += [row + (n * k) // pieces for k in range(pieces)]
        row += n + 6
    return np.array(first), np.array(sorted(set(blocks)))
