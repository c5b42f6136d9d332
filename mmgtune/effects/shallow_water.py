"""Water so shallow that the flow around the hull changes."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..physics.elementary import exp, log, where
from ..physics.quantities import Lanes, Ship, Surroundings
from ..physics.regressions.kijima1990 import LEAST, shallow_ratios
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
    Y_v: Lanes
    Y_r: Lanes
    N_v: Lanes
    N_r: Lanes
    cross: Lanes
    inertia: Lanes
    L_pp: Lanes
    B: Lanes
    d: Lanes
    C_b: Lanes


class ShallowFactors(NamedTuple):
    """Factors [-] on the linear derivatives of the hull, on all that is not linear, of whatever hull it is, and on
    the water carried along.
    """

    Y_v: Lanes
    Y_r: Lanes
    N_v: Lanes
    N_r: Lanes
    Y_vvv: Lanes
    Y_vvr: Lanes
    Y_vrr: Lanes
    Y_rrr: Lanes
    N_vvv: Lanes
    N_vvr: Lanes
    N_vrr: Lanes
    N_rrr: Lanes
    Y_vv: Lanes
    Y_vr: Lanes
    Y_rr: Lanes
    N_vv: Lanes
    N_rr: Lanes
    C_D: Lanes
    m_y_: Lanes
    J_zz_: Lanes


def shallow_water(around: Surroundings, e: ShallowWater) -> ShallowFactors:
    """Factors on hull derivatives in water of some depth [m].

    Where the trial has measured depth it counts, the draught over it times ``measured``; else the steady one.  Wake
    and rudder are left as they are, and the water as deep under the whole ship (assumptions).  The others may grow
    more or less than the formulas have it: by the factor on Y_v to a power, which is 0 in the formulas; those know of
    no growth of what is not linear, nor of added masses.
    """
    by_log = around.depth_known * e.measured > 0.0
    h = np.minimum(e.measured * e.d / np.maximum(around.depth, 1e-6), 1.0 / AFLOAT)
    found = shallow_ratios(e.L_pp, e.B, e.d, e.C_b, where(by_log, h, e.d / e.depth))
    growth = log(found.Y_v)
    cross = exp(e.cross * growth)
    inertia = exp(e.inertia * growth)
    return ShallowFactors(
        Y_v=found.Y_v * exp(e.Y_v * growth),
        Y_r=found.Y_r * exp(e.Y_r * growth),
        N_v=found.N_v * exp(e.N_v * growth),
        N_r=found.N_r * exp(e.N_r * growth),
        Y_vvv=cross,
        Y_vvr=cross,
        Y_vrr=cross,
        Y_rrr=cross,
        N_vvv=cross,
        N_vvr=cross,
        N_vrr=cross,
        N_rrr=cross,
        Y_vv=cross,
        Y_vr=cross,
        Y_rr=cross,
        N_vv=cross,
        N_rr=cross,
        C_D=cross,
        m_y_=inertia,
        J_zz_=inertia,
    )


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


def _power(of: str, low: float = -1.0, high: float = 1.0) -> Parameter:
    """How much more than the formulas have it something grows."""
    return Parameter(
        f"power of the factor on Y_v by which {of} grows beyond the formulas",
        bounds=lambda _: (low, high),
        bounds_source="a choice: beyond it another effect is at work",
    )


EFFECT = FactorsEffect(
    kind="effects.shallow-water",
    tag="shallow-water",
    title="shallow water",
    told_by="the depth along the track",
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
        **{name: _power(name) for name in ("Y_v", "Y_r", "N_v", "N_r")},
        "cross": _power("what is not linear in Y and N", -0.5, 1.5),
        "inertia": _power("the added mass in sway and the added moment of inertia in yaw", -0.5, 1.0),
    },
    form={"Y_v": 0.25, "Y_r": 0.25, "N_v": 0.25, "N_r": 0.25, "cross": 0.5, "inertia": 0.25},
    borrowed={name: f"particulars.{name}" for name in ("L_pp", "B", "d", "C_b")},
    variants=(("depth",), ("measured",)),
    unvisited=unvisited,
    rough=True,
    akin=("loading",),
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
    changes=tuple(f"{'particulars' if name in Ship._fields else 'hull'}.{name}" for name in ShallowFactors._fields),
)
