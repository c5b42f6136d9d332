"""Measured standard manoeuvres repeated by a model with a helmsman of its own: what it would have promised.

Simulated with the measured rudder, a zigzag's errors in heading and in time add up; a designer asks what overshoot the
model foretells for an order, and whether the trial agreed.  So the order is read from the trial and given anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arguments import ShipGiven, TrialsGiven, some_of
from .arrays import FloatArray
from .displayed import Brief
from .errors import TrialError
from .inputs import INPUTS
from .manoeuvres import (
    Track,
    TurningIndices,
    ZigzagIndices,
    manoeuvre_kind,
    turning_indices,
    zigzag_indices,
)
from .manoeuvres.judged import JUDGED
from .model import Model
from .motions import Motion, ordered_angles, track_if_whole
from .networks import named_ship
from .orders import LONGEST_STEP, Helmsman, Sailing, TurningOrder, ZigzagOrder, run_manoeuvres
from .predictor import PhysicsPredictor, Predictor, as_predictor, stepper_of
from .trial import Trial
from .units import DEG

PATIENCE = 2.0
"""A repetition may last this many times as long as the trial did."""

REST = 10.0
"""Samples before the order at least: the order is found by the rudder's rest before it."""


@dataclass(frozen=True, repr=False)
class Repeated(Brief):
    """A measured turning circle or zigzag beside the model's own.

    id          of the trial
    manoeuvre   "turning" or "zigzag"
    order       in words: "35 deg to starboard", "10/10 to port first"
    measured, simulated  indices by names with their unit, None where a record does not reach one; no simulated ones
                where the simulation diverged or did not turn
    member      of the predictor, from 0
    """

    id: str
    manoeuvre: str
    order: str
    measured: dict[str, Any]
    simulated: dict[str, Any]
    member: int = 0

    @property
    def judged(self) -> dict[str, tuple[float, float]]:
        """Measured and simulated value of the indices the manoeuvre is usually judged by, where both exist."""
        pairs = {name: (self.measured.get(name), self.simulated.get(name)) for name in JUDGED}
        return {name: (a, b) for name, (a, b) in pairs.items() if a is not None and b is not None}


def repeat(
    ship: ShipGiven | Model | Predictor,
    trials: TrialsGiven,
    *,
    theta: FloatArray | None = None,
) -> list[Repeated]:
    """Repeat each trial that is a turning circle or a zigzag without gaps, begun with way on; others are left out.

    ship, trials  objects, paths or bundled names; ``ship`` may be any predictor, ``trials`` a list of trials
    theta  (n_rows, n_members) coefficients of a profile or model, its own where None
    -> trial by trial, and of each all members

    Each begins straight ahead at the trial's approach speed and heading, with its mean revolutions before the order
    throughout.  A turn gets the angle held; a zigzag the median angle held, with counter-orders at its check angle: the
    one its trial names ("zigzag 35/5"), else the usual one nearest to where the rudder was reversed.
    The rudder moves as the profile's steering gear does, at once where it has none.  There is no measured wind.
    Any predictor can be steered, see ``predictor.stepper_of``.  Raises TrialError where there are no trials.
    """
    return repetitions(as_predictor(named_ship(ship), theta=theta), some_of(trials))


def repetitions(predictor: Predictor, trials: Sequence[Trial]) -> list[Repeated]:
    """As ``repeat``; none of no trials."""
    read: dict[str, _Read] = {"turning": _turn, "zigzag": _zigzag}
    given = []
    for trial in trials:
        track = track_if_whole(trial)
        kind = "other" if track is None else manoeuvre_kind(track)
        order = read[kind](predictor.L_pp, trial, track) if track is not None and kind in read else None
        if order is not None:
            given += [(trial.id, kind, order)] * predictor.n_members
    members = [k % predictor.n_members for k in range(len(given))]
    motions = steered(predictor, members, [order.sailing for _, _, order in given])
    return [
        Repeated(id, kind, order.words, order.measured.to_dict(), order.again(motion), member)
        for (id, kind, order), motion, member in zip(given, motions, members, strict=True)
    ]


def document(repeated: Sequence[Repeated]) -> dict[str, Any]:
    """For JSON: every manoeuvre with all its indices, and the errors over all."""
    several = any(one.member for one in repeated)
    return {
        "runs": [
            {
                "id": one.id,
                **({"member": one.member} if several else {}),
                "manoeuvre": one.manoeuvre,
                "order": one.order,
                "measured": one.measured,
                "simulated": one.simulated or None,
            }
            for one in repeated
        ],
        "errors": summary(repeated),
    }


def summary(repeated: Sequence[Repeated]) -> dict[str, dict[str, float | int]]:
    """Errors of the judged indices over several manoeuvres: number, mean and root mean square of each.

    Of lengths and times the errors are shares of the measured value; of overshoots they are in degrees.
    """
    errors: dict[str, list[float]] = {}
    for one in repeated:
        for name, (measured, simulated) in one.judged.items():
            _, unit, _ = JUDGED[name]
            scale = 1.0 if unit == "deg" else measured
            errors.setdefault(name, []).append((simulated - measured) / scale)
    return {
        name: {"n": len(of), "mean": float(np.mean(of)), "rms": float(np.sqrt(np.mean(np.square(of))))}
        for name, of in errors.items()
    }


