"""The rate gyro shows too much or too little, the more so perhaps the faster she turns; the heading does not come from
it."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, factor_about_one
from .visited import Visited

TURNING = 0.3
"""Yaw rate r L / U [-] that trials have to go beyond for a change of the factor with it to be told."""

FALLING = 1e-2
"""Least slope of what is shown by what is there that the inverse reckons with."""


class GyroScale(NamedTuple):
    """See the parameters below."""

    factor: Lanes
    curve: Lanes
    time: Lanes


def gyro_scale(state: State, e: GyroScale) -> State:
    """Yaw rate shown = factor [-] times (1 + curve |r| time) times yaw rate."""
    r = state.r * e.factor * (1.0 + e.curve * np.abs(state.r) * e.time)
    return State(x=state.x, y=state.y, psi=state.psi, u=state.u, v_m=state.v_m, r=r)


def gyro_scale_inverse(logged: State, e: GyroScale) -> State:
    """Yaw rate from the one shown: the root of a parabola that is next to it where there is no curve."""
    straight = logged.r / e.factor
    slope = np.sqrt(np.maximum(1.0 + 4.0 * e.curve * e.time * np.abs(straight), FALLING))
    r = 2.0 * straight / (1.0 + slope)
    return State(x=logged.x, y=logged.y, psi=logged.psi, u=logged.u, v_m=logged.v_m, r=r)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Hard turns, for how the factor changes with the yaw rate."""
    largest = visited.span(np.abs(visited.rate))[1]
    if "curve" not in found or largest > TURNING:
        return ""
    return f"yaw rates r L/U beyond {TURNING:g} (these go to {largest:.2g})"


def _sentence(v: Mapping[str, str]) -> str:
    said = f"The rate gyro showed {v['factor']} times the yaw rate"
    if "curve" not in v:
        return said
    return f"{said} in slow turns, a factor that changed by {v['curve']} of itself to a yaw rate r L/U of 1"


EFFECT = SensorEffect(
    kind="effects.gyro-scale",
    tag="gyro-scale",
    title="scale error of the rate gyro",
    told_by="the yaw rate of a second gyro",
    params=GyroScale,
    function=gyro_scale,
    inverse=gyro_scale_inverse,
    cites=(),
    fields={
        "factor": factor_about_one("yaw rate shown over yaw rate", 0.3, 0.02, "three tenths either way"),
        "curve": Parameter(
            "change of that factor up to a yaw rate of one over the time below, as a share of it",
            low=-1.0,
            high=1.0,
            bounds=lambda _: (-0.4, 0.4),
            typical=lambda _: 0.05,
            bounds_source="four tenths: with half, what is shown falls again where a ship turns fastest",
        ),
        "time": Parameter("time by which yaw rates are meant, as r L/U", "s", low=AT_LEAST_0),
    },
    pivots={"time": lambda ship: ship.L / ship.U},
    variants=(("factor",), ("factor", "curve")),
    besides=("curve",),
    varies=("factor",),
    subject="factor of the rate gyro",
    unvisited=unvisited,
    sentence=_sentence,
)
