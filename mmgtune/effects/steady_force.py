"""A force and a yaw moment that act all the time, whatever the ship does."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from ..physics.quantities import Force, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter
from .signs import signed


class SteadyForce(NamedTuple):
    """See the parameters below."""

    ahead: Lanes
    side: Lanes
    moment: Lanes


def steady_force(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: SteadyForce) -> Force:
    """Force ahead, side force [N] and yaw moment [N m] about midship, constant in the ship's axes: of a tow, of a chain
    that drags, of a thruster left on.

    At one speed a force ahead is a resistance that is off; as she slows down in a turn it stays what it was.
    """
    nothing = 0.0 * state.u
    return Force(X=nothing + e.ahead, Y=nothing + e.side, N=nothing + e.moment)


_WORDS = {
    "ahead": ("force of {}", "ahead", "astern"),
    "side": ("side force of {}", "to starboard", "to port"),
    "moment": ("yaw moment of {}", "to starboard", "to port"),
}


def _sentence(v: Mapping[str, str]) -> str:
    pushes = " and ".join(words.format(signed(v[name], *ways)) for name, (words, *ways) in _WORDS.items() if name in v)
    thing = "a thruster left on or a tow" if "side" in v else "a tow or a chain that drags"
    return f"A steady {pushes} acted on the ship, as of {thing}"


def _force(way: str) -> Parameter:
    return Parameter(
        f"force {way}",
        "N",
        bounds=lambda ship: (-0.03 * ship.force, 0.03 * ship.force),
        typical=lambda ship: 0.002 * ship.force,
        bounds_source="about twice the resistance going straight",
    )


EFFECT = ForceEffect(
    kind="effects.steady-force",
    tag="steady-force",
    title="steady force on the ship",
    params=SteadyForce,
    function=steady_force,
    cites=(),
    fields={
        "ahead": _force("ahead"),
        "side": _force("to starboard"),
        "moment": Parameter(
            "moment about midship, bow to starboard",
            "N m",
            bounds=lambda ship: (-0.01 * ship.force * ship.L, 0.01 * ship.force * ship.L),
            typical=lambda ship: 0.0004 * ship.force * ship.L,
            bounds_source="that of a rudder at about ten degrees",
        ),
    },
    akin=("hull-asymmetry", "propeller-walk", "propeller-side-force"),
    variants=(("side", "moment"), ("ahead",)),
    sentence=_sentence,
)
