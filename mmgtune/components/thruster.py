"""Thrusters in tunnels."""

from __future__ import annotations

from ..physics.thruster.fading import FadingThruster, fading_thruster
from .component import Component, Field, polynomial
from .sources import KOBAYASHI, WAKITA

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
        **polynomial("side force over thrust, less 1", "a", ("constant term", "Fr term", "Fr^2 term")),
        **polynomial("yaw moment over thrust times position, less 1", "b", ("constant term", "Fr term", "Fr^2 term")),
        "u_off": Field("speed from which on the thruster has no force", "m/s", low=0.0),
    },
)

THRUSTERS = (FADING_THRUSTER,)
