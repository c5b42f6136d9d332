"""The compass is off by an angle that depends on the heading: the harmonics of a table of deviation."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..physics.elementary import cos, sin
from ..physics.quantities import Lanes, State
from .effect import Parameter, SensorEffect, angle_about_zero
from .heading_bias import ANTENNA, MIDSHIP, MOVED_FROM, heading_shown


class CompassDeviation(NamedTuple):
    """See the parameters below."""

    sine: Lanes
    cosine: Lanes
    sine_of_twice: Lanes
    cosine_of_twice: Lanes
    sine_alone: Lanes
    cosine_alone: Lanes
    sine_of_twice_alone: Lanes
    cosine_of_twice_alone: Lanes
    antenna_ahead: Lanes
    antenna_abeam: Lanes


class Harmonics(NamedTuple):
    """Coefficients [rad] of a table of deviation."""

    B: Lanes
    C: Lanes
    D: Lanes
    E: Lanes


def compass_deviation(state: State, e: CompassDeviation) -> State:
    """Heading shown = heading + B sin(heading) + C cos(heading) + D sin(2 heading) + E cos(2 heading).

    B to E are those of a table of deviation of a magnetic compass (Handbook of Magnetic Compass Adjustment, NGA Pub.
    226), here of the true heading (assumption); the constant A is a bias of the heading.

    The velocity over ground is logged in the axes of the heading shown, but for the part that is of it alone.
    """
    s, c = sin(state.psi), cos(state.psi)
    return heading_shown(state, _deviation(_turned(e), s, c), _deviation(_alone(e), s, c), e)


def compass_deviation_inverse(logged: State, e: CompassDeviation) -> State:
    """The motion from what was logged: the heading by Newton's method, which doubles the digits each time."""
    turned, alone = _turned(e), _alone(e)
    both = Harmonics(turned.B + alone.B, turned.C + alone.C, turned.D + alone.D, turned.E + alone.E)
    psi = logged.psi
    for _ in range(5):
        s, c = sin(psi), cos(psi)
        slope = 1.0 + both.B * c - both.C * s + 2.0 * (both.D * (c * c - s * s) - both.E * 2.0 * s * c)
        psi = psi - (psi + _deviation(both, s, c) - logged.psi) / np.maximum(slope, 0.1)
    s, c = sin(psi), cos(psi)
    return heading_shown(logged, -_deviation(turned, s, c), -_deviation(alone, s, c), e)


def _turned(e: CompassDeviation) -> Harmonics:
    return Harmonics(e.sine, e.cosine, e.sine_of_twice, e.cosine_of_twice)


def _alone(e: CompassDeviation) -> Harmonics:
    return Harmonics(e.sine_alone, e.cosine_alone, e.sine_of_twice_alone, e.cosine_of_twice_alone)


def _deviation(of: Harmonics, s: Lanes, c: Lanes) -> Lanes:
    """Deviation at a heading of that sine and cosine."""
    return of.B * s + of.C * c + of.D * 2.0 * s * c + of.E * (c * c - s * s)


_TURNED, _ALONE = "in whose axes velocities are logged", "velocities being logged in the ship's own axes"

_HARMONICS = (("sine", "cosine", "the heading"), ("sine_of_twice", "cosine_of_twice", "twice the heading"))
"""Parameters where velocities are logged in the axes shown, and whose sine and cosine they go with."""


def _harmonics(words: str, suffix: str = "") -> dict[str, Parameter]:
    """Parameters for velocities logged so."""
    return {
        f"{name}{suffix}": angle_about_zero(f"deviation in proportion to the {what} of {of}, {words}", 0.6, 15.0)
        for sine, cosine, of in _HARMONICS
        for name, what in ((sine, "sine"), (cosine, "cosine"))
    }


def _sentence(v: Mapping[str, str]) -> str:
    parts = []
    for suffix, words in (("", ""), ("_alone", f", the {_ALONE}")):
        there = [
            f"{v[sine + suffix]} times the sine and {v[cosine + suffix]} times the cosine of {of}"
            for sine, cosine, of in _HARMONICS
            if sine + suffix in v and cosine + suffix in v
        ]
        parts += [" and ".join(there) + words] if there else []
    return "The compass showed too much by " + ", and by ".join(parts)


EFFECT = SensorEffect(
    kind="effects.compass-deviation",
    tag="compass-deviation",
    title="deviation of the compass",
    told_by="the heading by bearings or a second compass, on eight headings",
    params=CompassDeviation,
    function=compass_deviation,
    inverse=compass_deviation_inverse,
    cites=(),
    fields={**_harmonics(_TURNED), **_harmonics(_ALONE, "_alone"), **ANTENNA},
    pivots=MIDSHIP,
    read_off=MOVED_FROM,
    variants=(
        ("sine", "cosine"),
        ("sine_alone", "cosine_alone"),
        tuple(_harmonics(_TURNED)),
        tuple(_harmonics(_ALONE, "_alone")),
    ),
    besides=("sine_of_twice", "cosine_of_twice", "sine_of_twice_alone", "cosine_of_twice_alone"),
    sentence=_sentence,
)
