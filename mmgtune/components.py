"""What a ship model can be put together from: components by kind and tag, with the meaning of every coefficient.

A component is a tuple of coefficients, one pure function of ``mmgtune.physics`` and the facts below.  A new
hull, wake, propeller or rudder is one new file there and one entry here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from .displayed import Brief
from .inputs import INPUTS, Input, Role
from .physics.arrangements import single_propeller_single_rudder, single_propeller_twin_rudder
from .physics.hull.cubic import CubicHull, cubic_hull
from .physics.hull.derivatives import DerivativesHull, derivatives_hull
from .physics.hull.unified import UnifiedHull, unified_hull
from .physics.propeller.four_quadrant import FourQuadrantPropeller, four_quadrant_propeller
from .physics.propeller.kang import KangPropeller, kang_propeller
from .physics.propeller.open_water import OpenWaterPropeller, open_water_propeller
from .physics.propeller.reversible import ReversiblePropeller, reversible_propeller
from .physics.quantities import HARMONICS, AboveWater, Ship
from .physics.rudder.flapped import FlappedRudder, flapped_rudder
from .physics.rudder.kang import (
    OneOfTwo,
    RudderPair,
    reaction_of_pair,
    rudder_of_pair_to_port,
    rudder_of_pair_to_starboard,
)
from .physics.rudder.plain import PlainRudder, plain_rudder
from .physics.rudder.reversible import ReversibleRudder, reversible_rudder
from .physics.rudder.slip import SlipRudder, slip_rudder
from .physics.thruster.fading import FadingThruster, fading_thruster
from .physics.wake.asymmetric import AsymmetricWake, asymmetric_wake
from .physics.wake.exponential import ExponentialWake, exponential_wake
from .physics.wake.quadratic import QuadraticWake, quadratic_wake


@dataclass(frozen=True, repr=False)
class Field(Brief):
    """One coefficient of a component.

    label    what it is, in words
    unit     SI unit, "-" for a pure number, "prime" for the prime system of the MMG standard method
    default  value where a profile leaves it out; None if the profile must give it, which holds for every term of a
             force: a term that a source does not have is written as 0
    low, high  impossible at or beyond these (exclusive), None where anything goes
    choices  words a profile may write instead of the number each stands for
    table    0 for a number; else the number of values of a table
    derived  computed from other numbers of the profile where it is left out
    """

    label: str
    unit: str = "-"
    default: float | None = None
    low: float | None = None
    high: float | None = None
    choices: dict[str, float] = field(default_factory=dict)
    table: int = 0
    derived: bool = False


@dataclass(frozen=True, repr=False)
class Component(Brief):
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

    def __reduce__(self) -> tuple[Callable[..., Component | None], tuple[str, ...]]:
        """Pickled by name: functions stay where they are.  Raises TypeError for one that is not in ``COMPONENTS``."""
        if find(self.kind, self.tag) is not self:
            raise TypeError(f"{self.kind} '{self.tag}' is not one of COMPONENTS and cannot be found again")
        return find, (self.kind, self.tag)


@dataclass(frozen=True, repr=False)
class Arrangement(Brief):
    """How components are put together: which a ship has, what drives her, and the function that combines their forces.

    control       NamedTuple of the inputs, each field one of ``inputs.INPUTS``
    components    NamedTuple of the components' functions; its fields are the kinds a profile has besides particulars
    coefficients  NamedTuple of ``ship`` and the same kinds
    breakdown     NamedTuple of what ``forces`` returns: ``flow``, ``hull``, ``total``, and whatever else there is
    forces        forces(State through the water, control, components, coefficients) -> breakdown
    """

    tag: str
    title: str
    control: type[Any]
    components: type[Any]
    coefficients: type[Any]
    breakdown: type[Any]
    forces: Callable[..., Any]
    cites: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        unknown = [name for name in self.control._fields if name not in INPUTS]
        lacking = [name for name in ("flow", "hull", "total") if name not in self.breakdown._fields]
        if unknown or lacking:
            raise TypeError(f"arrangement '{self.tag}': unknown inputs {unknown}, breakdown without {lacking}")
        if self.coefficients._fields != ("ship", *self.components._fields):
            raise TypeError(f"arrangement '{self.tag}': {self.coefficients._fields} are not ship and its components")

    def __reduce__(self) -> tuple[Callable[..., Arrangement | None], tuple[str]]:
        """Pickled by tag.  Raises TypeError for one that is not in ``ARRANGEMENTS``."""
        if find_arrangement(self.tag) is not self:
            raise TypeError(f"arrangement '{self.tag}' is not one of ARRANGEMENTS and cannot be found again")
        return find_arrangement, (self.tag,)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kinds of components a profile needs one of each, in the order of ``coefficients``."""
        return ("particulars", *self.components._fields)

    @property
    def inputs(self) -> tuple[Input, ...]:
        """What drives the ship, in the order of ``control``."""
        return tuple(INPUTS[name] for name in self.control._fields)

    def of_role(self, role: Role) -> tuple[int, ...]:
        """Places of the inputs of one role among all."""
        return tuple(k for k, one in enumerate(self.inputs) if one.role == role)


