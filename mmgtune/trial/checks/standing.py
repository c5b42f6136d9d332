"""Channels of the motion that stand still where the ship moves: logs held between updates."""

from __future__ import annotations

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...phrases import listed
from ..model import Trial
from ..schema import MOTION
from .finding import Finding

LONGEST_STEP = 20.0
"""Samples between two updates up to which a log is told to be held: a channel that stood still for longer was lost."""

FEWEST = 8
"""Updates that show how often a log is updated."""

HARDLY = 0.02
"""Share of the samples between updates of the positions at which a channel that is held with them may change."""


def standing_findings(trial: Trial, where: str) -> list[Finding]:
    """Positions that stand still for several samples and then jump, again and again, while the ship makes way."""
    moves = (np.diff(trial.x) != 0.0) | (np.diff(trial.y) != 0.0)
    known = np.isfinite(trial.x[1:]) & np.isfinite(trial.x[:-1])
    speed = np.hypot(trial.u, trial.v_m)
    under_way = speed[1:] > 0.5 * np.nanmedian(speed)
    updates = np.flatnonzero(moves & known)
    if len(updates) < FEWEST or float(np.nanmedian(speed)) == 0.0:
        return []
    apart = np.diff(updates)[under_way[updates[1:]]]
    step = float(np.median(apart)) if len(apart) else 1.0
    if not 2.0 <= step <= LONGEST_STEP:
        return []
    names = [name for name in MOTION if _stands(trial.columns[name], moves & known, known & under_way)]
    seconds = step * float(np.median(np.diff(trial.t)))
    return [
        Finding(
            "warning",
            f"{listed([repr(name) for name in names])} stand still between updates, {seconds:.3g} s apart",
            f"{where}, column '{names[0]}'",
            f"the log shows them {step:.3g} times over, while the ship moves on: up to {seconds:.3g} s old",
            "keep the first sample of each value, and mark the repeated ones as NaN",
            "held",
        )
    ]


def _stands(values: FloatArray, updated: BoolArray, asked: BoolArray) -> bool:
    """Whether a channel (n_samples,) stands still wherever the positions do; updated, asked (n_samples - 1,)."""
    still = asked & ~updated
    changed = np.diff(values)[still] != 0.0
    return bool(still.any()) and float(np.mean(changed)) < HARDLY
