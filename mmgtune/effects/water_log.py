"""The speed log shows velocities through the water, not over ground; positions are over ground."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, velocity_of_water


class WaterLog(NamedTuple):
    """See the parameters below."""

    north: Lanes
    east: Lanes


def water_log(state: State, e: WaterLog) -> State:
    """Velocities shown are those less the velocity of the water [m/s] that the log measures against."""
    ahead, starboard = to_ship(state.psi, e.north, e.east)
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u - ahead, v_m=state.v_m - starboard, r=state.r)


def water_log_inverse(logged: State, e: WaterLog) -> State:
    """Velocities over ground from those shown."""
    ahead, starboard = to_ship(logged.psi, e.north, e.east)
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=logged.u + ahead, v_m=logged.v_m + starboard, r=logged.r)


def _component(direction: str) -> Parameter:
    return velocity_of_water(f"velocity over ground of the water that the log measures against, {direction}")


def _sentence(v: Mapping[str, str]) -> str:
    water = f"The speed log showed velocities through the water, which moved at {v['speed']}"
    return f"{water} towards {v['towards']}" if "towards" in v else water


EFFECT = SensorEffect(
    kind="effects.water-log",
    tag="water-log",
    title="speed log through the water",
    told_by="whether the log is set to speed through the water or over the ground",
    params=WaterLog,
    function=water_log,
    inverse=water_log_inverse,
    cites=(),
    fields={"north": _component("north"), "east": _component("east")},
    variants=(("north", "east"),),
    told_as={("north", "east"): ("speed", "towards")},
    varies=("north", "east"),
    subject="water that the speed log measured against",
    sentence=_sentence,
)
