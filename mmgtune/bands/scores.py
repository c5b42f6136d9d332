"""How far particles lie from what happened, and whether they knew: scores of Wakita et al., eq. 29 to 31, and others.

``particles`` are (n_particles, n_samples, n_channels), ``truth`` is (n_samples, n_channels), NaN in gaps.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import BoolArray, FloatArray
from .quantiles import central, quantiles

SINGULAR = 1e-12
"""Least eigenvalue of a correlation matrix of particles, below which their covariance counts as singular."""


def covariances(particles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean (n_samples, n_channels) and covariance (n_samples, n_channels, n_channels) of particles (eq. 30).

    The covariance divides by the number of particles, as the paper does.
    """
    mean = particles.mean(axis=0)
    off = particles - mean
    return mean, np.asarray(np.einsum("ptc,ptd->tcd", off, off) / len(particles))


def standardised_error(states: FloatArray, truth: FloatArray, sigma: FloatArray) -> FloatArray:
    """(..., n_samples) squared distance of states (..., n_samples, n_channels) from the truth over sigma (eq. 29).

    sigma  (n_channels,) standard deviations; infinite for a channel that does not count
    """
    return np.asarray(np.sum(((states - truth) / sigma) ** 2, axis=-1))


def squared_error(particles: FloatArray, truth: FloatArray) -> FloatArray:
    """(n_samples,) squared Euclidean distance of the particles' mean from the truth (eq. 31a), NaN in gaps."""
    return np.asarray(np.sum((truth - particles.mean(axis=0)) ** 2, axis=-1))


def squared_mahalanobis(particles: FloatArray, truth: FloatArray) -> FloatArray:
    """(n_samples,) squared Mahalanobis distance of the truth from the particles (eq. 31b), NaN in gaps.

    NaN too where the covariance is singular: with no more particles than channels it always is, and where all
    particles agree.  The distance is then infinite or nothing, by which way the truth lies, and says no more.
    """
    n, _, channels = particles.shape
    mean, covariance = covariances(particles)
    found = np.full(len(truth), np.nan)
    spread = np.sqrt(np.einsum("tcc->tc", covariance))
    whole = np.isfinite(truth).all(axis=-1) & np.isfinite(spread).all(axis=-1) & (spread > 0.0).all(axis=-1)
    if n <= channels or not whole.any():
        return found
    spread = spread[whole]
    values, axes = np.linalg.eigh(covariance[whole] / (spread[:, :, None] * spread[:, None, :]))
    off = np.einsum("tcd,tc->td", axes, (truth - mean)[whole] / spread)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.sum(off**2 / values, axis=-1)
    found[whole] = np.where(values[:, 0] > SINGULAR, distance, np.nan)
    return found


def crps(particles: FloatArray, truth: FloatArray) -> FloatArray:
    """(n_samples, n_channels) continuous ranked probability score of the particles' distribution, NaN in gaps.

    The mean distance from the truth less half the mean distance of two particles from each other (Gneiting & Raftery
    2007, eq. 21), in the unit of the channel; of a single particle the absolute error.
    """
    n = len(particles)
    away = np.abs(particles - truth).mean(axis=0)
    ranks = (2.0 * np.arange(1, n + 1) - n - 1.0).reshape(-1, *[1] * truth.ndim)
    between = np.sum(ranks * np.sort(particles, axis=0), axis=0) / n**2  # half the mean of |a - b|
    return np.asarray(away - between)


def covered(particles: FloatArray, truth: FloatArray, levels: Sequence[float]) -> tuple[BoolArray, FloatArray]:
    """Whether the truth lies in the central bands, (n_levels, n_samples, n_channels), and how wide these are.

    In gaps it does not.
    """
    ends = quantiles(particles, [end for level in levels for end in central(level)])
    low, high = ends[0::2], ends[1::2]
    with np.errstate(invalid="ignore"):
        return np.asarray((truth >= low) & (truth <= high)), np.asarray(high - low)
