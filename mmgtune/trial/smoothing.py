"""Measured channels without their noise: cubic smoothing splines that share one time scale.

A cubic smoothing spline passes a motion of angular frequency w by 1 / (1 + (tau w)^4), without delay.  tau is what
makes Mallows' C_L smallest: the sum over channels of (residual sum of squares) / (noise variance) + 2 (effective number
of parameters).  The number of parameters follows from tau.  Noise that is not white is taken for motion.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

FEWEST = 10
"""Measured samples below which there is nothing to smooth."""


def time_scale(t: FloatArray, channels: FloatArray, noise: FloatArray, dt: float) -> float:
    """The tau [s] with the smallest C_L, out of half a sample's time to a tenth of the record.

    t         (n_samples,) time [s], strictly increasing
    channels  (n_samples, n_channels) without gaps, any units
    noise     (n_channels,) standard deviation of white noise, in the channels' units
    dt        usual time between samples [s]
    """
    span = float(t[-1] - t[0])
    scale = np.maximum(noise, 1e-6 * np.maximum(np.ptp(channels, axis=0), 1e-6))
    scaled = (channels - channels.mean(axis=0)) / scale
    frequency = (np.arange(200) + 0.5) / 200.0 * np.pi / dt
    candidates = np.geomspace(0.5 * dt, max(dt, 0.1 * span), 24)
    criterion = []
    roughness = _Roughness(t)
    for tau in candidates:
        misfit = roughness.smoothed(scaled, tau**4 / dt) - scaled
        parameters = len(t) * float(np.mean(1.0 / (1.0 + (tau * frequency) ** 4)))
        criterion.append(float(np.sum(misfit * misfit)) + 2.0 * scaled.shape[1] * parameters)
    return float(candidates[int(np.argmin(criterion))])


def smoothed(t: FloatArray, values: FloatArray, tau: float, dt: float, derivative: int = 0) -> FloatArray:
    """A channel (n_samples,), or its time derivative of that order, from its smoothing spline.

    Several channels (n_samples, n_channels) are smoothed together: a sample counts where all of them are measured.
    Gaps (NaN) are bridged.  NaN before the first and after the last measured sample, and throughout where fewer than
    FEWEST samples are measured.
    """
    from scipy.interpolate import CubicSpline  # a quarter of a second, which few commands need

    known = np.isfinite(values) if values.ndim == 1 else np.isfinite(values).all(axis=1)
    out = np.full(values.shape, np.nan)
    if known.sum() >= FEWEST:
        first, last = np.flatnonzero(known)[[0, -1]]
        inside = slice(int(first), int(last) + 1)
        at_samples = _Roughness(t[known]).smoothed(values[known], tau**4 / dt)
        out[inside] = CubicSpline(t[known], at_samples, bc_type="natural")(t[inside], nu=derivative)
    return out


class _Roughness:
    """What the integral of the squared second derivative of natural cubic splines with knots t (n,) is made of.

    Q takes values to jumps of slope, R second derivatives to the same jumps: Green & Silverman 1994, section 2.3.
    """

    def __init__(self, t: FloatArray):
        h = np.diff(t)
        self._left, self._right = 1.0 / h[:-1], 1.0 / h[1:]
        self._middle = -self._left - self._right
        n = len(t) - 2
        self._R = np.zeros((3, n))
        self._R[2] = (h[:-1] + h[1:]) / 3.0
        self._R[1, 1:] = h[1:-1] / 6.0
        a, b, c = self._left, self._middle, self._right
        self._QQ = np.zeros((3, n))
        self._QQ[2] = a * a + b * b + c * c
        self._QQ[1, 1:] = b[:-1] * a[1:] + c[:-1] * b[1:]
        self._QQ[0, 2:] = c[:-2] * a[2:]

    def smoothed(self, values: FloatArray, penalty: float) -> FloatArray:
        """What minimises the squared distance from values (n, ...) plus ``penalty`` times the roughness, at the knots.

        Reinsch 1967: (R + penalty Q'Q) curvature = Q' values.
        """
        from scipy.linalg import solveh_banded

        a, b, c = (part.reshape(-1, *[1] * (values.ndim - 1)) for part in (self._left, self._middle, self._right))
        jumps = a * values[:-2] + b * values[1:-1] + c * values[2:]
        curvature = solveh_banded(self._R + penalty * self._QQ, jumps)
        pull = np.zeros_like(values)
        pull[:-2] += a * curvature
        pull[1:-1] += b * curvature
        pull[2:] += c * curvature
        return np.asarray(values - penalty * pull)
