"""The speed log shows too much or too little, the more so the faster the ship."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, factor_about_one
from .visited import Visited

SPEEDS = 0.2
"""Share by which the speed ahead must vary to say how something grows with it."""


class SpeedScale(NamedTuple):
    """See the parameters below."""

    factor: Lanes
    both: Lanes
    grows: Lanes
    pivot: Lanes


SHOWN = {"factor": "speed ahead", "both": "speeds ahead and to starboard"}
"""What the factors are on."""


def speed_scale(state: State, e: SpeedScale) -> State:
    """Surge velocity shown = factor times both [-] times (1 + grows (u - pivot)) times surge velocity, sway velocity
    shown = both times it.  The factor is that at the pivot [m/s]."""
    u, v_m = state.u * e.factor * e.both * (1.0 + e.grows * (state.u - e.pivot)), state.v_m * e.both
    return State(x=state.x, y=state.y, psi=state.psi, u=u, v_m=v_m, r=state.r)


def speed_scale_inverse(logged: State, e: SpeedScale) -> State:
    """Velocities from those shown: the one ahead by Newton's method, which doubles the digits each time."""
    straight = logged.u / (e.factor * e.both)
    u = straight
    for _ in range(5):
        slope = np.maximum(1.0 + e.grows * (2.0 * u - e.pivot), 0.1)
        u = u - (u * (1.0 + e.grows * (u - e.pivot)) - straight) / slope
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=u, v_m=logged.v_m / e.both, r=logged.r)


def _factor(of: str) -> Parameter:
    """What is shown over what is."""
    return factor_about_one(f"{of} shown over {of}", 0.3, 0.02, "three tenths either way")


def _sentence(v: Mapping[str, str]) -> str:
    said = [f"{v[name]} times the {of}" for name, of in SHOWN.items() if name in v]
    if "grows" in v:
        said.append(f"a factor that changed by {v['grows']}")
    return "The speed log showed " + ", ".join(said)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """More than one speed, for how the error grows with it."""
    if "grows" not in found or visited.varies(visited.ahead) > SPEEDS:
        return ""
    return f"speeds ahead that differ by {100.0 * SPEEDS:.0f} %"


EFFECT = SensorEffect(
    kind="effects.speed-scale",
    tag="speed-scale",
    title="scale error of the speed log",
    told_by="a measured mile, both ways",
    params=SpeedScale,
    function=speed_scale,
    inverse=speed_scale_inverse,
    cites=(),
    fields={
        **{name: _factor(of) for name, of in SHOWN.items()},
        "grows": Parameter(
            "growth with speed of the speed ahead shown over the speed ahead",
            "s/m",
            bounds=lambda ship: (-0.4 / ship.U, 0.4 / ship.U),
            typical=lambda ship: 0.05 / ship.U,
            bounds_source="four tenths over the approach speed: half of it shows the half of that",
        ),
        "pivot": Parameter("speed ahead at which the factor holds, whatever the growth", "m/s", low=AT_LEAST_0),
    },
    pivots={"pivot": lambda ship: ship.U},
    variants=(("factor",), ("both",), ("factor", "grows")),
    besides=("grows",),
    varies=("factor",),
    subject="factor of the speed log",
    unvisited=unvisited,
    sentence=_sentence,
)
