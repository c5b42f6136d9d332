"""A hull that is not alike on both sides: going straight, she is pushed aside and turned."""

from typing import Any, NamedTuple

from ..physics.prime import force_unit, moment_unit
from ..physics.quantities import Force, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter
from .signs import each


class HullAsymmetry(NamedTuple):
    """See the parameters below."""

    Y_0: Lanes
    N_0: Lanes


def hull_asymmetry(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: HullAsymmetry) -> Force:
    """Side force and yaw moment about midship in the prime system, which grow with the square of the speed.

    As of a list, a skeg or a stabilizer that is bent, a bilge keel that is lost on one side.
    """
    Y = force_unit(p.ship.rho, p.ship.L_pp, p.ship.d, found.flow.U) * e.Y_0
    N = moment_unit(p.ship.rho, p.ship.L_pp, p.ship.d, found.flow.U) * e.N_0
    return Force(X=0.0 * Y, Y=Y, N=N)


def _coefficient(words: str, size: float) -> Parameter:
    return Parameter(
        words,
        "prime",
        bounds=lambda _: (-20.0 * size, 20.0 * size),
        typical=lambda _: size,
        bounds_source="more than a rudder at ten degrees is",
    )


_WORDS = {"Y_0": "a side force Y_0' of {}", "N_0": "a yaw moment N_0' of {}"}

EFFECT = ForceEffect(
    kind="effects.hull-asymmetry",
    tag="hull-asymmetry",
    title="asymmetry of the hull",
    params=HullAsymmetry,
    function=hull_asymmetry,
    cites=(),
    fields={
        "Y_0": _coefficient("side force without drift and yaw, to starboard", 0.002),
        "N_0": _coefficient("yaw moment without drift and yaw, bow to starboard", 0.0004),
    },
    akin=("steady-force", "propeller-walk", "propeller-side-force"),
    variants=(("Y_0", "N_0"),),
    sentence=lambda v: (
        "The hull is not alike on both sides, as with a list: it has "
        + each(_WORDS, v, ("to starboard", "to port"))
        + " where the ship neither drifts nor turns"
    ),
)
