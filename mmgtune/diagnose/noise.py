"""Noise of a channel: white, or white on top of something that fades slowly; and residuals freed of its memory."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..arrays import FloatArray, IntArray
from ..backends import STATES, Cases

LAGS = 6
"""Autocovariances a fading part is estimated from."""

SLOWEST = 0.995
"""Largest autocorrelation assumed of neighbouring samples."""

NOTICED = 4.0
"""A fading part counts from this many standard errors of the autocorrelation."""


@dataclass(frozen=True)
class ChannelNoise:
    """A first-order autoregressive part plus white noise, in the units of the residuals.

    phi     autocorrelation of neighbouring samples of the fading part
    fading  its variance
    white   variance of the white part
    """

    phi: float = 0.0
    fading: float = 0.0
    white: float = 1.0

    @property
    def variance(self) -> float:
        """Variance of a sample."""
        return self.fading + self.white

    @property
    def filter(self) -> tuple[float, float, float]:
        """phi, theta, sigma of the process e_k = phi e_(k-1) + a_k + theta a_(k-1) with a_k of deviation sigma."""
        if self.fading <= 0.0:
            return 0.0, 0.0, float(np.sqrt(self.white))
        driving = self.fading * (1.0 - self.phi**2)
        g0 = driving + (1.0 + self.phi**2) * self.white
        g1 = -self.phi * self.white
        if abs(g1) < 1e-12 * g0:
            return self.phi, 0.0, float(np.sqrt(g0))
        half = 0.5 * g0 / g1
        theta = half + np.sqrt(half * half - 1.0)  # g1 < 0: the root inside the unit circle
        return self.phi, float(theta), float(np.sqrt(g1 / theta))


@dataclass(eq=False)
class NoiseModel:
    """Noise by channel, and the whitening that follows from it."""

    cases: Cases
    channels: dict[str, ChannelNoise]
    _series: list[tuple[str, IntArray]] = field(init=False)

    def __post_init__(self) -> None:
        self._series = series_of(self.cases)

    @property
    def coloured(self) -> bool:
        """Whether any channel has memory."""
        return any(noise.fading > 0.0 for noise in self.channels.values())

    def apply(self, values: FloatArray) -> FloatArray:
        """Residuals (n_residuals, ...) or their derivatives with noise of variance 1 and no memory."""
        out = np.empty_like(values)
        for channel, rows in self._series:
            noise = self.channels[channel]
            phi, theta, sigma = noise.filter
            if noise.fading <= 0.0:
                out[rows] = values[rows] / sigma
                continue
            with np.errstate(invalid="ignore", over="ignore"):
                white = _filtered([1.0, -phi], [1.0, theta], values[rows]) / sigma
                white[0] *= sigma / np.sqrt(noise.variance)
            out[rows] = white
        return out

    def restore(self, values: FloatArray) -> FloatArray:
        """Whitened residuals (n_residuals, ...) back in the units and with the memory they had before ``apply``."""
        out = np.empty_like(values)
        for channel, rows in self._series:
            noise = self.channels[channel]
            phi, theta, sigma = noise.filter
            part = values[rows] * sigma
            if noise.fading > 0.0:
                part[0] *= np.sqrt(noise.variance) / sigma
                part = _filtered([1.0, theta], [1.0, -phi], part)
            out[rows] = part
        return out


def _filtered(over: list[float], under: list[float], values: FloatArray) -> FloatArray:
    from scipy.signal import lfilter  # half a second, which white noise does without

    return np.asarray(lfilter(over, under, values, axis=0))


def series_of(cases: Cases) -> list[tuple[str, IntArray]]:
    """Residuals of each channel of each case: name of the channel and where they stand."""
    found = []
    for case in range(len(cases)):
        for k, channel in enumerate(STATES):
            rows = cases.rows[case, :, k]
            rows = rows[rows >= 0]
            if len(rows):
                found.append((channel, rows))
    return found


def rows_of_channels(cases: Cases) -> dict[str, list[IntArray]]:
    """Where the residuals of each channel stand, case by case."""
    found: dict[str, list[IntArray]] = {}
    for channel, rows in series_of(cases):
        found.setdefault(channel, []).append(rows)
    return found


def white(cases: Cases) -> NoiseModel:
    """Noise of variance 1 without memory: what residuals divided by their noise have."""
    return NoiseModel(cases, {channel: ChannelNoise() for channel in rows_of_channels(cases)})


def estimate(cases: Cases, residuals: FloatArray) -> NoiseModel:
    """Noise by channel from residuals (n_residuals,) that hold hardly anything but noise, pooled over cases.

    The white part is what the fading part, extrapolated from lags 1, 2, ..., leaves of the variance.
    """
    channels = {}
    for channel, series in rows_of_channels(cases).items():
        parts = [residuals[rows] for rows in series]
        n = sum(len(part) for part in parts)
        covariance = np.array(
            [
                sum(float(part[lag:] @ part[: len(part) - lag]) for part in parts if len(part) > lag) / n
                for lag in range(LAGS + 1)
            ]
        )
        channels[channel] = _decompose(covariance, n)
    return NoiseModel(cases, channels)


def _decompose(covariance: FloatArray, n: int) -> ChannelNoise:
    variance = float(max(covariance[0], 1e-12))
    lagged = covariance[1:]
    if float(np.sum(lagged)) <= NOTICED * variance * np.sqrt(LAGS / n):
        return ChannelNoise(white=variance)
    phi = float(np.clip(lagged[1:] @ lagged[:-1] / (lagged[:-1] @ lagged[:-1]), 0.05, SLOWEST))
    powers = phi ** np.arange(1, LAGS + 1)
    fading = float(np.clip(powers @ lagged / (powers @ powers), 0.0, variance))
    return ChannelNoise(phi=phi, fading=fading, white=max(variance - fading, 1e-3 * variance))
