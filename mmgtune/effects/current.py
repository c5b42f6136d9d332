"""Water that moves over ground, uniform and steady."""

from typing import NamedTuple

from ..physics.elementary import cos, sin
from ..physics.quantities import Lanes
from .effect import Effect, Parameter


class Current(NamedTuple):
    """See the parameters below."""

    north: Lanes
    east: Lanes


def current(state, air, e):
    """Velocity of the water in the ship's axes: surge and sway [m/s].

    With velocities through water, and for a current that is constant in the earth frame, the equations of motion hold
    unchanged (Mathioudakis et al., eq. 9).
    """
    cos_psi = cos(state.psi)
    sin_psi = sin(state.psi)
    return cos_psi * e.north + sin_psi * e.east, cos_psi * e.east - sin_psi * e.north


def _component(direction: str) -> Parameter:
    return Parameter(
        f"velocity of the water, {direction}",
        "m/s",
        bounds=lambda ship: (-0.6 * ship.U, 0.6 * ship.U),
        typical=lambda ship: 0.05 * ship.U,
        bounds_source="six tenths of the approach speed",
    )


EFFECT = Effect(
    kind="effects.current",
    tag="current",
    title="current",
    place="flow",
    params=Current,
    function=current,
    cites=("Mathioudakis et al., FAM, eq. 9",),
    fields={"north": _component("north"), "east": _component("east")},
    variants=(("north", "east"),),
    sentence=lambda v: f"The trials were run in a current of {v['speed']} setting towards {v['towards']}",
)
