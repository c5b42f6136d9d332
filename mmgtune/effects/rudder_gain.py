"""The rudder moves more or less than its indicator says."""

from typing import NamedTuple

from ..physics.elementary import where
from ..physics.quantities import Lanes
from .effect import ActuatorEffect, Parameter


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
    return Parameter(
        f"rudder angle over indicated angle{words}",
        low=0.0,
        high=3.0,
        null=1.0,
        bounds=lambda _: (0.5, 1.5),
        typical=lambda _: 0.05,
        bounds_source="half as much again either way",
    )


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
    sentence=lambda v: (
        "The rudder moved by "
        + " and ".join(
            f"{v[name]} times the angle its indicator showed{words}"
            for name, words in {"factor": "", "starboard": " to starboard", "port": " to port"}.items()
            if name in v
        )
    ),
)
