"""Play in the linkage between the indicator and the blade."""

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
    noise: Lanes


def backlash(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: Backlash) -> Lanes:
    """Blade angle [rad]: it stays where it is until the linkage has taken up its play, and is then taken along.

    The blade is held by friction and moves with the linkage half the play behind it; at the first sample it stands in
    the middle (assumptions: the load of the flow does not move it within the play).  Noise of the log would carry it
    along by as much as it reaches, and hide so much of the play: it is let go on either side, as far as the play does.
    """
    half = 0.5 * e.play
    half = half + np.minimum(half, e.noise)
    return np.minimum(np.maximum(before, end - half), end + half)


EFFECT = ActuatorEffect(
    kind="effects.backlash",
    tag="backlash",
    title="play in the rudder linkage",
    told_by="the angle of the rudder stock, logged beside what moves it",
    of="rudder",
    params=Backlash,
    function=backlash,
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
        "noise": Parameter("how far noise of the logged angle reaches, which moves no blade", "rad", low=AT_LEAST_0),
    },
    pivots={"noise": lambda _: 0.0},
    read_off={"noise": lambda visited: REACH * min(visited.rudder_noise, NOISIEST)},
    variants=(("play",),),
    sentence=lambda v: f"The linkage of the rudder had a play of {v['play']}",
)
