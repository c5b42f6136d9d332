"""Wind on the part of the ship above the water."""

from typing import NamedTuple

import numpy as np

from ..physics.elementary import cos, sin, where
from ..physics.quantities import Force, Lanes
from ..physics.wind import WindCoefficients, wind_shape
from .effect import Effect, Parameter

RHO_AIR = 1.225
"""Density of air [kg/m^3]."""


class Wind(NamedTuple):
    """Wind, then what the ship shows it."""

    speed: Lanes
    direction: Lanes
    measured: Lanes
    A_T: Lanes
    A_L: Lanes
    X_0: Lanes
    X_1: Lanes
    X_3: Lanes
    X_5: Lanes
    Y_1: Lanes
    Y_3: Lanes
    Y_5: Lanes
    N_1: Lanes
    N_2: Lanes
    N_3: Lanes


def wind(state, air, found, components, p, e):
    """Force of the apparent wind: Fujiwara, Ueno & Nimura 1998.

    Where the trial has measured wind it counts, times ``measured``; else the steady wind.  No wind at all is no force:
    a model without this effect has the drag of still air in its resistance.
    """
    by_log = air.known * e.measured > 0.0
    north = where(by_log, air.north * e.measured, -e.speed * cos(e.direction))
    east = where(by_log, air.east * e.measured, -e.speed * sin(e.direction))
    blows = where(by_log, 1.0, where(e.speed > 0.0, 1.0, 0.0))
    cos_psi = cos(state.psi)
    sin_psi = sin(state.psi)
    u_A = cos_psi * north + sin_psi * east - state.u
    v_A = cos_psi * east - sin_psi * north - state.v_m
    U_A2 = u_A * u_A + v_A * v_A
    U_A = np.sqrt(np.maximum(U_A2, 1e-12))
    C_X, C_Y, C_N = wind_shape(-u_A / U_A, -v_A / U_A, e)
    q = blows * 0.5 * RHO_AIR * U_A2
    return Force(X=q * e.A_T * C_X, Y=q * e.A_L * C_Y, N=q * e.A_L * p.ship.L_pp * C_N)


EFFECT = Effect(
    kind="effects.wind",
    tag="wind",
    title="wind",
    place="force",
    params=Wind,
    function=wind,
    cites=("Fujiwara, Ueno & Nimura 1998, J. Society of Naval Architects of Japan 183, 77-90",),
    fields={
        "speed": Parameter(
            "true wind speed where the trial has no measured wind",
            "m/s",
            low=-1e-12,
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
        "measured": Parameter(
            "factor on the wind measured in the trial",
            default=1.0,
            low=-1e-12,
            high=5.0,
            null=0.0,
            bounds=lambda _: (0.0, 2.0),
            typical=lambda _: 1.0,
            bounds_source="from no wind to twice the measured",
        ),
    },
    borrowed={name: f"above_water.{name}" for name in ("A_T", "A_L", *WindCoefficients._fields)},
    variants=(("speed", "direction"), ("measured",)),
    sentence=lambda v: (
        f"The wind measured in the trials acts on the ship, with {v['measured']} times its measured speed"
        if "measured" in v
        else f"A wind of {v['speed']} blew from {v['direction']}"
    ),
    needs=("above_water.A_T",),
    of_measured_wind=("measured",),
)
