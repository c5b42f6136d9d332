"""Resistance going straight differs from the model's, by a factor or in how it grows with speed."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..physics.constants import GRAVITY
from ..physics.quantities import Flow, Force, Forces, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter
from .visited import Visited

SPEEDS = 0.1
"""Share by which speed must vary to say how something grows with it."""


class Resistance(NamedTuple):
    """See the parameters below."""

    factor: Lanes
    slope: Lanes


def resistance(state: State, around: Surroundings, found: Forces, components: Any, p: Any, e: Resistance) -> Force:
    """Surge force [N] that makes the model's resistance coefficient R_0' into R_0' (factor + slope Fn).

    The model's own resistance is asked of its hull at the same speed without drift and yaw, so that any hull will do.
    """
    Fn = found.flow.U / np.sqrt(GRAVITY * p.ship.L_pp)
    zero = 0.0 * Fn
    straight = Flow(u=found.flow.u, v_m=zero, r=zero, U=found.flow.U, beta=zero, v_=zero, r_=zero)
    X = (e.factor - 1.0 + e.slope * Fn) * components.hull(straight, p.ship, p.hull).X
    return Force(X=X, Y=zero, N=zero)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """More than one speed, for how the coefficient grows with it."""
    if "slope" not in found or visited.varies(visited.speed) > SPEEDS:
        return ""
    return f"speeds that differ by {100.0 * SPEEDS:.0f} %"


_WORDS = {"factor": "it was {} times as large", "slope": "its coefficient grew by {} per unit of Froude number"}

EFFECT = ForceEffect(
    kind="effects.resistance",
    tag="resistance",
    title="resistance",
    params=Resistance,
    function=resistance,
    cites=(),
    fields={
        "factor": Parameter(
            "factor on R_0'",
            low=-1.0,
            high=10.0,
            null=1.0,
            bounds=lambda _: (0.3, 3.0),
            typical=lambda _: 0.1,
            bounds_source="from a third to three times, heavy fouling",
        ),
        "slope": Parameter(
            "change of that factor per unit of Froude number",
            bounds=lambda _: (-10.0, 20.0),
            typical=lambda _: 1.0,
            bounds_source="resistance coefficient three times as large at Fn 0.1",
        ),
    },
    variants=(("factor",), ("slope",)),
    unvisited=unvisited,
    on_demand=True,
    absorbed={"factor": "hull.R_0"},
    sentence=lambda v: (
        "The resistance differed from the model's: "
        + " and ".join(_WORDS[name].format(v[name]) for name in _WORDS if name in v)
    ),
)
