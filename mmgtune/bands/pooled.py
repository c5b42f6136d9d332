"""Scores of windows, and of many of them together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..displayed import Brief
from .quantiles import widest
from .scores import covered, crps, squared_error, squared_mahalanobis, standardised_error

LEVELS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)
"""Nominal shares at which bands are held against what they hold."""

VELOCITIES = slice(3, 6)
"""u, v_m, r among the states: what L_Eucl and L_Maha are about (Wakita et al., eq. 30)."""

FEWEST_WINDOWS = 3
"""Windows that a correlation needs."""


@dataclass(frozen=True, eq=False, repr=False)
class WindowScore(Brief):
    """Particles on one window.

    id, trial, run, manoeuvre  of the window, as in ``TrialScore``
    particles, diverged  how many there are, and how many of them diverged in it; scores are of the rest, and there is
                         none where fewer than two are left of several
    fit           (n_samples,) squared distance over the noise, mean over particles; NaN in gaps, without noise known
    eucl, maha    (n_samples,) squared distances, NaN in gaps; maha where the covariance is singular too
    crps, width   (n_channels,) and (n_levels, n_channels) sums over samples [SI]
    inside        (n_levels, n_channels) samples in the band
    counts        (n_channels,) samples
    """

    id: str
    trial: str
    run: str
    manoeuvre: str
    particles: int
    diverged: int
    fit: FloatArray
    eucl: FloatArray
    maha: FloatArray
    crps: FloatArray
    width: FloatArray
    inside: FloatArray
    counts: IntArray

    @property
    def distances(self) -> tuple[float, float] | None:
        """Root mean squares of both distances over samples that have both; None without any."""
        both = np.isfinite(self.eucl) & np.isfinite(self.maha)
        if not both.any():
            return None
        return float(np.sqrt(self.eucl[both].mean())), float(np.sqrt(self.maha[both].mean()))


def score_window(
    id: str,
    trial: str,
    run: str,
    manoeuvre: str,
    states: FloatArray,
    diverged: BoolArray,
    truth: FloatArray,
    noise: FloatArray,
) -> WindowScore:
    """Scores of states (n_particles, n_samples, 6) against the truth (n_samples, 6), NaN where it does not count.

    diverged  (n_particles,)
    noise     (3,) standard deviations of the sensors of u, v_m [m/s], r [rad/s]; NaN where they are not known
    """
    lost, n = int(diverged.sum()), len(states)
    sound = states[~diverged] if lost else states
    if len(sound) < min(n, 2):
        empty = np.full(len(truth), np.nan)
        nothing = np.zeros((len(LEVELS), truth.shape[1]))
        zero = np.zeros(truth.shape[1], dtype=np.int64)
        return WindowScore(
            id, trial, run, manoeuvre, n, lost, empty, empty, empty, nothing[0], nothing, nothing, zero
        )  # fmt: skip
    hit, width = covered(sound, truth, LEVELS)
    known = np.isfinite(truth)
    speeds = truth[:, VELOCITIES]
    return WindowScore(
        id,
        trial,
        run,
        manoeuvre,
        n,
        lost,
        standardised_error(sound[:, :, VELOCITIES], speeds, noise).mean(axis=0),
        squared_error(sound[:, :, VELOCITIES], speeds),
        squared_mahalanobis(sound[:, :, VELOCITIES], speeds),
        np.where(known, crps(sound, truth), 0.0).sum(axis=0),
        np.where(known, width, 0.0).sum(axis=1),
        hit.sum(axis=1).astype(float),
        known.sum(axis=0),
    )


@dataclass(frozen=True)
class Pooled:
    """Windows together; each sample of each channel counts alike.

    windows, lost  how many, and in how many of them fewer than two particles were left, which nothing here counts
    particles   of each window
    diverged    particles that diverged, over all windows
    L_fit       mean squared distance of a particle from the truth over the noise, of velocities (eq. 29); None where
                the noise is not known
    L_Eucl      mean squared distance of the mean from the truth, of velocities (eq. 31a) [m^2/s^2, with rad^2/s^2]
    L_Maha      mean squared Mahalanobis distance (eq. 31b); 3 is what a right covariance gives
    singular    samples left out of L_Maha because the covariance was singular
    correlation of both distances, each a window's root mean square; None of fewer than three windows
    CRPS        mean over channels of the score over sigma; by channel in SI under ``CRPS_by_state``
    coverage    share of samples in the bands of ``LEVELS``, mean over channels
    sharpness   width of the band of 90 %, mean over channels, over sigma
    widest      share that the widest band of so many particles can hold
    """

    windows: int
    lost: int
    particles: int
    diverged: int
    L_fit: float | None
    L_Eucl: float | None
    L_Maha: float | None
    singular: int
    correlation: float | None
    CRPS: float | None
    coverage: tuple[float | None, ...]
    sharpness: float | None
    widest: float
    CRPS_by_state: Mapping[str, float]
    coverage_by_state: Mapping[str, tuple[float, ...]]
    width_by_state: Mapping[str, float]

    def covers(self, level: float) -> float | None:
        """Coverage of one of ``LEVELS``; None of a single prediction, which has no band."""
        return self.coverage[LEVELS.index(level)]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "windows": self.windows,
            "windows_lost": self.lost,
            "particles": self.particles,
            "diverged": self.diverged,
            "L_fit": self.L_fit,
            "L_Eucl": self.L_Eucl,
            "L_Maha": self.L_Maha,
            "singular": self.singular,
            "correlation": self.correlation,
            "CRPS": self.CRPS,
            "coverage_50": self.covers(0.5),
            "coverage_90": self.covers(0.9),
            "sharpness": self.sharpness,
            "widest": self.widest,
            "calibration": {
                "nominal": list(LEVELS),
                "covered": list(self.coverage),
                "by_state": {name: list(of) for name, of in self.coverage_by_state.items()},
            },
            "CRPS_by_state": dict(self.CRPS_by_state),
            "width_90_by_state": dict(self.width_by_state),
        }


def pooled_by(
    key: Callable[[WindowScore], str | None], scores: Sequence[WindowScore], sigma: Mapping[str, float]
) -> dict[str, Pooled]:
    """Windows together by what ``key`` says of each, in the order met; those it says nothing of are left out."""
    of: dict[str, list[WindowScore]] = {}
    for one in scores:
        if (name := key(one)) is not None:
            of.setdefault(name, []).append(one)
    return {name: pooled(some, sigma) for name, some in of.items()}


def pooled(scores: Sequence[WindowScore], sigma: Mapping[str, float]) -> Pooled:
    """All windows together.

    sigma  spread of each state [SI], by name and in their order; what CRPS and widths are counted in
    Raises ValueError where there is no window.
    """
    if not scores:
        raise ValueError("no window, no score")
    names = tuple(sigma)
    counts = np.sum([one.counts for one in scores], axis=0)
    measured = counts > 0
    spread = np.array([sigma[name] for name in names])
    with np.errstate(invalid="ignore", divide="ignore"):
        score = np.sum([one.crps for one in scores], axis=0) / counts
        inside = np.sum([one.inside for one in scores], axis=0) / counts
        width = np.sum([one.width for one in scores], axis=0)[LEVELS.index(0.9)] / counts
    eucl = np.concatenate([one.eucl for one in scores])
    maha = np.concatenate([one.maha for one in scores])
    several = scores[0].particles > 1
    held = bool(measured.any())
    varying = measured & (spread > 0.0)  # what never changes has nothing to be counted in
    return Pooled(
        windows=len(scores),
        lost=sum(one.particles - one.diverged < min(one.particles, 2) for one in scores),
        particles=scores[0].particles,
        diverged=sum(one.diverged for one in scores),
        L_fit=_mean(np.concatenate([one.fit for one in scores])),
        L_Eucl=_mean(eucl),
        L_Maha=_mean(maha),
        singular=int((np.isfinite(eucl) & ~np.isfinite(maha)).sum()),
        correlation=_correlation(scores),
        CRPS=float(np.mean(score[varying] / spread[varying])) if varying.any() else None,
        coverage=tuple(float(of[measured].mean()) if held and several else None for of in inside),
        sharpness=float(np.mean(width[varying] / spread[varying])) if varying.any() and several else None,
        widest=widest(scores[0].particles),
        CRPS_by_state={name: float(score[k]) for k, name in enumerate(names) if measured[k]},
        coverage_by_state={
            name: tuple(inside[:, k].tolist()) for k, name in enumerate(names) if measured[k] and several
        },
        width_by_state={name: float(width[k]) for k, name in enumerate(names) if measured[k] and several},
    )


def _mean(values: FloatArray) -> float | None:
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else None


def _correlation(scores: Sequence[WindowScore]) -> float | None:
    pairs = np.array([pair for one in scores if (pair := one.distances) is not None])
    if len(pairs) < FEWEST_WINDOWS or not (pairs.std(axis=0) > 0.0).all():
        return None
    return float(np.corrcoef(pairs.T)[0, 1])
