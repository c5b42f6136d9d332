"""The flow around the hull takes time to follow the motion."""

from typing import NamedTuple

import numpy as np

from ..physics.quantities import Force, Forces, Lanes
from .effect import LagEffect, Parameter

STIFF = 0.5
"""Time constants below this many steps of the integration fade in linearly, so that the lag stays stable."""


class Memory(NamedTuple):
    """See the parameters below."""

    time_constant: Lanes


def settled(found: Forces, e: Memory) -> tuple[Lanes, Lanes]:
    """Hull side force [N] and moment [N m] of a motion that has lasted."""
    return found.hull.Y, found.hull.N


def memory(found: Forces, behind: tuple[Lanes, Lanes], h: Lanes, e: Memory) -> tuple[Force, tuple[Lanes, Lanes]]:
    """Hull side force and moment as first-order lags of the model's: dY/dt = (Y_H - Y) / T.

    -> Force that is added to the model's; dY/dt [N/s], dN/dt [N m/s].
    """
    hull = found.hull
    Y, N = behind
    shortest = np.maximum(STIFF * h, 1e-9)
    T = np.maximum(e.time_constant, shortest)
    share = np.minimum(e.time_constant / shortest, 1.0)
    behind_Y = Y - hull.Y
    behind_N = N - hull.N
    return Force(X=0.0 * hull.X, Y=share * behind_Y, N=share * behind_N), (-behind_Y / T, -behind_N / T)


EFFECT = LagEffect(
    kind="effects.memory",
    tag="memory",
    title="memory of the flow around the hull",
    params=Memory,
    function=memory,
    start=settled,
    states=("Y", "N"),
    on_demand=True,
    cites=(),
    fields={
        "time_constant": Parameter(
            "time constant of the hull's side force and yaw moment",
            "s",
            low=-1e-12,
            bounds=lambda ship: (0.0, 1.5 * ship.L / ship.U),
            typical=lambda ship: 0.2 * ship.L / ship.U,
            bounds_source="the time of one and a half ship lengths",
        )
    },
    variants=(("time_constant",),),
    sentence=lambda v: f"The hull's forces followed the motion with a time constant of {v['time_constant']}",
)
