"""The rudder stalls: beyond an inflow angle its force grows less, no more, or falls."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.elementary import sin, where
from ..physics.quantities import Force, Lanes, State, Surroundings
from ..units import DEG
from .effect import ForceEffect, Parameter, rudder_angle_from
from .visited import Visited

LEAST = 15.0 * DEG
"""Least inflow angle [rad] at which a ship's rudder is taken to stall (assumption): of aspect ratios of 1 to 2 they
hold on to about 20 deg in free flow, and longer behind a propeller."""


SHARP = 1e-9
"""Width [rad] that is none."""


class RudderStall(NamedTuple):
    """See the parameters below."""

    angle: Lanes
    slope: Lanes
    width: Lanes


def rudder_stall(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: RudderStall) -> Force:
    """Force that makes the rudder's that of an inflow angle alpha' where |alpha_R| is larger than the angle.

    alpha' = angle + slope (|alpha_R| - angle): with no slope the force grows no more, and stalls differ in what they
    leave of it (assumption).  Within the width about the angle a parabola joins the two, as a rudder stalls from its
    ends inwards.
    """
    limit = np.minimum(e.angle, np.pi)
    alpha = np.abs(found.rudder.alpha_R)
    over = alpha - limit
    stalled = where(over < e.width, np.maximum(over + e.width, 0.0) ** 2 / np.maximum(4.0 * e.width, SHARP), over)
    felt = alpha - (1.0 - e.slope) * stalled
    lost = where(stalled > 0.0, sin(felt) / np.maximum(np.abs(sin(alpha)), 1e-12) - 1.0, 0.0)
    lost = np.minimum(lost, 0.0)
    force = found.rudder.force
    return Force(X=lost * force.X, Y=lost * force.Y, N=lost * force.N)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Rudder angles beyond that of the stall."""
    return visited.lacking_rudder(max(found["angle"], LEAST))


EFFECT = ForceEffect(
    kind="effects.rudder-stall",
    tag="rudder-stall",
    title="stall of the rudder",
    params=RudderStall,
    function=rudder_stall,
    cites=(),
    fields={
        "angle": rudder_angle_from("effective inflow angle at which the rudder stalls", 25.0),
        "slope": Parameter(
            "share of its slope that the force keeps beyond that angle; negative where it falls",
            low=-3.0,
            high=1.0,
            bounds=lambda _: (-2.0, 0.9),
            bounds_source="from a force that falls twice as fast as it rose to one that hardly stalls",
        ),
        "width": Parameter(
            "inflow angles to either side of that angle over which the force gives way",
            "rad",
            default=0.0,
            low=AT_LEAST_0,
            high=0.5 * np.pi,
            null=4.0 * DEG,
            bounds=lambda _: (0.0, 16.0 * DEG),
            bounds_source="from a sharp stall to one that begins with the first force",
        ),
    },
    rough=True,
    form={"slope": 0.5, "width": 4.0 * DEG},
    of_parts=("rudder",),
    variants=(("angle",),),
    unvisited=unvisited,
    sentence=lambda v: f"The rudder stalled at an inflow angle of {v['angle']}",
)
