"""Water so shallow that the flow around the hull changes."""

from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import Effect, Parameter


class ShallowWater(NamedTuple):
    """See the parameters below."""

    depth: Lanes


def shallow_water(values, e):
    """Linear hull derivatives in water of depth [m]: Kijima et al. 1990, h = d / depth.

    Y_v, N_v, N_r times (1 - h)^-n - h with n = 0.40, 0.425 C_b B/d and 1.5 - 14.28 d/L; Y_r times a cubic in h.
    The exponent of N_v is from memory of the paper.  Added masses, wake and rudder are left as they are (assumption);
    not validated below depth / draught = 1.2.
    """
    d = values["particulars.d"]
    fullness = values["particulars.C_b"] * values["particulars.B"] / d
    h = d / e.depth
    a_1 = -5.5 * fullness**2 + 26.0 * fullness - 31.5
    a_2 = 37.0 * fullness**2 - 185.0 * fullness + 230.0
    a_3 = -38.0 * fullness**2 + 197.0 * fullness - 250.0

    def deep_to_shallow(n):
        return (1.0 - h) ** -n - h

    return {
        "hull.Y_v": values["hull.Y_v"] * deep_to_shallow(0.40 * fullness),
        "hull.N_v": values["hull.N_v"] * deep_to_shallow(0.425 * fullness),
        "hull.N_r": values["hull.N_r"] * deep_to_shallow(1.5 - 14.28 * d / values["particulars.L_pp"]),
        "hull.Y_r": values["hull.Y_r"] * (1.0 + h * (a_1 + h * (a_2 + h * a_3))),
    }


EFFECT = Effect(
    kind="effects.shallow-water",
    tag="shallow-water",
    title="shallow water",
    place="coefficients",
    params=ShallowWater,
    function=shallow_water,
    cites=("Kijima et al. 1990, J. Society of Naval Architects of Japan 168, 247-256",),
    fields={
        "depth": Parameter(
            "depth of the water",
            "m",
            null=float("inf"),
            low=0.0,
            chart="reciprocal",
            bounds=lambda ship: (0.0, 1.0 / (1.2 * ship.d)),
            typical=lambda ship: 0.3 / ship.d,
            bounds_source="formula valid down to a depth of 1.2 draughts",
        )
    },
    variants=(("depth",),),
    sentence=lambda v: f"The ship sailed in shallow water, as if {v['depth']} deep",
    needs=("hull.Y_v", "hull.Y_r", "hull.N_v", "hull.N_r"),
)
