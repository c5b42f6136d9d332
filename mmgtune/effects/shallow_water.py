"""Water so shallow that the flow around the hull changes."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.quantities import Lanes
from ..physics.regressions.kijima1990 import shallow_ratios
from .effect import CoefficientsEffect, Parameter


class ShallowWater(NamedTuple):
    """See the parameters below."""

    depth: Lanes


def shallow_water(values: Mapping[str, Lanes], e: ShallowWater) -> dict[str, Lanes]:
    """Linear hull derivatives in water of depth [m].

    Added masses, wake and rudder are left as they are (assumption).
    """
    L, B, d, C_b = (values[f"particulars.{name}"] for name in ("L_pp", "B", "d", "C_b"))
    ratios = shallow_ratios(L, B, d, C_b, e.depth)
    return {f"hull.{name}": values[f"hull.{name}"] * ratio for name, ratio in ratios._asdict().items()}


EFFECT = CoefficientsEffect(
    kind="effects.shallow-water",
    tag="shallow-water",
    title="shallow water",
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
