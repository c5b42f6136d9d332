"""The rudder stands off its indicator by a constant angle."""

from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import ActuatorEffect, angle_about_zero
from .signs import signed


class RudderOffset(NamedTuple):
    """See the parameters below."""

    angle: Lanes


def rudder_offset(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: RudderOffset) -> Lanes:
    """Blade angle = logged + angle [rad]."""
    return end + e.angle


EFFECT = ActuatorEffect(
    kind="effects.rudder-offset",
    tag="rudder-offset",
    title="zero error of the rudder",
    told_by="the angle of the rudder stock where the indicator shows zero",
    of="rudder",
    params=RudderOffset,
    function=rudder_offset,
    cites=(),
    fields={
        "angle": angle_about_zero("angle of the rudder when the indicator shows 0, to starboard", 1.0, 10.0),
    },
    variants=(("angle",),),
    varies=("angle",),
    subject="zero of the rudder",
    sentence=lambda v: f"The rudder stood {signed(v['angle'], 'to starboard', 'to port')} of its indicator",
)
