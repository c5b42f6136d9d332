"""What trials say of everything there is room for: residuals on short windows, nearly linear in all of it.

Over a whole turn a small error of the yaw rate carries the ship to the other side of her circle, and no Gaussian
distribution of coefficients follows that.  Over a window of some ship lengths, begun anew from what was measured, the
motion is almost linear in the coefficients even where they are far off, so the mode is found in a few steps and the
distribution about it is Gaussian to good approximation.  The noise of the state a window begins from is part of the
covariance of its residuals.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import STATES, Backend, Cases, Integrator
from ..errors import Problem, TrialError
from ..fitting.journal import remembered
from ..model import Model
from ..objective import PAPER_CHANNELS, Objective, cases_of
from ..profile import ShipProfile, scale_of
from ..trial import Trial
from ..trial.noise import noise_of
from ..trial.pieces import counting, windows
from .room import Room

LENGTHS = 2.5
"""Length of a window, in times the ship takes for her own length at the approach speed."""

APART = 0.4
"""Time between samples that are compared, likewise."""

STEP = 0.02
"""Step of derivatives, in prior deviations."""

AT_ONCE = 512
"""Candidates run at one time; bounds the memory."""

ITERATIONS = 30
CORRECTIONS = 6
"""Steps of particles from where linear residuals have them."""

SETTLED = 0.5
"""Fall of a particle's sum of squares from which on it is looked at no further."""

DAMPING = (0.0, 0.1, 1.0, 10.0, 100.0)
FIRM = (1e-3, 1e-2, 1e-1, 1.0)
"""Damping where all of these lead uphill, over the largest curvature: far from the mode, where the model misses the
trials by many times their noise, slopes hold for a small share of a deviation only."""

SMALL = 0.05
"""Fall of the sum of squares below which the mode is found."""


