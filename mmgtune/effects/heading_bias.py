"""The compass shows a heading that is off by a constant angle."""

from typing import NamedTuple

from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, angle_about_zero
from .signs import each


class HeadingBias(NamedTuple):
    """See the parameters below."""

    angle: Lanes
    alone: Lanes


def heading_shown(state: State, turned: Lanes, alone: Lanes) -> State:
    """The heading off by two angles [rad]; the velocity over ground is logged in axes turned by the first of them."""
    u, v_m = to_ship(turned, state.u, state.v_m)
    return State(x=state.x, y=state.y, psi=state.psi + turned + alone, u=u, v_m=v_m, r=state.r)


def heading_bias(state: State, e: HeadingBias) -> State:
    """Heading shown = heading + angle; the velocity over ground is logged in the axes of the heading shown, but for
    the part of the angle that is of the heading alone."""
    return heading_shown(state, e.angle, e.alone)


def heading_bias_inverse(logged: State, e: HeadingBias) -> State:
    """Motion in the ship's own axes from what was logged."""
    return heading_shown(logged, -e.angle, -e.alone)


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
    },
    variants=(("angle",), ("alone",)),
    besides=("alone",),
    varies=("angle", "alone"),
    subject="error of the compass",
    sentence=lambda v: "The compass showed " + each(_WORDS, v, ("too much", "too little")),
)
