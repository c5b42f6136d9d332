"""The waves a trial was measured in."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..gaps import bridged
from ..model import Trial

WAVE_PAIR = ("wave_height", "wave_dir")
"""Columns that are waves together, and nothing alone."""


def measured_waves(trial: Trial) -> FloatArray:
    """(n_samples, 3) significant height times the unit vector to where waves come from, north and east [m], and 1 where
    the trial has waves, else 0.  Short gaps are bridged linearly; a height below 0 is a gap.
    """
    found = None
    if set(WAVE_PAIR) <= set(trial.extra):
        height, come_from = (trial.extra[name] for name in WAVE_PAIR)
        height = np.where(height >= 0.0, height, np.nan)
        found = bridged(trial.t, height * np.cos(come_from), height * np.sin(come_from))
    if found is None:
        return np.zeros((trial.n_samples, 3))
    return np.column_stack([found, np.ones(trial.n_samples)])
