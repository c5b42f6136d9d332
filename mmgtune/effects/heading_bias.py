"""The compass shows a heading that is off by a constant angle."""

from typing import NamedTuple

from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State
from ..units import DEG
from .effect import Parameter, SensorEffect


class HeadingBias(NamedTuple):
    """See the parameters below."""

    angle: Lanes


def _turned(state: State, psi: Lanes, angle: Lanes) -> State:
    """The same motion with another heading, its velocities in axes turned by ``angle`` [rad]."""
    u, v_m = to_ship(angle, state.u, state.v_m)
    return State(x=state.x, y=state.y, psi=psi, u=u, v_m=v_m, r=state.r)


def heading_bias(state: State, e: HeadingBias) -> State:
    """Heading shown = heading + angle; the ground velocity is logged in the axes of the heading shown."""
    return _turned(state, state.psi + e.angle, e.angle)


def heading_bias_inverse(logged: State, e: HeadingBias) -> State:
    """Motion in the ship's own axes from what was logged."""
    return _turned(logged, logged.psi - e.angle, -e.angle)


EFFECT = SensorEffect(
    kind="effects.heading-bias",
    tag="heading-bias",
    title="bias of the heading",
    params=HeadingBias,
    function=heading_bias,
    inverse=heading_bias_inverse,
    cites=(),
    fields={
        "angle": Parameter(
            "heading shown less true heading",
            "rad",
            low=-3.2,
            high=3.2,
            bounds=lambda _: (-15.0 * DEG, 15.0 * DEG),
            typical=lambda _: 1.0 * DEG,
            bounds_source="beyond 15 deg anyone would see it",
        )
    },
    variants=(("angle",),),
    sentence=lambda v: f"The compass showed {v['angle']} too much (negative: too little)",
)
