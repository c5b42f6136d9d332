"""The log holds the rudder ordered; the blade follows with a delay or at a limited rate."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.elementary import where
from ..physics.following import INSTANT, followed
from ..physics.quantities import Lanes
from .effect import ActuatorEffect, Parameter
from .signs import UNLIMITED, each

SLOW_GEAR = 60.0
"""Time [s/rad] of a rudder at less than half the rate of 65 deg in 28 s, which SOLAS II-1/29 asks of any gear: that of
a tug is no faster than a tanker's, for all that she sails her length in a few seconds."""


class SteeringLag(NamedTuple):
    """See the parameters below."""

    time_constant: Lanes
    rate_limit: Lanes
    to_starboard: Lanes
    to_port: Lanes


def steering_lag(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: SteeringLag) -> Lanes:
    """Blade angle after a step of h [s], for an order that changes linearly over the step.

    Exact for a first-order lag; the rate limit then cuts the change, and another one where the rudder turns slower to
    one side.
    """
    goal = followed(start, end, before, h, e.time_constant)
    change = goal - before
    to_its_side = where(change > 0.0, e.to_starboard, e.to_port)
    most = np.minimum(e.rate_limit, to_its_side) * np.maximum(h, INSTANT)
    limited = before + np.minimum(np.maximum(change, -most), most)
    return where(np.abs(change) > most, limited, goal)


_WORDS = {
    "time_constant": "with a time constant of {}",
    "rate_limit": "at {} at most",
    "to_starboard": "at {} at most to starboard",
    "to_port": "at {} at most to port",
}


_WHOLE = {"to_starboard": "at once to starboard", "to_port": "at once to port"}
"""What is said of a side without a limit."""


def _sentence(v: Mapping[str, str]) -> str:
    free = {name: _WHOLE[name] for name, size in v.items() if size == UNLIMITED and name in _WHOLE}
    return "The rudder followed the logged angle " + each(_WORDS | free, v)


def _rate(words: str) -> Parameter:
    return Parameter(
        f"largest rate of the rudder{words}",
        "rad/s",
        null=float("inf"),
        low=0.0,
        chart="reciprocal",
        bounds=lambda ship: (0.0, max(4.0 * ship.L / ship.U, SLOW_GEAR)),
        typical=lambda ship: 0.9 * ship.L / ship.U,
        bounds_source="a rudder that takes the time of a ship length for 15 deg, or moves at less than half the rate "
        "that rules ask of any gear (65 deg in 28 s)",
    )


EFFECT = ActuatorEffect(
    kind="effects.steering-lag",
    tag="steering-lag",
    title="rudder trailing its order",
    told_by="the time the rudder stock takes from hard over to hard over",
    of="rudder",
    params=SteeringLag,
    function=steering_lag,
    cites=(),
    fields={
        "time_constant": Parameter(
            "time constant of the steering gear behind the logged angle",
            "s",
            low=AT_LEAST_0,
            bounds=lambda ship: (0.0, 0.6 * ship.L / ship.U),
            typical=lambda ship: 0.075 * ship.L / ship.U,
            bounds_source="the time the ship takes for six tenths of her length",
        ),
        "rate_limit": _rate(""),
        "to_starboard": _rate(" towards starboard"),
        "to_port": _rate(" towards port"),
    },
    variants=(("time_constant",), ("rate_limit",), ("time_constant", "rate_limit"), ("to_starboard", "to_port")),
    besides=("to_starboard", "to_port"),
    sentence=_sentence,
)
