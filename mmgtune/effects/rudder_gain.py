"""The rudder moves more or less than its indicator says."""

from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import ActuatorEffect, Parameter


class RudderGain(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def rudder_gain(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: RudderGain) -> Lanes:
    """Blade angle = factor [-] times logged."""
    return end * e.factor


EFFECT = ActuatorEffect(
    kind="effects.rudder-gain",
    tag="rudder-gain",
    title="scale error of the rudder",
    of="rudder",
    params=RudderGain,
    function=rudder_gain,
    cites=(),
    fields={
        "factor": Parameter(
            "rudder angle over indicated angle",
            low=0.0,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.5, 1.5),
            typical=lambda _: 0.05,
            bounds_source="half as much again either way",
        )
    },
    variants=(("factor",),),
    sentence=lambda v: f"The rudder moved by {v['factor']} times the angle its indicator showed",
)
