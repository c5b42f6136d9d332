"""IMO criteria on manoeuvring indices, resolution MSC.137(76), section 5.3.

Functions take L, the length between perpendiculars [m], and V, the test speed [m/s].
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ..units import DEG
from .stopping import StoppingIndices
from .turning import TurningIndices
from .zigzag import ZigzagIndices

SOURCE = "IMO MSC.137(76), 5.3"
ADVANCE_LIMIT = 4.5
TACTICAL_DIAMETER_LIMIT = 5.0
INITIAL_TURNING_LIMIT = 2.5
"""Limits of distances [L]."""

TRACK_REACH_LIMIT = 15.0
"""Limit of the track reach of a full astern stop [L]; an Administration may allow up to 20 for ships of large
displacement, which is not judged here."""

FIRST_OVERSHOOT_LIMIT_20_20 = 25.0
"""First overshoot of the 20/20 zigzag [deg]."""

LARGEST_RUDDER = 35.0 * DEG
"""Rudder angle of the turning circle, where the ship has no smaller largest angle [rad]."""

ANGLE_TOLERANCE = 1.5 * DEG
"""How far a rudder angle may be from the asked one to count as it [rad]; a choice of this program."""

SPEED_TOLERANCE = 0.1
"""How far the approach speed may be from the test speed [-]; a choice of this program."""


@dataclass(frozen=True)
class Criterion:
    """One criterion on one trial.

    name, value, limit, unit  what is limited from above; value None if the record does not reach it
    passed                    None where the criterion cannot be judged; ``reason`` then says why
    source                    where the limit is from
    """

    name: str
    value: float | None
    limit: float
    unit: str
    passed: bool | None
    source: str
    reason: str = ""

    def to_dict(self) -> dict[str, Any]:
        """The same fields, for JSON."""
        return asdict(self)


def first_overshoot_limit(L: float, V: float) -> float:
    """Largest first overshoot of the 10/10 zigzag [deg]; MSC.137(76), 5.3.3.1."""
    return _between(L, V, 10.0, 5.0, 0.5, 20.0)


def second_overshoot_limit(L: float, V: float) -> float:
    """Largest second overshoot of the 10/10 zigzag [deg]; MSC.137(76), 5.3.3.2."""
    return _between(L, V, 25.0, 17.5, 0.75, 40.0)


def check_turning(
    indices: TurningIndices, L: float, V: float, *, largest_rudder: float = LARGEST_RUDDER
) -> tuple[Criterion, ...]:
    """Advance and tactical diameter; initial turning ability as well where the rudder was at 10 deg.

    largest_rudder  the rudder angle the circle is asked for, 35 deg or the largest permissible [rad]
    """
    why = _unfit(indices.execute_at_start, indices.approach_speed, V)
    circle = why
    if not circle and abs(indices.rudder_angle - largest_rudder) > ANGLE_TOLERANCE:
        circle = f"rudder at {indices.rudder_angle / DEG:.1f} deg, asked for at {largest_rudder / DEG:.1f} deg"
    advance, diameter = _lengths(indices.advance, L), _lengths(indices.tactical_diameter, L)
    found = [
        _criterion("advance", advance, ADVANCE_LIMIT, "L", ".1", circle),
        _criterion("tactical diameter", diameter, TACTICAL_DIAMETER_LIMIT, "L", ".1", circle),
    ]
    if abs(indices.rudder_angle - 10.0 * DEG) <= ANGLE_TOLERANCE:
        distance = _lengths(indices.initial_turning_distance, L)
        found.append(_criterion("initial turning distance", distance, INITIAL_TURNING_LIMIT, "L", ".2", why))
    return tuple(found)


def check_zigzag(indices: ZigzagIndices, L: float, V: float) -> tuple[Criterion, ...]:
    """Nominal overshoots and initial turning of a 10/10 zigzag, first overshoot of a 20/20; () for any other."""
    why = _unfit(indices.execute_at_start, indices.approach_speed, V)
    over = [angle / DEG for angle in indices.overshoot]
    first = over[0] if over else None
    if _is_zigzag(indices, 10.0):
        second = over[1] if len(over) > 1 else None
        distance = _lengths(indices.initial_turning_distance, L)
        return (
            _criterion("initial turning distance", distance, INITIAL_TURNING_LIMIT, "L", ".2", why),
            _criterion("first overshoot 10/10", first, first_overshoot_limit(L, V), "deg", ".3.1", why),
            _criterion("second overshoot 10/10", second, second_overshoot_limit(L, V), "deg", ".3.2", why),
        )
    if _is_zigzag(indices, 20.0):
        return (_criterion("first overshoot 20/20", first, FIRST_OVERSHOOT_LIMIT_20_20, "deg", ".3.3", why),)
    return ()


def check_stopping(indices: StoppingIndices, L: float, V: float) -> tuple[Criterion, ...]:
    """Track reach of a full astern stop."""
    why = _unfit(False, indices.approach_speed, V)
    return (_criterion("track reach", _lengths(indices.track_reach, L), TRACK_REACH_LIMIT, "L", ".4", why),)


def _between(L: float, V: float, short: float, base: float, slope: float, long: float) -> float:
    """The limit for L/V below 10 s, between, and from 30 s on, as for a ship at rest."""
    if L >= 30.0 * V:
        return long
    return short if L < 10.0 * V else base + slope * (L / V)


def _is_zigzag(indices: ZigzagIndices, degrees: float) -> bool:
    """Whether rudder and heading angle are both this one."""
    pair = (indices.rudder_angle, indices.heading_angle)
    return all(angle is not None and bool(np.isclose(angle / DEG, degrees)) for angle in pair)


def _lengths(distance: float | None, L: float) -> float | None:
    """A distance in ship lengths."""
    return None if distance is None else distance / L


def _unfit(at_start: bool, approach_speed: float, V: float) -> str:
    """Why no criterion can be judged on the trial, or ""."""
    if at_start:
        return "the record begins with the rudder already over"
    if not V > 0.0:
        return "the test speed is 0"
    if abs(approach_speed / V - 1.0) > SPEED_TOLERANCE:
        return f"approach at {approach_speed:.2f} m/s, test speed {V:.2f} m/s"
    return ""


def _criterion(name: str, value: float | None, limit: float, unit: str, part: str, why: str) -> Criterion:
    """A criterion with its verdict; ``why`` says why it cannot be given."""
    if value is None:
        return Criterion(name, None, limit, unit, None, SOURCE + part, why or "the record does not reach it")
    if unit == "L" and value <= 0.0 and not why:
        return Criterion(name, value, limit, unit, False, SOURCE + part, "the ship went to the other side or astern")
    return Criterion(name, value, limit, unit, None if why else value <= limit, SOURCE + part, why)
