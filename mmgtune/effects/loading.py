"""The ship lies deeper, lighter or trimmed, other than the profile has her."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from ..physics.elementary import exp, log
from ..physics.quantities import Lanes
from ..physics.regressions.inoue1981 import LinearDerivatives, linear_derivatives
from .effect import CoefficientsEffect, Parameter, factor_about_one


class Loading(NamedTuple):
    """See the parameters below."""

    draught: Lanes
    trim: Lanes
    displacement: Lanes
    Y_v: Lanes
    Y_r: Lanes
    N_v: Lanes
    N_r: Lanes
    inertia: Lanes


def loading(values: Mapping[str, Lanes], e: Loading) -> dict[str, Lanes]:
    """Draught, block coefficient and linear hull derivatives of a ship loaded otherwise.

    d times draught, displacement with it; C_b times displacement.  The derivatives change by the ratios of the
    formulas of Inoue, Hirano & Kijima 1981 for draught and trim (by the stern, over the draught).  They may change
    more or less than these have it, and so may the added masses, of which these say nothing: by the exponential of a
    power times log draught + trim.  All else stays.
    """
    L, B, d, C_b = (values[f"particulars.{name}"] for name in ("L_pp", "B", "d", "C_b"))
    before = linear_derivatives(L, B, d, C_b, 0.0)
    after = linear_derivatives(L, B, d * e.draught, C_b, e.trim)
    change = log(e.draught) + e.trim
    inertia = exp(e.inertia * change)
    return {
        "particulars.d": d * e.draught,
        "particulars.C_b": C_b * e.displacement,
        **{name: values[name] * inertia for name in ("particulars.m_y_", "particulars.J_zz_")},
        **{
            f"hull.{name}": values[f"hull.{name}"] * (new / old) * exp(getattr(e, name) * change)
            for name, old, new in zip(LinearDerivatives._fields, before, after, strict=True)
        },
    }


def _power(of: str) -> Parameter:
    """How much more than the formulas have it something changes."""
    return Parameter(
        f"power by which {of} changes with draught and trim beyond the formulas",
        bounds=lambda _: (-1.5, 1.5),
        bounds_source="a choice: beyond it another effect is at work",
    )


_WORDS = {
    "draught": "{} times the draught",
    "trim": "a trim by the stern of {} of the draught",
    "displacement": "{} times the displacement",
}

EFFECT = CoefficientsEffect(
    kind="effects.loading",
    tag="loading",
    title="draught and trim",
    told_by="the draughts fore and aft, read from the marks",
    params=Loading,
    function=loading,
    cites=("Inoue, Hirano & Kijima 1981, International Shipbuilding Progress 28, 112-125",),
    fields={
        "draught": factor_about_one("draught over the profile's", 0.4, 0.05, "from ballast to overloaded"),
        "trim": Parameter(
            "trim by the stern over the draught",
            low=-1.0,
            high=1.0,
            bounds=lambda _: (-0.5, 0.5),
            typical=lambda _: 0.1,
            bounds_source="half the draught",
        ),
        "displacement": replace(
            factor_about_one("factor on the displacement at that draught", 0.4, 0.05, "as for the draught"),
            of_run=lambda _: (0.75, 1.25),  # of one hull trim and the density of the water change it, by far less
        ),
        **{name: _power(name) for name in LinearDerivatives._fields},
        "inertia": _power("the added mass in sway and the added moment of inertia in yaw"),
    },
    form={**dict.fromkeys(LinearDerivatives._fields, 0.5), "inertia": 0.5},
    variants=(("draught",), ("trim",), ("displacement",)),
    varies=("draught", "trim", "displacement"),
    subject="loading",
    rough=True,
    akin=("shallow-water",),
    sentence=lambda v: (
        "The ship was loaded otherwise than the profile says: "
        + ", ".join(_WORDS[name].format(v[name]) for name in _WORDS if name in v)
    ),
    needs=("hull.Y_v", "hull.Y_r", "hull.N_v", "hull.N_r"),
)
