"""Which columns are wind: true and apparent wind make a triangle with the ship's own motion."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ... import units
from ...arrays import FloatArray
from .look import Look

SPEED_UNITS = ("m/s", "kn", "km/h")
TURN = 7.0
"""Angle beyond which there is no need to go in radians: a little more than a turn."""

CLOSES = 0.1
"""Share of the apparent wind by which a triangle may miss."""


@dataclass(frozen=True)
class Wind:
    """Columns of one wind and how they count; ``direction`` is "from" or "to"."""

    speed: int
    direction: int
    unit: str
    degrees: bool
    points: str


@dataclass(frozen=True)
class Triangle:
    """Both winds; ``miss`` is what is left of the triangle, a share of the apparent wind."""

    true: Wind
    apparent: Wind
    miss: float


def rows_of(look: Look, wind: Wind, apparent: bool) -> tuple[FloatArray, FloatArray]:
    """Velocity (n_rows,) of the air north and east [m/s]: over the ground, or past the ship where ``apparent``."""
    columns = look.windows.columns
    speed = columns[wind.speed] * units.factors("m/s")[wind.unit]
    angle = columns[wind.direction] * (units.factors("rad")["deg"] if wind.degrees else 1.0)
    if apparent:
        angle = angle + look.heading
    if wind.points == "from":
        angle = angle + np.pi
    return speed * np.cos(angle), speed * np.sin(angle)


def _ways(look: Look) -> tuple[FloatArray, FloatArray]:
    """The ship's velocity (n_rows,) north and east."""
    windows = look.windows
    middle = 0.5 * (windows.t[windows.edges[1:]] + windows.t[windows.edges[:-1]])
    known = np.isfinite(look.north) & np.isfinite(look.east)
    return np.interp(windows.t, middle[known], look.north[known]), np.interp(windows.t, middle[known], look.east[known])


def candidates(look: Look, among: Sequence[int], units_said: Sequence[str]) -> list[Wind]:
    """Pairs of columns that may be a wind: a speed that is never negative, and an angle."""
    columns, found = look.windows.columns, []
    sizes = [k for k in among if np.nanmin(columns[k], initial=np.inf) >= 0.0 and not look.windows.periods[k]]
    for speed, direction in itertools.permutations(among, 2):
        if speed not in sizes or units_said[speed] not in ("", *SPEED_UNITS):
            continue
        if units_said[direction] not in ("", "deg", "rad") or np.nanmax(columns[speed], initial=0.0) > 150.0:
            continue
        for degrees in _readings(look, direction, units_said[direction]):
            for unit in SPEED_UNITS if not units_said[speed] else (units_said[speed],):
                found += [Wind(speed, direction, unit, degrees, points) for points in ("from", "to")]
    return found


def _readings(look: Look, direction: int, said: str) -> list[bool]:
    """Whether an angle may be in degrees (True) and in radians (False), the likelier first: by the unit it says, by the
    jumps of a turn, and by its values: radians beyond a turn are those of a ship that went round."""
    turn = look.windows.periods[direction]
    if said or turn:
        readings = [said == "deg"] if said else [True, False]
        return [degrees for degrees in readings if not turn or degrees == (turn > TURN)]
    values = look.windows.columns[direction]
    if np.nanmax(np.abs(values), initial=0.0) <= TURN:
        return [False]
    return [True, False] if np.nanmax(values) - np.nanmin(values) >= TURN else [True]


def triangles(look: Look, found: Sequence[Wind]) -> list[Triangle]:
    """True and apparent winds that go together, best first."""
    if not np.isfinite(look.north).any():
        return []
    north, east = _ways(look)
    over = [rows_of(look, one, False) for one in found]
    past = [rows_of(look, one, True) for one in found]
    made = []
    for i, j in itertools.permutations(range(len(found)), 2):
        a, b = found[i], found[j]
        if {a.speed, a.direction} & {b.speed, b.direction} or a.unit != b.unit:
            continue
        off = np.hypot(past[j][0] - over[i][0] + north, past[j][1] - over[i][1] + east)
        size = float(np.sqrt(np.nanmean(past[j][0] ** 2 + past[j][1] ** 2)))
        way = float(np.sqrt(np.nanmean(north**2 + east**2)))
        if size > 0.0 and way > 0.02 * size:
            made.append(Triangle(a, b, float(np.sqrt(np.nanmean(off**2))) / size))
    return sorted(made, key=lambda one: one.miss)[:20]


def steadiness(look: Look, wind: Wind) -> dict[str, float]:
    """Share of the mean wind by which the true wind changes over the run, read as true and as apparent."""
    north, east = _ways(look)
    found = {}
    for words, apparent in (("true", False), ("apparent", True)):
        a, b = rows_of(look, wind, apparent)
        if apparent:
            a, b = a + north, b + east
        size = float(np.sqrt(np.nanmean(a**2 + b**2)))
        found[words] = float(np.sqrt(np.nanvar(a) + np.nanvar(b))) / size if size > 0.0 else 1.0
    return found
