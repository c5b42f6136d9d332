"""The steering gear does nothing for a while after each order, then does what it was told.

The time is the same for every order (assumption): that of relays and pumps, beside a lag and a limited rate.
"""

from typing import NamedTuple

from ..components import AT_LEAST_0
from ..physics.quantities import Lanes
from .effect import ClockEffect, Parameter


class DeadTime(NamedTuple):
    """See the parameters below."""

    seconds: Lanes


EFFECT = ClockEffect(
    kind="effects.dead-time",
    tag="dead-time",
    title="dead time of the steering",
    told_by="the time from an order to the first movement of the rudder stock, taken on board",
    of="rudder",
    late="ship",
    params=DeadTime,
    cites=(),
    fields={
        "seconds": Parameter(
            "time from the logged rudder angle to that of the blade",
            "s",
            low=AT_LEAST_0,
            bounds=lambda ship: (0.0, 0.5 * ship.L / ship.U),
            typical=lambda ship: 0.05 * ship.L / ship.U,
            bounds_source="half the time of a ship length",
        )
    },
    variants=(("seconds",),),
    sentence=lambda v: f"The blade did what the log says {v['seconds']} later",
)
