"""Mean drift force of waves, constant in the earth frame."""

from typing import Any, NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.elementary import sin
from ..physics.frame import to_ship
from ..physics.quantities import Force, Forces, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter


class WaveDrift(NamedTuple):
    """See the parameters below."""

    force: Lanes
    direction: Lanes
    ahead: Lanes
    turning: Lanes


def wave_drift(state: State, around: Surroundings, found: Forces, components: Any, p: Any, e: WaveDrift) -> Force:
    """Force [N] along one line over ground, at midship, whatever the ship's heading.

    That is an assumption; ``ahead`` and ``turning`` say how far a ship is off it.
    """
    ahead, starboard = to_ship(state.psi - e.direction, -e.force, 0.0)
    moment = e.turning * e.force * p.ship.L_pp * sin(2.0 * (state.psi - e.direction))
    return Force(X=e.ahead * ahead, Y=starboard, N=moment)


EFFECT = ForceEffect(
    kind="effects.wave-drift",
    tag="wave-drift",
    title="drift force of waves",
    told_by="height and direction of the waves in each run",
    params=WaveDrift,
    function=wave_drift,
    cites=(),
    fields={
        "force": Parameter(
            "mean force",
            "N",
            low=AT_LEAST_0,
            chart="polar",
            bounds=lambda ship: (0.0, 0.03 * ship.force),
            typical=lambda ship: 0.003 * ship.force,
            bounds_source="about twice the resistance going straight",
        ),
        "direction": Parameter(
            "direction the waves come from, clockwise from north",
            "rad",
            bounds=lambda _: (0.0, 2.0 * np.pi),
            typical=lambda _: 0.5 * np.pi,
        ),
        "ahead": Parameter(
            "factor on the force along the ship",
            null=1.0,
            low=AT_LEAST_0,
            bounds=lambda _: (0.0, 2.0),
            bounds_source="from none to twice that of a force along one line",
        ),
        "turning": Parameter(
            "moment to starboard with waves from 45 deg to port, over force and length",
            bounds=lambda _: (-0.2, 0.2),
            bounds_source="a fifth of the force times the length",
        ),
    },
    form={"ahead": 0.25, "turning": 0.02},
    variants=(("force", "direction"),),
    akin=("wind",),
    varies=("force", "direction"),
    sentence=lambda v: f"A steady force of {v['force']}, as of waves from {v['direction']}, acted on the ship",
)
