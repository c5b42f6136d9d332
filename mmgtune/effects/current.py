"""Water that moves over ground, uniform: steady, changing steadily as a tide does, or as it was measured in time."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..phrases import capital
from ..physics.elementary import where
from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State, Surroundings
from .effect import FlowEffect, Parameter, factor_on_flow_measured, turned_on_measured, velocity_of_water
from .signs import as_logged


class Current(NamedTuple):
    """See the parameters below."""

    north: Lanes
    east: Lanes
    north_rate: Lanes
    east_rate: Lanes
    measured: Lanes
    turned: Lanes
    carried: Lanes


def current(state: State, around: Surroundings, e: Current) -> tuple[Lanes, Lanes]:
    """Velocity of the water in the ship's axes: surge and sway [m/s].

    Where the trial has measured current it counts, times ``measured`` and turned back by ``turned``; else one that is
    linear in time.  With velocities through water the equations of motion hold unchanged (Mathioudakis et al., eq. 9).
    """
    north, east = e.north + e.north_rate * around.elapsed, e.east + e.east_rate * around.elapsed
    return _in_the_ship(state, around, e, around.current_north, around.current_east, north, east)


def rate_of_current(state: State, around: Surroundings, e: Current) -> tuple[Lanes, Lanes]:
    """How fast the current changes over ground and takes the ship along, in her axes [m/s^2]: constant between two
    samples.

    Water that gains speed has a pressure gradient, by which a ship gains as much; ``carried`` is the share of that, 0
    for one that only the forces of the flow take along.
    """
    logged_north, logged_east = around.current_north_rate, around.current_east_rate
    ahead, starboard = _in_the_ship(state, around, e, logged_north, logged_east, e.north_rate, e.east_rate)
    return e.carried * ahead, e.carried * starboard


def _in_the_ship(
    state: State,
    around: Surroundings,
    e: Current,
    logged_north: Lanes,
    logged_east: Lanes,
    north: Lanes,
    east: Lanes,
) -> tuple[Lanes, Lanes]:
    """What was logged, or where nothing was what is given beside it, along the ship's axes."""
    by_log = around.current_known * np.abs(e.measured) > 0.0
    shown_north, shown_east = to_ship(e.turned, logged_north, logged_east)
    north = where(by_log, shown_north * e.measured, north)
    east = where(by_log, shown_east * e.measured, east)
    ahead, starboard = to_ship(state.psi, north, east)
    return ahead, starboard


def _component(direction: str) -> Parameter:
    return velocity_of_water(f"velocity of the water, {direction}, where the trial has no measured current")


def _rate(direction: str) -> Parameter:
    return Parameter(
        f"what that velocity gains in a second from the beginning of a run on, {direction}",
        "m/s^2",
        bounds=lambda ship: (-0.6 * ship.U**2 / (20.0 * ship.L), 0.6 * ship.U**2 / (20.0 * ship.L)),
        typical=lambda ship: 0.05 * ship.U**2 / (20.0 * ship.L),
        bounds_source="six tenths of the approach speed in the time of twenty ship lengths",
    )


def _sentence(v: Mapping[str, str]) -> str:
    if told := as_logged("current", "sets to", v):
        return capital("; ".join(told))
    steady = f"The trials were run in a current of {v['speed']}"
    if "towards" in v:
        steady += f" setting towards {v['towards']}"
    if "gain" not in v:
        return steady
    if "gaining" not in v:
        return f"{steady}, which hardly changed during a run: by {v['gain']}"
    grew = f"{steady} at the beginning of a run, which gained {v['gain']} towards {v['gaining']}"
    if "carried" not in v:
        return grew
    return f"{grew} and carried the ship along by {v['carried']} of that, her drag alone by the rest"


EFFECT = FlowEffect(
    kind="effects.current",
    tag="current",
    title="current",
    told_by="the drift of the ship stopped in the water, before and after the runs",
    params=Current,
    function=current,
    rate=rate_of_current,
    cites=(
        "Mathioudakis et al., Towards real-world validation of a physics-based ship motion prediction model, eq. 9",
    ),
    fields={
        "north": _component("north"),
        "east": _component("east"),
        "north_rate": _rate("north"),
        "east_rate": _rate("east"),
        "measured": factor_on_flow_measured("the current", 0.2),
        "turned": turned_on_measured("the current", "sets to"),
        "carried": Parameter(
            "share of what the water gains that a ship gains with it, her drag apart",
            null=1.0,
            low=AT_LEAST_0,
            high=2.0,
            bounds=lambda _: (0.0, 1.0),
            typical=lambda _: 0.3,
            bounds_source="from a ship that only drag takes along to one that goes with the water, as theory has it",
        ),
    },
    variants=(
        ("north", "east"),
        ("north", "east", "north_rate", "east_rate"),
        ("north", "east", "north_rate", "east_rate", "carried"),
        ("measured",),
        ("turned",),
        ("measured", "turned"),
    ),
    told_as={("north", "east"): ("speed", "towards"), ("north_rate", "east_rate"): ("gain", "gaining")},
    sentence=_sentence,
    of_measured={"measured": "current", "turned": "current"},
    refines=("carried",),
    besides=("north_rate", "east_rate", "carried"),
    rough_with=("north_rate", "east_rate"),
    stand_in=("north", "east", "north_rate", "east_rate"),
    varies=("north", "east", "north_rate", "east_rate"),
)
