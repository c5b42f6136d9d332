"""The wind a trial was measured in."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...physics.frame import to_earth
from ..gaps import bridged
from ..model import Trial

Pair = tuple[str, str]
TRUE: Pair = ("wind_speed", "wind_dir")
APPARENT: Pair = ("wind_speed_app", "wind_dir_app")
WIND_PAIRS = (TRUE, APPARENT)
"""Columns that are wind together, and nothing alone; the first pair that is there counts."""


def wind_pair(trial: Trial) -> Pair | None:
    """The columns that are the wind of a trial; None where it has none."""
    return next((pair for pair in WIND_PAIRS if set(pair) <= set(trial.extra)), None)


def air_over_ground(trial: Trial, pair: Pair, apparent: bool, from_bow: bool) -> tuple[FloatArray, FloatArray]:
    """Velocity (n_samples,) of the air over ground, north and east [m/s], of columns read as said.

    apparent  they hold the wind at the moving ship; from_bow: the direction it comes from counts from her bow
    """
    speed, direction = (trial.extra[name] for name in pair)
    first, second = -speed * np.cos(direction), -speed * np.sin(direction)
    if apparent:
        own = (trial.u, trial.v_m) if from_bow else to_earth(trial.psi, trial.u, trial.v_m)
        first, second = own[0] + first, own[1] + second
    if from_bow:
        first, second = to_earth(trial.psi, first, second)
    return first, second


def measured_wind(trial: Trial) -> FloatArray:
    """(n_samples, 3) velocity of the air over ground, north and east [m/s], and 1 where the trial has wind, else 0.

    Apparent wind becomes true wind by the measured motion.  Short gaps are bridged linearly.
    """
    pair = wind_pair(trial)
    if pair is None:
        return np.zeros((trial.n_samples, 3))
    apparent = pair == APPARENT
    found = bridged(trial.t, *air_over_ground(trial, pair, apparent, from_bow=apparent))
    if found is None:
        return np.zeros((trial.n_samples, 3))
    return np.column_stack([found, np.ones(trial.n_samples)])
