"""The flap turns more or less than its linkage is believed to."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import CoefficientsEffect, Parameter


class Flap(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def flap(values: Mapping[str, Lanes], e: Flap) -> dict[str, Lanes]:
    """Flap angles of the profile's table, times factor [-]."""
    return {name: value * e.factor for name, value in values.items() if name.startswith("rudder.flap[")}


EFFECT = CoefficientsEffect(
    kind="effects.flap",
    tag="flap",
    title="flap linkage",
    params=Flap,
    function=flap,
    cites=(),
    fields={
        "factor": Parameter(
            "flap angle over the profile's",
            low=-1e-12,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.0, 2.0),
            typical=lambda _: 0.1,
            bounds_source="from a locked flap to twice the angle",
        )
    },
    variants=(("factor",),),
    sentence=lambda v: f"The flap turned by {v['factor']} times the angle the profile gives it",
    needs=("rudder.flap[0]",),
)