@dataclass(frozen=True, eq=False)
class Windowed:
    """Residuals of trials in short windows, white and of variance 1 if the model is right.

    sigma     (6,) deviations of the measured states
    whitened  rows of each window, and what makes them white: the inverse of the lower factor of their covariance
    """

    room: Room
    model: Model
    trials: tuple[Trial, ...]
    cases: Cases
    sigma: FloatArray
    whitened: tuple[tuple[IntArray, FloatArray], ...]
    backend: Backend
    integrator: Integrator

    def residuals(self, z: FloatArray) -> FloatArray:
        """Rows (n_rows, n) at z (n_names, n); not finite throughout where a run diverged."""
        parts = [self._raw(z[:, first : first + AT_ONCE]) for first in range(0, z.shape[1], AT_ONCE)]
        raw = np.hstack(parts)
        out = np.empty_like(raw)
        with np.errstate(invalid="ignore"):
            for rows, factor in self.whitened:
                out[rows] = factor @ raw[rows]
        return out

    def _raw(self, z: FloatArray) -> FloatArray:
        theta = self.model.matrix(self.room.names, self.room.values(z))
        found = self.backend.run(self.model, theta, self.cases, integrator=self.integrator, keep_residuals=True)
        rows = np.array(found.residuals)
        rows[:, found.diverged.any(axis=0)] = np.nan
        return rows

    def linearised(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals (n_rows,) at z (n_names,) and their derivatives (n_rows, n_names), steps towards the centre."""
        n = len(z)
        steps = np.where(z > 0.0, -STEP, STEP)
        columns = np.repeat(z[:, None], n + 1, axis=1)
        columns[np.arange(n), 1 + np.arange(n)] += steps
        found = self.residuals(columns)
        return found[:, 0], np.nan_to_num((found[:, 1:] - found[:, :1]) / steps)

    @property
    def asked(self) -> list[Any]:
        """What tells these residuals from others of one run."""
        return [self.room.profile.sha256, list(self.room.names), [trial.id for trial in self.trials]]

    @property
    def n_series(self) -> int:
        """Channels of runs: time series that may each be off by a misfit of its own."""
        return len(self.trials) * len(PAPER_CHANNELS)


def make_windowed(
    room: Room, trials: Sequence[Trial], backend: Backend, integrator: Integrator = Integrator("rk4")
) -> Windowed:
    """Trials cut into windows, compared in position and heading.

    Raises TrialError for a trial that is too short.
    """
    model = Model(room.profile)
    scale = scale_of(room.profile)
    unit = scale.L / scale.U
    sigma = np.maximum(np.median([noise_of(trial) for trial in trials], axis=0), least_noise(room.profile))
    _require_long(trials, APART * unit)
    pieces = [piece for trial in trials for piece in windows(trial, LENGTHS * unit, APART * unit)]
    objective = Objective(dict(zip(STATES, sigma, strict=True)), dict.fromkeys(PAPER_CHANNELS, 1.0), every=APART * unit)
    cases = cases_of(pieces, objective, model.inputs, model.draught)
    started = np.repeat(cases.initial[:, None], 7, axis=1)
    started[:, 1 + np.arange(6), np.arange(6)] += sigma
    theta = np.repeat(model.matrix(room.names, room.values(np.zeros((len(room), 1)))), 7, axis=1)
    found = backend.run(model, theta, cases, initial=started, integrator=integrator, keep_residuals=True)
    with np.errstate(invalid="ignore"):
        by_start = found.residuals[:, 1:] - found.residuals[:, :1]
    whitened = []
    for case, lost in enumerate(found.diverged):
        rows = cases.rows[case]
        rows = np.sort(rows[rows >= 0])
        if len(rows):
            by_start[rows] = np.where(lost[1:] | lost[0], 0.0, by_start[rows])
            covariance = np.eye(len(rows)) + by_start[rows] @ by_start[rows].T
            whitened.append((rows, np.linalg.inv(np.linalg.cholesky(covariance))))
    return Windowed(room, model, tuple(trials), cases, sigma, tuple(whitened), backend, integrator)


def _require_long(trials: Sequence[Trial], apart: float) -> None:
    """Raises TrialError for trials without a complete sample so long [s] after another: nothing is compared in them."""
    short = [trial for trial in trials if not _is_compared(trial, apart)]
    if short:
        why = f"positions and headings are compared {apart:.3g} s apart for this ship, and it has no two such samples"
        fix = "leave it out of the split, or give a longer one"
        raise TrialError(
            *(Problem(f"trial '{one.id}' is too short", str(one.path or one.id), why, fix) for one in short)
        )


def _is_compared(trial: Trial, apart: float) -> bool:
    measured = np.isfinite(trial.motion)
    whole = np.flatnonzero(measured.all(axis=1))
    counts = counting(trial.t[whole[0] :], apart) if len(whole) else np.zeros(0, dtype=bool)
    return bool(measured[whole[0] :, :3][counts].any()) if len(whole) else False


def least_noise(profile: ShipProfile) -> FloatArray:
    """Deviations (6,) of x, y, psi, u, v_m, r below which nothing is believed: basins measure better than any model."""
    scale = scale_of(profile)
    rate = scale.U / scale.L
    return np.array([1e-3 * scale.L, 1e-3 * scale.L, 2e-3, 2e-3 * scale.U, 2e-3 * scale.U, 2e-3 * rate])


@dataclass(frozen=True, eq=False)
class Mode:
    """The most probable point, and everything linear about it.

    z          (n_names,) prior deviations from the centre
    residual   (n_rows,) there
    slopes     (n_rows, n_names)
    """

    z: FloatArray
    residual: FloatArray
    slopes: FloatArray
    converged: bool

    @property
    def misfit(self) -> float:
        """Mean square of the residuals: 1 where the model with its room is right."""
        return float(np.mean(self.residual**2))

    def gaussian(self, temper: float) -> tuple[FloatArray, FloatArray]:
        """Mean (n_names,) and covariance (n_names, n_names) with residuals of that variance."""
        A = self.slopes / np.sqrt(temper)
        b = A.T @ (A @ self.z - self.residual / np.sqrt(temper))
        covariance = np.linalg.inv(A.T @ A + np.eye(len(self.z)))
        return covariance @ b, covariance

    def learnt(self, temper: float) -> float:
        """Number of combinations that the trials determine better than the room does."""
        return float(len(self.z) - np.trace(self.gaussian(temper)[1]))


@dataclass(frozen=True, eq=False)
class _Ended:
    """Where a search for the mode ended; residual and slopes there, None where a journal says no more."""

    z: FloatArray
    converged: bool
    linear: tuple[FloatArray, FloatArray] | None = None


def find_mode(
    data: Windowed,
    temper: float = 1.0,
    start: FloatArray | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> Mode:
    """Damped Gauss-Newton steps within the room from ``start``, the centre where None; all dampings as lanes of a call.

    temper  variance of residuals
    stop    asked at each step; it has not converged then
    What is at the edge of the room and would leave it is held there, and the step is that of the others: beyond the
    edge nothing changes, and a step that counts on what is there goes astray.  Where every step leads uphill, shorter
    ones are tried.  It has converged where no step of full length finds anything better: that a short one does not
    may be for its shortness.
    """
    ended = _searched(data, temper, np.zeros(len(data.room)) if start is None else start, stop)
    residual, slopes = ended.linear if ended.linear else data.linearised(ended.z)
    return Mode(ended.z, np.nan_to_num(residual), slopes, ended.converged)


@remembered(
    asked=lambda data, temper, start, stop: [*data.asked, temper, start],
    note=lambda ended: [ended.z.tolist(), ended.converged],
    recall=lambda noted: _Ended(np.array(noted[0]), bool(noted[1])),
)
def _searched(data: Windowed, temper: float, start: FloatArray, stop: Callable[[], bool]) -> _Ended:
    n = len(data.room)
    low, high = data.room.box
    z = np.clip(start, low, high)
    r, J = data.linearised(z)

    def cost(values: FloatArray, at: FloatArray) -> FloatArray:
        total = np.sum(values**2, axis=0) / temper + np.sum(at**2, axis=0)
        return np.where(np.isfinite(total), total, np.inf)

    now = float(cost(r[:, None], z[:, None])[0])
    converged = False
    for _ in range(ITERATIONS if np.isfinite(now) else 0):  # no slope leads out of what cannot be simulated
        if stop():
            converged = False
            break
        H = J.T @ J / temper + np.eye(n)
        g = J.T @ np.nan_to_num(r) / temper + z
        tried = _steps(z, H, g, low, high, DAMPING)
        found = cost(data.residuals(tried), tried)
        k = int(np.argmin(found))
        converged = bool(abs(now - found[k]) < SMALL)
        if found[k] - now >= SMALL:
            tried = _steps(z, H, g, low, high, np.max(np.diag(H)) * np.array(FIRM))
            found = cost(data.residuals(tried), tried)
            k = int(np.argmin(found))
        ends = converged or not now - found[k] >= SMALL  # in the latter case the search is stuck
        if found[k] < now:
            z, now = tried[:, k], float(found[k])
            r, J = data.linearised(z)
        if ends:
            break
    return _Ended(z, converged, (r, J))


def _steps(
    z: FloatArray, H: FloatArray, g: FloatArray, low: FloatArray, high: FloatArray, dampings: Iterable[float]
) -> FloatArray:
    """Where damped Gauss-Newton steps from z (n_names,) end within the box, (n_names, n_dampings)."""
    free = np.flatnonzero(~(((z >= high) & (g < 0.0)) | ((z <= low) & (g > 0.0))))
    ends = []
    for damping in dampings:
        end = z.copy()
        end[free] -= np.linalg.solve(H[np.ix_(free, free)] + damping * np.eye(len(free)), g[free])
        ends.append(np.clip(end, low, high))
    return np.column_stack(ends)


def particles_about(data: Windowed, mode: Mode, temper: float, n: int, seed: int) -> FloatArray:
    """n particles z (n_names, n): the most probable points of what might have been measured and thought beforehand.

    mode  found with residuals of that variance
    Each has residuals and centre of its own, moved by noise (randomise, then optimise: Bardsley et al. 2014).  Where
    residuals are linear these are draws of the Gaussian about the mode; where they bend, a few steps with the slopes of
    the mode bring each to where it belongs.  One whose run leaves the world of ships, or comes out worse than the mode,
    sets out from there.
    """
    rng = np.random.default_rng(seed)
    centre = rng.standard_normal((len(mode.z), n))
    noise = rng.standard_normal((len(mode.residual), n))
    A = mode.slopes / np.sqrt(temper)
    covariance = mode.gaussian(temper)[1]

    def at(z: FloatArray) -> tuple[FloatArray, FloatArray]:
        off = data.residuals(z) / np.sqrt(temper) - noise
        total = np.sum(off**2, axis=0) + np.sum((z - centre) ** 2, axis=0)
        return np.nan_to_num(off), np.where(np.isfinite(total), total, np.inf)

    begun = np.repeat(mode.z[:, None], n, axis=1)
    there = mode.residual[:, None] / np.sqrt(temper) - noise
    squares = np.sum(there**2, axis=0) + np.sum((begun - centre) ** 2, axis=0)
    z, off = begun, there
    length = np.ones(n)
    for _ in range(1 + CORRECTIONS):
        tried = z - length * (covariance @ (A.T @ off + z - centre))
        found, now = at(tried)
        better = now < squares
        moving = ~better | (squares - np.where(better, now, squares) > SETTLED)
        z, off = np.where(better, tried, z), np.where(better, found, off)
        squares = np.where(better, now, squares)
        length = np.where(better, 1.0, 0.25 * length)
        if np.mean(moving) < 0.1:
            break
    return np.asarray(z)
