"""Mean drift force of waves, constant in the earth frame."""

from typing import Any, NamedTuple

import numpy as np

from ..physics.frame import to_ship
from ..physics.quantities import Force, Forces, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter


class WaveDrift(NamedTuple):
    """See the parameters below."""

    force: Lanes
    direction: Lanes


def wave_drift(state: State, around: Surroundings, found: Forces, components: Any, p: Any, e: WaveDrift) -> Force:
    """Force [N] along one line over ground, at midship, without a moment (assumption: whatever the ship's heading)."""
    ahead, starboard = to_ship(state.psi - e.direction, -e.force, 0.0)
    return Force(X=ahead, Y=starboard, N=0.0 * ahead)


EFFECT = ForceEffect(
    kind="effects.wave-drift",
    tag="wave-drift",
    title="drift force of waves",
    params=WaveDrift,
    function=wave_drift,
    cites=(),
    fields={
        "force": Parameter(
            "mean force",
            "N",
            low=-1e-12,
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
    },
    variants=(("force", "direction"),),
    varies=("force", "direction"),
    sentence=lambda v: f"A steady force of {v['force']}, as of waves from {v['direction']}, acted on the ship",
)
