"""Manoeuvring indices: the numbers a turning circle, a zigzag or a stop is summed up in, and the IMO criteria on them.

The same functions read measured and simulated records, so that the two differ by the ship and not by the reading.
"""

from .criteria import (
    Criterion,
    check_stopping,
    check_turning,
    check_zigzag,
    first_overshoot_limit,
    second_overshoot_limit,
)
from .stopping import StoppingIndices, stopping_indices
from .summary import criteria_of, indices_of
from .track import Execute, Track, find_execute, find_executes
from .turning import TurningIndices, turning_indices
from .zigzag import ZigzagIndices, manoeuvre_kind, zigzag_indices

__all__ = [
    "Criterion",
    "Execute",
    "StoppingIndices",
    "Track",
    "TurningIndices",
    "ZigzagIndices",
    "check_stopping",
    "check_turning",
    "check_zigzag",
    "criteria_of",
    "find_execute",
    "find_executes",
    "first_overshoot_limit",
    "indices_of",
    "manoeuvre_kind",
    "second_overshoot_limit",
    "stopping_indices",
    "turning_indices",
    "zigzag_indices",
]
