"""The rudder moves more or less than its indicator says."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..physics.elementary import where
from ..physics.quantities import Lanes
from ..units import DEG
from .effect import ActuatorEffect, Parameter, factor_about_one
from .visited import Visited

LEAST = 2.0 * DEG
"""Rudder to either side from which its gain there can be told."""

HARD_OVER = 35.0 * DEG
"""Rudder angle [rad] at which the change of the gain with the angle is meant."""

CURVED = 15.0 * DEG
"""Rudder angle [rad] that trials have to go beyond for that change to be told."""


class RudderGain(NamedTuple):
    """See the parameters below."""

    factor: Lanes
    starboard: Lanes
    port: Lanes
    curve: Lanes


def rudder_gain(start: Lanes, end: Lanes, before: Lanes, h: Lanes, e: RudderGain) -> Lanes:
    """Blade angle = factor [-] times logged, times another factor on the side it is logged on, times
    1 + curve (logged / 35 deg)^2, as of a linkage out of square, whose angle is nearly a sine; beyond 70 deg as at 70.
    """
    share = np.minimum(end * end / HARD_OVER**2, 4.0)
    return end * e.factor * where(end > 0.0, e.starboard, e.port) * (1.0 + e.curve * share)


def _factor(words: str) -> Parameter:
    return factor_about_one(f"rudder angle over indicated angle{words}", 0.5, 0.05, "half as much again either way")


def unvisited(found: Mapping[str, float], visited: Visited) -> str:
    """Rudder to both sides, for how they differ; small and large angles, for how they do."""
    if "curve" in found:
        return visited.lacking_rudder(CURVED)
    low, high = visited.span(visited.rudder)
    if "starboard" not in found or low < -LEAST < LEAST < high:
        return ""
    return f"{LEAST / DEG:.0f}° of rudder to either side"


def _sentence(v: Mapping[str, str]) -> str:
    words = {"factor": "", "starboard": " to starboard", "port": " to port"}
    said = "The rudder moved by " + " and ".join(
        f"{v[name]} times the angle its indicator showed{side}" for name, side in words.items() if name in v
    )
    return f"{said} amidships, a factor that changed by {v['curve']} of itself to 35 deg" if "curve" in v else said


EFFECT = ActuatorEffect(
    kind="effects.rudder-gain",
    tag="rudder-gain",
    title="scale error of the rudder",
    told_by="the angle of the rudder stock, read at several angles of the indicator",
    of="rudder",
    params=RudderGain,
    function=rudder_gain,
    cites=(),
    fields={
        "factor": _factor(""),
        "starboard": _factor(" to starboard, beside that factor"),
        "port": _factor(" to port, beside that factor"),
        "curve": Parameter(
            "change of that factor from amidships to 35 deg, as a share of it",
            low=-0.3,
            high=1.0,
            bounds=lambda _: (-0.24, 0.24),
            typical=lambda _: 0.05,
            bounds_source="a quarter; as much the other way at 70 deg it leaves nothing of the angle",
        ),
    },
    variants=(("factor",), ("starboard", "port"), ("factor", "curve")),
    besides=("starboard", "port", "curve"),
    varies=("factor",),
    subject="gain of the rudder",
    unvisited=unvisited,
    sentence=_sentence,
)
