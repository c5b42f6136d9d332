"""A propeller with two rudders behind it: what they share, and each of the two."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..physics.propeller.kang import KangPropeller, kang_propeller
from ..physics.rudder.kang import (
    OneOfTwo,
    RudderPair,
    reaction_of_pair,
    rudder_of_pair_to_port,
    rudder_of_pair_to_starboard,
)
from .component import AT_LEAST_0, Component, Field, polynomial
from .sources import KANG

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
        "k_0": Field("thrust coefficient at J = 0, ship ahead", low=0.0),
        "k_1": Field("thrust coefficient, J term, ship ahead"),
        "k_2": Field("thrust coefficient, J^2 term, ship ahead"),
        "k_0n": Field("thrust coefficient, constant term, ship astern"),
        "k_1n": Field("thrust coefficient, J term, ship astern"),
        "k_2n": Field("thrust coefficient, J^2 term, ship astern"),
        "J_max": Field("largest size of an advance ratio", default=1.5, low=0.0),
        "x_P_": Field("longitudinal position of the propeller, over L_pp", low=-1.0, high=1.0),
        **polynomial("1 - w_P going straight", "a", ("constant term", "J_S term", "J_S^2 term")),
        "b_1": Field("1 - w_P, gain by lateral velocity at the propeller v_P'"),
        "b_2": Field("1 - w_P, v_P' term of that gain"),
        "b_3": Field("1 - w_P, v_P'|v_P'| beside v_P' in the squared part of that gain"),
        **polynomial("1 - t_P going straight", "c", _IN_J),
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
        "x_R_": Field("longitudinal position of the rudders, over L_pp", low=-1.0, high=0.0),
        "k_x": Field("share of the propeller race's gain of velocity that reaches a rudder", low=AT_LEAST_0),
        **polynomial("steering resistance deduction t_R", "e", _IN_J),
        **polynomial("increase a_H of the rudder force by the hull", "f", _IN_J),
        "a_H_low": Field("smallest a_H", low=-1.0, high=3.0),
        "a_H_high": Field("largest a_H", low=-1.0, high=3.0),
        **polynomial("position x_H of that increase, over L_pp", "g", _IN_J),
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
            **polynomial("1 - w_R", "a", ("constant term", "delta term", "delta^2 term", "delta^3 term")),
            **polynomial("neutral angle", "b", _IN_SLIP[:2], unit="rad"),
            **polynomial("deflection by the other rudder's angle", "d", _IN_SLIP),
            **polynomial("deflection by the other rudder's angle squared", "e", _IN_SLIP, unit="1/rad"),
            **polynomial("share of the inflow kept when turned outward", "g", _IN_SLIP),
            **polynomial("share of the inflow kept, delta_2 part", "h", _IN_SLIP, unit="1/rad"),
            **polynomial("share of the inflow kept, delta_2^2 part", "k", _IN_SLIP, unit="1/rad^2"),
            **{
                f"r_{4 * i + j + 1}": Field(f"flow straightening, {case}, {term}")
                for i, case in enumerate(_CASES)
                for j, term in enumerate(_STRAIGHTENING)
            },
            **{
                f"gamma_{i}": Field(f"largest flow straightening, {case}", low=AT_LEAST_0, high=2.0)
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

PROPELLER_WITH_TWO_RUDDERS = (KANG_PROPELLER, RUDDER_PAIR, RUDDER_PORT, RUDDER_STBD)
