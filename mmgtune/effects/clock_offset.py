"""Two loggers with different clocks: controls and motion are not of the same instant."""

from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import ClockEffect, Parameter
from .signs import signed


class ClockOffset(NamedTuple):
    """See the parameters below."""

    seconds: Lanes


EFFECT = ClockEffect(
    kind="effects.clock-offset",
    tag="clock-offset",
    title="clocks of control log and motion log apart",
    told_by="the clocks of both logs, compared",
    params=ClockOffset,
    cites=(),
    fields={
        "seconds": Parameter(
            "how late the control log is: what acted at t is logged at t + seconds",
            "s",
            bounds=lambda ship: (-2.0 * ship.L / ship.U, 2.0 * ship.L / ship.U),
            typical=lambda ship: 0.05 * ship.L / ship.U,
            far=lambda ship: tuple(by * ship.L / ship.U for by in (-1.6, -0.8, -0.4, 0.4, 0.8, 1.6)),
            bounds_source="the time of two ship lengths",
        )
    },
    variants=(("seconds",),),
    varies=("seconds",),
    subject="clock of the control log against that of the motion log",
    sentence=lambda v: f"The control log ran {signed(v['seconds'], 'behind', 'ahead of')} the motion log",
)
