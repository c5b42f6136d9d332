"""Side force and yaw moment of the propeller differ from the profile's."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import CoefficientsEffect, Parameter
from .visited import Visited

LOADS = 0.1
"""Share by which u / n must vary: at one load of the propeller its side force is any steady force."""


class PropellerSideForce(NamedTuple):
    """See the parameters below."""

    force: Lanes
    moment: Lanes


def propeller_side_force(values: Mapping[str, Lanes], e: PropellerSideForce) -> dict[str, Lanes]:
    """The profile's side force polynomial times ``force``, its yaw moment polynomials times ``moment``."""
    factors = {"propeller.C_PY": e.force, "propeller.C_PN": e.moment}
    return {name: value * factors[name[:14]] for name, value in values.items() if name[:14] in factors}


def _factor(what: str) -> Parameter:
    return Parameter(
        f"{what} over the profile's",
        low=-10.0,
        high=10.0,
        null=1.0,
        bounds=lambda _: (-1.0, 3.0),
        typical=lambda _: 0.4,
        bounds_source="from the opposite to three times",
    )


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """More than one load of the propeller."""
    if visited.varies(visited.advance) > LOADS:
        return ""
    return f"loads of the propeller (u/n) that differ by {100.0 * LOADS:.0f} %, as in a tight turn or at other speeds"


EFFECT = CoefficientsEffect(
    kind="effects.propeller-side-force",
    tag="propeller-side-force",
    title="side force of the propeller",
    params=PropellerSideForce,
    function=propeller_side_force,
    cites=(),
    fields={"force": _factor("side force"), "moment": _factor("yaw moment")},
    akin=("steady-force", "hull-asymmetry"),
    variants=(("force", "moment"),),
    unvisited=unvisited,
    sentence=lambda v: (
        f"The propeller pushed the stern sideways by {v['force']} times the profile's force"
        f" and {v['moment']} times its moment"
    ),
    needs=("propeller.C_PY0",),
)
