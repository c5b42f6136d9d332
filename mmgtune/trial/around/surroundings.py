"""What was measured around the ship during a trial, as simulators take it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray
from ...physics.quantities import KNOWN, Surroundings
from ..model import Trial
from .current import measured_current
from .depth import measured_depth
from .waves import measured_waves
from .wind import measured_wind

SOURCES: dict[tuple[str, ...], Callable[[Trial, float | None], FloatArray]] = {
    ("wind_north", "wind_east", "wind_known"): lambda trial, _: measured_wind(trial),
    ("current_north", "current_east", "current_north_rate", "current_east_rate", "current_known"): measured_current,
    ("wave_north", "wave_east", "wave_known"): lambda trial, _: measured_waves(trial),
    ("depth", "depth_known"): lambda trial, _: measured_depth(trial),
    ("elapsed",): lambda trial, _: (trial.begins + trial.t)[:, None],
}
"""Where each field of ``Surroundings`` comes from: functions of a trial and the ship's draught [m], None where nobody
knows it, that return (n_samples, n_fields)."""


def surroundings(trial: Trial, draught: float | None) -> FloatArray:
    """(n_samples, n_surroundings) in the order of ``Surroundings``; 0 where nothing was measured, but for the time.

    draught  of the ship [m], over which the mean of a current in layers is taken; None where nobody knows it
    """
    found = np.zeros((trial.n_samples, len(Surroundings._fields)))
    for names, source in SOURCES.items():
        if not trial.extra and names != ("elapsed",):
            continue
        found[:, [Surroundings._fields.index(name) for name in names]] = source(trial, draught)
    return found


def measured_around(trial: Trial) -> frozenset[str]:
    """Which of ``KNOWN`` were measured in a trial: "wind" where it has speed and direction in one sample at least."""
    found = surroundings(trial, None)
    return frozenset(name for name in KNOWN if found[:, Surroundings._fields.index(f"{name}_known")].any())
