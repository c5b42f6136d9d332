"""Indices of all particles of a manoeuvre, by keys with their unit: advance_m, overshoot_1_deg."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..trial.index_trial import INDICES
from ..units import DEG

Values = dict[str, FloatArray]
"""(n_particles,) of each index, in the unit of its key, NaN where a particle does not reach it."""


@dataclass(frozen=True)
class Known:
    """An index: its key with the unit, words, the unit people read, the factor to it from SI.

    endless  whether not to reach it is to lie above all that do
    """

    key: str
    words: str
    unit: str
    factor: float
    endless: bool


_UNITS = {
    "m": ("_m", "m", 1.0),
    "s": ("_s", "s", 1.0),
    "rad": ("_deg", "deg", 1.0 / DEG),
    "m/s": ("_m_per_s", "m/s", 1.0),
    "rad/s": ("_deg_per_s", "deg/s", 1.0 / DEG),
    "-": ("", "-", 1.0),
}


def _known(name: str, words: str, unit: str) -> Known:
    suffix, shown, factor = _UNITS[unit]
    endless = (unit in ("m", "s") and name != "lateral_deviation") or name.startswith("overshoot")
    return Known(name + suffix, words, shown, factor, endless)


KNOWN: Mapping[str, Known] = {
    **{name: _known(name, one.words, one.unit) for name, one in INDICES.items()},
    "overshoot_4": _known("overshoot_4", "4th overshoot", "rad"),
    "lateral_deviation": _known("lateral_deviation", "lateral deviation", "m"),
}
"""Indices that are shown, by the names of ``manoeuvres.on_lanes``."""

BY_KEY: Mapping[str, Known] = {one.key: one for one in KNOWN.values()}


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
