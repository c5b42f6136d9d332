"""The compass is off by an angle that depends on the heading: the first harmonics of a table of deviation."""

from typing import NamedTuple

import numpy as np

from ..physics.elementary import cos, sin
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, angle_about_zero
from .heading_bias import heading_shown


class CompassDeviation(NamedTuple):
    """See the parameters below."""

    sine: Lanes
    cosine: Lanes
    sine_alone: Lanes
    cosine_alone: Lanes


def compass_deviation(state: State, e: CompassDeviation) -> State:
    """Heading shown = heading + B sin(heading) + C cos(heading), the semicircular deviation of a magnetic compass.

    B and C are those of a table of deviation (Handbook of Magnetic Compass Adjustment, NGA Pub. 226), here of the true
    heading; the constant A is a bias, and the quadrantal D and E are left out (assumption).

    The velocity over ground is logged in the axes of the heading shown, but for the part that is of it alone.
    """
    s, c = sin(state.psi), cos(state.psi)
    return heading_shown(state, e.sine * s + e.cosine * c, e.sine_alone * s + e.cosine_alone * c)


def compass_deviation_inverse(logged: State, e: CompassDeviation) -> State:
    """The motion from what was logged: the heading by Newton's method, which doubles the digits each time."""
    B, C = e.sine + e.sine_alone, e.cosine + e.cosine_alone
    psi = logged.psi
    for _ in range(5):
        s, c = sin(psi), cos(psi)
        psi = psi - (psi + B * s + C * c - logged.psi) / np.maximum(1.0 + B * c - C * s, 0.1)
    s, c = sin(psi), cos(psi)
    return heading_shown(logged, -(e.sine * s + e.cosine * c), -(e.sine_alone * s + e.cosine_alone * c))


def _harmonic(of: str, words: str) -> Parameter:
    return angle_about_zero(f"deviation in proportion to the {of} of the heading, {words}", 0.6, 15.0)


_TURNED, _ALONE = "in whose axes velocities are logged", "velocities being logged in the ship's own axes"

EFFECT = SensorEffect(
    kind="effects.compass-deviation",
    tag="compass-deviation",
    title="deviation of the compass",
    params=CompassDeviation,
    function=compass_deviation,
    inverse=compass_deviation_inverse,
    cites=(),
    fields={
        "sine": _harmonic("sine", _TURNED),
        "cosine": _harmonic("cosine", _TURNED),
        "sine_alone": _harmonic("sine", _ALONE),
        "cosine_alone": _harmonic("cosine", _ALONE),
    },
    variants=(("sine", "cosine"), ("sine_alone", "cosine_alone")),
    sentence=lambda v: (
        "The compass showed too much by "
        + " and ".join(
            words.format(*(v[name] for name in names))
            for names, words in {
                ("sine", "cosine"): "{} times the sine and {} times the cosine of the heading",
                (
                    "sine_alone",
                    "cosine_alone",
                ): "{} times the sine and {} times the cosine of the heading, the velocities"
                " being logged in the ship's own axes",
            }.items()
            if all(name in v for name in names)
        )
    ),
)
