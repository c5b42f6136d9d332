"""Wind on the part of the ship above the water."""

from collections import namedtuple
from typing import Any

import numpy as np

from ..components import AT_LEAST_0
from ..physics.elementary import cos, sin, where
from ..physics.frame import to_ship
from ..physics.quantities import HARMONICS, Force, Forces, State, Surroundings
from ..physics.wind import wind_shape
from .effect import ForceEffect, Parameter, factor_on_measured

RHO_AIR = 1.225
"""Density of air [kg/m^3]."""


SHOWN = ("A_T", "A_L", *HARMONICS)
"""What the ship shows the wind, out of her section above_water."""

Wind = namedtuple("Wind", ("speed", "direction", "measured", "ahead", "across", "turning", "arm", *SHOWN))  # type: ignore[misc]


def _factor(what: str) -> Parameter:
    return Parameter(
        f"factor on the {what} of the formulas",
        null=1.0,
        low=AT_LEAST_0,
        bounds=lambda _: (0.25, 2.5),
        bounds_source="from a quarter to two and a half times",
    )


def wind(state: State, around: Surroundings, found: Forces, components: Any, p: Any, e: Any) -> Force:
    """Force of the apparent wind: Fujiwara, Ueno & Nimura 1998.

    Where the trial has measured wind it counts, times ``measured``; else the steady wind.  No wind at all is no force:
    a model without this effect has the drag of still air in its resistance.
    """
    by_log = around.wind_known * e.measured > 0.0
    north = where(by_log, around.wind_north * e.measured, -e.speed * cos(e.direction))
    east = where(by_log, around.wind_east * e.measured, -e.speed * sin(e.direction))
    blows = where(by_log, 1.0, where(e.speed > 0.0, 1.0, 0.0))
    ahead, starboard = to_ship(state.psi, north, east)
    u_A = ahead - state.u
    v_A = starboard - state.v_m
    U_A2 = u_A * u_A + v_A * v_A
    U_A = np.sqrt(np.maximum(U_A2, 1e-12))
    C_X, C_Y, C_N = wind_shape(-u_A / U_A, -v_A / U_A, e)
    q = blows * 0.5 * RHO_AIR * U_A2
    X, Y = e.ahead * q * e.A_T * C_X, e.across * q * e.A_L * C_Y
    return Force(X=X, Y=Y, N=(e.across * e.turning * q * e.A_L * C_N + e.arm * Y) * p.ship.L_pp)


EFFECT = ForceEffect(
    kind="effects.wind",
    tag="wind",
    title="wind",
    told_by="the wind in each run, by a vane and cups above the superstructure",
    params=Wind,
    function=wind,
    cites=("Fujiwara, Ueno & Nimura 1998, J. Society of Naval Architects of Japan 183, 77-90",),
    fields={
        "speed": Parameter(
            "true wind speed where the trial has no measured wind",
            "m/s",
            low=AT_LEAST_0,
            chart="polar",
            bounds=lambda ship: (0.0, 10.0 * ship.U),
            typical=lambda ship: 1.6 * ship.U,
            bounds_source="ten times the approach speed",
        ),
        "direction": Parameter(
            "direction that wind comes from, clockwise from north",
            "rad",
            bounds=lambda _: (0.0, 2.0 * np.pi),
            typical=lambda _: 0.5 * np.pi,
        ),
        "measured": factor_on_measured("the wind", 2.0, 1.0, "from no wind to twice the measured"),
        "ahead": _factor("force ahead"),
        "across": _factor("force across"),
        "turning": Parameter(
            "factor on the moment of the formulas, beside that on the force across",
            null=1.0,
            bounds=lambda _: (-1.0, 5.0),
            bounds_source="against the formulas to five times them",
        ),
        "arm": Parameter(
            "shift of the force across forward of where the formulas have it, in ship lengths",
            low=-1.0,
            high=1.0,
            bounds=lambda _: (-0.25, 0.25),
            bounds_source="a quarter of the ship's length",
        ),
    },
    form={"ahead": 0.2, "across": 0.2, "turning": 0.5, "arm": 0.05},
    borrowed={name: f"above_water.{name}" for name in SHOWN},
    variants=(("speed", "direction"), ("measured",)),
    akin=("wave-drift",),
    sentence=lambda v: (
        f"The wind measured in the trials acts on the ship, with {v['measured']} times its measured speed"
        if "measured" in v
        else f"A wind of {v['speed']} blew from {v['direction']}"
    ),
    needs=("above_water.A_T",),
    of_measured={"measured": "wind"},
    stand_in=("speed",),
    varies=("speed", "direction"),
)
