"""Resistance going straight differs from the model's, by a factor or in how it grows with speed."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.constants import GRAVITY
from ..physics.quantities import Flow, Force, Forces, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter, Scale
from .visited import Visited


class Resistance(NamedTuple):
    """See the parameters below."""

    factor: Lanes
    slope: Lanes
    pivot: Lanes


def resistance(state: State, around: Surroundings, found: Forces, components: Any, p: Any, e: Resistance) -> Force:
    """Surge force [N] that makes the model's resistance coefficient R_0' into R_0' (factor + slope (Fn - Fn_pivot)).

    The factor is that at the pivot, so that a slope leaves the level there alone.  The model's own resistance is asked
    of its hull at the same speed without drift and yaw, so that any hull will do.
    """
    Fn = (found.flow.U - e.pivot) / np.sqrt(GRAVITY * p.ship.L_pp)
    zero = 0.0 * Fn
    straight = Flow(u=found.flow.u, v_m=zero, r=zero, U=found.flow.U, beta=zero, v_=zero, r_=zero)
    X = (e.factor - 1.0 + e.slope * Fn) * components.hull(straight, p.ship, p.hull).X
    return Force(X=X, Y=zero, N=zero)


def _froude(ship: Scale) -> float:
    return ship.U / math.sqrt(GRAVITY * ship.L)


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """More than one speed, for how the coefficient grows with it."""
    return visited.lacking_speeds if "slope" in found else ""


def _sentence(v: Mapping[str, str]) -> str:
    told = [f"it was {v['factor']} times as large"] if "factor" in v else []
    if "slope" in v:
        size = v["slope"].removeprefix("-")
        told.append(f"its coefficient {'grew' if size == v['slope'] else 'fell'} by {size} per unit of Froude number")
    return "The resistance differed from the model's: " + " and ".join(told)


EFFECT = ForceEffect(
    kind="effects.resistance",
    tag="resistance",
    title="resistance",
    told_by="thrust or torque on straight runs, logged at the shaft",
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
            bounds=lambda ship: (-1.2 / _froude(ship), 1.2 / _froude(ship)),
            typical=lambda ship: 0.1 / _froude(ship),
            bounds_source="a coefficient that is gone at rest, or twice as large, and a fifth beyond",
        ),
        "pivot": Parameter("speed at which the factor holds, whatever the slope", "m/s", low=AT_LEAST_0),
    },
    pivots={"pivot": lambda ship: ship.U},
    varies=("factor",),
    variants=(("factor",), ("slope",)),
    unvisited=unvisited,
    absorbed={"factor": "hull.R_0"},
    sentence=_sentence,
)
