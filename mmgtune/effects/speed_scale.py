"""The speed log shows too much or too little."""

from typing import NamedTuple

from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, factor_about_one


class SpeedScale(NamedTuple):
    """See the parameters below."""

    factor: Lanes
    both: Lanes


SHOWN = {"factor": "speed ahead", "both": "speeds ahead and to starboard"}
"""What each parameter is a factor on."""


def speed_scale(state: State, e: SpeedScale) -> State:
    """Surge velocity shown = factor times both [-] times surge velocity, sway velocity shown = both times it."""
    u, v_m = state.u * e.factor * e.both, state.v_m * e.both
    return State(x=state.x, y=state.y, psi=state.psi, u=u, v_m=v_m, r=state.r)


def speed_scale_inverse(logged: State, e: SpeedScale) -> State:
    """Velocities from those shown."""
    u, v_m = logged.u / (e.factor * e.both), logged.v_m / e.both
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=u, v_m=v_m, r=logged.r)


def _factor(of: str) -> Parameter:
    """What is shown over what is."""
    return factor_about_one(f"{of} shown over {of}", 0.3, 0.02, "three tenths either way")


EFFECT = SensorEffect(
    kind="effects.speed-scale",
    tag="speed-scale",
    title="scale error of the speed log",
    params=SpeedScale,
    function=speed_scale,
    inverse=speed_scale_inverse,
    cites=(),
    fields={name: _factor(of) for name, of in SHOWN.items()},
    variants=(("factor",), ("both",)),
    sentence=lambda v: (
        "The speed log showed " + ", and ".join(f"{v[name]} times the {of}" for name, of in SHOWN.items() if name in v)
    ),
)
