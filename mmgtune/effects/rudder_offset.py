"""The rudder stands off its indicator by a constant angle."""

from typing import NamedTuple

from ..physics.quantities import Control, Lanes
from ..units import DEG
from .effect import Effect, Parameter


class RudderOffset(NamedTuple):
    """See the parameters below."""

    angle: Lanes


def rudder_offset(start, end, before, h, e):
    """Blade angle = logged + angle [rad]."""
    return Control(n=end.n, delta=end.delta + e.angle)


EFFECT = Effect(
    kind="effects.rudder-offset",
    tag="rudder-offset",
    title="zero error of the rudder",
    place="actuator",
    params=RudderOffset,
    function=rudder_offset,
    cites=(),
    fields={
        "angle": Parameter(
            "angle of the rudder when the indicator shows 0, to starboard",
            "rad",
            low=-1.0,
            high=1.0,
            bounds=lambda _: (-10.0 * DEG, 10.0 * DEG),
            typical=lambda _: 1.0 * DEG,
            bounds_source="beyond 10 deg anyone would see it",
        )
    },
    variants=(("angle",),),
    sentence=lambda v: f"The rudder stood {v['angle']} off its indicator (positive to starboard)",
)
