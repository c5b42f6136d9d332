"""A side force and a yaw moment that act all the time, whatever the ship does."""

from typing import Any, NamedTuple

from ..physics.quantities import Force, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter
from .signs import each


class SteadyForce(NamedTuple):
    """See the parameters below."""

    side: Lanes
    moment: Lanes


def steady_force(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: SteadyForce) -> Force:
    """Side force [N] and yaw moment [N m] about midship, constant in the ship's axes: of a thruster left on, of a tow.

    No force ahead, which trials do not tell from a resistance that is off.
    """
    nothing = 0.0 * state.u
    return Force(X=nothing, Y=nothing + e.side, N=nothing + e.moment)


_WORDS = {"side": "side force of {}", "moment": "yaw moment of {}"}

EFFECT = ForceEffect(
    kind="effects.steady-force",
    tag="steady-force",
    title="steady force on the ship",
    params=SteadyForce,
    function=steady_force,
    cites=(),
    fields={
        "side": Parameter(
            "force to starboard",
            "N",
            bounds=lambda ship: (-0.03 * ship.force, 0.03 * ship.force),
            typical=lambda ship: 0.002 * ship.force,
            bounds_source="about twice the resistance going straight",
        ),
        "moment": Parameter(
            "moment about midship, bow to starboard",
            "N m",
            bounds=lambda ship: (-0.01 * ship.force * ship.L, 0.01 * ship.force * ship.L),
            typical=lambda ship: 0.0004 * ship.force * ship.L,
            bounds_source="that of a rudder at about ten degrees",
        ),
    },
    akin=("hull-asymmetry", "propeller-walk", "propeller-side-force"),
    variants=(("side", "moment"),),
    sentence=lambda v: (
        "A steady "
        + each(_WORDS, v, ("to starboard", "to port"))
        + " acted on the ship, as of a thruster left on or a tow"
    ),
)
