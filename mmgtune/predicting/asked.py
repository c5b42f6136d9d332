"""What is asked of a ship: standard manoeuvres, from an approach that her profile or the user states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ..arrays import FloatArray
from ..errors import OptionError, Problem
from ..inputs import INPUTS
from ..model import Model
from ..options import PredictOptions
from ..orders import possible_approach
from ..predictor import Predictor
from ..profile import Actuator, ShipProfile
from ..simulating import (
    STOP,
    approach_speed,
    astern_of,
    revolutions,
    rudder_angle,
    turn_name,
    zigzag_angles,
    zigzag_name,
)
from ..units import DEG, read_as

Manoeuvre = Literal["turning", "zigzag", "stopping"]

USUAL = PredictOptions(turn=("35", "-35"), zigzag=("10/10", "20/20"))
"""What is predicted where nothing is asked for."""


@dataclass(frozen=True)
class Approach:
    """Straight ahead at a speed [m/s] with revolutions n [1/s]."""

    speed: float
    n: float

    def to_dict(self) -> dict[str, float]:
        """For JSON."""
        return {"speed_m_per_s": self.speed, "rpm": 60.0 * self.n}


@dataclass(frozen=True)
class Asked:
    """A standard manoeuvre.

    rudder  ordered [rad], starboard positive; 0 for a stop
    check   check heading of a zigzag [rad], else None
    n       revolutions ordered [1/s], those of the approach but in a stop
    """

    id: str
    manoeuvre: Manoeuvre
    words: str
    rudder: float
    check: float | None
    n: float


def profile_behind(predictor: Predictor) -> ShipProfile | None:
    """The profile whose model a predictor moves by, alone or with something added; None of a network alone."""
    model: Any = getattr(predictor, "model", None)
    return model.profile if isinstance(model, Model) else None


def approach_of(predictor: Predictor, options: PredictOptions) -> Approach:
    """The approach, of the options or of the profile.  Raises OptionError where neither says it."""
    own = profile.approach if (profile := profile_behind(predictor)) else None
    ordered = approach_speed(options.speed) if options.speed else None
    turning = revolutions(options.rpm) if options.rpm else None
    possible_approach(ordered, turning, predictor.L_pp, own)
    speed = own.speed if ordered is None and own else ordered
    n = own.n if turning is None and own else turning
    if speed is None or n is None:
        lacking = [name for name, value in (("speed", speed), ("rpm", n)) if value is None]
        why = "its profile has no [approach] section" if profile else "a network knows no approach condition"
        fix = 'give speed="12 kn" and rpm="106"'
        raise OptionError(Problem(f"where '{predictor.name}' begins is not known", lacking[0], why, fix))
    if not speed > 0.0:
        raise OptionError(
            Problem(f"the approach speed is {speed:g} m/s", "speed", "manoeuvres begin ahead", "give a speed above 0")
        )
    return Approach(speed, n)


def asked(predictor: Predictor, options: PredictOptions, approach: Approach) -> list[Asked]:
    """The manoeuvres of the options, the usual ones where there are none.  Raises OptionError for what makes no sense.

    A manoeuvre that is asked for twice is made once.
    """
    named = options if options.turn or options.zigzag or options.stop else USUAL
    found = [_turn(rudder_angle(text), approach) for text in named.turn]
    found += [_zigzag(*zigzag_angles(text), approach) for text in named.zigzag]
    if named.stop:
        found.append(_stop(predictor, options, approach))
    _possible(predictor, found)
    return list({one.id: one for one in found}.values())


def actuators_of(predictor: Predictor) -> list[Actuator | None]:
    """What moves each input of a predictor; None where orders act at once."""
    profile = profile_behind(predictor)
    return [profile.actuator(name) if profile else None for name in predictor.inputs]


def _turn(angle: float, approach: Approach) -> Asked:
    words = f"turn with {abs(angle) / DEG:.3g} deg of rudder to {'starboard' if angle > 0.0 else 'port'}"
    return Asked(turn_name(angle), "turning", words, angle, None, approach.n)


def _zigzag(rudder: float, heading: float, approach: Approach) -> Asked:
    words = f"zigzag {abs(rudder):g}/{heading:g} to {'starboard' if rudder > 0.0 else 'port'} first"
    return Asked(zigzag_name(rudder, heading), "zigzag", words, rudder * DEG, heading * DEG, approach.n)


def _stop(predictor: Predictor, options: PredictOptions, approach: Approach) -> Asked:
    n = astern_of(options, approach.n, predictor.L_pp, profile_behind(predictor))
    return Asked(STOP, "stopping", f"crash stop at {60.0 * n:.4g} rpm astern", 0.0, None, -n)


def _possible(predictor: Predictor, found: list[Asked]) -> None:
    """Raises OptionError for a rudder angle that the steering gear does not reach."""
    for name, gear in zip(predictor.inputs, actuators_of(predictor), strict=True):
        for one in found if INPUTS[name].role == "rudder" else ():
            require_reached(name, gear, np.array([one.rudder]), "zigzag" if one.manoeuvre == "zigzag" else "turn")


def require_reached(name: str, gear: Actuator | None, ordered: FloatArray, where: str) -> None:
    """Raises OptionError for the first of the orders (n,) to an input, in SI, that is beyond what moves it.

    where  they are given
    """
    if gear is None:
        return
    beyond = ordered[(ordered < gear.low - 1e-9) | (ordered > gear.high + 1e-9)]
    if len(beyond):
        word, factor = read_as(INPUTS[name].unit)
        what = f"{INPUTS[name].words} '{name}' is ordered to {factor * beyond[0]:.4g} {word}"
        why = f"it goes from {factor * gear.low:.4g} to {factor * gear.high:.4g} {word}"
        raise OptionError(Problem(what, where, why, "order less, or correct the limits of the profile"))
