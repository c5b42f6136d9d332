"""The heading is logged through a low-pass: by a damped or slowly read compass."""

from typing import NamedTuple

from ..components import AT_LEAST_0
from ..physics.following import followed
from ..physics.quantities import Lanes, State
from .effect import FilterEffect, Parameter
from .heading_bias import ANTENNA, MIDSHIP, MOVED_FROM, heading_shown


class HeadingFilter(NamedTuple):
    """See the parameters below."""

    time_constant: Lanes
    alone: Lanes
    antenna_ahead: Lanes
    antenna_abeam: Lanes


def heading_filter(
    start: State, end: State, held: tuple[Lanes, Lanes], h: Lanes, e: HeadingFilter
) -> tuple[State, tuple[Lanes, Lanes]]:
    """Heading behind a first-order low-pass (assumption); the velocity over ground is logged in the axes of the heading
    shown, but for that part of the lag that is of the heading alone."""
    turned = followed(start.psi, end.psi, held[0], h, e.time_constant)
    alone = followed(start.psi, end.psi, held[1], h, e.alone)
    return heading_shown(end, turned - end.psi, alone - end.psi, e), (turned, alone)


def heading_settled(state: State, e: HeadingFilter) -> tuple[State, tuple[Lanes, Lanes]]:
    """The same in a steady turn: T r behind."""
    turned, alone = -e.time_constant * state.r, -e.alone * state.r
    return heading_shown(state, turned, alone, e), (state.psi + turned, state.psi + alone)


def heading_filter_inverse(logged: State, e: HeadingFilter) -> State:
    """The motion of a steady turn from what was logged."""
    return heading_shown(logged, e.time_constant * logged.r, e.alone * logged.r, e)


def _constant(what: str) -> Parameter:
    return Parameter(
        f"time constant of the heading shown, {what}",
        "s",
        low=AT_LEAST_0,
        bounds=lambda ship: (0.0, 0.5 * ship.L / ship.U),
        typical=lambda ship: 0.03 * ship.L / ship.U,
        bounds_source="half the time of a ship length",
    )


EFFECT = FilterEffect(
    kind="effects.heading-filter",
    tag="heading-filter",
    title="low-pass of the heading",
    told_by="the filter that is set in the compass, or a second compass",
    params=HeadingFilter,
    function=heading_filter,
    settled=heading_settled,
    inverse=heading_filter_inverse,
    states=("turned", "alone"),
    cites=(),
    fields={
        "time_constant": _constant("in whose axes velocities are logged"),
        "alone": _constant("velocities being logged in the ship's own axes"),
        **ANTENNA,
    },
    pivots=MIDSHIP,
    read_off=MOVED_FROM,
    variants=(("time_constant",), ("alone",)),
    sentence=lambda v: (
        "The compass lagged behind the heading, by a time constant or a delay of "
        + " and ".join(
            words.format(v[name])
            for name, words in {
                "time_constant": "{} (velocities are logged in the axes it shows)",
                "alone": "{} (velocities are logged in the ship's own axes)",
            }.items()
            if name in v
        )
    ),
)
