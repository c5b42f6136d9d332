"""Side force and yaw moment of the propeller differ from the profile's."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import CoefficientsEffect, Parameter


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


EFFECT = CoefficientsEffect(
    kind="effects.propeller-side-force",
    tag="propeller-side-force",
    title="side force of the propeller",
    params=PropellerSideForce,
    function=propeller_side_force,
    cites=(),
    fields={"force": _factor("side force"), "moment": _factor("yaw moment")},
    variants=(("force", "moment"),),
    sentence=lambda v: (
        f"The propeller pushed the stern sideways by {v['force']} times the profile's force"
        f" and {v['moment']} times its moment"
    ),
    needs=("propeller.C_PY0",),
)
