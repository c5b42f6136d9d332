"""Short-horizon residuals: the simulation restarted again and again, so that drift does not hide where it is wrong."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...backends import Integrator
from ...model import Model
from ...predictor import Predictor, as_predictor, cases_from, draught_of, portions, predicted
from ...profile import ShipProfile
from ...trial import Trial
from .smoothing import Smoothed, smooth


@dataclass(frozen=True, eq=False)
class ShortHorizon:
    """Simulated less measured motion, never longer than a window after a restart from the measurement.

    ids        of the trials
    t          (n_samples,) time [s], by trial
    residuals  (n_samples, 6) in x, y [m], psi [rad], u, v_m [m/s], r [rad/s], by trial; NaN in gaps, at samples that
               no window reaches, and in windows that diverged
    since      (n_samples,) time since the restart [s], by trial; NaN where no window reaches
    noise      (n_trials, 6) deviation of the sensors' noise
    window     longest time since a restart [s]
    diverged   number of windows whose simulation left the world of ships
    """

    ids: tuple[str, ...]
    t: tuple[FloatArray, ...]
    residuals: tuple[FloatArray, ...]
    since: tuple[FloatArray, ...]
    noise: FloatArray
    window: float
    diverged: int

    @property
    def rms(self) -> FloatArray:
        """(n_trials, 6) root mean square by trial and channel, in the units of ``residuals``; NaN without samples."""
        return np.array([_rms(values) for values in self.residuals])

    @property
    def pooled_rms_in_noise(self) -> FloatArray:
        """(6,) root mean square over all trials, in deviations of each trial's noise; NaN where there is none."""
        return _rms(np.concatenate(self._in_noise))

    @property
    def _in_noise(self) -> list[FloatArray]:
        unit = np.where(self.noise > 0.0, self.noise, np.nan)
        return [values / one for values, one in zip(self.residuals, unit, strict=True)]


def short_horizon(
    ship: Predictor | ShipProfile | Model,
    trials: Sequence[Trial],
    *,
    window: float = 60.0,
    member: int = 0,
    integrator: Integrator = Integrator(),
) -> ShortHorizon:
    """Restart the simulation from smoothed measured states every ``window`` [s]: all windows of all trials at once.

    A sample at which one window ends and the next begins belongs to the one that ends.  Windows begin anew after a gap
    too long to be bridged.  Lags of the model count as settled at each restart.

    member  of the predictor, from 0

    Restarts carry on what noise the smoothing left: the true model's residuals are one to two deviations of the noise,
    most in the heading.

    Raises ValueError for no trials, a window that is not positive or no longer than every step, and a trial that has
    too few samples to smooth.
    """
    if not trials:
        raise ValueError("there are no trials")
    if not window > 0.0:
        raise ValueError(f"a window of {window:g} s is not positive")
    predictor = as_predictor(ship, integrator=integrator)
    motions = [smooth(trial) for trial in trials]
    windows = [(i, part) for i, motion in enumerate(motions) for part in _windows(motion, window)]
    if not windows:
        raise ValueError(f"no window of {window:g} s holds two samples with a measured state")
    residuals = [np.full((trial.n_samples, 6), np.nan) for trial in trials]
    since = [np.full(trial.n_samples, np.nan) for trial in trials]
    diverged = 0
    for portion in portions([part.stop - part.start for _, part in windows], predictor.n_members):
        some = windows[portion]
        parts = [part for _, part in some]
        start = [motions[i].states[part.start] for i, part in some]
        found = predicted(
            predictor,
            cases_from(
                [trials[i] for i, _ in some], predictor.inputs, draught_of(predictor), parts=parts, initial=start
            ),
        )
        diverged += int(found.diverged[:, member].sum())
        for k, (i, part) in enumerate(some):
            t, after = trials[i].t, slice(part.start + 1, part.stop)
            since[i][after] = t[after] - t[part.start]
            if not found.diverged[k, member]:
                residuals[i][after] = found.states[k, member, 1 : part.stop - part.start] - trials[i].motion[after]
    return ShortHorizon(
        ids=tuple(trial.id for trial in trials),
        t=tuple(trial.t for trial in trials),
        residuals=tuple(residuals),
        since=tuple(since),
        noise=np.array([motion.noise for motion in motions]),
        window=window,
        diverged=diverged,
    )


def _windows(motion: Smoothed, window: float) -> list[slice]:
    """Samples of each window; neighbours share the sample at which the next begins."""
    usable: BoolArray = motion.present & np.isfinite(motion.states).all(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], usable, [False]]).astype(int)))
    found = []
    for first, stop in edges.reshape(-1, 2):
        start = int(first)
        while start + 1 < stop:
            end = int(np.searchsorted(motion.t[:stop], motion.t[start] + window * (1.0 + 1e-9), side="right"))
            if end - start < 2:  # a step longer than the window
                start += 1
                continue
            found.append(slice(start, end))
            start = end - 1
    return found


def _rms(values: FloatArray) -> FloatArray:
    """(6,) of (n, 6), NaN left out."""
    known = np.isfinite(values)
    squares = np.sum(np.where(known, values, 0.0) ** 2, axis=0)
    count = known.sum(axis=0)
    return np.sqrt(np.where(count > 0, squares / np.maximum(count, 1), np.nan))
