"""Positions are logged late: the receiver shows where the ship was a moment ago, and perhaps how she moved then."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..physics.frame import to_earth
from ..physics.quantities import Lanes, State
from .effect import FilterEffect, Parameter
from .signs import signed


class PositionLatency(NamedTuple):
    """See the parameters below."""

    seconds: Lanes
    with_velocity: Lanes


def _way(state: State, du: Lanes, dv: Lanes, dr: Lanes, T: Lanes) -> tuple[Lanes, Lanes]:
    """Way north and east [m] over the last T [s] to a state whose u, v_m and r have changed at constant rates.

    Simpson's rule over the velocity over ground at the beginning, in the middle and at the end.
    """
    half = 0.5 * T
    north_0, east_0 = to_earth(state.psi - T * (state.r - half * dr), state.u - T * du, state.v_m - T * dv)
    north_1, east_1 = to_earth(
        state.psi - half * (state.r - 0.5 * half * dr), state.u - half * du, state.v_m - half * dv
    )
    north_2, east_2 = to_earth(state.psi, state.u, state.v_m)
    share = T / 6.0
    return share * (north_0 + 4.0 * north_1 + north_2), share * (east_0 + 4.0 * east_1 + east_2)


def _moved(state: State, north: Lanes, east: Lanes) -> State:
    return State(x=state.x + north, y=state.y + east, psi=state.psi, u=state.u, v_m=state.v_m, r=state.r)


def _of_then(state: State, du: Lanes, dv: Lanes, dr: Lanes, T: Lanes) -> State:
    """The velocity over ground of T [s] ago, in the axes of now, of a motion like that of ``_way``: the ship has turned
    since."""
    u, v_m = to_earth(-T * (state.r - 0.5 * T * dr), state.u - T * du, state.v_m - T * dv)
    return State(x=state.x, y=state.y, psi=state.psi, u=u, v_m=v_m, r=state.r)


def position_latency(
    start: State, end: State, held: tuple[()], h: Lanes, e: PositionLatency
) -> tuple[State, tuple[()]]:
    """Position of some seconds ago, and velocity over ground where that is late too, by the rates of u, v_m and r over
    the last step (assumption: they were the same before; 1 cm off in a turn of 35 deg at 3 s and steps of 1 s)."""
    step = np.maximum(h, 1e-9)
    du, dv, dr = (end.u - start.u) / step, (end.v_m - start.v_m) / step, (end.r - start.r) / step
    north, east = _way(end, du, dv, dr, e.seconds + e.with_velocity)
    return _moved(_of_then(end, du, dv, dr, e.with_velocity), -north, -east), ()


def position_settled(state: State, e: PositionLatency) -> tuple[State, tuple[()]]:
    """The same in a steady motion."""
    north, east = _way(state, 0.0, 0.0, 0.0, e.seconds + e.with_velocity)
    return _moved(_of_then(state, 0.0, 0.0, 0.0, e.with_velocity), -north, -east), ()


def position_latency_inverse(logged: State, e: PositionLatency) -> State:
    """Where the ship is in a steady motion, from where she was; and how she moves, from how she did."""
    now = _of_then(logged, 0.0, 0.0, 0.0, -e.with_velocity)
    north, east = _way(now, 0.0, 0.0, 0.0, e.seconds + e.with_velocity)
    return _moved(now, north, east)


def _delay(of: str) -> Parameter:
    return Parameter(
        f"how old {of} when logged",
        "s",
        low=-10.0,
        high=60.0,
        bounds=lambda ship: (-0.1 * ship.L / ship.U, 0.3 * ship.L / ship.U),
        typical=lambda ship: 0.03 * ship.L / ship.U,
        bounds_source="three tenths of the time of a ship length; a tenth early, by a receiver that looks ahead",
    )


def _sentence(v: Mapping[str, str]) -> str:
    late = {name: signed(size, "late", "early") for name, size in v.items()}
    told = [f"Positions were logged {late['seconds']}"] if "seconds" in v else []
    if "with_velocity" in v:
        together = (
            "The position and the velocity over ground were logged" if not told else "with the velocity over ground"
        )
        told.append(f"{together} {late['with_velocity']}")
    return ", and ".join(told)


EFFECT = FilterEffect(
    kind="effects.position-latency",
    tag="position-latency",
    title="latency of the receiver",
    told_by="the delay of the receiver, from its papers or beside a second one",
    params=PositionLatency,
    function=position_latency,
    settled=position_settled,
    inverse=position_latency_inverse,
    cites=(),
    fields={
        "seconds": _delay("the position is"),
        "with_velocity": _delay("position and velocity over ground are"),
    },
    variants=(("seconds",), ("with_velocity",)),
    varies=("seconds", "with_velocity"),
    sentence=_sentence,
)
