"""Headings that begin anew after a full turn, as a compass shows them, made to go on."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray

TURN = 2.0 * np.pi

NEARLY = 1.0
"""Radians that a step may be off a full turn: what a ship turns between two samples."""

BELIEVED = 0.5, 1.5
"""Steps of the heading over those that the yaw rate says, between which the yaw rate tells how far a gap turned her."""


def full_turns(psi: FloatArray) -> BoolArray:
    """(n_samples - 1,) where a heading [rad] jumps by a full turn from one sample to the next."""
    return np.asarray(np.abs(np.abs(np.diff(psi)) - TURN) < NEARLY)


def going_on(psi: FloatArray, t: FloatArray, r: FloatArray) -> FloatArray:
    """A heading [rad] (n_samples,) without its jumps by full turns; as it is where it has none.

    t, r  time [s] and yaw rate [rad/s]: across a gap the ship has turned as far as that says, where it agrees with the
          heading elsewhere, else less than half a turn
    """
    with np.errstate(all="ignore"):  # of numbers that no heading has, which are told elsewhere
        if not full_turns(psi).any():
            return psi
    known = np.flatnonzero(np.isfinite(psi))
    steps = np.diff(psi[known])
    rate = np.interp(t, t[rated], r[rated]) if (rated := np.isfinite(r)).any() else np.zeros(len(t))
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t))])
    told = np.diff(angle[known])
    near = np.abs(steps) < NEARLY
    size = float(told[near] @ told[near])
    agrees = size > 0.0 and BELIEVED[0] < float(steps[near] @ told[near]) / size < BELIEVED[1]
    expected = np.where(agrees & (np.diff(known) > 1), told, 0.0)
    return unwrapped(psi, TURN, expected)


def unwrapped(values: FloatArray, turn: float = TURN, expected: FloatArray | float = 0.0) -> FloatArray:
    """Angles (n_samples,) without jumps of a full turn; NaN stays where it is and does not count.

    expected  how far each of the known is from the one before, where that is known to less than half a turn
    """
    known = np.isfinite(values)
    out = np.array(values)
    if known.any():
        jumps = np.round((np.diff(out[known]) - expected) / turn)
        out[known] -= turn * np.concatenate([[0.0], np.cumsum(jumps)])
    return out
