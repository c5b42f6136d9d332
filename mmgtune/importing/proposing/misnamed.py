"""Units that the names of columns say and their behaviour refutes, as of a rate in deg/s under "ROT [deg/min]"."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .finder import ROUGH, Finder
from .look import Look
from .motions import Match, courses, speeds, yaw_rates
from .words import LOG_SPEED

FITS_RATE, FITS_COURSE = 0.95, 0.2
"""Correlation of a yaw rate, and miss of a course [rad], from which another unit is believed."""

VELOCITIES = ("u", "v", "sog", LOG_SPEED)


def doubt_units(find: Finder) -> None:
    """Believe no name's unit of a rate, a speed or a course that fits in another one only.

    One component of the velocity goes with the other: abeam a ship moves too little to tell by.
    """
    wrong = [k for k in find.pool() if find.units_said[k] and _elsewhere(find, k)]
    speeds_wrong = {find.units_said[k] for k in wrong if find.said[k] in VELOCITIES}
    wrong += [k for k in find.pool() if find.said[k] == "v" and find.units_said[k] in speeds_wrong and k not in wrong]
    for k in wrong:
        find.units_wrong[k], find.units_said[k] = find.units_said[k], ""


def agrees(find: Finder, k: int) -> bool:
    """Whether a column is a rate, a speed or a course, as its name says, in one log at least."""
    fits = _fits(find, k)
    return fits is not None and any(fits(look, k, find.units_said) for look in find.looks)


def _fits(find: Finder, k: int) -> Callable[[Look, int, Sequence[str]], bool] | None:
    return {"r": _rate, "cog": _course, "u": _speed, "sog": _speed, LOG_SPEED: _speed}.get(find.said[k])


def _elsewhere(find: Finder, k: int) -> bool:
    """Whether a column is what its name says in most logs, but in none with the unit that its name says."""
    fits = _fits(find, k)
    if fits is None or agrees(find, k):
        return False
    free = [*find.units_said[:k], "", *find.units_said[k + 1 :]]
    return 2 * sum(fits(look, k, free) for look in find.looks) > len(find.looks)


def _rate(look: Look, k: int, units_said: Sequence[str]) -> bool:
    return any(abs(correlation) > FITS_RATE for _, correlation, _ in yaw_rates(look, [k], units_said).values())


def _course(look: Look, k: int, units_said: Sequence[str]) -> bool:
    return _least(courses(look, [k], units_said)) < FITS_COURSE


def _speed(look: Look, k: int, units_said: Sequence[str]) -> bool:
    return _least(speeds(look, look.speed, [k], units_said, False)) < ROUGH


def _least(found: Sequence[Match]) -> float:
    return min((one.miss for one in found), default=float("inf"))
