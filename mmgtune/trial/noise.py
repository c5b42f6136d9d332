"""How noisy the motion of a trial is."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from .kinematics import motion_noise
from .model import Trial
from .schema import MOTION


def noise_of(trial: Trial) -> FloatArray:
    """Standard deviation of white noise in x, y, psi, u, v_m, r: (6,), SI units.

    What the file says, else what second differences show, in which a smooth motion hardly does, and rounding.
    """
    channels = zip(MOTION, trial.motion.T, strict=True)
    return np.array([trial.noise.get(name, motion_noise(values)) for name, values in channels])
