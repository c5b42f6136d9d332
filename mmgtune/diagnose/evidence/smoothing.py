"""Measured motion without its noise: one smoothing spline per channel, all with the same time scale.

All channels and the inputs share one tau (``mmgtune.trial.smoothing``): a rudder angle and the yaw it causes are then
blunted alike, and the difference between the two sides of an equation of motion is not an artefact of having smoothed
one more than the other.  tau is chosen on u, v_m and r; the noise is what the trial's file says, or what second
differences show.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...trial import Trial
from ...trial.noise import noise_of
from ...trial.smoothing import FEWEST, smoothed, time_scale

BoolArray = BoolArray

REACH = 2.5
"""Time scales from an end or a long gap within which slopes of the spline are not relied on."""

VARIANCE_OF_VALUE = 3.0 * np.sqrt(2.0) / 16.0
"""Variance of the spline, over that of the noise and dt / tau: the integral of the filter's gain squared over pi."""

VARIANCE_OF_SLOPE = np.sqrt(2.0) / 16.0
"""Variance of its slope, over that of the noise and dt / tau^3."""


@dataclass(frozen=True, eq=False)
class Smoothed:
    """A trial's motion, smoothed.

    t         (n_samples,) time [s]
    states    (n_samples, 6) x, y [m], psi [rad], u, v_m [m/s], r [rad/s]; NaN before the first and after the last
              measured sample, and throughout a channel with fewer than FEWEST measured samples
    tau       time scale of the splines [s]
    dt        usual time between samples [s]
    noise     (6,) deviation of the sensors' noise, SI units
    present   (n_samples,) whether u, v_m and r are all measured nearby: not outside the record, not in a long gap
    inner     (n_samples,) whether slopes can be relied on too: not near an end or a long gap either
    """

    t: FloatArray
    states: FloatArray
    tau: float
    dt: float
    noise: FloatArray
    present: BoolArray
    inner: BoolArray

    def alike(self, values: FloatArray) -> FloatArray:
        """Other columns (n_samples, n) of the trial, without gaps, blunted as the motion is."""
        return np.column_stack([smoothed(self.t, column, self.tau, self.dt) for column in values.T])

    @property
    def value_noise(self) -> FloatArray:
        """(6,) deviation of the smoothed states from the sensors' noise, well inside the record, SI units."""
        return np.asarray(self.noise * np.sqrt(min(1.0, VARIANCE_OF_VALUE * self.dt / self.tau)))

    @property
    def slope_noise(self) -> FloatArray:
        """(6,) deviation of their time derivatives, well inside the record, SI units per second."""
        return np.asarray(self.noise * np.sqrt(VARIANCE_OF_SLOPE * self.dt / self.tau**3))


@lru_cache(maxsize=64)
def smooth(trial: Trial) -> Smoothed:
    """Smooth a trial; gaps (NaN) up to twice the time scale are bridged, longer ones split the record.

    Raises ValueError where fewer than FEWEST samples have all of u, v_m and r.
    """
    t, motion = np.asarray(trial.t), trial.motion
    whole: BoolArray = np.asarray(np.isfinite(motion[:, 3:]).all(axis=1))
    if whole.sum() < FEWEST:
        raise ValueError(f"trial '{trial.id}' has {whole.sum()} samples with u, v_m and r; {FEWEST} are needed")
    dt = float(np.median(np.diff(t)))
    noise = _noise(trial)
    tau = time_scale(t[whole], motion[whole, 3:], noise[3:], dt)
    states = np.column_stack([smoothed(t, values, tau, dt) for values in motion.T])
    present, inner = _reliable(t, whole, tau, dt)
    return Smoothed(t, states, tau, dt, noise, present, inner)


def _noise(trial: Trial) -> FloatArray:
    """Deviation of the noise by channel; that of rounding where most neighbours are equal."""
    found = np.array(noise_of(trial), dtype=float)
    for k, values in enumerate(trial.motion.T):
        steps = np.abs(np.diff(values[np.isfinite(values)]))
        found[k] = (
            max(found[k], float(np.min(steps[steps > 0.0], initial=np.inf)) / np.sqrt(12.0)) if steps.any() else 0.0
        )
    return found


def _reliable(t: FloatArray, whole: BoolArray, tau: float, dt: float) -> tuple[BoolArray, BoolArray]:
    """Samples with measurements nearby, and those among them that are far from where measurements cease."""
    measured = t[whole]
    ends = np.diff(measured) > max(2.0 * tau, 1.5 * dt)
    starts = measured[np.concatenate([[True], ends])]
    stops = measured[np.concatenate([ends, [True]])]
    piece = np.clip(np.searchsorted(starts, t, side="right") - 1, 0, None)
    since, left = t - starts[piece], stops[piece] - t
    nearest = np.minimum(since, left)
    return nearest >= 0.0, nearest >= REACH * tau
