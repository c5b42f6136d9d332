"""Speeds that ships make."""

from __future__ import annotations

import math

from ..physics.constants import GRAVITY

FROUDE = 1.0
"""Froude number U / sqrt(g L_pp) that no ship of displacement comes near: ships stay below 0.5."""


def fastest_speed(L_pp: float) -> float:
    """Speed [m/s] that no ship of this length [m] comes near."""
    return FROUDE * math.sqrt(GRAVITY * L_pp)


def too_fast(speed: float, L_pp: float) -> float | None:
    """The Froude number of a speed [m/s] that no ship of this length [m] comes near; None of any that some may make."""
    return None if speed <= fastest_speed(L_pp) else speed / math.sqrt(GRAVITY * L_pp)
