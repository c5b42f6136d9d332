"""The rudder goes no further than some angle, whatever its log shows."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..physics.quantities import Lanes
from .effect import ActuatorEffect, rudder_angle_from
from .visited import Visited


class RudderLimit(NamedTuple):
    """See the parameters below."""

    angle: Lanes


def rudder_limit(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: RudderLimit) -> Lanes:
    """Blade angle = logged, but no more than the angle [rad] to either side."""
    return np.minimum(np.maximum(end, -e.angle), e.angle)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Rudder angles beyond that limit."""
    return visited.lacking_rudder(found["angle"])


EFFECT = ActuatorEffect(
    kind="effects.rudder-limit",
    tag="rudder-limit",
    title="stop of the rudder",
    told_by="the angle of the rudder stock at hard over",
    of="rudder",
    params=RudderLimit,
    function=rudder_limit,
    cites=(),
    fields={
        "angle": rudder_angle_from("angle beyond which the rudder does not go, to either side", 28.0),
    },
    akin=("rudder-stall", "rudder-gain"),
    variants=(("angle",),),
    unvisited=unvisited,
    sentence=lambda v: f"The rudder went no further than {v['angle']}, whatever its log shows",
)
