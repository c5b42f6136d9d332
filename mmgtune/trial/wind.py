"""The wind a trial was measured in."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..physics.frame import to_earth
from .gaps import bridged
from .model import Trial

WIND_PAIRS = (("wind_speed", "wind_dir"), ("wind_speed_app", "wind_dir_app"))
"""Columns that are wind together, and nothing alone; the first pair that is there counts."""


def measured_wind(trial: Trial) -> FloatArray:
    """(n_samples, 3) velocity of the air over ground, north and east [m/s], and 1 where the trial has wind, else 0.

    Apparent wind becomes true wind by the measured motion.  Short gaps are bridged linearly.
    """
    extra = trial.extra
    if "wind_speed" in extra and "wind_dir" in extra:
        north = -extra["wind_speed"] * np.cos(extra["wind_dir"])
        east = -extra["wind_speed"] * np.sin(extra["wind_dir"])
    elif "wind_speed_app" in extra and "wind_dir_app" in extra:
        ahead = trial.u - extra["wind_speed_app"] * np.cos(extra["wind_dir_app"])
        abeam = trial.v_m - extra["wind_speed_app"] * np.sin(extra["wind_dir_app"])
        north, east = to_earth(trial.psi, ahead, abeam)
    else:
        return np.zeros((trial.n_samples, 3))
    found = bridged(trial.t, north, east)
    if found is None:
        return np.zeros((trial.n_samples, 3))
    return np.column_stack([found, np.ones(trial.n_samples)])
