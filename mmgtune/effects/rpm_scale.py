"""The propeller turns faster or slower than its indicator says."""

from typing import NamedTuple

from ..physics.quantities import Control, Lanes
from .effect import Effect, Parameter


class RpmScale(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def rpm_scale(start, end, before, h, e):
    """Revolutions = factor [-] times logged."""
    return Control(n=end.n * e.factor, delta=end.delta)


EFFECT = Effect(
    kind="effects.rpm-scale",
    tag="rpm-scale",
    title="scale error of the revolutions",
    place="actuator",
    params=RpmScale,
    function=rpm_scale,
    cites=(),
    fields={
        "factor": Parameter(
            "revolutions over indicated revolutions",
            low=0.0,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.7, 1.3),
            typical=lambda _: 0.02,
            bounds_source="thrust changes by half",
        )
    },
    variants=(("factor",),),
    sentence=lambda v: f"The propeller turned at {v['factor']} times the revolutions logged",
)
