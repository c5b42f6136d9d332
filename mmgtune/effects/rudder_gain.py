"""The rudder moves more or less than its indicator says."""

from typing import NamedTuple

from ..physics.quantities import Control, Lanes
from .effect import Effect, Parameter


class RudderGain(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def rudder_gain(start, end, before, h, e):
    """Blade angle = factor [-] times logged."""
    return Control(n=end.n, delta=end.delta * e.factor)


EFFECT = Effect(
    kind="effects.rudder-gain",
    tag="rudder-gain",
    title="scale error of the rudder",
    place="actuator",
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
