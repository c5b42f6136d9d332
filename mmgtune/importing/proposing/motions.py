"""Which columns are the yaw rate and the velocities: they are what position and heading change by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ... import units
from ...arrays import FloatArray
from ...units import DEG
from .look import Look

RATES = ("deg/s", "rad/s", "deg/min")
SPEEDS = ("m/s", "kn", "km/h")
ANGLES = ("deg", "rad")
NEAR = 0.12
"""How far a factor may lie from that of a unit, as a share."""


@dataclass(frozen=True)
class Match:
    """A column that is a quantity.

    unit, minus  how it counts
    miss         what is left unexplained: a share of the quantity's own size
    """

    column: int
    unit: str
    minus: bool
    miss: float


def yaw_rates(look: Look, among: Sequence[int], units_said: Sequence[str]) -> dict[int, tuple[Match, float, float]]:
    """Columns whose integral follows the heading: match, correlation, and factor on the unit's own."""
    found = {}
    known_rate = np.isfinite(look.rate)
    for k in among:
        mean = look.mean(k)
        both = known_rate & np.isfinite(mean)
        if both.sum() < 8 or np.std(mean[both]) == 0.0 or np.std(look.rate[both]) == 0.0:
            continue
        slope, logged = look.rate[both], mean[both]
        correlation = float(np.corrcoef(slope, logged)[0, 1])
        if abs(correlation) < 0.8:
            continue
        # Both have noise: the factor is the ratio of their spreads.
        factor = float(np.std(slope) / np.std(logged))
        allowed = [one for one in RATES if not units_said[k] or units_said[k] == one]
        fits = {one: abs(np.log(factor / units.factors("rad/s")[one])) for one in allowed}
        best = min(fits, key=lambda one: fits[one], default="")
        if best and fits[best] < np.log(1.0 + 2.0 * NEAR):
            found[k] = (
                Match(k, best, correlation < 0.0, float(np.sqrt(max(0.0, 1.0 - correlation**2)))),
                correlation,
                factor,
            )
    return found


def speeds(look: Look, target: FloatArray, among: Sequence[int], units_said: Sequence[str], signs: bool) -> list[Match]:
    """Columns that are a velocity (n_windows,) [m/s] as the positions show it, best first.

    A constant share of the yaw rate, the lever of another point of the ship, counts as explained.
    """
    size = float(np.sqrt(np.nanmean(target**2))) if np.isfinite(target).any() else 0.0
    found = []
    for k in among:
        mean = look.mean(k)
        both = np.isfinite(mean) & np.isfinite(target) & np.isfinite(look.rate)
        if both.sum() < 8 or size == 0.0:
            continue
        for unit in SPEEDS if units_said[k] not in units.factors("m/s") else (units_said[k],):
            if units_said[k] and units_said[k] != unit:
                continue
            logged = mean[both] * units.factors("m/s")[unit]
            for minus in (False, True) if signs else (False,):
                rest = target[both] + logged if minus else target[both] - logged
                found.append(Match(k, unit, minus, float(np.sqrt(np.mean(rest**2))) / size))
    return sorted(found, key=lambda one: one.miss)


@dataclass(frozen=True)
class Velocities:
    """Two columns read as the velocity.

    axes    "ship" or "earth"
    first   ahead or north; second: abeam or east
    miss    share of the speed by which they miss the positions
    """

    axes: str
    first: Match
    second: Match
    miss: float


def velocities(look: Look, among: Sequence[int], units_said: Sequence[str]) -> list[Velocities]:
    """Readings of pairs of columns as the velocity, best first: in ship axes, and in earth axes."""
    found = []
    usual = look.usual_speed
    if usual == 0.0:
        return []
    for axes, (a, b) in (("ship", (look.ahead, look.abeam)), ("earth", (look.north, look.east))):
        firsts, seconds = (_absolute(look, one, among, units_said) for one in (a, b))
        for first in firsts[:12]:
            for second in seconds[:12]:
                if first.column != second.column and first.unit == second.unit:
                    found.append(Velocities(axes, first, second, float(np.hypot(first.miss, second.miss)) / usual))
    return sorted(found, key=lambda one: one.miss)


def _absolute(look: Look, target: FloatArray, among: Sequence[int], units_said: Sequence[str]) -> list[Match]:
    """The same as ``speeds``, of either sign, with misses in m/s."""
    size = float(np.sqrt(np.nanmean(target**2))) if np.isfinite(target).any() else 0.0
    return [
        Match(one.column, one.unit, one.minus, one.miss * size) for one in speeds(look, target, among, units_said, True)
    ]


def courses(look: Look, among: Sequence[int], units_said: Sequence[str]) -> list[Match]:
    """Columns that are the course over the ground, best first; misses in rad."""
    course = np.arctan2(look.east, look.north)
    under_way = look.speed > 0.5 * look.usual_speed
    found = []
    for k in among:
        mean = look.mean(k)
        both = np.isfinite(mean) & np.isfinite(course) & under_way
        if both.sum() < 8:
            continue
        turn = look.windows.periods[k]
        for unit in ANGLES:
            if (units_said[k] and units_said[k] != unit) or (turn and (unit == "deg") != (turn > 7.0)):
                continue
            angle = mean[both] * units.factors("rad")[unit]
            if np.abs(angle).max() > 200.0:
                continue
            off = np.angle(np.exp(1j * (angle - course[both])))
            found.append(Match(k, unit, False, float(np.sqrt(np.mean(off**2)))))
    return sorted(found, key=lambda one: one.miss)


def through_water(look: Look, match: Match) -> tuple[float, float] | None:
    """Size of the current [m/s] that a speed ahead is off by, and the share of the difference it explains.

    None where the ship does not turn enough to tell.
    """
    logged = look.mean(match.column) * units.factors("m/s")[match.unit]
    off = look.ahead - (-logged if match.minus else logged)
    both = np.isfinite(off) & np.isfinite(look.psi)
    if both.sum() < 12 or np.ptp(look.psi[both]) < 150.0 * DEG:
        return None
    basis = np.column_stack([np.cos(look.psi[both]), np.sin(look.psi[both]), np.ones(int(both.sum()))])
    fit, *_ = np.linalg.lstsq(basis, off[both], rcond=None)
    rest = off[both] - basis @ fit
    spread = float(np.var(off[both]))
    if spread == 0.0:
        return None
    return float(np.hypot(fit[0], fit[1])), 1.0 - float(np.var(rest)) / spread
