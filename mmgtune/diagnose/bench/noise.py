"""Noise of a channel: white, or white on top of something that fades slowly; and residuals freed of its memory."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...arrays import FloatArray, IntArray
from ...backends import STATES, Cases
from ...backends.filtering import Recursion, Series
from ...trial import Trial

LAGS = 6
"""Autocovariances a fading part is estimated from."""

SLOWEST = 0.995
"""Largest autocorrelation assumed of neighbouring samples."""

DRAWS = 8
"""Realisations of a noise model that show what fitting takes away from it."""

ROUNDS = 6
"""Times a noise model is corrected for that; each time about half of what is missing comes back."""

FAR_LAGS = 20
"""Autocovariances that tell how slowly a part fades of which fitting took most."""

FADE_IN = (1.25, 2.5, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0)
"""Samples in which such a part may fade to 1/e."""

AS_LIKELY = 1.0
"""Sum of squares, in variances of autocorrelations, by which a slower part may fit worse and is assumed: chance brings
as much, and noise that is thought quicker than it is makes causes of what it does."""

NEAR = 4.0
"""Variance over that of white noise beyond which what is left may be an error of the model, and is not made more of."""

POSITIONS = ("x", "y")
"""Channels of which a satellite receiver's errors wander far and slowly; those of a model show in the others too."""

AS_ROUGH, BY_CHANCE, LESS = 0.1, 6.0, 2.0
"""How far the second differences of residuals, over the first in variance, may be from those of noise that fades and
has no white part, 3 less its autocorrelation; and how far by chance, and how much less than that they are mostly, times
the square root of the number of samples.  White noise brings more of them, an error of the model hardly any."""

NOTICED = 4.0
"""A fading part counts from this many standard errors of the autocorrelation."""


