"""Motions of a trial that no manoeuvring model has: the swinging of a ship in waves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...units import DEG
from ..gaps import bridged
from ..model import Trial
from .finding import Finding

CHANNELS = {"psi": ("deg", DEG), "r": ("deg/s", DEG), "v": ("m/s", 1.0), "u": ("m/s", 1.0)}
"""Where waves show, with the unit and size in which it is told."""

LONGEST = 20.0
"""Period [s] beyond which swinging may be that of the manoeuvre."""

OF_LENGTH = 1.0
"""The same in times the ship takes for her length."""

SHORTEST = 2.5
"""Samples of a period."""

PEAKS = 6
"""Peaks of a spectrum that are looked at, the highest first."""

PERIODS = 12
"""Times a swinging must be seen in a record."""

ABOVE = 8.0
"""Spectrum at the period over that to both sides of it."""

BELOW, BEYOND = (0.4, 0.65), (1.5, 2.3)
"""These sides, as shares of the frequency."""

LASTS = 0.4
"""Amplitude in each third of the record, over that in all of it."""

NOTICED = 0.02
"""Amplitude over the range of a channel that one of them must have: carriages of towing tanks tremble too."""

ALIKE = 0.15
"""Share by which periods of two channels may differ."""


class Swing(NamedTuple):
    """A channel that swings: period [s], amplitude in the unit of the channel, and that over its range."""

    channel: str
    period: float
    amplitude: float
    share: float


def swell_findings(trial: Trial, where: str, L_pp: float | None = None) -> list[Finding]:
    """That two channels or more swing alike from beginning to end, faster than a ship steers.

    L_pp  of the ship [m], where it is known
    """
    found = swings(trial, L_pp)
    if not found:
        return []
    middle = period_of(found)
    told = ", ".join(
        f"'{one.channel}' by {one.amplitude / CHANNELS[one.channel][1]:.2g} {CHANNELS[one.channel][0]}" for one in found
    )
    return [
        Finding(
            "warning",
            f"the ship swings with a period of {middle:.2g} s from beginning to end",
            f"{where}, columns {', '.join(repr(one.channel) for one in found)}",
            f"{told}, as in waves, which a manoeuvring model does not have",
            "give trials in calmer water, or a log that is filtered as autopilots filter waves, all its channels alike",
            "swell",
        )
    ]


def swings(trial: Trial, L_pp: float | None = None) -> list[Swing]:
    """Channels that swing alike from beginning to end, faster than a ship steers: two or more, else none.

    L_pp  of the ship [m], where it is known
    """
    found = list(_swings(trial, L_pp))
    middle = period_of(found) if found else 1.0
    found = [one for one in found if abs(one.period / middle - 1.0) < ALIKE]
    return [] if len(found) < 2 or max(one.share for one in found) < NOTICED else found


def period_of(found: Sequence[Swing]) -> float:
    """Period [s] of channels that swing alike."""
    return float(np.median([one.period for one in found]))


def _swings(trial: Trial, L_pp: float | None) -> Iterator[Swing]:
    """Channels that swing, where the record is even and long enough to tell."""
    dt = np.diff(trial.t)
    if len(dt) < 8 or dt.max() > 1.01 * dt.min():
        return
    step = float(np.median(dt))
    speed = float(np.nanmedian(np.abs(trial.u)))
    longest = min(LONGEST, trial.duration / PERIODS)
    if L_pp is not None and speed > 0.0:
        longest = min(longest, OF_LENGTH * L_pp / speed)
    if longest < 2.0 * SHORTEST * step:
        return
    for name in CHANNELS:
        known = bridged(trial.t, trial.columns[name])
        if known is not None:
            values = np.asarray(known).reshape(-1)
            swing = _swing(values, step, longest)
            if swing is not None:
                yield Swing(name, *swing, swing[1] / max(float(np.ptp(values)), 1e-12))


def _swing(values: FloatArray, step: float, longest: float) -> tuple[float, float] | None:
    """Period [s] and amplitude of what stands out of the spectrum of a channel (n_samples,), None for nothing."""
    width = min(len(values), max(16, round(8.0 * longest / step)))
    f, power = np.fft.rfftfreq(width, step), _spectrum(values, width)
    asked = np.flatnonzero((f >= 1.0 / longest) & (f <= 1.0 / (SHORTEST * step)))
    asked = asked[(asked > 0) & (asked < len(f) - 1)]
    peaks = asked[(power[asked] > power[asked - 1]) & (power[asked] > power[asked + 1])]
    for k in peaks[np.argsort(-power[peaks])][:PEAKS]:
        peak = f[k]
        sides = [power[(f >= low * peak) & (f <= high * peak)] for low, high in (BELOW, BEYOND)]
        if any(len(side) and power[k] < ABOVE * np.median(side) for side in sides) or not len(sides[0]):
            continue
        thirds = [_amplitude(part, step, peak) for part in np.array_split(values, 3)]
        if min(thirds) > LASTS * np.mean(thirds):
            return 1.0 / peak, float(np.mean(thirds))
        return None
    return None


def _spectrum(values: FloatArray, width: int) -> FloatArray:
    """Power by frequency, up to a factor, the mean over pieces of ``width`` samples that overlap by half (Welch 1967):
    not SciPy's own, which takes half a second to import."""
    pieces = np.lib.stride_tricks.sliding_window_view(values, width)[:: max(1, width // 2)]
    return np.asarray(np.mean(np.abs(np.fft.rfft(_tapered(pieces), axis=1)) ** 2, axis=0))


def _tapered(pieces: FloatArray) -> FloatArray:
    """Pieces (n, n_samples) less a straight line each, faded in and out."""
    n = pieces.shape[1]
    k = np.arange(n) - 0.5 * (n - 1)
    level = pieces.mean(axis=1, keepdims=True)
    return np.asarray((pieces - level - np.outer(pieces @ k / (k @ k), k)) * np.hanning(n))


def _amplitude(values: FloatArray, step: float, frequency: float) -> float:
    """Of what a channel has within a quarter of a frequency."""
    n = len(values)
    spectrum = np.fft.rfft(_tapered(values[None])[0])
    f = np.fft.rfftfreq(n, step)
    near = np.abs(f / frequency - 1.0) < 0.25
    power = 2.0 * float(np.sum(np.abs(spectrum[near]) ** 2)) / (n * float(np.sum(np.hanning(n) ** 2)))
    return float(np.sqrt(2.0 * power))
