"""A gyro that drifts: what it shows is off by ever more, linearly in time."""

from typing import NamedTuple

import numpy as np

from ..physics.elementary import exp, where
from ..physics.following import INSTANT
from ..physics.quantities import Lanes, State
from .effect import FilterEffect, Parameter
from .heading_bias import ANTENNA, MIDSHIP, MOVED_FROM, heading_shown
from .signs import each


class GyroDrift(NamedTuple):
    """See the parameters below."""

    heading: Lanes
    heading_alone: Lanes
    yaw_rate: Lanes
    settles: Lanes
    antenna_ahead: Lanes
    antenna_abeam: Lanes


SHORT = 0.03
"""Share of the time in which a drift dies away up to which how much is left of it is a series: exactly all of it where
it never does, and without a difference of two numbers that are nearly alike."""


def gyro_drift(start: State, end: State, held: tuple[Lanes], h: Lanes, e: GyroDrift) -> tuple[State, tuple[Lanes]]:
    """Heading and yaw rate off by their drift [rad/s, rad/s^2] times the time since the first sample, at which they
    are right (assumption: set before each run; a bias is another effect).  It dies away with a time constant where the
    gyro settles.

    The velocity over ground is logged in the axes of the heading shown, but for that part that is of it alone.
    """
    t = held[0] + h
    past = t / np.maximum(e.settles, INSTANT)
    series = 1.0 - past * (1.0 / 2.0 - past * (1.0 / 6.0 - past * (1.0 / 24.0 - past * (1.0 / 120.0 - past / 720.0))))
    drifted = t * where(past < SHORT, series, (1.0 - exp(-past)) / np.maximum(past, SHORT))
    seen = heading_shown(end, e.heading * drifted, e.heading_alone * drifted, e)
    return State(x=seen.x, y=seen.y, psi=seen.psi, u=seen.u, v_m=seen.v_m, r=seen.r + e.yaw_rate * drifted), (t,)


def gyro_set(state: State, e: GyroDrift) -> tuple[State, tuple[Lanes]]:
    """What it shows at the first sample."""
    return state, (0.0 * state.psi,)


def gyro_drift_inverse(logged: State, e: GyroDrift) -> State:
    """The motion there."""
    return logged


def _heading(words: str) -> Parameter:
    return Parameter(
        f"drift of the heading shown, {words}",
        "rad/s",
        low=-0.1,
        high=0.1,
        bounds=lambda ship: (-0.03 * ship.U / ship.L, 0.03 * ship.U / ship.L),
        typical=lambda ship: 0.001 * ship.U / ship.L,
        bounds_source="two degrees in the time of a ship length",
    )


_WORDS = {
    "heading": "its heading by {}, in whose axes velocities are logged",
    "heading_alone": "its heading by {}, velocities being logged in the ship's own axes",
    "yaw_rate": "its yaw rate by {}",
}

EFFECT = FilterEffect(
    kind="effects.gyro-drift",
    tag="gyro-drift",
    title="drift of the gyro",
    told_by="the heading by bearings or a second compass, at the beginning and the end of a run",
    params=GyroDrift,
    function=gyro_drift,
    settled=gyro_set,
    inverse=gyro_drift_inverse,
    states=("time",),
    cites=(),
    fields={
        "heading": _heading("in whose axes velocities are logged"),
        "heading_alone": _heading("velocities being logged in the ship's own axes"),
        "yaw_rate": Parameter(
            "drift of the yaw rate shown",
            "rad/s^2",
            low=-0.01,
            high=0.01,
            bounds=lambda ship: (-0.01 * (ship.U / ship.L) ** 2, 0.01 * (ship.U / ship.L) ** 2),
            typical=lambda ship: 3e-4 * (ship.U / ship.L) ** 2,
            bounds_source="a third of the speed over the length within thirty ship lengths",
        ),
        "settles": Parameter(
            "time constant with which the drift dies away",
            "s",
            null=float("inf"),
            low=0.0,
            chart="reciprocal",
            bounds=lambda _: (0.0, 1.0 / 60.0),
            typical=lambda _: 1.0 / 600.0,
            bounds_source="from a drift that is even to a minute",
        ),
        **ANTENNA,
    },
    pivots=MIDSHIP,
    read_off=MOVED_FROM,
    form={"settles": 1.0 / 600.0},
    variants=(("heading",), ("heading_alone",), ("yaw_rate",)),
    varies=("heading", "heading_alone"),
    subject="drift of the gyro",
    sentence=lambda v: "The gyro drifted: " + each(_WORDS, v),
)
