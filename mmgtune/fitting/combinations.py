"""Combinations of coefficients that a motion can tell although it cannot tell their members.

Which directions of the coefficients leave the motion unchanged is found numerically from the data.  The list below
only offers names: a combination is reported where it is constant along every such direction, and not otherwise.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Combination:
    """An expression in the field's symbols, the coefficients it needs, and its value from theirs."""

    expression: str
    needs: tuple[str, ...]
    value: Callable[[Mapping[str, float]], float]


COMBINATIONS = (
    Combination(
        "(1 - t_R) eps^2", ("rudder.t_R", "rudder.eps"), lambda c: (1.0 - c["rudder.t_R"]) * c["rudder.eps"] ** 2
    ),
    Combination(
        "(1 + a_H) eps^2", ("rudder.a_H", "rudder.eps"), lambda c: (1.0 + c["rudder.a_H"]) * c["rudder.eps"] ** 2
    ),
    Combination(
        "(x_R' + a_H x_H') eps^2",
        ("rudder.x_R_", "rudder.a_H", "rudder.x_H_", "rudder.eps"),
        lambda c: (c["rudder.x_R_"] + c["rudder.a_H"] * c["rudder.x_H_"]) * c["rudder.eps"] ** 2,
    ),
    Combination(
        "gamma_R(beta_R > 0) / eps", ("rudder.gamma_Rp", "rudder.eps"), lambda c: c["rudder.gamma_Rp"] / c["rudder.eps"]
    ),
    Combination(
        "gamma_R(beta_R < 0) / eps", ("rudder.gamma_Rn", "rudder.eps"), lambda c: c["rudder.gamma_Rn"] / c["rudder.eps"]
    ),
)
"""Of the rudder in a propeller's slipstream: its inflow velocities all scale with eps, its force with their square."""