@dataclass(frozen=True, eq=False)
class _Order:
    """A manoeuvre as it was ordered.

    words     of the order
    measured  indices of the trial
    sailing   the same manoeuvre anew
    read      indices of a track of it
    """

    words: str
    measured: TurningIndices | ZigzagIndices
    sailing: Sailing
    read: Callable[[Track], TurningIndices | ZigzagIndices]

    def again(self, motion: Motion) -> dict[str, Any]:
        """Indices of a motion; none where it diverged, spun, or did not turn to its rudder."""
        try:
            return {} if motion.diverged else self.read(motion.track()).to_dict()
        except TrialError:
            return {}


_Read = Callable[[float, Trial, Track], _Order | None]


def _turn(L_pp: float, trial: Trial, track: Track) -> _Order | None:
    measured = turning_indices(track, L_pp)
    angle = _signed(measured.rudder_angle, measured.direction)
    until = float(np.max(np.abs(track.psi - track.psi[0]))) + 5.0 * DEG
    words = f"{measured.rudder_angle / DEG:.3g} deg to {measured.direction}"
    if not measured.approach_speed > 0.0:
        return None
    at = measured.execute_time, measured.approach_speed
    sailing = _sailing(L_pp, track, *at, lambda begin: TurningOrder(angle, begin, until))
    return _Order(words, measured, sailing, lambda again: turning_indices(again, L_pp))


def _zigzag(L_pp: float, trial: Trial, track: Track) -> _Order | None:
    measured = zigzag_indices(track, L_pp, ordered_angles(trial))
    angle = _signed(measured.rudder_held, measured.direction)
    heading = measured.heading_angle or measured.rudder_angle
    legs = len(measured.execute_time)
    words = f"{measured.rudder_angle / DEG:.3g}/{heading / DEG:.3g} to {measured.direction} first"
    at = measured.execute_time[0], measured.approach_speed
    nominal = measured.rudder_angle, heading
    if not measured.approach_speed > 0.0:
        return None
    sailing = _sailing(L_pp, track, *at, lambda begin: ZigzagOrder(angle, heading, begin, legs))
    return _Order(words, measured, sailing, lambda again: zigzag_indices(again, L_pp, nominal))


def _signed(angle: float, direction: str) -> float:
    return angle if direction == "starboard" else -angle


def _sailing(L_pp: float, track: Track, execute: float, speed: float, helmsman: Callable[[float], Helmsman]) -> Sailing:
    """The manoeuvre of a track with the order half a ship length after the start."""
    assert track.n is not None  # tracks of trials have it
    before = track.t <= execute
    sample = float(np.median(np.diff(track.t)))
    return Sailing(
        helmsman(max(0.5 * L_pp / speed, REST * sample)),
        speed=speed,
        n=float(np.mean(track.n[before])),
        heading=float(track.psi[before][-1]),
        longest=PATIENCE * float(track.t[-1] - track.t[0]) + L_pp / speed,
        sample=sample,
    )


def steered(predictor: Predictor, members: Sequence[int], sailings: Sequence[Sailing]) -> list[Motion]:
    """Manoeuvres, each by a member of a predictor, from straight ahead.

    A physics model has the steering gear of its profile.  With any other predictor the rudder moves at once, and steps
    are as long as a helmsman waits between two looks at the compass.
    """
    if isinstance(predictor, PhysicsPredictor):
        return run_manoeuvres(predictor.model, sailings, theta=predictor.theta[:, list(members)])
    return [_stepped(predictor, member, sailing) for member, sailing in zip(members, sailings, strict=True)]


def _stepped(predictor: Predictor, member: int, sailing: Sailing) -> Motion:
    assert sailing.speed is not None  # read from the trial
    assert sailing.n is not None
    state = np.array([0.0, 0.0, sailing.heading, sailing.speed, 0.0, 0.0])
    driven = {"propeller": sailing.n, "rudder": 0.0, "thruster": 0.0}
    now = np.array([driven[INPUTS[name].role] for name in predictor.inputs])
    under_way = stepper_of(predictor, member, state, now)
    helmsman = sailing.helmsman_of_its_own()
    sample = sailing.sample
    steps = max(1, math.ceil(sample / LONGEST_STEP - 1e-9))
    states, controls = [state], [now]
    diverged = False
    for i in range(round(sailing.longest / sample)):
        for k in range(steps):
            t = i * sample + k * sample / steps
            driven["rudder"] = helmsman.order(t, float(state[2] - sailing.heading))
            then = np.array([driven[INPUTS[name].role] for name in predictor.inputs])
            state, now = under_way.step(now, then, sample / steps), then
        states.append(state)
        controls.append(now)
        diverged = not bool(np.isfinite(state).all())
        if diverged or helmsman.finished(float(state[2] - sailing.heading)):
            break
    times: FloatArray = sample * np.arange(len(states), dtype=np.float64)
    return Motion("run", times, np.array(states), np.array(controls), diverged, tuple(predictor.inputs), member)
