"""Which columns are the rudder and the propeller: what the ship answers to."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ...trial.checks.cross_checks import ADVANCE
from ...units import DEG, factors
from ..conventions import RudderEvidence, rudder_evidence
from .look import Look

LARGEST = 1.75
"""Rudder angle [rad] beyond which a column is in degrees."""

OVER, FEWEST_OVER, ONE_SIDE = 5.0 * DEG, 8, 0.9
"""Rudder angle [rad] that is over, samples of a turn at least, and mean over mean size, of the angle and of the yaw
rate, from which both are to one side."""

TURNS = {one: factor for one, factor in factors("1/s").items() if one != "1/s"}
"""Units of revolutions, in turns a second."""


@dataclass(frozen=True)
class Rudder:
    """A column that a ship answers to as to her rudder.

    weight  how clearly
    circle  in a turn to one side: the sign of its angle, and the side she turns to (1: starboard); else None
    """

    column: int
    degrees: bool
    evidence: RudderEvidence
    weight: float
    circle: tuple[int, int] | None


def rudders(look: Look, among: Sequence[int], units_said: Sequence[str]) -> list[Rudder]:
    """Columns that may be a rudder, the clearest first."""
    windows = look.windows
    edges, t = windows.edges, windows.t
    middle = 0.5 * (t[edges[1:]] + t[edges[:-1]])
    known = np.isfinite(look.ahead)
    if known.sum() < 8:
        return []
    ahead = np.interp(t, middle[known], look.ahead[known])
    rate = look.rate_now()
    found = []
    for k in among:
        values = windows.columns[k]
        there = np.isfinite(values)
        if there.mean() < 0.5 or np.ptp(values[there]) == 0.0 or windows.periods[k]:
            continue
        largest = float(np.percentile(np.abs(values[there]), 99.0))
        degrees = units_said[k] == "deg" if units_said[k] in ("deg", "rad") else largest > LARGEST
        angle = values * (DEG if degrees else 1.0)
        if not 0.5 * DEG < float(np.percentile(np.abs(angle[there]), 99.0)) < 100.0 * DEG:
            continue
        filled = np.interp(t, t[there], angle[there])
        evidence = rudder_evidence(t, {"u": ahead, "r": rate, "delta": filled, "n": np.ones(len(t))})
        # A rudder stands for a while between orders, which no motion does.
        still = float(np.mean(np.abs(np.diff(filled)) < 1e-3 * np.ptp(filled)))
        weight = abs(evidence.gain) * (0.3 + still)
        found.append(Rudder(k, degrees, evidence, weight, _circle(filled, rate, ahead)))
    return sorted(found, key=lambda one: -one.weight)


def _circle(delta: FloatArray, rate: FloatArray, ahead: FloatArray) -> tuple[int, int] | None:
    """Of a turn with the rudder over to one side: the sign of its angle, and the side the ship turns to; else None.

    delta [rad], rate [rad/s] and ahead [m/s], (n_samples,)
    """
    over = (np.abs(delta) > OVER) & np.isfinite(rate) & (ahead > 0.0)
    if over.sum() < FEWEST_OVER or over.mean() < 0.3:
        return None
    angle, turn = delta[over], rate[over]
    sides = [float(np.mean(one)) / max(float(np.mean(np.abs(one))), 1e-300) for one in (angle, turn)]
    if min(map(abs, sides)) < ONE_SIDE:
        return None
    return int(np.sign(sides[0])), int(np.sign(sides[1]))


def side_of_circles(circles: Collection[tuple[int, int]]) -> int:
    """The side that positive angles turn a ship to, 1 starboard, where there are turns to either side; else 0: a ship
    that turns to one side whatever her rudder does shows nothing."""
    towards = {angle * side for angle, side in circles}
    return towards.pop() if len(towards) == 1 and len({angle for angle, _ in circles}) == 2 else 0


@dataclass(frozen=True)
class Shaft:
    """A column that may be revolutions.

    unit     "rpm", "rps" or what its name says, "" where both may be
    steady   share of the time it does not change
    advance  way with each turn, in lengths guessed from how quickly she turns, by unit
    """

    column: int
    unit: str
    steady: float
    advance: dict[str, float]


def shafts(look: Look, among: Sequence[int], units_said: Sequence[str], rudder: float) -> list[Shaft]:
    """Columns that may be the revolutions of a propeller, the likeliest first.

    rudder  her usual largest angle in this log [rad]

    A ship that turns at r with a speed U and that rudder is about 0.8 U rudder / r long; that is what tells revolutions
    a minute from those a second, which differ by a factor of 60.
    """
    speed = look.usual_speed
    quick = float(np.nanpercentile(np.abs(look.rate), 95.0)) if np.isfinite(look.rate).any() else 0.0
    length = 0.8 * speed * rudder / quick if quick > 0.0 else float("nan")
    found = []
    for k in among:
        values = look.windows.columns[k]
        values = values[np.isfinite(values)]
        if len(values) < 10:
            continue
        size = float(np.percentile(np.abs(values), 80.0))
        if size == 0.0 or look.windows.periods[k]:
            continue
        said = units_said[k].replace("1/s", "rps")
        may_be = [said] if said in TURNS else ["rpm", "rps"]
        advance = {unit: speed / (size * TURNS[unit]) / length for unit in may_be}
        fits = {one: abs(np.log(way / 0.025)) for one, way in advance.items() if ADVANCE[0] < way < ADVANCE[1]}
        unit = said if said in TURNS else min(fits, key=lambda one: fits[one], default="")
        spread = float(np.ptp(values))
        steady = 1.0 if spread == 0.0 else float(np.mean(np.abs(np.diff(values)) < 2e-3 * spread))
        one_way = float(np.mean(values > -0.02 * size))
        calm = 1.0 - min(1.0, float(np.std(values)) / max(abs(float(np.mean(values))), 1e-300))
        found.append((one_way * (1.0 + steady + calm), Shaft(k, unit, steady, advance)))
    return [one for _, one in sorted(found, key=lambda pair: -pair[0])]
