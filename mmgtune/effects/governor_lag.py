"""The log holds the revolutions ordered; the shaft follows."""

from collections.abc import Mapping
from typing import NamedTuple

from ..components import AT_LEAST_0
from ..physics.following import followed
from ..physics.quantities import Lanes
from .effect import ActuatorEffect, Parameter
from .visited import Visited

CHANGE = 0.02
"""Share by which revolutions must change to say how the shaft follows them."""


class GovernorLag(NamedTuple):
    """See the parameters below."""

    time_constant: Lanes


def governor_lag(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: GovernorLag) -> Lanes:
    """Revolutions after a step of h [s], for an order that changes linearly over the step.

    A lag of first order, settled at the first sample (assumptions: governor, engine and shaft are not modelled).
    """
    return followed(start, end, before, h, e.time_constant)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Revolutions that change, for what follows them."""
    if visited.varies(visited.shaft) > CHANGE:
        return ""
    return f"revolutions that change by {100.0 * CHANGE:.0f} %"


EFFECT = ActuatorEffect(
    kind="effects.governor-lag",
    tag="governor-lag",
    title="lag of the engine",
    told_by="the revolutions, counted at the shaft after a change of the telegraph",
    of="propeller",
    params=GovernorLag,
    function=governor_lag,
    cites=(),
    fields={
        "time_constant": Parameter(
            "time constant of the shaft behind the logged revolutions",
            "s",
            low=AT_LEAST_0,
            bounds=lambda ship: (0.0, 5.0 * ship.L / ship.U),
            typical=lambda ship: 1.0 * ship.L / ship.U,
            bounds_source="the time of five ship lengths",
        )
    },
    variants=(("time_constant",),),
    unvisited=unvisited,
    sentence=lambda v: f"The shaft followed the logged revolutions with a time constant of {v['time_constant']}",
)