SUYAMA = "Suyama et al. 2023, arXiv:2312.04224"
OKUDA = "Okuda et al. 2023, Applied Ocean Research 135, 103567"
YASUKAWA = "Yasukawa & Yoshimura 2015, J. Marine Science and Technology 20, 37-52"
YOSHIMURA = (
    "Yoshimura, Nakao & Ishibashi 2009, unified mathematical model for ocean and harbour manoeuvring, MARSIM 2009"
)
INOUE = "Inoue, Hirano & Kijima 1981, Int. Shipbuilding Progress 28, 112-125"
KIJIMA = "Kijima et al. 1990, J. Society of Naval Architects of Japan 168, 247-256"
MATHIOUDAKIS = "Mathioudakis et al., Towards real-world validation of a physics-based ship motion prediction model"
MIYAUCHI = "Miyauchi et al. 2022, J. Marine Science and Technology, doi 10.1007/s00773-022-00889-3"
KANG = "Kang, Nagarajan, Hasegawa & Sano 2008, J. Marine Science and Technology 13, 207-222"
KOBAYASHI = "Kobayashi 1988, Mitsubishi Technical Bulletin 180"
WAKITA = (
    "Wakita, Akimoto & Maki, Probabilistic prediction of ship maneuvering motion using ensemble learning with "
    "feedforward neural networks"
)

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
            name: Field(f"{force}, {term} term", "prime")
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

DERIVATIVES_HULL = Component(
    kind="hull",
    tag="derivatives",
    title="hydrodynamic derivatives: linear terms, squares with their sign, v^2 r and v r^2",
    params=DerivativesHull,
    function=derivatives_hull,
    cites=(MATHIOUDAKIS, INOUE, KIJIMA),
    fields={
        "R_0": Field("resistance going straight", "prime", low=0.0),
        "X_vr": Field("surge force, vr term", "prime"),
        "Y_v": Field("sway force, v term", "prime"),
        "Y_r": Field("sway force, r term", "prime"),
        "Y_vv": Field("sway force, v|v| term", "prime"),
        "Y_vr": Field("sway force, v|r| term", "prime"),
        "Y_rr": Field("sway force, r|r| term", "prime"),
        "Y_vvr": Field("sway force, vvr term", "prime"),
        "Y_vrr": Field("sway force, vrr term", "prime"),
        "N_v": Field("yaw moment, v term", "prime"),
        "N_r": Field("yaw moment, r term", "prime"),
        "N_vv": Field("yaw moment, v|v| term", "prime"),
        "N_rr": Field("yaw moment, r|r| term", "prime"),
        "N_vvr": Field("yaw moment, vvr term", "prime"),
        "N_vrr": Field("yaw moment, vrr term", "prime"),
    },
)

