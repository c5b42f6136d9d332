"""The depth of the water a trial was measured in."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ..gaps import bridged
from ..model import Trial


def measured_depth(trial: Trial) -> FloatArray:
    """(n_samples, 2) depth of the water [m], and 1 where the trial has it, else 0.

    Short gaps are bridged linearly; a depth that is not above 0 is a gap.
    """
    depth = trial.extra.get("depth", np.zeros(trial.n_samples))
    found = bridged(trial.t, np.where(depth > 0.0, depth, np.nan))
    if found is None:
        return np.zeros((trial.n_samples, 2))
    return np.column_stack([found, np.ones(trial.n_samples)])
