"""Position and velocities are those of an antenna, not of midship."""

from typing import NamedTuple

from ..physics.elementary import cos, sin
from ..physics.quantities import Lanes, State
from .effect import Effect, Parameter


class Antenna(NamedTuple):
    """See the parameters below."""

    x: Lanes
    y: Lanes


def antenna(state, e):
    """What an antenna at (x, y) in the ship's axes sees of the motion of midship."""
    cos_psi = cos(state.psi)
    sin_psi = sin(state.psi)
    return State(
        x=state.x + cos_psi * e.x - sin_psi * e.y,
        y=state.y + sin_psi * e.x + cos_psi * e.y,
        psi=state.psi,
        u=state.u - state.r * e.y,
        v_m=state.v_m + state.r * e.x,
        r=state.r,
    )


def antenna_inverse(logged, e):
    """Motion of midship from that of the antenna."""
    cos_psi = cos(logged.psi)
    sin_psi = sin(logged.psi)
    return State(
        x=logged.x - (cos_psi * e.x - sin_psi * e.y),
        y=logged.y - (sin_psi * e.x + cos_psi * e.y),
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


EFFECT = Effect(
    kind="effects.antenna",
    tag="antenna",
    title="antenna away from midship",
    place="sensor",
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
