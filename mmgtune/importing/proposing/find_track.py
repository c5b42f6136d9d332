"""Position and heading, voted on by all logs."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ... import units
from ...phrases import listed
from ...trial.kinematics import FITS
from ...units import DEG
from ..cells.headers import bare
from .bearings import Track, keys_of, tracks
from .clocks import in_seconds, likely_units
from .find_time import CLEARLY, time_unit
from .finder import Finder
from .guess import LIKELY, SURE, Guess
from .look import Look
from .motions import courses, speeds, velocities, yaw_rates
from .unsaid import asked_length, other_length
from .windows import Windows
from .words import ORDER, OTHER, ROLL, TIME, magnetic

_OTHER_HALF = {"x": "y", "y": "x", "latitude": "longitude", "longitude": "latitude"}
_HALF = {"x": "the position to the north", "y": "the position to the east"}
_HALF |= {"latitude": "latitude", "longitude": "longitude"}
_ANGLES_OF_ROBOTS = ("yaw", "theta")
DRIFTS = 2.0 * DEG
"""Standard deviation of heading and course of each other from which a ship drifts in turns."""
LEADS = (0.3, 0.4)
"""Correlation of what an angle is ahead of the course with the rate of turn, from which it is a heading: where its name
says so, and where it does not."""
_DIVIDER = re.compile(r"[./]")
"""Between the parts of a name such as pose.position.x."""


@dataclass(frozen=True, eq=False)
class Motion:
    """What logs show of a motion with time in one unit.

    scores, words  by reading: what speaks for it in all logs, and in words
    windows        of each log
    agreeing       how many of yaw rate and velocities are what they must be with the likeliest reading
    """

    unit: str
    scores: Mapping[Track, float]
    words: Mapping[Track, str]
    windows: Sequence[Windows]
    agreeing: float

    @property
    def likeliest(self) -> float:
        """Score of the likeliest reading, 0 where there is none."""
        return max(self.scores.values(), default=0.0)

    @property
    def explained(self) -> float:
        """How much fits with time in this unit."""
        return self.likeliest + 2.0 * self.agreeing


def position_and_heading(find: Finder) -> None:
    """Find the position, the heading and the unit of time together, by which course follows which heading."""
    motion = _likeliest_motion(find)
    if motion is None:
        find.unit = likely_units(find.first, find.clock)[0]
        time_unit(find)
        find.notes.append("the motion shows neither position nor heading: what follows is by names alone")
        if lacking := _no_track(find):
            find.notes.append(f"{lacking}, and a trial needs the track: have it exported too")
        return
    find.unit = motion.unit
    time_unit(find)
    track, course, led = _beside_the_course(find, motion.scores, motion.windows)
    find.looks = [Look(s, w, track) for s, w in zip(find.samples, motion.windows, strict=True) if w.enough]
    length, why = ("", "") if track.geographic else other_length(find, find.looks, (track.x, track.y))
    if length:
        # The rest is looked at with the positions in that unit, which is asked for.
        for k in (track.x, track.y):
            find.units_said[k] = length
        motion = _motion_with(find, motion.unit)
        track, course, led = _beside_the_course(find, motion.scores, motion.windows)
        find.looks = [Look(s, w, track) for s, w in zip(find.samples, motion.windows, strict=True) if w.enough]
    if find.said[track.psi] == "cog":  # that the course follows the course is no evidence
        find.notes.append(
            f"no heading is found: {find.shown(track.psi)}, the course over ground, is taken for it, which lacks the "
            "drift angle of a ship that turns"
        )
    elif passed_over := _called_heading(find, track):
        find.notes.append(
            f"{listed(passed_over)}, called a heading, is not what the course follows, {find.shown(track.psi)} is: "
            "exchange them in the map if the name is right"
        )
    if magnetic(find.first.names[track.psi]):
        find.notes.append(
            f"{find.shown(track.psi)} is magnetic by its name: give it an offset, the variation of the place with east "
            "positive, unless the log has added it"
        )
    _add_columns(find, track, _confidence(find, motion.scores, track, course), motion.words, led)
    for name in ("x", "y") if length else ():
        find.guesses[name] = asked_length(find.guesses[name], length, why)
    _doubt_mirror_image(find, motion.scores, track)


def _no_track(find: Finder) -> str:
    """What is not there of a position by the names of the columns, "" where both halves of one are."""
    halves = {name: [k for k, said in enumerate(find.said) if said == name] for name in _OTHER_HALF}
    there = [name for name, columns in halves.items() if columns]
    if not there:
        return "no column is called a position"
    if any(_OTHER_HALF[name] in there for name in there):
        return ""
    name = there[0]
    return f"{find.shown(halves[name][0])} is called {_HALF[name]}, and no column {_HALF[_OTHER_HALF[name]]}"


def _likeliest_motion(find: Finder) -> Motion | None:
    """The motion with time in the usual unit, or another one that explains far more; None where none shows.

    Notes in ``find.readings`` how well it fits in each unit tried.
    """
    best: Motion | None = None
    for unit in likely_units(find.first, find.clock):
        motion = _motion_with(find, unit)
        find.readings[unit] = motion.likeliest / len(find.samples) + 2.0 * motion.agreeing
        # The usual unit, which comes first, unless another one explains far more.
        if motion.scores and (best is None or motion.explained > best.explained + CLEARLY):
            best = motion
        if motion.agreeing and unit == find.clock.unit:
            break  # the unit that the name says is right
    return best


def _motion_with(find: Finder, unit: str) -> Motion:
    """What all logs together show with time in a unit."""
    scale = [units.factors("m").get(find.units_said[k], 1.0) for k in range(len(find.first.names))]
    among = [k for k in find.numeric if find.said[k] not in (ORDER, OTHER, ROLL, TIME)]
    windows = [
        Windows(in_seconds(one, find.clock, unit), [n * f for n, f in zip(one.numbers, scale, strict=True)])
        for one in find.samples
    ]
    scores: dict[Track, float] = defaultdict(float)
    words: dict[Track, str] = {}
    for sample, w in zip(find.samples, windows, strict=True):
        if not w.enough:
            continue
        for track, (score, word) in tracks(w, sample, find.said, find.units_said, among).items():
            if find.said[track.psi] != "psi" and _against_its_name(find, track):
                continue
            scores[track] += score
            words.setdefault(track, word)
    return Motion(unit, dict(scores), words, windows, fits(find, scores, windows))


def _confidence(find: Finder, scores: Mapping[Track, float], track: Track, course: int | None) -> str:
    """How sure a reading is, by what speaks for those of other columns; that of the course itself is no other."""
    others = [one for one in scores if (one.x, one.y, one.psi) != (track.x, track.y, track.psi) and one.psi != course]
    rival = max((scores[one] for one in others), default=0.0)
    clear = scores[track] > 1.1 * rival and not (track.geographic and track.left) and not _as_exchanged(find, track)
    return SURE if clear and scores[track] > 0.45 * len(find.looks) else LIKELY


def _add_columns(find: Finder, track: Track, confidence: str, words: Mapping[Track, str], led: Sequence[str]) -> None:
    """Take the columns of a reading for position and heading, each with what speaks for it.

    led  what tells the heading from the course of the positions, in words
    """
    unit = next((find.units_said[k] for k in (track.x, track.y) if find.units_said[k] in units.factors("m")), "")
    keys = keys_of(track, find.first, unit or "m")
    speed = np.median([one.usual_speed for one in find.looks])
    for (quantity, own), column in zip(keys.items(), (track.x, track.y, track.psi), strict=True):
        partner = track.y if column == track.x else track.x
        both = find.shown(partner) == find.shown(column)
        with_it = "its cells hold both, which make" if both else f"with {find.shown(partner)} it makes"
        said = [f"{with_it} a course that follows the heading, at {speed:.3g} m/s"]
        if quantity == "psi":
            said = [words.get(track, "the course follows it"), *led]
            if find.units_said[column] == own["unit"]:
                said.append(f"its name says {own['unit']}")
            elif _against_its_name(find, track):
                own |= {"header_says": find.units_said[column]}
                said.append(f"it is in {own['unit']}, although its name says {find.units_said[column]}")
        elif find.said[column] == quantity and not both:
            said.append("its name says so")
        if column in find.parts:
            said.append(f"{listed([find.shown(k) for k in find.parts[column].values()])} with it")
        elif column in find.first.written and not both:
            said.append("its cells are in degrees and minutes")
        doubtful = bool(quantity == "psi" and (find.said[column] == "cog" or _called_heading(find, track)))
        if quantity != "psi" and find.said[partner] and not find.said[column] and _only_grows(find, column):
            doubtful = True
            said.append("it only grows, as a distance sailed would")
        find.add(Guess(quantity, column, own, tuple(said), LIKELY if doubtful else confidence))


def _only_grows(find: Finder, k: int) -> bool:
    """Whether a column never falls by more than its noise in any log."""
    for values in (one.numbers[k] for one in find.samples):
        known = values[np.isfinite(values)]
        back = float(np.max(np.maximum.accumulate(known) - known, initial=0.0))
        if not len(known) or back > 0.01 * float(np.ptp(known)):
            return False
    return True


def _called_heading(find: Finder, track: Track) -> list[str]:
    """Columns that are called a heading where another one, which is not, is taken for it."""
    if find.said[track.psi] == "psi":
        return []
    return [find.shown(k) for k in find.numeric if find.said[k] == "psi" and k != track.psi]


def _doubt_mirror_image(find: Finder, scores: Mapping[Track, float], track: Track) -> None:
    """Say where neither motion nor names tell a track from its mirror image, whose turns are to the other side."""
    mirrored = max((v for one, v in scores.items() if one.left != track.left and one.psi == track.psi), default=0.0)
    x, y, psi = (find.shown(k) for k in (track.x, track.y, track.psi))
    if (
        not track.geographic
        and not {find.said[track.x], find.said[track.y]} & {"x", "y"}
        and scores[track] < 1.05 * mirrored
    ):
        find.notes.append("no motion shows its mirror image: y is taken to the east and the heading clockwise")
    elif track.geographic and track.left:
        find.notes.append(
            f"{psi} counts counterclockwise if {y} is to the east, as no compass does: where {y} is to the west, give "
            f'it positive = "west", {psi} positive = "clockwise", and exchange port and starboard under r, v and the '
            "rudder"
        )
    elif _as_exchanged(find, track):
        find.notes.append(
            f"{psi} counts counterclockwise from east if {x} is to the north, as no compass does: where {x} is to the "
            f'east and {y} to the north, exchange the columns of x and y, give {psi} positive = "clockwise" and no '
            "zero, and exchange port and starboard under v, r and the rudder"
        )
    elif _as_robots_have_them(find, track):
        find.notes.append(
            f"no motion shows its mirror image, and names do not tell: {x} is taken to the north, {y} to the east and "
            f"{psi} clockwise. If {x} is to the east, {y} to the north and {psi} to port from east, as of robots, "
            'exchange the columns of x and y, give psi positive = "counterclockwise" and zero = "east", and exchange '
            "port and starboard under v, r and the rudder"
        )


def _as_robots_have_them(find: Finder, track: Track) -> bool:
    """Whether the names are those that robots give to axes east and north with the angle of yaw to port, although it is
    the mirror image that is read."""
    x, y, psi = (_DIVIDER.split(bare(find.first.names[k]).lower())[-1] for k in (track.x, track.y, track.psi))
    plain = not (track.geographic or track.south or track.west or track.left or track.east)
    return plain and (x, y) == ("x", "y") and psi in _ANGLES_OF_ROBOTS


def _as_exchanged(find: Finder, track: Track) -> bool:
    """Whether a heading counts as none does by a compass with x and y where their names have them, and as all do with
    the two exchanged."""
    named = [find.said[k] for k in (track.x, track.y, track.psi)] == ["x", "y", "psi"]
    plain = not (track.geographic or track.south or track.west)
    return named and plain and track.left and track.east


def _against_its_name(find: Finder, track: Track) -> bool:
    """Whether a heading is in the other unit than its name says."""
    unit = find.units_said[track.psi]
    return unit in ("deg", "rad") and (unit == "deg") != track.degrees


def fits(find: Finder, scores: Mapping[Track, float], windows: Sequence[Windows]) -> float:
    """Of the yaw rate and the velocities how many are what they must be with the likeliest track."""
    if not scores:
        return 0.0
    track = max(scores, key=lambda one: scores[one])
    rate = speed = False
    for sample, w in zip(find.samples, windows, strict=True):
        if not w.enough:
            continue
        look = Look(sample, w, track)
        among = [k for k in find.numeric if k not in (track.x, track.y, track.psi)]
        rate = rate or bool(yaw_rates(look, among, find.units_said))
        found = velocities(look, among, find.units_said)
        ahead = speeds(look, look.ahead, among, find.units_said, False)
        along = speeds(look, look.speed, [k for k in among if find.said[k] == "sog"], find.units_said, False)
        misses = (
            [one.miss for one in found[:1]] + [one.miss for one in along[:1]] + [2.0 * one.miss for one in ahead[:1]]
        )
        best = min(misses, default=FITS)
        speed = speed or best < FITS
    return float(rate) + float(speed)


def _beside_the_course(
    find: Finder, scores: Mapping[Track, float], windows: Sequence[Windows]
) -> tuple[Track, int | None, list[str]]:
    """The likeliest track; the column that is the course of the positions itself and not the heading, where another one
    leads it in turns as a heading does, whatever names say; and that in words.
    """
    track = _better_heading(find, scores, windows)
    looks = [(s, w) for s, w in zip(find.samples, windows, strict=True) if w.enough]
    own, _ = _ahead_of_course([Look(s, w, track) for s, w in looks])
    found: list[tuple[float, Track, float]] = []
    for other, score in scores.items():
        same = replace(other, psi=track.psi) == track and other.psi != track.psi
        if not same or score < 0.3 * scores[track] or find.said[other.psi] == "cog":
            continue
        off, leads = _ahead_of_course([Look(s, w, other) for s, w in looks])
        if off > max(DRIFTS, 2.0 * own) and leads > LEADS[find.said[other.psi] != "psi"]:
            found.append((leads + (find.said[other.psi] == "psi"), other, off))
    if not found or find.said[track.psi] == "cog":
        return track, None, []
    _, heading, off = max(found, key=lambda one: one[0])
    find.said[track.psi] = "cog"
    words = f"{find.shown(track.psi)} is the course of the positions within {own / DEG:.2g} deg, and this one"
    return heading, track.psi, [f"{words} leads it in turns: they differ by {off / DEG:.2g} deg"]


def _ahead_of_course(looks: Sequence[Look]) -> tuple[float, float]:
    """By how much a heading is now ahead of the course, now behind [rad], and the correlation of that with the rate."""
    off, rates, spread = [], [], []
    for look in looks:
        known = np.isfinite(look.psi) & np.isfinite(look.rate) & (look.speed > 0.5 * look.usual_speed)
        ahead = np.exp(1j * (look.psi - np.arctan2(look.east, look.north)))[known]
        if known.sum() < 8:
            continue
        off.append(np.angle(ahead * np.conj(ahead.mean())))
        rates.append(look.rate[known])
        spread.append(float(np.std(off[-1])))
    if not off:
        return 0.0, 0.0
    ahead, rate = np.concatenate(off), np.concatenate(rates)
    size = float(np.sqrt((ahead @ ahead) * (rate @ rate)))
    return float(np.median(spread)), float(ahead @ rate) / size if size > 0.0 else 0.0


def _better_heading(find: Finder, scores: Mapping[Track, float], windows: Sequence[Windows]) -> Track:
    """The likeliest track; of two columns that both follow the course, that which is not the course itself."""
    best = max(scores, key=lambda one: scores[one])
    same = [
        one
        for one, score in scores.items()
        if (one.x, one.y, one.geographic, one.south, one.west)
        == (best.x, best.y, best.geographic, best.south, best.west)
        and (one.left, one.east) == (best.left, best.east)
        and score > (0.3 if find.said[one.psi] == "psi" and find.said[best.psi] == "cog" else 0.5) * scores[best]
    ]
    if len(same) < 2 or find.said[best.psi] == "psi":
        return best
    merits = {}
    for track in same:
        misses, rates = [], []
        for sample, w in zip(find.samples, windows, strict=True):
            if w.enough:
                look = Look(sample, w, track)
                found = courses(look, [track.psi], find.units_said)
                misses.append(min((one.miss for one in found), default=np.pi))
                among = [k for k in find.numeric if k not in (track.x, track.y, track.psi)]
                rates.append(max((abs(c) for _, c, _ in yaw_rates(look, among, find.units_said).values()), default=0.0))
        named = (find.said[track.psi] == "psi") - (find.said[track.psi] == "cog")
        followed = float(np.mean(rates)) if rates else 0.0
        # One that follows the course far less well is the heading only where a yaw rate follows it.
        if named > 0 or scores[track] > 0.75 * scores[best] or followed > 0.99:
            merits[track] = (named, round(followed, 2), float(np.median(misses)))
    return max(merits, key=lambda one: merits[one])
