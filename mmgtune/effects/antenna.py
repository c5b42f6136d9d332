"""Positions, and perhaps velocities, are those of an antenna, not of midship."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.frame import to_earth
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect
from .signs import signed


class Antenna(NamedTuple):
    """See the parameters below."""

    x: Lanes
    y: Lanes
    x_alone: Lanes
    y_alone: Lanes


def _seen_from(state: State, x: Lanes, y: Lanes, x_alone: Lanes, y_alone: Lanes) -> State:
    """Motion of a point at (x, y) in the ship's axes, its position (x_alone, y_alone) further on."""
    north, east = to_earth(state.psi, x + x_alone, y + y_alone)
    return State(
        x=state.x + north,
        y=state.y + east,
        psi=state.psi,
        u=state.u - state.r * y,
        v_m=state.v_m + state.r * x,
        r=state.r,
    )


def antenna(state: State, e: Antenna) -> State:
    """What is logged of the motion of midship: position and velocities of a point at (x, y) in the ship's axes, or,
    where velocities have another source, the position alone."""
    return _seen_from(state, e.x, e.y, e.x_alone, e.y_alone)


def antenna_inverse(logged: State, e: Antenna) -> State:
    """Motion of midship from what was logged."""
    return _seen_from(logged, -e.x, -e.y, -e.x_alone, -e.y_alone)


def _arm(direction: str, of: str, share: float) -> Parameter:
    return Parameter(
        f"antenna {direction} of midship, {of}",
        "m",
        bounds=lambda ship: (-share * ship.L, share * ship.L),
        typical=lambda ship: 0.2 * share * ship.L,
        bounds_source="a little beyond the ends of the ship",
    )


BOTH, ALONE = "positions and velocities being its own", "velocities being those of midship"


def _place(v: Mapping[str, str], x: str, y: str, of: str = "midship") -> str:
    return f"{signed(v[x], 'forward', 'aft')} of {of} and {signed(v[y], 'to starboard', 'to port')}"


def _sentence(v: Mapping[str, str]) -> str:
    if "x" not in v:
        return f"The position, not the velocities, is that of an antenna {_place(v, 'x_alone', 'y_alone')}"
    if "x_alone" not in v:
        return f"Position and velocities are those of an antenna {_place(v, 'x', 'y')}"
    further = _place(v, "x_alone", "y_alone", "that")
    return f"Velocities are those of a point {_place(v, 'x', 'y')}, and positions those of one {further}"


EFFECT = SensorEffect(
    kind="effects.antenna",
    tag="antenna",
    title="antenna away from midship",
    told_by="the place of the antenna, measured on board",
    params=Antenna,
    function=antenna,
    inverse=antenna_inverse,
    cites=(),
    fields={
        "x": _arm("forward", BOTH, 0.6),
        "y": _arm("to starboard", BOTH, 0.3),
        "x_alone": _arm("forward", ALONE, 0.6),
        "y_alone": _arm("to starboard", ALONE, 0.3),
    },
    variants=(("x", "y"), ("x_alone", "y_alone")),
    besides=("x_alone", "y_alone"),
    sentence=_sentence,
)
