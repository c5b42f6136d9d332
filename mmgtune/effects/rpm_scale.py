"""The propeller turns faster or slower than its indicator says."""

from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import ActuatorEffect, Parameter


class RpmScale(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def rpm_scale(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: RpmScale) -> Lanes:
    """Revolutions = factor [-] times logged."""
    return end * e.factor


EFFECT = ActuatorEffect(
    kind="effects.rpm-scale",
    tag="rpm-scale",
    title="scale error of the revolutions",
    told_by="the revolutions, counted at the shaft",
    of="propeller",
    params=RpmScale,
    function=rpm_scale,
    cites=(),
    fields={
        "factor": Parameter(
            "revolutions over indicated revolutions",
            low=0.0,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.2, 3.0),
            typical=lambda _: 0.02,
            far=lambda _: (0.3, 0.5, 1.5, 2.0, 2.5),
            of_run=lambda _: (0.7, 1.3),
            bounds_source="the ratio of a gear between the shaft and what is counted",
        )
    },
    akin=("engine-droop", "thrust"),
    variants=(("factor",),),
    varies=("factor",),
    subject="scale of the revolutions",
    sentence=lambda v: f"The propeller turned at {v['factor']} times the revolutions logged",
)
