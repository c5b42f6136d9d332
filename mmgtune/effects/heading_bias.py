"""The compass shows a heading that is off by a constant angle."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from ..physics.frame import to_earth, to_ship
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, angle_about_zero
from .signs import each
from .visited import Visited


class HeadingBias(NamedTuple):
    """See the parameters below."""

    angle: Lanes
    alone: Lanes
    antenna_ahead: Lanes
    antenna_abeam: Lanes


def heading_shown(state: State, turned: Lanes, alone: Lanes, e: Any) -> State:
    """The heading off by two angles [rad]; the velocity over ground is logged in axes turned by the first of them.

    Positions that were moved to midship from an antenna, ``e.antenna_ahead`` and ``e.antenna_abeam`` of it [m], were
    moved along the heading shown.
    """
    u, v_m = to_ship(turned, state.u, state.v_m)
    psi = state.psi + turned + alone
    north, east = to_earth(state.psi, e.antenna_ahead, e.antenna_abeam)
    north_shown, east_shown = to_earth(psi, e.antenna_ahead, e.antenna_abeam)
    return State(x=state.x + (north - north_shown), y=state.y + (east - east_shown), psi=psi, u=u, v_m=v_m, r=state.r)


def heading_bias(state: State, e: HeadingBias) -> State:
    """Heading shown = heading + angle; the velocity over ground is logged in the axes of the heading shown, but for
    the part of the angle that is of the heading alone."""
    return heading_shown(state, e.angle, e.alone, e)


def heading_bias_inverse(logged: State, e: HeadingBias) -> State:
    """Motion in the ship's own axes from what was logged."""
    return heading_shown(logged, -e.angle, -e.alone, e)


ANTENNA = {
    "antenna_ahead": Parameter("antenna from which positions were moved to midship, forward of it", "m"),
    "antenna_abeam": Parameter("antenna from which positions were moved to midship, to starboard of it", "m"),
}
"""Parameters of every effect on the heading shown, along which they were moved."""

MIDSHIP: Mapping[str, Callable[[Any], float]] = {"antenna_ahead": lambda _: 0.0, "antenna_abeam": lambda _: 0.0}
"""Where they stand where nothing says that positions were moved."""

MOVED_FROM: Mapping[str, Callable[[Visited], float]] = {
    "antenna_ahead": lambda visited: visited.antenna[0],
    "antenna_abeam": lambda visited: visited.antenna[1],
}
"""Where the trials say so."""


def _angle(words: str) -> Parameter:
    return angle_about_zero(f"heading shown less true heading, {words}", 3.2, 15.0)


_WORDS = {"angle": "{}", "alone": "{}, velocities being logged in the ship's own axes"}

EFFECT = SensorEffect(
    kind="effects.heading-bias",
    tag="heading-bias",
    title="bias of the heading",
    told_by="the heading on leading marks, or by a second compass",
    params=HeadingBias,
    function=heading_bias,
    inverse=heading_bias_inverse,
    cites=(),
    fields={
        "angle": _angle("in whose axes velocities are logged"),
        "alone": _angle("velocities being logged in the ship's own axes"),
        **ANTENNA,
    },
    pivots=MIDSHIP,
    read_off=MOVED_FROM,
    variants=(("angle",), ("alone",)),
    besides=("alone",),
    varies=("angle", "alone"),
    subject="error of the compass",
    sentence=lambda v: "The compass showed " + each(_WORDS, v, ("too much", "too little")),
)
