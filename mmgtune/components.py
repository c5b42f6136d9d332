"""What a ship model can be put together from: components by kind and tag, with the meaning of every coefficient.

A component is a tuple of coefficients, one pure function of ``mmgtune.physics`` and the facts below.  A new
hull, wake, propeller or rudder is one new file there and one entry here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from .physics.hull.cubic import CubicHull, cubic_hull
from .physics.propeller.four_quadrant import FourQuadrantPropeller, four_quadrant_propeller
from .physics.propeller.open_water import OpenWaterPropeller, open_water_propeller
from .physics.quantities import AboveWater, Ship
from .physics.rudder.flapped import FlappedRudder, flapped_rudder
from .physics.rudder.plain import PlainRudder, plain_rudder
from .physics.wake.asymmetric import AsymmetricWake, asymmetric_wake
from .physics.wake.exponential import ExponentialWake, exponential_wake


@dataclass(frozen=True)
class Field:
    """One coefficient of a component.

    label    what it is, in words
    unit     SI unit, "-" for a pure number, "prime" for the prime system of the MMG standard method
    default  value where a profile leaves it out; None if the profile must give it
    low, high  impossible at or beyond these (exclusive), None where anything goes
    choices  words a profile may write instead of the number each stands for
    table    0 for a number; else the number of values of a table
    """

    label: str
    unit: str = "-"
    default: float | None = None
    low: float | None = None
    high: float | None = None
    choices: dict[str, float] = field(default_factory=dict)
    table: int = 0


@dataclass(frozen=True)
class Component:
    """A kind of force (or the ship itself), the tag profiles name it by, its function and its coefficients."""

    kind: str
    tag: str
    title: str
    params: type[Any]
    fields: dict[str, Field]
    function: Callable[..., Any] | None
    cites: tuple[str, ...]

    def __post_init__(self) -> None:
        if tuple(self.fields) != self.params._fields:
            raise TypeError(f"{self.kind} '{self.tag}': fields {tuple(self.fields)} are not {self.params._fields}")


SUYAMA = "Suyama et al. 2023, arXiv:2312.04224"
OKUDA = "Okuda et al. 2023, Applied Ocean Research 135, 103567"
YASUKAWA = "Yasukawa & Yoshimura 2015, J. Marine Science and Technology 20, 37-52"

SHIP = Component(
    kind="particulars",
    tag="ship",
    title="principal particulars and inertia",
    params=Ship,
    function=None,
    cites=(SUYAMA, YASUKAWA),
    fields={
        "rho": Field("density of water", "kg/m^3", default=1025.0, low=0.0, high=2000.0),
        "L_pp": Field("length between perpendiculars", "m", low=0.0, high=1000.0),
        "B": Field("breadth", "m", low=0.0, high=200.0),
        "d": Field("draught", "m", low=0.0, high=50.0),
        "C_b": Field("block coefficient", low=0.0, high=1.0),
        "x_G": Field("centre of gravity, forward of midship", "m"),
        "k_zz_": Field("radius of gyration about the centre of gravity, over L_pp", low=0.0, high=1.0),
        "m_x_": Field("added mass in surge", "prime", low=0.0),
        "m_y_": Field("added mass in sway", "prime", low=0.0),
        "J_zz_": Field("added moment of inertia in yaw", "prime", low=0.0),
    },
)

CUBIC_HULL = Component(
    kind="hull",
    tag="cubic",
    title="polynomial of the MMG standard method",
    params=CubicHull,
    function=cubic_hull,
    cites=(SUYAMA, YASUKAWA),
    fields={
        "R_0": Field("resistance going straight", "prime", low=0.0),
        **{
            name: Field(f"{force}, {term} term", "prime", default=0.0)
            for force, symbol, terms in (
                ("surge force", "X", ("vv", "vr", "rr", "vvvr", "vvvv")),
                ("sway force", "Y", ("v", "r", "vvv", "vvr", "vrr", "rrr")),
                ("yaw moment", "N", ("v", "r", "vvv", "vvr", "vrr", "rrr")),
            )
            for term in terms
            for name in (f"{symbol}_{term}",)
        },
    },
)

EXPONENTIAL_WAKE = Component(
    kind="wake",
    tag="exponential",
    title="wake fading with the inflow angle squared",
    params=ExponentialWake,
    function=exponential_wake,
    cites=(SUYAMA, OKUDA),
    fields={
        "w_P0": Field("wake fraction at zero inflow angle", low=-1.0, high=1.0),
        "C_w": Field("fading of the wake with the inflow angle squared", "1/rad^2", high=1e-12),
        "l_P_": Field("longitudinal position of the propeller, over L_pp", low=-1.0, high=1.0),
    },
)

ASYMMETRIC_WAKE = Component(
    kind="wake",
    tag="asymmetric",
    title="wake with different values for inflow from either side",
    params=AsymmetricWake,
    function=asymmetric_wake,
    cites=(YASUKAWA,),
    fields={
        "w_P0": Field("wake fraction at zero inflow angle", low=-1.0, high=1.0),
        "C_1": Field("rate of change of the wake with the inflow angle", "1/rad", low=-1e-12),
        "C_2p": Field("end value of (1-w_P)/(1-w_P0), inflow angle positive", low=0.0),
        "C_2n": Field("end value of (1-w_P)/(1-w_P0), inflow angle negative", low=0.0),
        "x_P_": Field("longitudinal position of the propeller, over L_pp", low=-1.0, high=1.0),
    },
)

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
        "K_T0": Field("thrust coefficient, constant term"),
        "K_T1": Field("thrust coefficient, phi_P term", "1/deg"),
        "K_T2": Field("thrust coefficient, phi_P^2 term", "1/deg^2"),
        "K_T3": Field("thrust coefficient, phi_P^3 term", "1/deg^3"),
        "C_PY0": Field("side force coefficient, constant term", default=0.0),
        "C_PY1": Field("side force coefficient, phi_P term", "1/deg", default=0.0),
        "C_PY2": Field("side force coefficient, phi_P^2 term", "1/deg^2", default=0.0),
        "C_PN0_low": Field("yaw moment coefficient below phi_switch, constant term", default=0.0),
        "C_PN1_low": Field("yaw moment coefficient below phi_switch, phi_P term", "1/deg", default=0.0),
        "C_PN0_high": Field("yaw moment coefficient from phi_switch, constant term", default=0.0),
        "C_PN1_high": Field("yaw moment coefficient from phi_switch, phi_P term", "1/deg", default=0.0),
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
        "k_0": Field("thrust coefficient at J = 0"),
        "k_1": Field("thrust coefficient, J term"),
        "k_2": Field("thrust coefficient, J^2 term"),
    },
)

_RUDDER_GEOMETRY = {
    "A_R": Field("rudder area", "m^2", low=0.0, high=500.0),
    "H_R": Field("rudder span", "m", low=0.0, high=30.0),
    "x_R_": Field("longitudinal position of the rudder, over L_pp", low=-1.0, high=1.0),
    "t_R": Field("steering resistance deduction", low=-2.0, high=1.0),
    "a_H": Field("increase of the rudder force by the hull", low=-1.0, high=3.0),
    "x_H_": Field("position of that increase, over L_pp", low=-3.0, high=3.0),
    "eps": Field("wake ratio between propeller and rudder position", low=0.0),
    "kappa": Field("propeller race acceleration", low=-1e-12),
}
_RUDDER_INFLOW = {
    "l_R_": Field("effective position of the rudder in yaw, over L_pp", low=-5.0, high=5.0),
    "gamma_Rp": Field("flow straightening, effective drift angle positive", low=-1e-12),
    "gamma_Rn": Field("flow straightening, effective drift angle negative", low=-1e-12),
}

FLAPPED_RUDDER = Component(
    kind="rudder",
    tag="flapped",
    title="rudder with a linked flap",
    params=FlappedRudder,
    function=flapped_rudder,
    cites=(SUYAMA, OKUDA),
    fields={
        **_RUDDER_GEOMETRY,
        "u_R0": Field("inflow from the propeller at bollard condition", default=0.0, low=-1e-12),
        **_RUDDER_INFLOW,
        "f_a0": Field("normal force gradient, flap amidships", "1/rad", low=0.0),
        "f_a2": Field("normal force gradient, flap angle squared term", "1/rad^3"),
        "c_l01": Field("lift at zero inflow angle, flap angle term", "1/rad"),
        "c_l03": Field("lift at zero inflow angle, flap angle cubed term", "1/rad^3"),
        "flap_step": Field("rudder angle between the values of the flap table", "rad", low=0.0, high=1.6),
        "flap": Field("flap angle at rudder angle 0, 1, 2, ... flap_step", "rad", table=10),
    },
)

PLAIN_RUDDER = Component(
    kind="rudder",
    tag="plain",
    title="rudder without a flap",
    params=PlainRudder,
    function=plain_rudder,
    cites=(YASUKAWA,),
    fields={
        **_RUDDER_GEOMETRY,
        **_RUDDER_INFLOW,
        "f_alpha": Field("normal force gradient", "1/rad", low=0.0),
    },
)

ABOVE_WATER = Component(
    kind="above_water",
    tag="above_water",
    title="geometry above the water",
    params=AboveWater,
    function=None,
    cites=("Fujiwara, Ueno & Nimura 1998, J. Society of Naval Architects of Japan 183, 77-90",),
    fields={
        "A_T": Field("frontal area", "m^2", low=0.0, high=10000.0),
        "A_L": Field("lateral area", "m^2", low=0.0, high=30000.0),
        "A_OD": Field("lateral area of superstructure and deck cargo", "m^2", low=0.0, high=30000.0),
        "C": Field("centroid of the lateral area, forward of midship", "m"),
        "C_BR": Field("centroid of the superstructure, forward of midship", "m"),
        "H_BR": Field("top of the bridge above the waterline", "m", low=0.0, high=150.0),
        "H_C": Field("centroid of the lateral area above the waterline", "m", low=0.0, high=100.0),
    },
)

COMPONENTS = (
    SHIP,
    CUBIC_HULL,
    EXPONENTIAL_WAKE,
    ASYMMETRIC_WAKE,
    FOUR_QUADRANT_PROPELLER,
    OPEN_WATER_PROPELLER,
    FLAPPED_RUDDER,
    PLAIN_RUDDER,
    ABOVE_WATER,
)
"""Every component there is, in the order documentation lists them."""

KINDS = ("particulars", "hull", "wake", "propeller", "rudder")
"""The kinds a model needs one of each, in the order of ``physics.mmg.Coefficients``."""

UNTAGGED = {"particulars": SHIP, "above_water": ABOVE_WATER}
"""Kinds of which there is only one component, so that a profile names no model."""


def split_name(name: str) -> tuple[str, str]:
    """Section and symbol of "hull.Y_v" or "effects.current.north"."""
    section, _, symbol = name.rpartition(".")
    return section, symbol


def tags(kind: str) -> tuple[str, ...]:
    """The tags a profile may name for one kind of component."""
    return tuple(component.tag for component in COMPONENTS if component.kind == kind)


def find(kind: str, tag: str) -> Component | None:
    """The component of that kind and tag, None if there is none."""
    for component in COMPONENTS:
        if (component.kind, component.tag) == (kind, tag):
            return component
    return None
