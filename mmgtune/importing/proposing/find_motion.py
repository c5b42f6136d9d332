"""Yaw rate and velocities, voted on by all logs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ... import units
from ...arrays import FloatArray
from ...phrases import figures
from ...trial.kinematics import FITS
from ...units import DEG
from .finder import ROUGH, Finder
from .guess import LIKELY, SURE, Guess
from .look import Look
from .motions import Match, courses, speeds, through_water, velocities, yaw_rates
from .words import LOG_SPEED, ORDER, OTHER, ROLL, plain

FACTOR = 0.03
"""Share by which a speed may be more or less than that of the positions throughout and still be surely what it is."""
GOES_WITH = 0.6
"""Correlation with the sway from which a column called so is that."""
STRAIGHT, FEW = 0.1, 5
"""Drift as a share of the speed up to which she goes straight, and windows of a log that show how fast then."""
CLEAR = 0.15
"""Standard error of the share of what drift takes off a speed, from which that share tells which speed it is."""


def yaw_rate(find: Finder) -> None:
    votes: dict[tuple[int, str, bool], list[tuple[float, float]]] = defaultdict(list)
    pool = [k for k in find.pool("psi", "cog", "x", "y", "delta") if not _called_sway(find, k)]
    for look in find.looks:
        for match, correlation, factor in yaw_rates(look, pool, find.units_said).values():
            off = abs(np.log(factor / units.factors("rad/s")[match.unit]))
            votes[match.column, match.unit, match.minus].append((abs(correlation) ** 4 - 2.0 * off, correlation))
    if not votes:
        return
    named = {
        key: sum(one for one, _ in many) + 0.5 * len(many) * (find.said[key[0]] == "r") for key, many in votes.items()
    }
    best = max(named, key=lambda one: named[one])
    column, unit, minus = best
    own, words = find.unit_of(column, "rad/s", unit)
    own["positive"] = "port" if minus else "starboard"
    correlation = float(np.median([one for _, one in votes[best]]))
    said = f"the heading changes by it, correlation {correlation:+.3f} in {len(votes[best])} of {len(find.looks)} logs"
    others = sorted({key[0] for key in votes if key[0] != column})
    evidence = [f"{said}, in {unit}{words}"]
    if others:
        evidence.append(f"it fits better than {', '.join(find.shown(k) for k in others[:3])}")
    find.add(Guess("r", column, own, tuple(evidence), SURE if abs(correlation) > 0.95 else LIKELY))


def _called_sway(find: Finder, k: int) -> bool:
    """Whether a column is called a velocity abeam, which goes with the yaw rate, by more than a letter."""
    return find.said[k] == "v" and len(plain(find.first.names[k])) > 2


def velocity(find: Finder) -> None:
    skip = (
        "delta",
        "n",
        "depth",
        "psi",
        "wind_speed",
        "wind_speed_app",
        "wind_dir",
        "wind_dir_app",
        ROLL,
        OTHER,
        ORDER,
    )
    among = find.pool(*skip)
    votes: dict[tuple[Any, ...], list[float]] = defaultdict(list)
    for look in find.looks:
        found = velocities(look, [k for k in among if k not in find.used], find.units_said)
        for one in found[:30]:
            key = (one.axes, one.first.column, one.second.column, one.first.unit, one.first.minus, one.second.minus)
            votes[key].append(one.miss)
    scores = {
        key: float(np.median(many)) * (1.0 + 0.5 * (len(find.looks) - len(many)) / len(find.looks))
        * _named(find, key[1], key[2]) for key, many in votes.items()
    }  # fmt: skip
    best = min(scores, key=lambda one: scores[one], default=None)
    if best is not None and np.median(votes[best]) < ROUGH:
        _both(find, best, scores, float(np.median(votes[best])))
    if "u" not in find.guesses:
        ground_speed(find, [k for k in among if k not in find.used])
    if "u" not in find.guesses and "sog" not in find.guesses:
        _one_speed(find, among)


def _named(find: Finder, first: int, second: int) -> float:
    """Less than 1 where names agree that two columns are velocities, more where they contradict."""
    agrees = sum(find.said[k] == name for k, name in ((first, "u"), (second, "v")))
    against = sum(find.said[k] not in ("", "u", "v", "sog", LOG_SPEED, "x", "y") for k in (first, second))
    return float(0.6**agrees * 2.0**against)


def _both(find: Finder, key: tuple[Any, ...], scores: Mapping[tuple[Any, ...], float], miss: float) -> None:
    axes, first, second, unit, minus, second_minus = key
    # Of other readings those that count: other axes, another sign of the second, of the same columns.
    rivals = [score for one, score in scores.items() if {one[1], one[2]} == {first, second} and one[:2] != key[:2]]
    signs = [score for one, score in scores.items() if one[:5] == key[:5] and one[5] != second_minus]
    clear = all(score > 2.0 * scores[key] for score in rivals)
    side = all(score > 1.25 * scores[key] for score in signs)
    if not _second_needed(find, axes, second, unit, second_minus):
        return
    words = f"{axes} axes: they miss the positions by {figures(100.0 * miss)} % of the speed"
    if rivals:
        words += f", read otherwise by {figures(100.0 * min(rivals))} %"
    own, more = find.unit_of(first, "m/s", unit)
    other, _ = find.unit_of(second, "m/s", unit)
    ways = {"ship": (("forward", "aft"), ("starboard", "port")), "earth": (("north", "south"), ("east", "west"))}[axes]
    own["positive"], other["positive"] = ways[0][minus], ways[1][second_minus]
    confidence = SURE if clear and side and miss < FITS else LIKELY
    find.axes = axes
    find.add(Guess("u", first, own, (words + more,), confidence))
    find.add(Guess("v", second, other, (words,), confidence))


def _second_needed(find: Finder, axes: str, column: int, unit: str, minus: bool) -> bool:
    """Whether a column explains the sway, or the way east, better than the yaw rate does; of one that is called so,
    whether it goes with it, however noisy it is."""
    told, direct, together = [], [], []
    for look in find.looks:
        target = look.abeam if axes == "ship" else look.east
        logged = look.mean(column) * units.factors("m/s")[unit]
        both = np.isfinite(target) & np.isfinite(logged) & np.isfinite(look.rate)
        if both.sum() > 8:
            # A lever of the yaw rate is what velocities of another point differ by.
            rate = look.rate[both]
            lever = float(rate @ target[both]) / max(float(rate @ rate), 1e-300)
            without = target[both] - lever * rate
            sign = -1.0 if minus else 1.0
            off = target[both] - sign * logged[both]
            size = _size(target[both])
            direct.append(_size(off) / size)
            together.append(sign * float(target[both] @ logged[both]) / size / _size(logged[both]) / both.sum())
            off = off - float(rate @ off) / max(float(rate @ rate), 1e-300) * rate
            told.append(_size(off) / _size(without))
    if not told:
        return False
    named = find.said[column] == "v"
    goes = float(np.median(told)) < (1.0 if named else 0.8) or float(np.median(direct)) < 0.35
    return goes or (named and float(np.median(together)) > GOES_WITH)


def _size(values: FloatArray) -> float:
    """Root of the mean square, more than 0."""
    return max(float(np.sqrt(np.mean(values**2))), 1e-300)


def ground_speed(find: Finder, among: Sequence[int]) -> None:
    """Speed and course over the ground."""
    votes: dict[tuple[int, str], list[float]] = defaultdict(list)
    for look in find.looks:
        for match in courses(look, among, find.units_said)[:6]:
            votes[match.column, match.unit].append(match.miss)
    psi = find.guesses["psi"].column
    heading = [
        float(np.nanstd(np.angle(np.exp(1j * (look.psi - np.arctan2(look.east, look.north)))))) for look in find.looks
    ]
    drift = float(np.median(heading)) if heading else 0.0
    scores = {key: float(np.median(many)) for key, many in votes.items() if len(many) >= 0.5 * len(find.looks)}
    scores = {key: miss * (0.5 if find.said[key[0]] == "cog" else 1.0) for key, miss in scores.items()}
    # Behaviour alone must show a course where no name does: closer than the heading is, and turning as far.
    best = min(scores, key=lambda one: scores[one], default=None)
    if best is None or best[0] == psi:
        return
    named = find.said[best[0]] == "cog"
    wide = [_turns_as_far(look, best) for look in find.looks]
    if not (named or (scores[best] < 0.7 * max(drift, 2.0 * DEG) and np.median(wide) > 0.7)) or scores[best] > 0.6:
        return
    speeds_found: dict[tuple[int, str], list[float]] = defaultdict(list)
    for look in find.looks:
        for match in speeds(look, look.speed, [k for k in among if k != best[0]], find.units_said, False)[:6]:
            speeds_found[match.column, match.unit].append(match.miss)
    merit = {"sog": 0.4, LOG_SPEED: 2.5, "v": 2.5}
    sizes = {
        key: float(np.median(many)) * merit.get(find.said[key[0]], 1.0)
        for key, many in speeds_found.items()
        if len(many) >= 0.5 * len(find.looks)
    }
    speed = min(sizes, key=lambda one: sizes[one], default=None)
    if speed is None or sizes[speed] > ROUGH:
        return
    own, words = find.unit_of(best[0], "rad", best[1])
    size, more = find.unit_of(speed[0], "m/s", speed[1])
    miss = float(np.median(speeds_found[speed]))
    find.add(
        Guess(
            "sog",
            speed[0],
            size,
            (f"it is the speed along the track within {figures(100.0 * miss)} %, in {speed[1]}{more}",),
        )
    )
    off = float(np.median(votes[best]))
    said = (
        f"it is the direction of the track within {off / DEG:.2g} deg; the heading differs by {drift / DEG:.2g}{words}"
    )
    find.add(Guess("cog", best[0], {**own, "positive": "clockwise"}, (said,)))


def _turns_as_far(look: Look, key: tuple[int, str]) -> float:
    angle = look.mean(key[0]) * units.factors("rad")[key[1]]
    course = np.arctan2(look.east, look.north)
    course = np.unwrap(course[np.isfinite(course)])
    return float(np.nanstd(angle) / max(float(np.nanstd(course)), 1e-9))


def _one_speed(find: Finder, among: Sequence[int]) -> None:
    """A single speed: over the ground ahead, or through the water."""
    votes: dict[tuple[int, str, bool], list[float]] = defaultdict(list)
    for look in find.looks:
        for match in speeds(look, look.ahead, [k for k in among if k not in find.used], find.units_said, True)[:8]:
            votes[match.column, match.unit, match.minus].append(match.miss)
    scores = {
        key: float(np.median(many)) * (0.5 if find.said[key[0]] in ("u", "sog", LOG_SPEED) else 1.0) + 0.2 * key[2]
        for key, many in votes.items()
        if len(many) >= 0.5 * len(find.looks)
    }
    best = min(scores, key=lambda one: scores[one], default=None)
    if best is None or np.median(votes[best]) > (0.35 if find.said[best[0]] == LOG_SPEED else ROUGH):
        return
    column, unit, minus = best
    water = [through_water(look, Match(column, unit, minus, 0.0)) for look in find.looks]
    told = [one for one in water if one is not None]
    current = float(np.median([one[0] for one in told])) if told else 0.0
    flows = (
        bool(told) and float(np.median([one[1] for one in told])) > 0.6 and current > 0.02 * find.looks[0].usual_speed
    )
    of_log = find.said[column] == LOG_SPEED
    along = not minus and not of_log and _along_the_track(find, column, unit)
    # What nothing says to be along the track may be that ahead times a factor, which a turn alone does not tell apart.
    factor = _factor(find, column, unit, along and find.said[column] == "sog")
    # A current that no turn shows may be as large as what a log is off by.
    if flows or (of_log and not told and abs(factor - 1.0) > FACTOR):
        why = (
            f"it differs from the speed over the ground by a steady flow of {current:.2g} m/s"
            if flows
            else "its name says so"
        )
        find.notes.append(f"{find.shown(column)} is the speed through the water ({why}), which a trial does not hold")
        find.used.add(column)
        return
    own, words = find.unit_of(column, "m/s", unit)
    miss = float(np.median(votes[best]))
    off = abs(factor - 1.0) > FACTOR
    confidence = SURE if miss < FITS and not off else LIKELY
    if of_log:
        words += "; its name says that it is of a log, which measures the speed ahead through the water"
    if off:
        more = f"{figures(100.0 * abs(factor - 1.0))} % {'more' if factor > 1.0 else 'less'}"
        words += f"; it says {more} than the positions throughout: is it off by a factor?"
    if along:
        said = f"it is the speed along the track within {figures(100.0 * miss)} %, in {unit}{words}"
        find.add(Guess("sog", column, own, (said, "its direction is that of the positions"), confidence))
        return
    own["positive"] = "aft" if minus else "forward"
    find.axes = "ship"
    said = f"it is the speed ahead within {figures(100.0 * miss)} %, in {unit}{words}"
    find.add(Guess("u", column, own, (said,), confidence))


def _factor(find: Finder, column: int, unit: str, along: bool) -> float:
    """How many times the speed of the positions, ahead or ``along`` the track, a column says, usually; where she goes
    straight, which are the same then, if she does."""
    ratios, straight = [], []
    for look in find.looks:
        with np.errstate(all="ignore"):
            # In a turn a ship drifts, and her speed along the track is more than that ahead.
            of = look.speed if along else np.abs(look.ahead)
            ratio = np.abs(look.mean(column)) * units.factors("m/s")[unit] / of
        there = np.isfinite(ratio) & (np.abs(look.ahead) > 0.5 * look.usual_speed)
        ratios.append(ratio[there])
        straight.append((np.abs(look.abeam) < STRAIGHT * look.speed)[there])
    if not ratios:
        return 1.0
    every, those = np.concatenate(ratios), np.concatenate(straight)
    if those.sum() >= FEW:
        every = every[those]
    return float(np.median(every)) if len(every) else 1.0


def _along_the_track(find: Finder, column: int, unit: str) -> bool:
    """Whether a speed is that of the track, not its part ahead: what drift takes off tells, or else the name."""
    drifts, takes = [], []
    for look in find.looks:
        logged = look.mean(column) * units.factors("m/s")[unit]
        both = np.isfinite(logged) & np.isfinite(look.speed) & np.isfinite(look.ahead)
        drifts.append((look.speed - look.ahead)[both])
        takes.append((logged - look.ahead)[both])
    drift, taken = np.concatenate(drifts), np.concatenate(takes)
    weight = max(float(drift @ drift), 1e-300)
    share = float(drift @ taken) / weight
    if float(np.std(taken - share * drift)) > CLEAR * np.sqrt(weight):
        return find.said[column] == "sog"
    return share > 0.5
