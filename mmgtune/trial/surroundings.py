"""What was measured around the ship during a trial, as simulators take it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import FloatArray
from ..physics.quantities import Surroundings
from .model import Trial
from .wind import measured_wind

SOURCES: dict[tuple[str, ...], Callable[[Trial], FloatArray]] = {
    ("wind_north", "wind_east", "wind_known"): measured_wind,
}
"""Where each field of ``Surroundings`` comes from: functions of a trial that return (n_samples, n_fields)."""


def surroundings(trial: Trial) -> FloatArray:
    """(n_samples, n_surroundings) in the order of ``Surroundings``; 0 where nothing was measured."""
    found = np.zeros((trial.n_samples, len(Surroundings._fields)))
    if not trial.extra:
        return found
    for names, source in SOURCES.items():
        found[:, [Surroundings._fields.index(name) for name in names]] = source(trial)
    return found
