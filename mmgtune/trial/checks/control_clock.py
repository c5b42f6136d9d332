"""Whether the rudder was logged at the times the motion was: clocks of two loggers may be minutes apart."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...physics.following import followed
from ...units import DEG
from ..model import Trial
from ..schema import RUDDERS
from .control_checks import rudders_of, steered
from .finding import Finding, Shift

LEAST_RUDDER = 4.0 * DEG
"""Range of rudder angles below which no turn follows from them."""

STEPS, TIMES, SHIFTS, FINER, COARSE = 1000, 12, 60, 10, 4
"""Samples that a run is looked at with; time constants that are tried, shifts to each side, and parts of one after, for
which all samples are looked at: of so many one before."""

KNOWN = 0.9
"""Share of yaw rates that must be measured, and of samples at which she must be steered by rudders, going ahead."""

FOLLOWS, MISSES, BETTER = 0.15, 0.1, 3.0
"""Share of the variance of the yaw rate that following the shifted rudder may leave, what following it as logged leaves
at least, and how many times the former that is."""

BEYOND = 0.3
"""Share of the time in which a ship answers her rudder that a shift exceeds, as it does the time the rudder takes from
side to side: less is as likely her steering gear's."""


def clock_findings(trial: Trial, where: str) -> list[Finding]:
    """That the ship turns well before or after what is logged of her rudder."""
    found = shift_of(trial)
    if found is None:
        return []
    shift, left, as_logged = found
    rudders = ", ".join(f"'{name}'" for name in RUDDERS if name in trial.columns)
    side = "after" if shift > 0.0 else "before"
    return [
        Finding(
            "warning",
            f"the ship turns about {abs(shift):.2g} s {side} what is logged of her rudder",
            where,
            f"so shifted, all but {100.0 * left:.2g} % of her yaw rate follows from it, as logged all but "
            f"{100.0 * as_logged:.2g} %: the clock of the rudder's log is off by that, or that of the motion's",
            Shift(f"shift {rudders} and all logged with it by about {shift:+.2g} s", -shift),
        )
    ]


def shift_of(trial: Trial) -> tuple[float, float, float] | None:
    """By how much later than logged [s] the rudder acts, with the share of the variance of the yaw rate that following
    it then leaves, and as logged; None where that is no more than her steering gear may take, or does not show.

    The yaw rate follows the rudder with a lag of first order (assumption), of whichever time constant fits best.
    """
    known = np.isfinite(trial.r)
    if np.mean(steered(trial) & (trial.n > 0.0)) < KNOWN:  # she turns by her engine, or by rudders that brake
        return None
    rudder = np.mean(rudders_of(trial), axis=0)
    if not np.isfinite(rudder).all() or known.mean() < KNOWN or np.ptp(rudder) < LEAST_RUDDER:
        return None
    duration = float(trial.t[-1] - trial.t[0])
    step = max(duration / STEPS, float(np.median(np.diff(trial.t))))
    t = trial.t[0] + step * np.arange(int(duration / step) + 1)
    rate = np.interp(t, trial.t[known], trial.r[known])
    variance = float(np.var(rate))
    if len(t) < SHIFTS or variance <= 0.0:
        return None
    times = np.geomspace(2.0 * step, 0.25 * duration, TIMES)
    rudder = np.interp(t, trial.t, rudder)
    answers = _answers(rudder, step, times)
    as_logged = float(_left(t, rate, answers, np.zeros(1))[0].min()) / variance
    if as_logged <= MISSES:
        return None
    span = duration / 3.0
    shifts = np.linspace(-span, span, 2 * SHIFTS + 1)
    left, sides = _left(t, rate, answers, shifts, COARSE)
    left = np.where(sides > 0.0, left, np.inf)
    near = shifts[int(np.argmin(left.min(axis=0)))]
    finer = near + np.linspace(-span, span, 2 * FINER + 1) / SHIFTS
    left, sides = _left(t, rate, answers, finer)
    left = np.where(sides > 0.0, left, np.inf)
    which, k = np.unravel_index(int(np.argmin(left)), left.shape)
    shift, least = float(finer[k]), float(left[which, k]) / variance
    over = step * float(np.ptp(rudder) / np.abs(np.diff(rudder)).max())
    enough = max(3.0 * step, over, BEYOND * float(times[which]))
    shows = least < FOLLOWS and as_logged > BETTER * least and abs(shift) > enough
    return (shift, least, as_logged) if shows else None


def _answers(rudder: FloatArray, step: float, times: FloatArray) -> FloatArray:
    """(n_times, n_samples) what follows the rudder with lags of first order."""
    of_before = followed(0.0, 0.0, 1.0, step, times)
    of_rudder = followed(rudder[:-1, None], rudder[1:, None], 0.0, step, times)
    found = np.empty((len(rudder), len(times)))
    found[0] = rudder[0]
    for k, added in enumerate(of_rudder):  # a step is linear in what was before it
        found[k + 1] = of_before * found[k] + added
    return found.T


def _left(
    t: FloatArray, rate: FloatArray, answers: FloatArray, shifts: FloatArray, every: int = 1
) -> tuple[FloatArray, FloatArray]:
    """(n_times, n_shifts) variances of the yaw rate that each lag of the rudder leaves where it acts later by a shift,
    and the gains with which it fits.

    every  of how many samples one is looked at
    """
    at = np.clip((t[::every] - shifts[:, None] - t[0]) / (t[1] - t[0]), 0.0, len(t) - 1.0)
    rate = rate[::every]
    before = np.minimum(at.astype(np.int64), len(t) - 2)
    share = at - before
    shifted = (1.0 - share) * answers[:, before] + share * answers[:, before + 1]
    shifted -= shifted.mean(axis=-1, keepdims=True)
    along = shifted @ (rate - rate.mean()) / len(rate)
    size = np.maximum(np.mean(shifted**2, axis=-1), 1e-300)
    return np.var(rate) - along**2 / size, along / size
