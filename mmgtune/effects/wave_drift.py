"""Mean drift force of waves, constant in the earth frame."""

from typing import NamedTuple

import numpy as np

from ..physics.elementary import cos, sin
from ..physics.quantities import Force, Lanes
from .effect import Effect, Parameter


class WaveDrift(NamedTuple):
    """See the parameters below."""

    force: Lanes
    direction: Lanes


def wave_drift(state, air, found, components, p, e):
    """Force [N] along one line over ground, at midship, without a moment (assumption: whatever the ship's heading)."""
    angle = state.psi - e.direction
    zero = 0.0 * angle
    return Force(X=-e.force * cos(angle), Y=e.force * sin(angle), N=zero)


EFFECT = Effect(
    kind="effects.wave-drift",
    tag="wave-drift",
    title="drift force of waves",
    place="force",
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
    sentence=lambda v: f"A steady force of {v['force']}, as of waves from {v['direction']}, acted on the ship",
)
