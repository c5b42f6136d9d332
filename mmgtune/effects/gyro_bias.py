"""The rate gyro shows a turn where there is none; the heading does not come from it."""

from typing import NamedTuple

from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect
from .signs import signed


class GyroBias(NamedTuple):
    """See the parameters below."""

    rate: Lanes


def gyro_bias(state: State, e: GyroBias) -> State:
    """Yaw rate shown = yaw rate + rate [rad/s]."""
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u, v_m=state.v_m, r=state.r + e.rate)


def gyro_bias_inverse(logged: State, e: GyroBias) -> State:
    """Yaw rate from the one shown."""
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=logged.u, v_m=logged.v_m, r=logged.r - e.rate)


EFFECT = SensorEffect(
    kind="effects.gyro-bias",
    tag="gyro-bias",
    title="bias of the rate gyro",
    told_by="what the rate gyro shows alongside",
    params=GyroBias,
    function=gyro_bias,
    inverse=gyro_bias_inverse,
    cites=(),
    fields={
        "rate": Parameter(
            "yaw rate shown less yaw rate",
            "rad/s",
            low=-0.5,
            high=0.5,
            bounds=lambda ship: (-0.3 * ship.U / ship.L, 0.3 * ship.U / ship.L),
            typical=lambda ship: 0.01 * ship.U / ship.L,
            bounds_source="three tenths of the speed over the length",
        )
    },
    variants=(("rate",),),
    varies=("rate",),
    sentence=lambda v: f"The rate gyro showed {signed(v['rate'], 'too much', 'too little')}",
)
