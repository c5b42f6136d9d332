"""The rudder moves more or less than its indicator says."""

from collections.abc import Mapping
from typing import NamedTuple

from ..physics.elementary import where
from ..physics.quantities import Lanes
from ..units import DEG
from .effect import ActuatorEffect, Parameter, factor_about_one
from .visited import Visited

LEAST = 2.0 * DEG
"""Rudder to either side from which its gain there can be told."""


class RudderGain(NamedTuple):
    """See the parameters below."""

    factor: Lanes
    starboard: Lanes
    port: Lanes


def rudder_gain(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: RudderGain) -> Lanes:
    """Blade angle = factor [-] times logged, times another factor on the side it is logged on.

    Constant on each side (assumption: a linkage out of square is more nearly a sine of the angle).
    """
    return end * e.factor * where(end > 0.0, e.starboard, e.port)


def _factor(words: str) -> Parameter:
    return factor_about_one(f"rudder angle over indicated angle{words}", 0.5, 0.05, "half as much again either way")


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Rudder to both sides, for how they differ."""
    low, high = visited.span(visited.rudder)
    if "starboard" not in found or low < -LEAST < LEAST < high:
        return ""
    return f"{LEAST / DEG:.0f}° of rudder to either side"


EFFECT = ActuatorEffect(
    kind="effects.rudder-gain",
    tag="rudder-gain",
    title="scale error of the rudder",
    of="rudder",
    params=RudderGain,
    function=rudder_gain,
    cites=(),
    fields={
        "factor": _factor(""),
        "starboard": _factor(" to starboard, beside that factor"),
        "port": _factor(" to port, beside that factor"),
    },
    variants=(("factor",), ("starboard", "port")),
    besides=("starboard", "port"),
    varies=("factor",),
    subject="gain of the rudder",
    unvisited=unvisited,
    sentence=lambda v: (
        "The rudder moved by "
        + " and ".join(
            f"{v[name]} times the angle its indicator showed{words}"
            for name, words in {"factor": "", "starboard": " to starboard", "port": " to port"}.items()
            if name in v
        )
    ),
)
