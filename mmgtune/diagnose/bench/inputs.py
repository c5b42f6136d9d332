"""What the logged inputs do not say: a simulation driven by a noisy rudder angle wanders off a little, and for good.

Besides noise, a log of one sample a second does not say when in that second the rudder began to move.  Nor does a log
say what gusts there were, where a wind blows, and what groups of waves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray, IntArray
from ...effects import Effect
from ...fitting.problem import FitProblem
from ...trial.kinematics import FEW_VALUES, rounding_noise, white_noise
from .wave_groups import drifts, other_waves
from .winds import blows, other_winds
from .workbench import Point, Workbench

DRAWS = 16
"""Simulated realisations per trial."""

BETWEEN = 0.2
"""Deviation of an input at a bend of its log, as a share of the bend: the bend may be anywhere between two samples."""

CLEAR = 8.0
"""Second differences beyond this many deviations of the noise are bends."""


def unsteady(effect: Effect | None) -> bool:
    """Whether what an effect is of changes within a run as no log says: a wind in gusts, waves in groups."""
    return blows(effect) or drifts(effect)


def wander(bench: Workbench, point: Point) -> FloatArray:
    """Change of the whitened residuals (n_residuals, DRAWS) by other inputs that the log does not tell from these."""
    problem = bench.problem_of(point.names, point.integrator)
    return bench.noise.apply(changes(problem, point.unit, point.offsets, bench.options.seed, bench.updates))


def changes(
    problem: FitProblem,
    unit: FloatArray,
    offsets: FloatArray,
    seed: int,
    updates: Sequence[Sequence[IntArray]] | None = None,
    logged: bool = True,
) -> FloatArray:
    """Change of the residuals (n_residuals, DRAWS) at a position (n_targets,) in the box, by inputs alike in the log.

    The noise of revolutions and rudder angle is what second differences of the logs show; those far above it are bends.
    What a log in whole degrees leaves out stays the same for as long as it shows the same.
    Where a wind blows it comes in gusts besides, and its force is of another shape; waves come in groups.  A run that
    diverges with them changes nothing.

    offsets  (n_cases, 6) of the initial states
    updates  samples at which each input of each case was updated; None where all of them are
    logged   whether the logged inputs are other ones too, or wind and waves alone
    """
    rng = np.random.default_rng(seed)
    cases = problem.cases
    noise = float(logged) * rng.standard_normal((len(cases), DRAWS, *cases.controls.shape[1:]))
    for case, n_samples in enumerate(cases.n_samples.tolist()):
        for k, series in enumerate(cases.controls[case].T):
            known = None if updates is None else updates[case][k]
            noise[case, :, :, k] = _otherwise(noise[case, :, :, k], series, n_samples, known)
    controls = np.concatenate([cases.controls[:, None], cases.controls[:, None] + noise], axis=1)
    copies = DRAWS + 1
    around, theta = other_winds(problem.model, problem.theta(unit[:, None]), cases, DRAWS, seed)
    many = replace(
        cases,
        t=np.repeat(cases.t, copies, axis=0),
        n_samples=np.repeat(cases.n_samples, copies),
        controls=controls.reshape(-1, *cases.controls.shape[1:]),
        around=around.reshape(-1, *cases.around.shape[1:]),
        initial=np.repeat(cases.initial + offsets, copies, axis=0),
        target=np.zeros_like(np.repeat(cases.target, copies, axis=0)),
        weight=np.repeat(cases.weight, copies, axis=0),
    )
    theta = other_waves(problem.model, theta, cases, seed).reshape(len(theta), -1, 1)
    result = problem.backend.run(problem.model, theta, many, integrator=problem.integrator, keep_residuals=True)
    assert result.residuals is not None  # asked for
    changed = np.empty((problem.n_residuals, DRAWS))
    at = 0
    for case, rows in enumerate(problem.rows_of_cases):
        n = rows.stop - rows.start
        runs = result.residuals[at : at + n * copies, 0].reshape(copies, n)
        lost = result.diverged[:, 0].reshape(-1, copies)[case]
        changed[rows] = np.where(lost[1:] | lost[0], 0.0, (runs[1:] - runs[0]).T)
        at += n * copies
    return changed


def _otherwise(drawn: FloatArray, logged: FloatArray, n_samples: int, at: IntArray | None) -> FloatArray:
    """Standard normal numbers (DRAWS, T) as what else an input (T,) may have been, of which so many samples count.

    at  samples at which the log was updated, None for all: between two updates nothing is known
    """
    values = logged[:n_samples] if at is None else logged[at]
    level = white_noise(values)
    kept = logged if at is None else values
    bend = np.zeros(len(kept))
    bend[1:-1] = np.abs(np.diff(kept, n=2))
    deviation = np.where(bend > CLEAR * level, np.hypot(level, BETWEEN * bend), level)
    rounded = _rounded_off(values, logged, drawn)
    if at is None:
        return deviation * drawn + rounded
    changed = np.zeros_like(drawn)
    for into, one in zip(changed, drawn, strict=True):
        into[:n_samples] = np.interp(np.arange(n_samples), at, deviation * one[at])
    return changed + rounded


def _rounded_off(values: FloatArray, logged: FloatArray, drawn: FloatArray) -> FloatArray:
    """What rounding may have left out of an input (T,), for each row of standard normal numbers (DRAWS, T).

    Orders of a few angles are no rounded ones, though all are multiples of one.
    """
    step = rounding_noise(values) if len(np.unique(values)) >= FEW_VALUES else 0.0
    if step == 0.0:
        return np.zeros_like(drawn)
    changes = np.concatenate([[True], np.diff(logged) != 0.0])
    return np.asarray(step * drawn[:, np.flatnonzero(changes)][:, np.cumsum(changes) - 1])
