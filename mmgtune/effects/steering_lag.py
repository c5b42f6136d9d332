"""The log holds the rudder ordered; the blade follows with a delay or at a limited rate."""

from typing import NamedTuple

import numpy as np

from ..physics.elementary import where
from ..physics.following import INSTANT, followed
from ..physics.quantities import Lanes
from .effect import ActuatorEffect, Parameter


class SteeringLag(NamedTuple):
    """See the parameters below."""

    time_constant: Lanes
    rate_limit: Lanes


def steering_lag(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: SteeringLag) -> Lanes:
    """Blade angle after a step of h [s], for an order that changes linearly over the step.

    Exact for a first-order lag; the rate limit then cuts the change.
    """
    goal = followed(start, end, before, h, e.time_constant)
    most = e.rate_limit * np.maximum(h, INSTANT)
    change = goal - before
    limited = before + np.minimum(np.maximum(change, -most), most)
    return where(np.abs(change) > most, limited, goal)


_WORDS = {"time_constant": "with a time constant of {}", "rate_limit": "at {} at most"}

EFFECT = ActuatorEffect(
    kind="effects.steering-lag",
    tag="steering-lag",
    title="rudder trailing its order",
    of="rudder",
    params=SteeringLag,
    function=steering_lag,
    cites=(),
    fields={
        "time_constant": Parameter(
            "time constant of the steering gear behind the logged angle",
            "s",
            low=-1e-12,
            bounds=lambda ship: (0.0, 0.6 * ship.L / ship.U),
            typical=lambda ship: 0.075 * ship.L / ship.U,
            bounds_source="the time the ship takes for six tenths of her length",
        ),
        "rate_limit": Parameter(
            "largest rate of the rudder",
            "rad/s",
            null=float("inf"),
            low=0.0,
            chart="reciprocal",
            bounds=lambda ship: (0.0, 2.0 * ship.L / ship.U),
            typical=lambda ship: 0.9 * ship.L / ship.U,
            bounds_source="a rudder that takes half the time of a ship length for 15 deg",
        ),
    },
    variants=(("time_constant",), ("rate_limit",)),
    sentence=lambda v: (
        "The rudder followed the logged angle "
        + " and ".join(_WORDS[name].format(v[name]) for name in _WORDS if name in v)
    ),
)
