"""The propeller gives more or less thrust than the profile's open-water curve has it."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.quantities import Lanes
from .effect import CoefficientsEffect, factor_about_one

CURVE = ("K_T0", "K_T1", "K_T2", "K_T3", "k_0", "k_1", "k_2", "C_3", "C_6", "C_7")
"""Coefficients of thrust, of whatever propeller it is; astern too."""


class Thrust(NamedTuple):
    """See the parameters below."""

    factor: Lanes


def thrust(values: Mapping[str, Lanes], e: Thrust) -> dict[str, Lanes]:
    """Coefficients of the thrust, all by one factor [-], as of a propeller that is fouled, damaged or another one.

    The slipstream that the rudder stands in changes with it; side force and moment of the propeller stay.
    """
    return {
        name: value * e.factor
        for name, value in values.items()
        if name.startswith("propeller") and name.rpartition(".")[2] in CURVE
    }


EFFECT = CoefficientsEffect(
    kind="effects.thrust",
    tag="thrust",
    title="thrust of the propeller",
    told_by="thrust and torque, logged at the shaft",
    params=Thrust,
    function=thrust,
    cites=(),
    fields={"factor": factor_about_one("thrust over that of the profile's propeller", 0.5, 0.05, "half as much again")},
    variants=(("factor",),),
    varies=("factor",),
    akin=("rpm-scale", "engine-droop"),
    sentence=lambda v: f"The propeller gave {v['factor']} times the thrust that the profile has for it",
)
