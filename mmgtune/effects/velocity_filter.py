"""Velocities are logged through a low-pass: as receivers and logs smooth them."""

from typing import NamedTuple

from ..components import AT_LEAST_0
from ..physics.following import followed
from ..physics.frame import to_earth, to_ship
from ..physics.quantities import Lanes, State
from .effect import FilterEffect, Parameter
from .signs import each


class VelocityFilter(NamedTuple):
    """See the parameters below."""

    over_ground: Lanes
    along_axes: Lanes
    yaw_rate: Lanes
    ahead: Lanes


Held = tuple[Lanes, Lanes, Lanes, Lanes, Lanes]
"""Velocity north and east, ahead and to starboard [m/s], and yaw rate [rad/s] as the filters have them."""


def _with(state: State, u: Lanes, v_m: Lanes, r: Lanes) -> State:
    return State(x=state.x, y=state.y, psi=state.psi, u=u, v_m=v_m, r=r)


def velocity_filter(start: State, end: State, held: Held, h: Lanes, e: VelocityFilter) -> tuple[State, Held]:
    """Velocity over ground smoothed north and east, as a satellite receiver does, and then ahead and to starboard, as
    a log in the ship does, or ahead alone, as one of a single axis; the yaw rate by itself.  First-order low-passes
    (assumption: what receivers and logs do is not published), exact for what is linear over a step."""
    north_0, east_0 = to_earth(start.psi, start.u, start.v_m)
    north_1, east_1 = to_earth(end.psi, end.u, end.v_m)
    north = followed(north_0, north_1, held[0], h, e.over_ground)
    east = followed(east_0, east_1, held[1], h, e.over_ground)
    u_0, v_0 = to_ship(start.psi, held[0] - north_0, held[1] - east_0)
    u_1, v_1 = to_ship(end.psi, north - north_1, east - east_1)
    u = followed(start.u + u_0, end.u + u_1, held[2], h, e.along_axes + e.ahead)
    v_m = followed(start.v_m + v_0, end.v_m + v_1, held[3], h, e.along_axes)
    r = followed(start.r, end.r, held[4], h, e.yaw_rate)
    return _with(end, u, v_m, r), (north, east, u, v_m, r)


def velocity_settled(state: State, e: VelocityFilter) -> tuple[State, Held]:
    """The same in a steady motion: a velocity that turns at r is 1 + (r T)^2 times too small, squared, and late."""
    lag = state.r * e.over_ground
    size = 1.0 + lag * lag
    u, v_m = (state.u + lag * state.v_m) / size, (state.v_m - lag * state.u) / size
    north, east = to_earth(state.psi, u, v_m)
    return _with(state, u, v_m, state.r), (north, east, u, v_m, state.r)


def velocity_filter_inverse(logged: State, e: VelocityFilter) -> State:
    """Velocities of a steady motion from those logged."""
    lag = logged.r * e.over_ground
    return _with(logged, logged.u - lag * logged.v_m, logged.v_m + lag * logged.u, logged.r)


def _constant(of: str) -> Parameter:
    return Parameter(
        f"time constant of the low-pass {of}",
        "s",
        low=AT_LEAST_0,
        bounds=lambda ship: (0.0, 0.8 * ship.L / ship.U),
        typical=lambda ship: 0.05 * ship.L / ship.U,
        bounds_source="eight tenths of the time of a ship length",
    )


_WORDS = {
    "over_ground": "the velocity over ground with a time constant of {}",
    "along_axes": "the velocities ahead and to starboard with a time constant of {}",
    "ahead": "the velocity ahead, and no other, with a time constant of {}",
    "yaw_rate": "the yaw rate with a time constant of {}",
}

EFFECT = FilterEffect(
    kind="effects.velocity-filter",
    tag="velocity-filter",
    title="low-pass of the velocities",
    told_by="the time over which the speed log is set to average",
    params=VelocityFilter,
    function=velocity_filter,
    settled=velocity_settled,
    inverse=velocity_filter_inverse,
    states=("north", "east", "u", "v_m", "r"),
    cites=(),
    fields={
        "over_ground": _constant("of the velocity over ground, north and east"),
        "along_axes": _constant("of the velocities ahead and to starboard"),
        "yaw_rate": _constant("of the yaw rate"),
        "ahead": _constant("of the velocity ahead alone, beside that of both"),
    },
    variants=(("over_ground",), ("along_axes",), ("ahead",), ("yaw_rate",)),
    besides=("ahead",),
    sentence=lambda v: "The log smooths " + each(_WORDS, v),
)