@dataclass(frozen=True)
class ChannelNoise:
    """A first-order autoregressive part plus white noise, in the units of the residuals.

    phi     autocorrelation of neighbouring samples of the fading part
    fading  its variance
    white   variance of the white part
    rough   whether neighbouring residuals differ as those of fading noise without a white part do, and not as an error
            of the model does
    """

    phi: float = 0.0
    fading: float = 0.0
    white: float = 1.0
    rough: bool = False

    @property
    def variance(self) -> float:
        """Variance of a sample."""
        return self.fading + self.white

    def autocovariance(self, lags: int) -> FloatArray:
        """(lags + 1,) of neighbouring samples, the variance first."""
        found = self.fading * self.phi ** np.arange(lags + 1.0)
        found[0] += self.white
        return np.asarray(found)

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
    _series: Series = field(init=False)
    _of: list[ChannelNoise] = field(init=False)
    _sigma: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        every = series_of(self.cases)
        self._of = [self.channels[channel] for channel, _ in every]
        self._series = Series.of([rows for _, rows in every])
        self._sigma = np.ones(len(self._series.rows))
        for noise, (_, rows) in zip(self._of, every, strict=True):
            self._sigma[rows] = noise.filter[2]

    @property
    def coloured(self) -> bool:
        """Whether any channel has memory."""
        return any(noise.fading > 0.0 for noise in self.channels.values())

    @property
    def may_be_error(self) -> bool:
        """Whether so much more than white noise is left beside positions that it may be an error of the model."""
        moving = [noise for channel, noise in self.channels.items() if channel not in POSITIONS]
        seen = moving or list(self.channels.values())
        return any(noise.variance > NEAR and not noise.rough for noise in seen)

    def apply(self, values: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Residuals (n_residuals, ...) or their derivatives with noise of variance 1 and no memory.

        out  where they are written to, ``values`` themselves perhaps: many columns are too much to hold twice
        """
        if not self.coloured:
            return np.asarray(np.divide(values, self._sigma.reshape(-1, *(1,) * (values.ndim - 1)), out=out))
        found = self._series.filtered(values, [_whitening(noise) for noise in self._of], out)
        found[self._series.firsts] *= self._settled(values.ndim)
        return found

    def restore(self, values: FloatArray) -> FloatArray:
        """Whitened residuals (n_residuals, ...) back in the units and with the memory they had before ``apply``."""
        found = np.array(values, dtype=np.float64)
        found[self._series.firsts] /= self._settled(values.ndim)
        return self._series.filtered(found, [_colouring(noise) for noise in self._of], found)

    def _settled(self, n_dim: int) -> FloatArray:
        """(n_series, 1, ...) deviation of a white sample over that of a first one, which has all that fades already."""
        ratio = np.array([noise.filter[2] / math.sqrt(noise.variance) for noise in self._of])
        return ratio.reshape(-1, *(1,) * (n_dim - 1))


def _whitening(noise: ChannelNoise) -> Recursion:
    phi, theta, sigma = noise.filter
    return Recursion(1.0 / sigma, -phi / sigma, -theta)


def _colouring(noise: ChannelNoise) -> Recursion:
    phi, theta, sigma = noise.filter
    return Recursion(sigma, theta * sigma, phi)


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


def estimate(
    cases: Cases, residuals: FloatArray, fitted: Callable[[FloatArray], FloatArray] | None = None
) -> NoiseModel:
    """Noise by channel, pooled over cases, from residuals (n_residuals,) that hold hardly anything but noise.

    Residuals are in white noise of their channel.  The white part is what the fading part, extrapolated from lags 1, 2,
    ..., leaves of the variance.

    fitted  what fitting left of residuals (n_residuals, k): it takes away much of what fades slowly, of which a run has
            few independent samples.  Simulated noise shows how much; None where nothing was fitted.
    """
    found, uneven = _autocovariances(cases, residuals[:, None]), _unevenness(cases, residuals)
    counts = {channel: sum(map(len, series)) for channel, series in rows_of_channels(cases).items()}
    model = NoiseModel(
        cases, {channel: _decompose(one, counts[channel], uneven[channel]) for channel, one in found.items()}
    )
    if fitted is None or model.may_be_error:
        return model
    plain = np.random.default_rng(0).standard_normal((len(residuals), DRAWS))

    def allowing(assumed: NoiseModel, channels: Iterable[str]) -> dict[str, ChannelNoise]:
        """Noise of channels, with what fitting takes of the noise assumed put back."""
        left = _autocovariances(cases, fitted(assumed.restore(plain)))
        taken = {channel: assumed.channels[channel].autocovariance(LAGS) - left[channel] for channel in channels}
        return {name: _decompose(found[name] + one, counts[name], uneven[name]) for name, one in taken.items()}

    # What fitting leaves of white noise alternates, which hides noise that fades.
    pure = NoiseModel(cases, {name: ChannelNoise(white=float(max(one[0], 1e-12))) for name, one in found.items()})
    unseen = allowing(pure, [name for name, noise in model.channels.items() if noise.fading == 0.0])
    seen = {name: noise for name, noise in unseen.items() if noise.fading > 0.0}
    model = NoiseModel(cases, {**model.channels, **seen})
    if model.may_be_error or not model.coloured:
        return model
    for _ in range(ROUNDS):
        again = allowing(model, [name for name, noise in model.channels.items() if noise.fading > 0.0])
        model = NoiseModel(cases, {**model.channels, **again})
    slow = [name for name, noise in model.channels.items() if noise.fading > 0.0 and not noise.rough]
    return _Slow(model, residuals, fitted, plain, counts).likeliest(slow) if slow else model


@dataclass(frozen=True, eq=False)
class _Slow:
    """How slowly parts fade of which fitting took most: what it leaves of simulated noise is held against residuals.

    model      noise as the first lags have it
    residuals  (n_residuals,), and what ``fitted`` them; see ``estimate``
    plain      (n_residuals, DRAWS) white noise
    counts     samples by channel
    """

    model: NoiseModel
    residuals: FloatArray
    fitted: Callable[[FloatArray], FloatArray]
    plain: FloatArray
    counts: dict[str, int]

    def likeliest(self, channels: Sequence[str]) -> NoiseModel:
        """The model with the slowest parts of channels that explain the autocovariances as well as any."""
        cases = self.model.cases
        seen = _autocovariances(cases, self.residuals[:, None], FAR_LAGS)
        misfits = {name: np.empty(len(FADE_IN)) for name in channels}
        for k, samples in enumerate(FADE_IN):
            left = self._left(self._settled(dict.fromkeys(channels, math.exp(-1.0 / samples)), seen))
            for name in channels:
                off = (seen[name] - left[name])[1:] / seen[name][0]
                misfits[name][k] = self.counts[name] * float(off @ off)
        likely = {name: np.flatnonzero(one <= one.min() + AS_LIKELY) for name, one in misfits.items()}
        return self._settled({name: math.exp(-1.0 / FADE_IN[those[-1]]) for name, those in likely.items()}, seen)

    def _settled(self, phi: dict[str, float], seen: dict[str, FloatArray]) -> NoiseModel:
        """The model with parts of these autocorrelations, as large as fitting must have found them to leave what is
        seen."""
        cases, channels = self.model.cases, self.model.channels
        model = NoiseModel(cases, {**channels, **{name: replace(channels[name], phi=one) for name, one in phi.items()}})
        for _ in range(ROUNDS):
            left = self._left(model)
            whole = {name: seen[name] - left[name] + model.channels[name].autocovariance(FAR_LAGS) for name in phi}
            settled = {name: _with_memory(one, whole[name]) for name, one in phi.items()}
            model = NoiseModel(cases, {**channels, **settled})
        return model

    def _left(self, model: NoiseModel) -> dict[str, FloatArray]:
        """What fitting leaves of noise of a model, (FAR_LAGS + 1,) autocovariances by channel."""
        return _autocovariances(model.cases, self.fitted(model.restore(self.plain)), FAR_LAGS)


def _autocovariances(cases: Cases, values: FloatArray, lags: int = LAGS) -> dict[str, FloatArray]:
    """(lags + 1,) by channel, of columns (n_residuals, k) pooled."""
    found = {}
    for channel, series in rows_of_channels(cases).items():
        sums = np.zeros(lags + 1)
        for rows in series:
            part = values[rows]
            for lag in range(min(lags, len(part) - 1) + 1):
                sums[lag] += float(np.vdot(part[lag:], part[: len(part) - lag]))
        found[channel] = sums / (sum(map(len, series)) * values.shape[1])
    return found


def _unevenness(cases: Cases, residuals: FloatArray) -> dict[str, float]:
    """Variance of second differences over that of first ones by channel, of residuals (n_residuals,) pooled."""
    found = {}
    for channel, series in rows_of_channels(cases).items():
        first, second = (np.concatenate([np.diff(residuals[rows], n=order) for rows in series]) for order in (1, 2))
        found[channel] = float(np.mean(second**2) / np.mean(first**2)) if first.any() and len(second) else 0.0
    return found


def _decompose(covariance: FloatArray, n: int, uneven: float) -> ChannelNoise:
    """Noise of a channel of n samples from its autocovariances and what ``_unevenness`` gives."""
    variance = float(max(covariance[0], 1e-12))
    lagged = covariance[1:]
    if float(np.sum(lagged)) <= NOTICED * variance * np.sqrt(LAGS / n):
        return ChannelNoise(white=variance)
    phi = float(np.clip(lagged[1:] @ lagged[:-1] / (lagged[:-1] @ lagged[:-1]), 0.05, SLOWEST))
    rough = abs(uneven - (3.0 - phi) + LESS / math.sqrt(n)) < AS_ROUGH + BY_CHANCE / math.sqrt(n)
    return replace(_with_memory(phi, covariance), rough=rough)


def _with_memory(phi: float, covariance: FloatArray) -> ChannelNoise:
    """Noise of which a part fades with this autocorrelation, as large as autocovariances (n_lags + 1,) have it."""
    variance, lagged = float(max(covariance[0], 1e-12)), covariance[1:]
    powers = phi ** np.arange(1, len(covariance))
    fading = float(np.clip(powers @ lagged / (powers @ powers), 0.0, variance))
    return ChannelNoise(phi=phi, fading=fading, white=max(variance - fading, 1e-3 * variance))


def by_channel(trials: Sequence[Trial], level: Callable[[FloatArray], float]) -> FloatArray:
    """(6,) medians over trials of a level of noise, worked out from each channel of the measured motion."""
    return np.asarray(np.median([[level(values) for values in trial.motion.T] for trial in trials], axis=0))


def white_level(residuals: Sequence[FloatArray]) -> FloatArray:
    """(n_channels,) deviation of white noise in residuals (n_samples, n_channels) of trials, from second differences; 0
    of what was not measured."""
    second = np.concatenate([np.diff(r, n=2, axis=0) for r in residuals])
    counts = np.isfinite(second).sum(axis=0)
    return np.asarray(np.sqrt(np.nansum(second**2, axis=0) / np.maximum(counts, 1) / 6.0))
