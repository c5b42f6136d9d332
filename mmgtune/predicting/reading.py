"""Indices of all particles of a manoeuvre, by keys with their unit: advance_m, overshoot_1_deg."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..manoeuvres.named import BY_KEY, KNOWN

Values = dict[str, FloatArray]
"""(n_particles,) of each index, in the unit of its key, NaN where a particle does not reach it."""


def of_lanes(values: Mapping[str, FloatArray], sound: BoolArray) -> Values:
    """Indices in SI by name as ``on_lanes`` has them; NaN for particles that are not ``sound`` (n_particles,)."""
    return {
        one.key: np.where(sound, one.factor * values[name], np.nan) for name, one in KNOWN.items() if name in values
    }


def of_records(rows: list[dict[str, object]]) -> Values:
    """Indices of particles, a row each as ``TrialRecord.indices`` has it; those that some particle reaches."""
    found = {key: np.array([_number(row.get(key)) for row in rows]) for key in BY_KEY}
    return {key: of for key, of in found.items() if np.isfinite(of).any()}


def _number(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) else math.nan
