"""Measured standard manoeuvres repeated by a model with a helmsman of its own: what it would have promised.

Simulated with the measured rudder, a zigzag's errors in heading and in time add up; a designer asks what overshoot the
model foretells for an order, and whether the trial agreed.  So the order is read from the trial and given anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import FloatArray
from .errors import TrialError
from .manoeuvres import (
    Track,
    TurningIndices,
    ZigzagIndices,
    manoeuvre_kind,
    turning_indices,
    zigzag_indices,
)
from .model import Model
from .orders import Helmsman, TurningOrder, ZigzagOrder, run_manoeuvre
from .profile import ShipProfile
from .simulation import Motion, track_of
from .trial import Trial
from .units import DEG

JUDGED = {
    "advance_over_L": ("advance", "L", 2),
    "transfer_over_L": ("transfer", "L", 2),
    "tactical_diameter_over_L": ("tactical diameter", "L", 2),
    "steady_diameter_over_L": ("steady diameter", "L", 2),
    "overshoot_1_deg": ("1st overshoot", "deg", 1),
    "overshoot_2_deg": ("2nd overshoot", "deg", 1),
    "initial_turning_time_s": ("initial turning time", "s", 1),
}
"""What a manoeuvre is usually judged by: words, unit and decimals worth showing; ``Repeated`` holds all indices."""

PATIENCE = 2.0
"""A repetition may last this many times as long as the trial did."""

REST = 10.0
"""Samples before the order at least: the order is found by the rudder's rest before it."""


@dataclass(frozen=True)
class Repeated:
    """A measured turning circle or zigzag beside the model's own.

    id          of the trial
    manoeuvre   "turning" or "zigzag"
    order       in words: "35 deg to starboard", "10/10 to port first"
    measured, simulated  indices by names with their unit, None where a record does not reach one; no simulated ones
                where the simulation diverged or did not turn
    """

    id: str
    manoeuvre: str
    order: str
    measured: dict[str, Any]
    simulated: dict[str, Any]

    @property
    def judged(self) -> dict[str, tuple[float, float]]:
        """Measured and simulated value of the indices the manoeuvre is usually judged by, where both exist."""
        pairs = {name: (self.measured.get(name), self.simulated.get(name)) for name in JUDGED}
        return {name: (a, b) for name, (a, b) in pairs.items() if a is not None and b is not None}


def repeat(ship: ShipProfile | Model, trials: Sequence[Trial], *, theta: FloatArray | None = None) -> list[Repeated]:
    """Repeat each trial that is a turning circle or a zigzag without gaps; others are left out.

    theta  (n_rows, 1) coefficients, those of the profile where None

    Each begins straight ahead at the trial's approach speed and heading, with its mean revolutions before the order
    throughout.  A turn gets the angle held; a zigzag the median angle held, with counter-orders at its nominal heading.
    The rudder moves as the profile's steering gear does, at once where it has none.  There is no measured wind.
    """
    model = ship if isinstance(ship, Model) else Model(ship)
    repeats: dict[str, _Repeat] = {"turning": _turn, "zigzag": _zigzag}
    found = []
    for trial in trials:
        if np.isnan(trial.motion).any():
            continue
        track = track_of(trial)
        kind = manoeuvre_kind(track)
        if kind in repeats:
            order, measured, simulated = repeats[kind](model, track, theta)
            found.append(Repeated(trial.id, kind, order, measured.to_dict(), simulated))
    return found


def summary(repeated: Sequence[Repeated]) -> dict[str, dict[str, float | int]]:
    """Errors of the judged indices over several manoeuvres: number, mean and root mean square of each.

    Of lengths and times the errors are shares of the measured value; of overshoots they are in degrees.
    """
    errors: dict[str, list[float]] = {}
    for one in repeated:
        for name, (measured, simulated) in one.judged.items():
            scale = 1.0 if name.endswith("_deg") else measured
            errors.setdefault(name, []).append((simulated - measured) / scale)
    return {
        name: {"n": len(of), "mean": float(np.mean(of)), "rms": float(np.sqrt(np.mean(np.square(of))))}
        for name, of in errors.items()
    }


def document(repeated: Sequence[Repeated]) -> dict[str, Any]:
    """For JSON: every manoeuvre with all its indices, and the errors over all."""
    return {
        "runs": [
            {
                "id": one.id,
                "manoeuvre": one.manoeuvre,
                "order": one.order,
                "measured": one.measured,
                "simulated": one.simulated or None,
            }
            for one in repeated
        ],
        "errors": summary(repeated),
    }


_Repeat = Callable[[Model, Track, FloatArray | None], tuple[str, TurningIndices | ZigzagIndices, dict[str, Any]]]
"""Order in words, what was measured, and what the model makes of it."""


def _turn(model: Model, track: Track, theta: FloatArray | None) -> tuple[str, TurningIndices, dict[str, Any]]:
    measured = turning_indices(track, model.L_pp)
    angle = _signed(measured.rudder_angle, measured.direction)
    until = float(np.max(np.abs(track.psi - track.psi[0]))) + 5.0 * DEG
    order = f"{measured.rudder_angle / DEG:.3g} deg to {measured.direction}"
    at = measured.execute_time, measured.approach_speed
    again = _run(model, track, *at, theta, lambda begin: TurningOrder(angle, begin, until))
    return order, measured, _read(lambda: turning_indices(again.track(), model.L_pp)) if again else {}


def _zigzag(model: Model, track: Track, theta: FloatArray | None) -> tuple[str, ZigzagIndices, dict[str, Any]]:
    measured = zigzag_indices(track, model.L_pp)
    angle = _signed(measured.rudder_held, measured.direction)
    heading = measured.heading_angle or measured.rudder_angle
    legs = len(measured.execute_time)
    order = f"{measured.rudder_angle / DEG:.3g}/{heading / DEG:.3g} to {measured.direction} first"
    at = measured.execute_time[0], measured.approach_speed
    again = _run(model, track, *at, theta, lambda begin: ZigzagOrder(angle, heading, begin, legs))
    nominal = measured.rudder_angle, heading
    return order, measured, _read(lambda: zigzag_indices(again.track(), model.L_pp, nominal)) if again else {}


def _signed(angle: float, direction: str) -> float:
    return angle if direction == "starboard" else -angle


def _read(indices: Callable[[], TurningIndices | ZigzagIndices]) -> dict[str, Any]:
    try:
        return indices().to_dict()
    except TrialError:  # the model did not turn to its rudder, or span
        return {}


def _run(
    model: Model,
    track: Track,
    execute: float,
    speed: float,
    theta: FloatArray | None,
    helmsman: Callable[[float], Helmsman],
) -> Motion | None:
    """The manoeuvre with the order half a ship length after the start; None where it diverges."""
    assert track.n is not None  # tracks of trials have it
    before = track.t <= execute
    sample = float(np.median(np.diff(track.t)))
    motion = run_manoeuvre(
        model,
        helmsman(max(0.5 * model.L_pp / speed, REST * sample)),
        speed=speed,
        n=float(np.mean(track.n[before])),
        heading=float(track.psi[before][-1]),
        longest=PATIENCE * float(track.t[-1] - track.t[0]) + model.L_pp / speed,
        sample=sample,
        theta=theta,
    )
    return None if motion.diverged else motion
