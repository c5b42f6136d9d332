"""The rudder goes no further than some angle, whatever its log shows."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..physics.quantities import Lanes
from ..units import DEG
from .effect import ActuatorEffect, Parameter
from .visited import Visited


class RudderLimit(NamedTuple):
    """See the parameters below."""

    angle: Lanes


def rudder_limit(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: RudderLimit) -> Lanes:
    """Blade angle = logged, but no more than the angle [rad] to either side."""
    return np.minimum(np.maximum(end, -e.angle), e.angle)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Rudder angles beyond that limit."""
    if visited.largest_rudder > found["angle"]:
        return ""
    return f"rudder angles beyond {found['angle'] / DEG:.0f} deg (these go to {visited.largest_rudder / DEG:.0f} deg)"


EFFECT = ActuatorEffect(
    kind="effects.rudder-limit",
    tag="rudder-limit",
    title="stop of the rudder",
    of="rudder",
    params=RudderLimit,
    function=rudder_limit,
    cites=(),
    fields={
        "angle": Parameter(
            "angle beyond which the rudder does not go, to either side",
            "rad",
            null=float("inf"),
            low=0.0,
            chart="reciprocal",
            bounds=lambda _: (1.0 / (60.0 * DEG), 1.0 / (8.0 * DEG)),
            typical=lambda _: 1.0 / (28.0 * DEG) - 1.0 / (60.0 * DEG),
            bounds_source="from 8 deg to an angle no rudder reaches",
        ),
    },
    akin=("rudder-stall", "rudder-gain"),
    variants=(("angle",),),
    unvisited=unvisited,
    sentence=lambda v: f"The rudder went no further than {v['angle']}, whatever its log shows",
)
