"""Water so shallow that the flow around the hull changes."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..physics.elementary import where
from ..physics.quantities import Lanes, Surroundings
from ..physics.regressions.kijima1990 import LEAST, ShallowRatios, shallow_ratios
from .effect import FactorsEffect, Parameter, factor_on_measured
from .visited import Visited

TURNING = 0.1
"""Least r L / U [-] at which derivatives of the hull show."""

AFLOAT = 1.05
"""Depth over draught [-] that measured depths count as where they are less: the formulas have no end there."""


class ShallowWater(NamedTuple):
    """See the parameters below; then what the formulas need of the ship."""

    depth: Lanes
    measured: Lanes
    L_pp: Lanes
    B: Lanes
    d: Lanes
    C_b: Lanes


def shallow_water(around: Surroundings, e: ShallowWater) -> ShallowRatios:
    """Factors on the linear hull derivatives in water of some depth [m].

    Where the trial has measured depth it counts, the draught over it times ``measured``; else the steady one.  Added
    masses, wake and rudder are left as they are, and the water as deep under the whole ship (assumptions).
    """
    by_log = around.depth_known * e.measured > 0.0
    h = np.minimum(e.measured * e.d / np.maximum(around.depth, 1e-6), 1.0 / AFLOAT)
    ratios: ShallowRatios = shallow_ratios(e.L_pp, e.B, e.d, e.C_b, where(by_log, h, e.d / e.depth))
    return ratios


def beyond(values: Mapping[str, float], around: Surroundings) -> str:
    """What to say of water too shallow for the formulas; "" where it is not."""
    measured = around.depth_known * values["effects.shallow-water.measured"] > 0.0
    depth = np.where(measured, around.depth, values["effects.shallow-water.depth"])
    over = float(np.min(depth)) / values["particulars.d"]
    if over >= LEAST:
        return ""
    return f"water is down to {over:.3g} draughts deep, and the formulas of shallow water hold down to {LEAST:g}"


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Turning: what changes are derivatives by drift and yaw."""
    if visited.span(np.abs(visited.rate))[1] > TURNING:
        return ""
    return f"a ship that turns, with r L/U beyond {TURNING:g}"


EFFECT = FactorsEffect(
    kind="effects.shallow-water",
    tag="shallow-water",
    title="shallow water",
    params=ShallowWater,
    function=shallow_water,
    cites=("Kijima et al. 1990, J. Society of Naval Architects of Japan 168, 247-256",),
    fields={
        "depth": Parameter(
            "depth of the water where the trial has no measured depth",
            "m",
            null=float("inf"),
            low=0.0,
            chart="reciprocal",
            bounds=lambda ship: (0.0, 1.0 / (LEAST * ship.d)),
            typical=lambda ship: 0.3 / ship.d,
            bounds_source="formula valid down to a depth of 1.2 draughts",
        ),
        "measured": factor_on_measured(
            "the draught over the depth", 1.5, 0.3, "from deep water to half as shallow again as measured"
        ),
    },
    borrowed={name: f"particulars.{name}" for name in ("L_pp", "B", "d", "C_b")},
    variants=(("depth",), ("measured",)),
    unvisited=unvisited,
    rough=True,
    sentence=lambda v: (
        f"The depth measured in the trials acts on the ship, her draught over it times {v['measured']}"
        if "measured" in v
        else f"The ship sailed in shallow water, as if {v['depth']} deep"
    ),
    needs=("hull.Y_v", "hull.Y_r", "hull.N_v", "hull.N_r"),
    of_measured={"measured": "depth"},
    stand_in=("depth",),
    varies=("depth",),
    subject="depth of the water",
    beyond=beyond,
    changes=("hull.Y_v", "hull.Y_r", "hull.N_v", "hull.N_r"),
)
