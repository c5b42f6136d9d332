"""Wind on the part of the ship above the water."""

from collections import namedtuple
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..components import AT_LEAST_0
from ..phrases import capital
from ..physics.elementary import cos, sin, where
from ..physics.frame import to_ship
from ..physics.quantities import HARMONICS, Force, Forces, State, Surroundings
from ..physics.wind import wind_shape
from .effect import ForceEffect, Parameter, factor_on_flow_measured, turned_on_measured
from .signs import as_logged

RHO_AIR = 1.225
"""Density of air [kg/m^3]."""


SHOWN = ("A_T", "A_L", *HARMONICS)
"""What the ship shows the wind, out of her section above_water."""

OWN = ("speed", "direction", "measured", "turned", "ahead", "across", "turning", "arm")
"""Parameters of the effect itself."""

Wind = namedtuple("Wind", (*OWN, *SHOWN))  # type: ignore[misc]


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

    Where the trial has measured wind it counts, times ``measured`` and turned back by ``turned``; else the steady wind.
    No wind at all is no force: a model without this effect has the drag of still air in its resistance.
    """
    by_log = around.wind_known * np.abs(e.measured) > 0.0
    shown_north, shown_east = to_ship(e.turned, around.wind_north, around.wind_east)
    north = where(by_log, shown_north * e.measured, -e.speed * cos(e.direction))
    east = where(by_log, shown_east * e.measured, -e.speed * sin(e.direction))
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


def _sentence(v: Mapping[str, str]) -> str:
    told = []
    if "speed" in v:
        told.append(f"a wind of {v['speed']} blew from {v['direction']}")
    told += as_logged("wind", "comes from", v)
    return capital("; ".join(told))


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
        "measured": factor_on_flow_measured("the wind", 1.0),
        "turned": turned_on_measured("the wind", "comes from"),
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
    variants=(("speed", "direction"), ("measured",), ("turned",), ("measured", "turned")),
    akin=("wave-drift",),
    sentence=_sentence,
    needs=("above_water.A_T",),
    of_measured={"measured": "wind", "turned": "wind"},
    stand_in=("speed",),
    varies=("speed", "direction"),
)
