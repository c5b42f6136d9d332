"""The speed log shows too much or too little."""

from typing import NamedTuple

from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect


class SpeedScale(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def speed_scale(state: State, e: SpeedScale) -> State:
    """Surge velocity shown = factor [-] times surge velocity."""
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u * e.factor, v_m=state.v_m, r=state.r)


def speed_scale_inverse(logged: State, e: SpeedScale) -> State:
    """Surge velocity from the one shown."""
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=logged.u / e.factor, v_m=logged.v_m, r=logged.r)


EFFECT = SensorEffect(
    kind="effects.speed-scale",
    tag="speed-scale",
    title="scale error of the speed log",
    params=SpeedScale,
    function=speed_scale,
    inverse=speed_scale_inverse,
    cites=(),
    fields={
        "factor": Parameter(
            "surge velocity shown over surge velocity",
            low=0.0,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.7, 1.3),
            typical=lambda _: 0.02,
            bounds_source="three tenths either way",
        )
    },
    variants=(("factor",),),
    sentence=lambda v: f"The speed log showed {v['factor']} times the speed",
)
