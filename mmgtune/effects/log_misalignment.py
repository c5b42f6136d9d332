"""The speed log is mounted at an angle to the keel."""

from typing import NamedTuple

from ..physics.frame import to_ship
from ..physics.quantities import Lanes, State
from .effect import SensorEffect, angle_about_zero
from .signs import signed


class LogMisalignment(NamedTuple):
    """See the parameters below."""

    angle: Lanes


def log_misalignment(state: State, e: LogMisalignment) -> State:
    """Velocities shown are those along axes turned by an angle [rad]; the heading shown is that of the ship."""
    u, v_m = to_ship(e.angle, state.u, state.v_m)
    return State(x=state.x, y=state.y, psi=state.psi, u=u, v_m=v_m, r=state.r)


def log_misalignment_inverse(logged: State, e: LogMisalignment) -> State:
    """Velocities in the ship's axes from those shown."""
    u, v_m = to_ship(-e.angle, logged.u, logged.v_m)
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=u, v_m=v_m, r=logged.r)


EFFECT = SensorEffect(
    kind="effects.log-misalignment",
    tag="log-misalignment",
    title="misalignment of the speed log",
    told_by="the leeway that the log shows on a straight course in still water",
    params=LogMisalignment,
    function=log_misalignment,
    inverse=log_misalignment_inverse,
    cites=(),
    fields={
        "angle": angle_about_zero("angle of the log's axes to the ship's, positive to starboard", 3.2, 15.0),
    },
    variants=(("angle",),),
    sentence=lambda v: f"The speed log was turned by {signed(v['angle'], 'to starboard', 'to port')}",
)
