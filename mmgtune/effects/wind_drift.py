"""The uppermost water goes with the wind, and the ship with the water."""

from typing import NamedTuple

from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State, Surroundings
from .effect import FlowEffect, Parameter


class WindDrift(NamedTuple):
    """See the parameters below."""

    along: Lanes
    across: Lanes


def wind_drift(state: State, around: Surroundings, e: WindDrift) -> tuple[Lanes, Lanes]:
    """Velocity of the water in the ship's axes: a share of the wind measured in the trial, turned to its right.

    Wind-driven surface currents are a few hundredths of the wind's speed; in a basin the water returns below.  Water
    does not follow gusts: it counts as steady from one moment to the next (assumption).
    """
    north = around.wind_known * (e.along * around.wind_north - e.across * around.wind_east)
    east = around.wind_known * (e.along * around.wind_east + e.across * around.wind_north)
    ahead, starboard = to_ship(state.psi, north, east)
    return ahead, starboard


def _share(direction: str) -> Parameter:
    return Parameter(
        f"velocity of the water over that of the measured wind, {direction}",
        bounds=lambda _: (-0.2, 0.2),
        typical=lambda _: 0.02,
        bounds_source="several times what wind drives on open water",
    )


EFFECT = FlowEffect(
    kind="effects.wind-drift",
    tag="wind-drift",
    title="water driven by the wind",
    told_by="the drift of the ship stopped in the water, before and after the runs",
    params=WindDrift,
    function=wind_drift,
    cites=("Wu 1983, Journal of Physical Oceanography 13, 1441-1451",),
    fields={"along": _share("along it"), "across": _share("to the right of it")},
    variants=(("along", "across"),),
    of_measured={"along": "wind", "across": "wind"},
    sentence=lambda v: (
        f"The water moved with {v['along']} of the measured wind along it and {v['across']} to the right of it"
    ),
)
