"""Rudders behind one propeller each."""

from __future__ import annotations

from ..physics.rudder.flapped import FlappedRudder, flapped_rudder
from ..physics.rudder.plain import PlainRudder, plain_rudder
from ..physics.rudder.reversible import ReversibleRudder, reversible_rudder
from ..physics.rudder.slip import SlipRudder, slip_rudder
from .component import AT_LEAST_0, Component, Field
from .sources import KIJIMA, MATHIOUDAKIS, MIYAUCHI, OKUDA, SUYAMA, YASUKAWA

_RUDDER_GEOMETRY = {
    "A_R": Field("rudder area", "m^2", low=0.0, high=500.0),
    "H_R": Field("rudder span", "m", low=0.0, high=30.0),
    "x_R_": Field("longitudinal position of the rudder, over L_pp", low=-1.0, high=0.0),
    "t_R": Field("steering resistance deduction", low=-2.0, high=1.0),
    "a_H": Field("increase of the rudder force by the hull", low=-1.0, high=3.0),
    "x_H_": Field("position of that increase, over L_pp", low=-3.0, high=3.0),
    "eps": Field("wake ratio between propeller and rudder position", low=0.0),
    "kappa": Field("propeller race acceleration", low=AT_LEAST_0),
}

_RUDDER_INFLOW = {
    "l_R_": Field("effective position of the rudder in yaw, over L_pp", low=-5.0, high=5.0),
    "gamma_Rp": Field("flow straightening, effective drift angle positive", low=AT_LEAST_0),
    "gamma_Rn": Field("flow straightening, effective drift angle negative", low=AT_LEAST_0),
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
        "u_R0": Field("inflow from the propeller at bollard condition", low=AT_LEAST_0),
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
        "k_reverse": Field("propeller race against the motion of the ship", low=AT_LEAST_0),
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
        "C_Q": Field("cross-flow coefficient of the rudder", low=AT_LEAST_0, high=5.0),
        "C_D0": Field("drag of the rudder at zero lift", low=AT_LEAST_0, high=1.0),
        "alpha_stall": Field("inflow angle at which lift begins to be lost", "rad", low=0.0, high=1.5),
        "stall_loss": Field("share of the circulatory lift that is lost in stall", low=AT_LEAST_0, high=1.0),
    },
)

RUDDERS = (FLAPPED_RUDDER, PLAIN_RUDDER, REVERSIBLE_RUDDER, SLIP_RUDDER)