UNIFIED_HULL = Component(
    kind="hull",
    tag="unified",
    title="cross-flow drag and linear lift, for any drift angle",
    params=UnifiedHull,
    function=unified_hull,
    cites=(YOSHIMURA, MIYAUCHI),
    fields={
        "X_0F": Field("surge force going straight ahead", "prime", high=0.0),
        "X_0A": Field("surge force going straight astern", "prime", high=0.0),
        "X_vr": Field("surge force, vr term", "prime"),
        "Y_v": Field("sway force, v term", "prime"),
        "Y_r": Field("sway force, r term", "prime"),
        "N_v": Field("yaw moment, v term", "prime"),
        "N_r": Field("yaw moment, r term", "prime"),
        "C_D": Field("cross-flow drag coefficient", low=-1e-12),
        "C_rY": Field("weight of the yaw rate in the cross flow, for the sway force", low=-1e-12),
        "C_rN": Field("weight of the yaw rate in the cross flow, for the yaw moment", low=-1e-12),
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

QUADRATIC_WAKE = Component(
    kind="wake",
    tag="quadratic",
    title="wake of the lateral velocity and its square, none astern",
    params=QuadraticWake,
    function=quadratic_wake,
    cites=(MIYAUCHI,),
    fields={
        "w_P0": Field("wake fraction at zero lateral velocity", low=-1.0, high=1.0),
        "tau": Field("change of 1 - w_P with the size of the lateral velocity at the propeller"),
        "C_P": Field("change of 1 - w_P with the square of the lateral velocity at the propeller"),
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
        "k_0": Field("thrust coefficient at J = 0"),
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
        "k_0": Field("thrust coefficient at J = 0, revolutions ahead"),
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
        "u_R0": Field("inflow from the propeller at bollard condition", low=-1e-12),
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

REVERSIBLE_RUDDER = Component(
    kind="rudder",
    tag="reversible",
    title="rudder without a flap, inflow from either direction",
    params=ReversibleRudder,
    function=reversible_rudder,
    cites=(YASUKAWA, MIYAUCHI, "Kitagawa et al. 2015, cited there for the inflow behind a braking propeller"),
    fields={
        **_RUDDER_GEOMETRY,
        **_RUDDER_INFLOW,
        "k_reverse": Field("propeller race against the motion of the ship", low=-1e-12),
        "C_PR": Field("loss of inflow behind a braking propeller"),
        "f_alpha": Field("normal force gradient", "1/rad", low=0.0),
    },
)

SLIP_RUDDER = Component(
    kind="rudder",
    tag="slip",
    title="rudder in a slipstream counted by slip, with generic lift, drag and stall",
    params=SlipRudder,
    function=slip_rudder,
    cites=(
        MATHIOUDAKIS,
        KIJIMA,
        "Kijima & Nakiri 2002, Trans. West-Japan Society of Naval Architects 105, 21-31",
        "Soding in Brix 1993, Manoeuvring Technical Manual, Seehafen Verlag",
    ),
    fields={
        **_RUDDER_GEOMETRY,
        "pitch_": Field("pitch of the propeller over its diameter", low=0.0, high=5.0),
        "C_port": Field("gain of the slipstream, rudder to port", low=0.0, high=5.0),
        "C_stbd": Field("gain of the slipstream, rudder to starboard", low=0.0, high=5.0),
        **_RUDDER_INFLOW,
        "C_Q": Field("cross-flow coefficient of the rudder", low=-1e-12, high=5.0),
        "C_D0": Field("drag of the rudder at zero lift", low=-1e-12, high=1.0),
        "alpha_stall": Field("inflow angle at which lift begins to be lost", "rad", low=0.0, high=1.5),
        "stall_loss": Field("share of the circulatory lift that is lost in stall", low=-1e-12, high=1.0),
    },
)


def _polynomial(of: str, letter: str, terms: tuple[str, ...], unit: str = "-") -> dict[str, Field]:
    """Fields letter_1, letter_2, ... of the terms of a sum, in words."""
    return {f"{letter}_{k}": Field(f"{of}, {term}", unit) for k, term in enumerate(terms, start=1)}


_IN_J = ("constant term", "J term", "J^2 term")
_IN_SLIP = ("constant term", "slip term", "slip^2 term")

KANG_PROPELLER = Component(
    kind="propulsion",
    tag="kang",
    title="propeller ahead on a ship that moves either way, with its wake",
    params=KangPropeller,
    function=kang_propeller,
    cites=(KANG,),
    fields={
        "D_P": Field("diameter", "m", low=0.0, high=20.0),
        "pitch_": Field("pitch over diameter", low=0.0, high=5.0),
        "k_0": Field("thrust coefficient at J = 0, ship ahead"),
        "k_1": Field("thrust coefficient, J term, ship ahead"),
        "k_2": Field("thrust coefficient, J^2 term, ship ahead"),
        "k_0n": Field("thrust coefficient, constant term, ship astern"),
        "k_1n": Field("thrust coefficient, J term, ship astern"),
        "k_2n": Field("thrust coefficient, J^2 term, ship astern"),
        "J_max": Field("largest size of an advance ratio", default=1.5, low=0.0),
        "x_P_": Field("longitudinal position of the propeller, over L_pp", low=-1.0, high=1.0),
        **_polynomial("1 - w_P going straight", "a", ("constant term", "J_S term", "J_S^2 term")),
        "b_1": Field("1 - w_P, gain by lateral velocity at the propeller v_P'"),
        "b_2": Field("1 - w_P, v_P' term of that gain"),
        "b_3": Field("1 - w_P, v_P'|v_P'| beside v_P' in the squared part of that gain"),
        **_polynomial("1 - t_P going straight", "c", _IN_J),
        "d_1": Field("1 - t_P, gain by lateral velocity at the propeller v_P'"),
        "d_2": Field("1 - t_P, v_P' term of that gain"),
        "d_3": Field("1 - t_P, v_P'|v_P'| beside v_P' in the squared part of that gain"),
    },
)

RUDDER_PAIR = Component(
    kind="rudder_pair",
    tag="kang",
    title="what two rudders behind one propeller share: geometry, hull reaction, normal force",
    params=RudderPair,
    function=reaction_of_pair,
    cites=(KANG,),
    fields={
        "A_R": Field("area of each rudder", "m^2", low=0.0, high=500.0),
        "H_R": Field("rudder span", "m", low=0.0, high=30.0),
        "x_R_": Field("longitudinal position of the rudders, over L_pp", low=-1.0, high=1.0),
        "k_x": Field("share of the propeller race's gain of velocity that reaches a rudder", low=-1e-12),
        **_polynomial("steering resistance deduction t_R", "e", _IN_J),
        **_polynomial("increase a_H of the rudder force by the hull", "f", _IN_J),
        "a_H_low": Field("smallest a_H", low=-1.0, high=3.0),
        "a_H_high": Field("largest a_H", low=-1.0, high=3.0),
        **_polynomial("position x_H of that increase, over L_pp", "g", _IN_J),
        "x_H_low": Field("smallest x_H, over L_pp", low=-3.0, high=3.0),
        "x_H_high": Field("largest x_H, over L_pp", low=-3.0, high=3.0),
        "C_N1": Field("normal force coefficient over sin(alpha), before stall", low=0.0),
        "C_N2": Field("normal force coefficient in stall, constant term"),
        "C_N3": Field("normal force coefficient in stall, alpha term", "1/rad"),
        "C_N4": Field("normal force coefficient in stall, alpha^2 term", "1/rad^2"),
    },
)

_CASES = (
    "drift angle positive, rudder to port",
    "drift angle negative, rudder to port",
    "drift angle positive, rudder to starboard",
    "drift angle negative, rudder to starboard",
)
_YAW_CASES = (
    "turning to starboard, rudder to starboard",
    "turning to starboard, rudder to port",
    "turning to port, rudder to starboard",
    "turning to port, rudder to port",
)
_STRAIGHTENING = ("|beta| term", "|beta|^2 term", "|beta| delta_2 term", "|beta|^2 delta_2 term")


def _one_of_two(kind: str, words: str, function: Callable[..., Any]) -> Component:
    return Component(
        kind=kind,
        tag="kang",
        title=f"{words} rudder of a pair behind one propeller",
        params=OneOfTwo,
        function=function,
        cites=(KANG,),
        fields={
            **_polynomial("1 - w_R", "a", ("constant term", "delta term", "delta^2 term", "delta^3 term")),
            **_polynomial("neutral angle", "b", _IN_SLIP[:2], unit="rad"),
            **_polynomial("deflection by the other rudder's angle", "d", _IN_SLIP),
            **_polynomial("deflection by the other rudder's angle squared", "e", _IN_SLIP, unit="1/rad"),
            **_polynomial("share of the inflow kept when turned outward", "g", _IN_SLIP),
            **_polynomial("share of the inflow kept, delta_2 part", "h", _IN_SLIP, unit="1/rad"),
            **_polynomial("share of the inflow kept, delta_2^2 part", "k", _IN_SLIP, unit="1/rad^2"),
            **{
                f"r_{4 * i + j + 1}": Field(f"flow straightening, {case}, {term}")
                for i, case in enumerate(_CASES)
                for j, term in enumerate(_STRAIGHTENING)
            },
            **{
                f"gamma_{i}": Field(f"largest flow straightening, {case}", low=-1e-12, high=2.0)
                for i, case in enumerate(_CASES, start=1)
            },
            **{
                f"C_{i}": Field(f"effective position in yaw over x_R, {case}", low=-5.0, high=5.0)
                for i, case in enumerate(_YAW_CASES, start=1)
            },
        },
    )


RUDDER_PORT = _one_of_two("rudder_port", "port", rudder_of_pair_to_port)
RUDDER_STBD = _one_of_two("rudder_stbd", "starboard", rudder_of_pair_to_starboard)

FADING_THRUSTER = Component(
    kind="thruster",
    tag="fading",
    title="bow thruster in a tunnel whose force fades with speed",
    params=FadingThruster,
    function=fading_thruster,
    cites=(KOBAYASHI, WAKITA),
    fields={
        "D": Field("diameter", "m", low=0.0, high=10.0),
        "x": Field("longitudinal position, forward of midship", "m"),
        "K_Tp": Field("thrust coefficient, pushing to starboard", low=0.0),
        "K_Tn": Field("thrust coefficient, pushing to port", low=0.0),
        **_polynomial("side force over thrust, less 1", "a", ("constant term", "Fr term", "Fr^2 term")),
        **_polynomial("yaw moment over thrust times position, less 1", "b", ("constant term", "Fr term", "Fr^2 term")),
        "u_off": Field("speed from which on the thruster has no force", "m/s", low=0.0),
    },
)

WIND_FORCES = {"X": "surge force", "Y": "sway force", "N": "yaw moment"}
HARMONIC_WORDS = (
    "mean over the angle of the wind",
    "first harmonic",
    "second harmonic",
    "third harmonic",
    "fourth harmonic",
    "fifth harmonic",
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
        **{
            name: Field(f"wind {WIND_FORCES[name[0]]}, {HARMONIC_WORDS[int(name[2])]}", derived=True)
            for name in HARMONICS
        },
    },
)

COMPONENTS = (
    SHIP,
    CUBIC_HULL,
    DERIVATIVES_HULL,
    UNIFIED_HULL,
    EXPONENTIAL_WAKE,
    ASYMMETRIC_WAKE,
    QUADRATIC_WAKE,
    FOUR_QUADRANT_PROPELLER,
    OPEN_WATER_PROPELLER,
    REVERSIBLE_PROPELLER,
    FLAPPED_RUDDER,
    PLAIN_RUDDER,
    REVERSIBLE_RUDDER,
    SLIP_RUDDER,
    KANG_PROPELLER,
    RUDDER_PAIR,
    RUDDER_PORT,
    RUDDER_STBD,
    FADING_THRUSTER,
    ABOVE_WATER,
)
"""Every component there is, in the order documentation lists them."""

SINGLE_PROPELLER_SINGLE_RUDDER = Arrangement(
    tag="single-propeller-single-rudder",
    title="one propeller with one rudder behind it",
    control=single_propeller_single_rudder.Control,
    components=single_propeller_single_rudder.Components,
    coefficients=single_propeller_single_rudder.Coefficients,
    breakdown=single_propeller_single_rudder.Breakdown,
    forces=single_propeller_single_rudder.forces,
    cites=(SUYAMA,),
)

SINGLE_PROPELLER_TWIN_RUDDER = Arrangement(
    tag="single-propeller-twin-rudder",
    title="one propeller with two rudders behind it, and a bow thruster",
    control=single_propeller_twin_rudder.Control,
    components=single_propeller_twin_rudder.Components,
    coefficients=single_propeller_twin_rudder.Coefficients,
    breakdown=single_propeller_twin_rudder.Breakdown,
    forces=single_propeller_twin_rudder.forces,
    cites=(KANG, WAKITA),
)

ARRANGEMENTS = (SINGLE_PROPELLER_SINGLE_RUDDER, SINGLE_PROPELLER_TWIN_RUDDER)
"""Every arrangement there is; a profile that names none has the first."""

KINDS = tuple(dict.fromkeys(kind for arrangement in ARRANGEMENTS for kind in arrangement.kinds))
"""Every kind of component that some arrangement has."""

UNTAGGED = {"particulars": SHIP, "above_water": ABOVE_WATER}
"""Kinds of which there is only one component, so that a profile names no model."""


def split_name(name: str) -> tuple[str, str]:
    """Section and symbol of "hull.Y_v" or "effects.current.north"."""
    section, _, symbol = name.rpartition(".")
    return section, symbol


def tags(kind: str) -> tuple[str, ...]:
    """The tags a profile may name for one kind of component."""
    return tuple(component.tag for component in COMPONENTS if component.kind == kind)


def find_arrangement(tag: str) -> Arrangement | None:
    """The arrangement of that tag, None if there is none."""
    return next((arrangement for arrangement in ARRANGEMENTS if arrangement.tag == tag), None)


def find(kind: str, tag: str) -> Component | None:
    """The component of that kind and tag, None if there is none."""
    for component in COMPONENTS:
        if (component.kind, component.tag) == (kind, tag):
            return component
    return None
