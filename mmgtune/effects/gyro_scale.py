"""The rate gyro shows too much or too little; the heading does not come from it."""

from typing import NamedTuple

from ..physics.quantities import Lanes, State
from .effect import SensorEffect, factor_about_one


class GyroScale(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def gyro_scale(state: State, e: GyroScale) -> State:
    """Yaw rate shown = factor [-] times yaw rate."""
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u, v_m=state.v_m, r=state.r * e.factor)


def gyro_scale_inverse(logged: State, e: GyroScale) -> State:
    """Yaw rate from the one shown."""
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=logged.u, v_m=logged.v_m, r=logged.r / e.factor)


EFFECT = SensorEffect(
    kind="effects.gyro-scale",
    tag="gyro-scale",
    title="scale error of the rate gyro",
    told_by="the yaw rate of a second gyro",
    params=GyroScale,
    function=gyro_scale,
    inverse=gyro_scale_inverse,
    cites=(),
    fields={"factor": factor_about_one("yaw rate shown over yaw rate", 0.3, 0.02, "three tenths either way")},
    variants=(("factor",),),
    sentence=lambda v: f"The rate gyro showed {v['factor']} times the yaw rate",
)
