"""The engine gives way under load: the log holds the revolutions ordered, and the propeller turns slower in a turn."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.elementary import where
from ..physics.quantities import Force, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter, Scale
from .visited import Visited

AHEAD = 0.02
"""Way per turn over the length of a ship whose profile has no approach: a pitch of six tenths of the diameter."""


class EngineDroop(NamedTuple):
    """See the parameters below."""

    share: Lanes
    pivot: Lanes
    way: Lanes


def engine_droop(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: EngineDroop) -> Force:
    """Force by which propeller and rudder change where the propeller turns slower than the log says.

    n (1 - share (1 - (u/n) / (way pivot))), with the way u/n that a ship makes in a turn of the propeller: as that
    falls the advance ratio falls and the torque rises.  Linear in it, as torque curves nearly are, at once, and none
    where the engine is loaded less than at the pivot, goes astern, or no pivot is given (assumptions).
    """
    n = found.propeller.n
    way = n * e.pivot * e.way
    load = np.minimum(np.maximum(1.0 - found.flow.u / where(way > 0.0, way, 1.0), 0.0), 1.0)
    slower = n * (1.0 - e.share * where(way > 0.0, load, 0.0))
    propeller = components.propeller(found.flow, found.wake, slower, p.ship, p.propeller)
    rudder = components.rudder(found.flow, p.ship, found.wake, propeller, found.rudder.delta, p.rudder)
    before, behind = found.propeller.force, found.rudder.force
    return Force(
        X=propeller.force.X - before.X + rudder.force.X - behind.X,
        Y=propeller.force.Y - before.Y + rudder.force.Y - behind.Y,
        N=propeller.force.N - before.N + rudder.force.N - behind.N,
    )


def _pivot(ship: Scale) -> float:
    return ship.U / ship.n if ship.n > 0.0 else AHEAD * ship.L


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Speeds that vary, and the load with them."""
    return visited.lacking_speeds


EFFECT = ForceEffect(
    kind="effects.engine-droop",
    tag="engine-droop",
    title="engine under load",
    told_by="the revolutions, counted at the shaft under load",
    params=EngineDroop,
    function=engine_droop,
    cites=(),
    fields={
        "share": Parameter(
            "share of the logged revolutions lost where the ship makes no way",
            low=AT_LEAST_0,
            high=1.0,
            bounds=lambda _: (0.0, 0.7),
            typical=lambda _: 0.15,
            bounds_source="from none to what stalls an engine",
        ),
        "pivot": Parameter("way per turn of the propeller at which none is lost", "m", low=0.0),
        "way": Parameter(
            "factor on that way: an approach of the profile may be another than that of the trials",
            low=0.0,
            null=1.0,
            bounds=lambda _: (0.5, 1.5),
            typical=lambda _: 0.1,
            bounds_source="half of it either way",
        ),
    },
    form={"way": 0.15},
    pivots={"pivot": _pivot},
    akin=("rpm-scale",),
    variants=(("share",),),
    of_parts=("propeller", "rudder"),
    rough=True,
    unvisited=unvisited,
    sentence=lambda v: (
        "The engine gave way under load: with no way on the ship the propeller would turn slower than the log says by "
        f"{v['share']} of its revolutions"
    ),
)
