"""The ship lies deeper, lighter or trimmed, other than the profile has her."""

from typing import NamedTuple

import numpy as np

from ..physics.quantities import Lanes
from .effect import Effect, Parameter


class Loading(NamedTuple):
    """See the parameters below."""

    draught: Lanes
    trim: Lanes
    displacement: Lanes


def loading(values, e):
    """Draught, block coefficient and linear hull derivatives of a ship loaded otherwise.

    d times draught, displacement with it; C_b times displacement.  The derivatives change by the ratios of the
    formulas of Inoue, Hirano & Kijima 1981 for draught and trim (by the stern, over the draught).  All else stays.
    """
    L = values["particulars.L_pp"]
    d = values["particulars.d"]
    c = values["particulars.C_b"] * values["particulars.B"] / L
    k, k_new = 2.0 * d / L, 2.0 * d * e.draught / L
    lift, lift_new = 0.5 * np.pi * k + 1.4 * c, 0.5 * np.pi * k_new + 1.4 * c
    return {
        "particulars.d": d * e.draught,
        "particulars.C_b": values["particulars.C_b"] * e.displacement,
        "hull.Y_v": values["hull.Y_v"] * (lift_new / lift * (1.0 + 0.67 * e.trim)),
        "hull.Y_r": values["hull.Y_r"] * (k_new / k * (1.0 + 0.80 * e.trim)),
        "hull.N_v": values["hull.N_v"] * (k_new / k * (1.0 - 0.27 * e.trim * lift_new / k_new)),
        "hull.N_r": values["hull.N_r"] * ((0.54 * k_new - k_new**2) / (0.54 * k - k**2) * (1.0 + 0.30 * e.trim)),
    }


_WORDS = {
    "draught": "{} times the draught",
    "trim": "a trim by the stern of {} of the draught",
    "displacement": "{} times the displacement",
}

EFFECT = Effect(
    kind="effects.loading",
    tag="loading",
    title="draught and trim",
    place="coefficients",
    params=Loading,
    function=loading,
    cites=("Inoue, Hirano & Kijima 1981, International Shipbuilding Progress 28, 112-125",),
    fields={
        "draught": Parameter(
            "draught over the profile's",
            low=0.0,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.6, 1.4),
            typical=lambda _: 0.05,
            bounds_source="from ballast to overloaded",
        ),
        "trim": Parameter(
            "trim by the stern over the draught",
            low=-1.0,
            high=1.0,
            bounds=lambda _: (-0.5, 0.5),
            typical=lambda _: 0.1,
            bounds_source="half the draught",
        ),
        "displacement": Parameter(
            "factor on the displacement at that draught",
            low=0.0,
            high=3.0,
            null=1.0,
            bounds=lambda _: (0.6, 1.4),
            typical=lambda _: 0.05,
            bounds_source="as for the draught",
        ),
    },
    variants=(("draught",), ("trim",), ("displacement",)),
    sentence=lambda v: (
        "The ship was loaded otherwise than the profile says: "
        + ", ".join(_WORDS[name].format(v[name]) for name in _WORDS if name in v)
    ),
    needs=("hull.Y_v", "hull.Y_r", "hull.N_v", "hull.N_r"),
)
