"""Waves from ahead hold the ship back."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.elementary import cos, sin, where
from ..physics.frame import to_ship
from ..physics.quantities import Force, Forces, Lanes, State, Surroundings
from ..physics.regressions.stawave1 import added_resistance, from_ahead, height_limit
from .effect import ForceEffect, Parameter, factor_on_measured


class Waves(NamedTuple):
    """See the parameters below."""

    height: Lanes
    direction: Lanes
    measured: Lanes
    L_BWL_: Lanes
    outside: Lanes


def waves(state: State, around: Surroundings, found: Forces, components: Any, p: Any, e: Waves) -> Force:
    """Surge force [N] of added resistance in waves: STAWAVE-1, X = -R_AWL; no side force and no moment.

    Where the trial has measured waves they count, their height times ``measured``; else the steady ones.
    """
    by_log = around.wave_known * e.measured > 0.0
    north = where(by_log, around.wave_north * e.measured, e.height * cos(e.direction))
    east = where(by_log, around.wave_east * e.measured, e.height * sin(e.direction))
    ahead, starboard = to_ship(state.psi, north, east)
    height = np.sqrt(ahead * ahead + starboard * starboard)
    R = added_resistance(p.ship.rho, p.ship.B, e.L_BWL_ * p.ship.L_pp, height)
    X = -R * from_ahead(ahead, starboard, e.outside)
    return Force(X=X, Y=0.0 * X, N=0.0 * X)


def beyond(values: Mapping[str, float], around: Surroundings) -> str:
    """What to say of waves too high for the formula; "" where they are not."""
    limit = float(height_limit(values["particulars.L_pp"]))
    measured = around.wave_known * values["effects.waves.measured"] > 0.0
    height = np.where(
        measured,
        np.hypot(around.wave_north, around.wave_east) * values["effects.waves.measured"],
        values["effects.waves.height"],
    )
    if not np.any(height > limit):
        return ""
    return f"waves are up to {np.max(height):.3g} m high, and STAWAVE-1 holds up to {limit:.3g} m for this ship"


EFFECT = ForceEffect(
    kind="effects.waves",
    tag="waves",
    title="added resistance in waves",
    told_by="height and direction of the waves in each run",
    params=Waves,
    function=waves,
    cites=(
        "ITTC 2014, Recommended Procedure 7.5-04-01-01.1, STAWAVE-1",
        "Mathioudakis et al., Towards real-world validation of a physics-based ship motion prediction model, eq. 8",
    ),
    fields={
        "height": Parameter(
            "significant wave height where the trial has no measured waves",
            "m",
            low=AT_LEAST_0,
            chart="polar",
            bounds=lambda ship: (0.0, float(height_limit(ship.L))),
            typical=lambda ship: 0.3 * float(height_limit(ship.L)),
            bounds_source="limit of STAWAVE-1",
        ),
        "direction": Parameter(
            "direction those waves come from, clockwise from north",
            "rad",
            bounds=lambda _: (0.0, 2.0 * np.pi),
            typical=lambda _: 0.5 * np.pi,
        ),
        "measured": factor_on_measured(
            "the significant height", 2.0, 0.5, "from no waves to twice as high as measured"
        ),
        "L_BWL_": Parameter(
            "distance from the bow to 95 % of the largest breadth on the waterline, over L_pp (0.25: assumption)",
            "prime",
            low=0.0,
            high=1.0,
            null=0.25,
            bounds=lambda _: (0.05, 0.6),
            typical=lambda _: 0.05,
            bounds_source="from a barge to a slender hull",
        ),
        "outside": Parameter(
            "in waves from beyond 45 deg off the bow: no added resistance, or a cosine that ends at 90 deg",
            choices={"none": 0.0, "taper": 1.0},
            bounds=lambda _: (0.0, 1.0),
        ),
    },
    # Steady waves are not looked for: all that trials would show of them is what a constant force does as well.
    variants=(("measured",),),
    sentence=lambda v: f"The waves measured in the trials hold the ship back, as if {v['measured']} times as high",
    of_measured={"measured": "wave"},
    stand_in=("height",),
    beyond=beyond,
)
