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
    from scipy.interpolate import make_smoothing_spline  # half a second, which few commands need

    span = float(t[-1] - t[0])
    scale = np.maximum(noise, 1e-6 * np.maximum(np.ptp(channels, axis=0), 1e-6))
    scaled = (channels - channels.mean(axis=0)) / scale
    frequency = (np.arange(200) + 0.5) / 200.0 * np.pi / dt
    candidates = np.geomspace(0.5 * dt, max(dt, 0.1 * span), 24)
    criterion = []
    for tau in candidates:
        misfit = make_smoothing_spline(t, scaled, lam=tau**4 / dt)(t) - scaled
        parameters = len(t) * float(np.mean(1.0 / (1.0 + (tau * frequency) ** 4)))
        criterion.append(float(np.sum(misfit * misfit)) + 2.0 * scaled.shape[1] * parameters)
    return float(candidates[int(np.argmin(criterion))])


def smoothed(t: FloatArray, values: FloatArray, tau: float, dt: float, derivative: int = 0) -> FloatArray:
    """A channel (n_samples,), or its time derivative of that order, from its smoothing spline.

    Several channels (n_samples, n_channels) are smoothed together: a sample counts where all of them are measured.
    Gaps (NaN) are bridged.  NaN before the first and after the last measured sample, and throughout where fewer than
    FEWEST samples are measured.
    """
    from scipy.interpolate import make_smoothing_spline

    known = np.isfinite(values) if values.ndim == 1 else np.isfinite(values).all(axis=1)
    out = np.full(values.shape, np.nan)
    if known.sum() >= FEWEST:
        first, last = np.flatnonzero(known)[[0, -1]]
        inside = slice(int(first), int(last) + 1)
        spline = make_smoothing_spline(t[known], values[known], lam=tau**4 / dt)
        out[inside] = spline(t[inside], nu=derivative)
    return out
