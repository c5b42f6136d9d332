"""Propellers."""

from __future__ import annotations

from ..physics.propeller.four_quadrant import FourQuadrantPropeller, four_quadrant_propeller
from ..physics.propeller.open_water import OpenWaterPropeller, open_water_propeller
from ..physics.propeller.reversible import ReversiblePropeller, reversible_propeller
from .component import Component, Field
from .sources import MIYAUCHI, OKUDA, SUYAMA, YASUKAWA

FOUR_QUADRANT_PROPELLER = Component(
    kind="propeller",
    tag="four-quadrant",
    title="polynomials of the hydrodynamic pitch angle, with side force and moment",
    params=FourQuadrantPropeller,
    function=four_quadrant_propeller,
    cites=(SUYAMA, OKUDA),
    fields={
        "D_P": Field("diameter", "m", low=0.0, high=20.0),
        "t_P": Field("thrust deduction fraction", low=-1.0, high=1.0),
        "K_T0": Field("thrust coefficient, constant term", low=0.0),
        "K_T1": Field("thrust coefficient, phi_P term", "1/deg"),
        "K_T2": Field("thrust coefficient, phi_P^2 term", "1/deg^2"),
        "K_T3": Field("thrust coefficient, phi_P^3 term", "1/deg^3"),
        "C_PY0": Field("side force coefficient, constant term"),
        "C_PY1": Field("side force coefficient, phi_P term", "1/deg"),
        "C_PY2": Field("side force coefficient, phi_P^2 term", "1/deg^2"),
        "C_PN0_low": Field("yaw moment coefficient below phi_switch, constant term"),
        "C_PN1_low": Field("yaw moment coefficient below phi_switch, phi_P term", "1/deg"),
        "C_PN0_high": Field("yaw moment coefficient from phi_switch, constant term"),
        "C_PN1_high": Field("yaw moment coefficient from phi_switch, phi_P term", "1/deg"),
        "phi_switch": Field("pitch angle where the yaw moment changes polynomial", "deg", default=20.0),
        "phi_min": Field("lower end of the range of the polynomials", "deg", low=-180.0, high=180.0),
        "phi_max": Field("upper end of the range of the polynomials", "deg", low=-180.0, high=180.0),
        "slipstream_kt": Field(
            "thrust coefficient in the rudder's slipstream",
            default=0.0,
            choices={"converted": 0.0, "as-printed": 1.0},
        ),
    },
)

OPEN_WATER_PROPELLER = Component(
    kind="propeller",
    tag="open-water",
    title="thrust coefficient quadratic in the advance ratio",
    params=OpenWaterPropeller,
    function=open_water_propeller,
    cites=(YASUKAWA,),
    fields={
        "D_P": Field("diameter", "m", low=0.0, high=20.0),
        "t_P": Field("thrust deduction fraction", low=-1.0, high=1.0),
        "k_0": Field("thrust coefficient at J = 0", low=0.0),
        "k_1": Field("thrust coefficient, J term"),
        "k_2": Field("thrust coefficient, J^2 term"),
    },
)

_SIDEWAYS = (
    "revolutions astern, J_S from -0.35 to -0.06, constant term",
    "revolutions astern, J_S from -0.35 to -0.06, J_S term",
    "revolutions astern, J_S below -0.35, constant term",
    "revolutions astern, J_S below -0.35, J_S term",
    "revolutions astern, J_S above -0.06",
    "ship astern and revolutions ahead, J_S^2 term",
    "ship astern and revolutions ahead, J_S term",
    "ship astern and revolutions ahead, constant term",
)

REVERSIBLE_PROPELLER = Component(
    kind="propeller",
    tag="reversible",
    title="either way of turning on a ship that moves either way, with side force",
    params=ReversiblePropeller,
    function=reversible_propeller,
    cites=(
        MIYAUCHI,
        "Hachii 2004, cited there for revolutions astern",
        "Ueno, Nimura & Miyazaki 2001, cited there for the ship astern with revolutions ahead",
    ),
    fields={
        "D_P": Field("diameter", "m", low=0.0, high=20.0),
        "pitch_": Field("pitch over diameter", low=0.0, high=5.0),
        "t_P": Field("thrust deduction fraction, revolutions ahead", low=-1.0, high=1.0),
        "k_0": Field("thrust coefficient at J = 0, revolutions ahead", low=0.0),
        "k_1": Field("thrust coefficient, J term, revolutions ahead"),
        "k_2": Field("thrust coefficient, J^2 term, revolutions ahead"),
        "J_max": Field("largest size of an advance ratio", default=1.5, low=0.0),
        **{f"A_{i}": Field(f"side force, {where}") for i, where in enumerate(_SIDEWAYS, start=1)},
        **{f"B_{i}": Field(f"yaw moment, {where}") for i, where in enumerate(_SIDEWAYS, start=1)},
        "C_3": Field("surge force, revolutions astern, J_S below C_10"),
        "C_6": Field("surge force, revolutions astern, J_S from C_10 on, constant term"),
        "C_7": Field("surge force, revolutions astern, J_S from C_10 on, J_S term"),
        "C_10": Field("advance ratio between the two, revolutions astern"),
    },
)

PROPELLERS = (FOUR_QUADRANT_PROPELLER, OPEN_WATER_PROPELLER, REVERSIBLE_PROPELLER)

ASTERN = (REVERSIBLE_PROPELLER.tag,)
"""Propellers whose equations hold for revolutions astern."""
