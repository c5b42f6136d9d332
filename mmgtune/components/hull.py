"""Hulls."""

from __future__ import annotations

from ..physics.hull.cubic import CubicHull, cubic_hull
from ..physics.hull.derivatives import DerivativesHull, derivatives_hull
from ..physics.hull.unified import UnifiedHull, unified_hull
from .component import AT_LEAST_0, AT_MOST_0, Component, Field
from .sources import INOUE, KIJIMA, MATHIOUDAKIS, MIYAUCHI, SUYAMA, YASUKAWA, YOSHIMURA

NEGATIVE = ("Y_v", "N_v", "N_r")
"""Linear terms that are negative for any hull that goes ahead, with sway to starboard positive."""

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
            name: Field(f"{force}, {term} term", "prime", high=AT_MOST_0 if name in NEGATIVE else None)
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
        "Y_v": Field("sway force, v term", "prime", high=AT_MOST_0),
        "Y_r": Field("sway force, r term", "prime"),
        "Y_vv": Field("sway force, v|v| term", "prime"),
        "Y_vr": Field("sway force, v|r| term", "prime"),
        "Y_rr": Field("sway force, r|r| term", "prime"),
        "Y_vvr": Field("sway force, vvr term", "prime"),
        "Y_vrr": Field("sway force, vrr term", "prime"),
        "N_v": Field("yaw moment, v term", "prime", high=AT_MOST_0),
        "N_r": Field("yaw moment, r term", "prime", high=AT_MOST_0),
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
        "Y_v": Field("sway force, v term", "prime", high=AT_MOST_0),
        "Y_r": Field("sway force, r term", "prime"),
        "N_v": Field("yaw moment, v term", "prime", high=AT_MOST_0),
        "N_r": Field("yaw moment, r term", "prime", high=AT_MOST_0),
        "C_D": Field("cross-flow drag coefficient", low=AT_LEAST_0),
        "C_rY": Field("weight of the yaw rate in the cross flow, for the sway force", low=AT_LEAST_0),
        "C_rN": Field("weight of the yaw rate in the cross flow, for the yaw moment", low=AT_LEAST_0),
    },
)

HULLS = (CUBIC_HULL, DERIVATIVES_HULL, UNIFIED_HULL)
