"""The flap turns more or less than its linkage is believed to."""

from collections.abc import Mapping
from typing import NamedTuple

from ..components import AT_LEAST_0
from ..physics.quantities import Lanes
from ..units import DEG
from .effect import CoefficientsEffect, Parameter
from .visited import Visited

LARGE = 15.0 * DEG
"""Rudder angle [rad] from which a flap that turns in another way is more than another gain of the rudder."""


class Flap(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def flap(values: Mapping[str, Lanes], e: Flap) -> dict[str, Lanes]:
    """Flap angles of the profile's table, times factor [-]."""
    return {name: value * e.factor for name, value in values.items() if name.startswith("rudder.flap[")}


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Large rudder angles: at small ones lift is linear in both angles."""
    if visited.largest_rudder > LARGE:
        return ""
    most = visited.largest_rudder / DEG
    return f"rudder angles beyond {LARGE / DEG:.0f} deg (these go to {most:.0f} deg)"


EFFECT = CoefficientsEffect(
    kind="effects.flap",
    tag="flap",
    title="flap linkage",
    told_by="the angle of the flap, read at several angles of the rudder",
    params=Flap,
    function=flap,
    cites=(),
    fields={
        "factor": Parameter(
            "flap angle over the profile's",
            low=AT_LEAST_0,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.0, 2.0),
            typical=lambda _: 0.1,
            bounds_source="from a locked flap to twice the angle",
        )
    },
    variants=(("factor",),),
    unvisited=unvisited,
    sentence=lambda v: f"The flap turned by {v['factor']} times the angle the profile gives it",
    needs=("rudder.flap[0]",),
)
