"""Water that moves over ground, uniform and steady."""

from typing import NamedTuple

from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State, Surroundings
from .effect import FlowEffect, Parameter


class Current(NamedTuple):
    """See the parameters below."""

    north: Lanes
    east: Lanes


def current(state: State, around: Surroundings, e: Current) -> tuple[Lanes, Lanes]:
    """Velocity of the water in the ship's axes: surge and sway [m/s].

    With velocities through water, and for a current that is constant in the earth frame, the equations of motion hold
    unchanged (Mathioudakis et al., eq. 9).
    """
    ahead, starboard = to_ship(state.psi, e.north, e.east)
    return ahead, starboard


def _component(direction: str) -> Parameter:
    return Parameter(
        f"velocity of the water, {direction}",
        "m/s",
        bounds=lambda ship: (-0.6 * ship.U, 0.6 * ship.U),
        typical=lambda ship: 0.05 * ship.U,
        bounds_source="six tenths of the approach speed",
    )


EFFECT = FlowEffect(
    kind="effects.current",
    tag="current",
    title="current",
    params=Current,
    function=current,
    cites=("Mathioudakis et al., FAM, eq. 9",),
    fields={"north": _component("north"), "east": _component("east")},
    variants=(("north", "east"),),
    told_as={("north", "east"): ("speed", "towards")},
    sentence=lambda v: f"The trials were run in a current of {v['speed']} setting towards {v['towards']}",
)
