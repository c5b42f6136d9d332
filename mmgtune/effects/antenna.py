"""Position and velocities are those of an antenna, not of midship."""

from typing import NamedTuple

from ..physics.frame import to_earth
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect


class Antenna(NamedTuple):
    """See the parameters below."""

    x: Lanes
    y: Lanes


def antenna(state: State, e: Antenna) -> State:
    """What an antenna at (x, y) in the ship's axes sees of the motion of midship."""
    north, east = to_earth(state.psi, e.x, e.y)
    return State(
        x=state.x + north,
        y=state.y + east,
        psi=state.psi,
        u=state.u - state.r * e.y,
        v_m=state.v_m + state.r * e.x,
        r=state.r,
    )


def antenna_inverse(logged: State, e: Antenna) -> State:
    """Motion of midship from that of the antenna."""
    north, east = to_earth(logged.psi, e.x, e.y)
    return State(
        x=logged.x - north,
        y=logged.y - east,
        psi=logged.psi,
        u=logged.u + logged.r * e.y,
        v_m=logged.v_m - logged.r * e.x,
        r=logged.r,
    )


def _arm(direction: str, share: float) -> Parameter:
    return Parameter(
        f"antenna {direction} of midship",
        "m",
        bounds=lambda ship: (-share * ship.L, share * ship.L),
        typical=lambda ship: 0.2 * share * ship.L,
        bounds_source="a little beyond the ends of the ship",
    )


EFFECT = SensorEffect(
    kind="effects.antenna",
    tag="antenna",
    title="antenna away from midship",
    params=Antenna,
    function=antenna,
    inverse=antenna_inverse,
    cites=(),
    fields={"x": _arm("forward", 0.6), "y": _arm("to starboard", 0.3)},
    variants=(("x", "y"),),
    sentence=lambda v: (
        f"Position and velocities are those of an antenna {v['x']} forward and {v['y']} to starboard of midship"
    ),
)
