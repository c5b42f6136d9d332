"""The propeller pushes the stern sideways, where the profile knows of no such force."""

from typing import Any, NamedTuple

import numpy as np

from ..physics.quantities import Force, Lanes, State, Surroundings
from .effect import ForceEffect, Parameter
from .propeller_side_force import unvisited

AT = -0.5
"""Where the propeller stands, forward of midship over L_pp [-]: at the after perpendicular (assumption)."""


USUAL = 0.2
"""Thrust coefficient of usual propellers under way, by which a force that follows the revolutions alone is measured."""


class PropellerWalk(NamedTuple):
    """See the parameters below."""

    share: Lanes
    revolutions: Lanes
    ahead: Lanes


def propeller_walk(state: State, around: Surroundings, found: Any, components: Any, p: Any, e: PropellerWalk) -> Force:
    """Side force as a share [-] of the thrust, positive to starboard, where the propeller stands.

    Blades meet another wake at the top than at the bottom, so that both sides do not cancel; that it grows with the
    thrust is an assumption, which holds about the speeds of service and not astern.  Of a part of it the thrust is that
    of a coefficient that no speed of the ship changes: it follows the revolutions alone.
    """
    propeller = found.propeller
    D_P = propeller.D_P
    turning = (8.0 / np.pi) * USUAL * D_P * D_P * propeller.n * np.abs(propeller.n)
    jet = propeller.jet + e.revolutions * (turning - propeller.jet)
    Y = e.share * (np.pi / 8.0) * p.ship.rho * D_P * D_P * jet
    return Force(X=0.0 * Y, Y=Y, N=(AT + e.ahead) * p.ship.L_pp * Y)


EFFECT = ForceEffect(
    kind="effects.propeller-walk",
    tag="propeller-walk",
    title="side force of the propeller",
    params=PropellerWalk,
    function=propeller_walk,
    cites=(),
    fields={
        "share": Parameter(
            "side force over thrust, positive to starboard",
            bounds=lambda _: (-0.2, 0.2),
            typical=lambda _: 0.05,
            bounds_source="a fifth of the thrust either way",
        ),
        "revolutions": Parameter(
            "part of that force that follows the revolutions squared instead of the thrust",
            bounds=lambda _: (-2.0, 1.5),
            bounds_source="from thrice as steep as the thrust, in its coefficient, to beyond the revolutions alone",
        ),
        "ahead": Parameter(
            "how far ahead of the propeller that force acts over L_pp, as the pressure on the hull about it has it",
            bounds=lambda _: (-0.1, 0.3),
            bounds_source="from behind the rudder to the after body",
        ),
    },
    form={"revolutions": 0.5, "ahead": 0.05},
    akin=("steady-force", "hull-asymmetry"),
    variants=(("share",),),
    rough=True,
    of_parts=("propeller",),
    needs=("propeller.k_0",),
    unvisited=unvisited,
    sentence=lambda v: (
        f"The propeller pushed the stern sideways by {v['share']} of its thrust (positive: to starboard)"
    ),
)
