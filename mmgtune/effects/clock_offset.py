"""Two loggers with different clocks: controls and motion are not of the same instant."""

from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import ClockEffect, Parameter, Scale
from .signs import signed

A_CLOCK = 90.0
"""Time [s] by which nobody's watch is off."""


def _most(ship: Scale) -> float:
    """The largest offset [s] that is looked for: ships turn and turn back within minutes, models within seconds."""
    length = ship.L / ship.U
    return min(max(2.0 * length, A_CLOCK), 6.0 * length)


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
            bounds=lambda ship: (-_most(ship), _most(ship)),
            typical=lambda ship: 0.05 * ship.L / ship.U,
            far=lambda ship: tuple(by * _most(ship) for by in (-0.8, -0.45, -0.2, 0.2, 0.45, 0.8)),
            of_run=lambda ship: (-0.5 * ship.L / ship.U, 0.5 * ship.L / ship.U),
            bounds_source="a minute and a half, no more than the time of six ship lengths, or that of two",
        )
    },
    variants=(("seconds",),),
    varies=("seconds",),
    subject="clock of the control log against that of the motion log",
    sentence=lambda v: f"The control log ran {signed(v['seconds'], 'behind', 'ahead of')} the motion log",
)
