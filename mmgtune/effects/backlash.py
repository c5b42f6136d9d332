"""Play in the linkage between the indicator and the blade."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..components import AT_LEAST_0
from ..physics.quantities import Lanes
from ..units import DEG
from .effect import ActuatorEffect, Parameter

REACH = 2.5
"""Standard deviations that the largest of a hundred samples of noise reaches: as many as between two orders."""

NOISIEST = 0.2 * DEG
"""Noise of an indicator [rad] beyond which it is a rudder moved by hand between samples far apart."""


class Backlash(NamedTuple):
    """See the parameters below."""

    play: Lanes
    begins: Lanes
    pushed: Lanes
    noise: Lanes


def rested(reached: Lanes, e: Backlash) -> Lanes:
    """Blade angle [rad] before the first sample, where the linkage has been left at an angle [rad]."""
    return reached + 0.5 * e.begins * e.play


def backlash(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: Backlash) -> Lanes:
    """Blade angle [rad]: it stays where it is until the linkage has taken up its play, and is then taken along.

    A blade that is held by friction moves with the linkage half the play behind it; where it stands in its play at the
    first sample is what was done before, the same in all runs.  One that is loose is pushed back to amidships by the
    flow, by half the play whichever way it is turned.  Noise of the log would carry a blade along by as much as it
    reaches, and hide so much of the play: it is let go on either side, as far as the play does.
    """
    half = 0.5 * e.play
    half = half + np.minimum(half, e.noise)
    blade = np.minimum(np.maximum(before, end - half), end + half)
    back = 0.5 * e.pushed
    return blade - np.minimum(np.maximum(blade, -back), back)


def _sentence(v: Mapping[str, str]) -> str:
    told = [v["play"]] if "play" in v else []
    if "pushed" in v:
        told.append(f"{v['pushed']} within which the flow pushes the blade back to amidships")
    return f"The linkage of the rudder had a play of {' and one of '.join(told)}"


EFFECT = ActuatorEffect(
    kind="effects.backlash",
    tag="backlash",
    title="play in the rudder linkage",
    told_by="the angle of the rudder stock, logged beside what moves it",
    of="rudder",
    params=Backlash,
    function=backlash,
    rested=rested,
    cites=(),
    fields={
        "play": Parameter(
            "angle the linkage moves before the blade follows, from one end of its play to the other",
            "rad",
            low=AT_LEAST_0,
            bounds=lambda _: (0.0, 12.0 * DEG),
            typical=lambda _: 2.0 * DEG,
            bounds_source="beyond 12 deg anyone would see it",
        ),
        "begins": Parameter(
            "where the blade stands in its play at the first sample, from -1, to port, to 1, to starboard",
            bounds=lambda _: (-1.0, 1.0),
            typical=lambda _: 0.5,
            bounds_source="from one end of the play to the other",
        ),
        "pushed": Parameter(
            "play of a blade that the flow pushes back to amidships within it, from one end to the other",
            "rad",
            low=AT_LEAST_0,
            bounds=lambda _: (0.0, 12.0 * DEG),
            typical=lambda _: 2.0 * DEG,
            bounds_source="beyond 12 deg anyone would see it",
        ),
        "noise": Parameter("how far noise of the logged angle reaches, which moves no blade", "rad", low=AT_LEAST_0),
    },
    pivots={"noise": lambda _: 0.0},
    read_off={"noise": lambda visited: REACH * min(visited.rudder_noise, NOISIEST)},
    form={"begins": 0.5},
    besides=("pushed",),
    variants=(("play",), ("pushed",)),
    sentence=_sentence,
)
