"""The propeller turns faster or slower than its indicator says."""

from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import ActuatorEffect, factor_about_one


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
    fields={"factor": factor_about_one("revolutions over indicated revolutions", 0.3, 0.02, "thrust changes by half")},
    akin=("engine-droop", "thrust"),
    variants=(("factor",),),
    varies=("factor",),
    subject="scale of the revolutions",
    sentence=lambda v: f"The propeller turned at {v['factor']} times the revolutions logged",
)
