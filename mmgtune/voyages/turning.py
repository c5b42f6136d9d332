"""The largest yaw rate of a ship, which cVDM is relative to."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ..arrays import FloatArray
from ..backends import pad
from ..predictor import PhysicsPredictor, Predictor

FULL_RUDDER = math.radians(35.0)
"""Rudder angle of a turn where the profile does not say how far the rudder goes."""

LENGTHS = 60.0
STEP = 0.05
"""How long the turn is simulated, and its step: times the ship takes for her own length."""

QUANTILE = 0.999


def largest_yaw_rate(predictor: Predictor) -> float | None:
    """Largest yaw rate [rad/s] of a model in its own turn: rudders hard over, at its approach speed and revolutions.

    None for what is no physics model, has no approach condition or no rudder, or diverges.
    """
    if not isinstance(predictor, PhysicsPredictor):
        return None
    profile = predictor.model.profile
    inputs = predictor.model.arrangement.inputs
    if profile.approach is None or not any(one.role == "rudder" for one in inputs):
        return None
    actuators = {one.name: profile.actuator(one.name) for one in inputs}
    driven = {"propeller": profile.approach.n, "thruster": 0.0, "rudder": FULL_RUDDER}
    limits = [actuators[one.name] if one.role == "rudder" else None for one in inputs]
    controls = [limit.high if limit else driven[one.role] for one, limit in zip(inputs, limits, strict=True)]
    length = predictor.L_pp / profile.approach.speed
    t = np.arange(0.0, LENGTHS, STEP) * length
    start = np.array([0.0, 0.0, 0.0, profile.approach.speed, 0.0, 0.0])
    found = predictor.predict(pad([t], [np.tile(controls, (len(t), 1))], [start]))
    if found.diverged[0, 0]:
        return None
    return float(np.abs(found.states[0, 0, :, 5]).max()) or None


def r_max_of(
    given: float | None, predictors: Iterable[tuple[str, Predictor]], largest: FloatArray
) -> tuple[float, str]:
    """The yaw rate that cVDM is relative to [rad/s], and where it comes from, in words.

    given    what the user says [rad/s]
    largest  (n_windows,) largest measured yaw rate of each window, for want of anything better: QUANTILE of them
    """
    if given is not None:
        return given, "as given"
    for name, predictor in predictors:
        own = largest_yaw_rate(predictor)
        if own is not None:
            return own, f"largest of {name} in its own turn, rudder hard over"
    there = largest[np.isfinite(largest)]
    found = float(np.quantile(there, QUANTILE)) if len(there) else 0.0
    if not found > 0.0:
        return math.nan, "not known"
    return found, f"{100.0 * QUANTILE:g} % quantile of the windows' largest measured yaw rates"
