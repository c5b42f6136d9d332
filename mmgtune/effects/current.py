"""Water that moves over ground, uniform: steady, or as it was measured in time."""

from typing import NamedTuple

from ..physics.elementary import where
from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State, Surroundings
from .effect import FlowEffect, Parameter, factor_on_measured


class Current(NamedTuple):
    """See the parameters below."""

    north: Lanes
    east: Lanes
    measured: Lanes


def current(state: State, around: Surroundings, e: Current) -> tuple[Lanes, Lanes]:
    """Velocity of the water in the ship's axes: surge and sway [m/s].

    Where the trial has measured current it counts, times ``measured``; else the steady one.  With velocities through
    water the equations of motion hold unchanged (Mathioudakis et al., eq. 9).
    """
    by_log = around.current_known * e.measured > 0.0
    north = where(by_log, around.current_north * e.measured, e.north)
    east = where(by_log, around.current_east * e.measured, e.east)
    ahead, starboard = to_ship(state.psi, north, east)
    return ahead, starboard


def rate_of_current(state: State, around: Surroundings, e: Current) -> tuple[Lanes, Lanes]:
    """How fast the measured current changes over ground, in the ship's axes [m/s^2]: constant between two samples."""
    share = around.current_known * e.measured
    ahead, starboard = to_ship(state.psi, around.current_north_rate * share, around.current_east_rate * share)
    return ahead, starboard


def _component(direction: str) -> Parameter:
    return Parameter(
        f"velocity of the water, {direction}, where the trial has no measured current",
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
    rate=rate_of_current,
    cites=(
        "Mathioudakis et al., Towards real-world validation of a physics-based ship motion prediction model, eq. 9",
    ),
    fields={
        "north": _component("north"),
        "east": _component("east"),
        "measured": factor_on_measured("the current", 2.0, 0.2, "from no current to twice the measured"),
    },
    variants=(("north", "east"), ("measured",)),
    told_as={("north", "east"): ("speed", "towards")},
    sentence=lambda v: (
        f"The current measured in the trials acts on the ship, with {v['measured']} times its measured speed"
        if "measured" in v
        else f"The trials were run in a current of {v['speed']} setting towards {v['towards']}"
    ),
    of_measured={"measured": "current"},
    stand_in=("north", "east"),
)
