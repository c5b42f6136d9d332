"""Which columns are the position and the heading: a ship's course over the ground follows her heading."""

from __future__ import annotations

import itertools
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ... import units
from ...arrays import FloatArray
from ...units import DEG, KNOT
from .sampling import Sample
from .windows import Windows

METRES_PER_DEGREE = 111.3e3
OFF = 30.0 * DEG
"""How far course and heading may differ on average: by drift, and by a compass that is off."""
SPEEDS = (0.005, 40.0)
"""Speeds over the ground [m/s] that ships and models have."""
LENGTHS = (1.0, 1.0 / KNOT, 3.6)
"""What a velocity is of the slope of a position in metres: in m/s, kn or km/h."""
FACTORS = (*LENGTHS, 60.0, 1.0 / DEG, 60.0 / DEG, DEG)
"""What a rate is of a slope, in other units."""
SLOWLY = 0.1
"""Share of its largest rate up to which a heading counts as steady."""
TURNED = 2e-4
"""Circular variance of a course, of 1 degree, below which nothing is told by it."""

CLOSELY = 0.9
"""Share of the course's changes that the heading is to explain where a name says that a column is no position."""
WIDELY = 0.25
"""Circular variance of a heading from which it has turned far, of about half a turn in all."""
UNLIKE = 2.5
"""Factor between speeds north and east from which two columns are not both positions in one unit."""


@dataclass(frozen=True)
class Track:
    """One reading of a log: which columns are the position and the heading, and how they count.

    x, y, psi           columns; x and y are latitude and longitude where ``geographic``
    south, west, left   whether x counts to the south, y to the west and psi counterclockwise
    east                whether psi counts from east
    degrees             whether psi is in degrees
    """

    x: int
    y: int
    psi: int
    geographic: bool
    south: bool
    west: bool
    left: bool
    east: bool
    degrees: bool

    def position(self, columns: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
        """North and east [m] (n_rows,)."""
        north, east = columns[self.x], columns[self.y]
        if self.geographic:
            middle = np.nanmedian(north)
            north, east = (
                (north - middle) * METRES_PER_DEGREE,
                (east - np.nanmedian(east)) * METRES_PER_DEGREE * np.cos(middle * DEG),
            )
        return np.where(self.south, -north, north), np.where(self.west, -east, east)

    def heading(self, columns: Sequence[FloatArray]) -> FloatArray:
        """Clockwise from north [rad] (n_rows,)."""
        psi = columns[self.psi] * (DEG if self.degrees else 1.0)
        return np.asarray((-psi if self.left else psi) + (np.pi / 2.0 if self.east else 0.0))


def tracks(
    windows: Windows, sample: Sample, said: Sequence[str], units_said: Sequence[str], among: Sequence[int]
) -> dict[Track, tuple[float, str]]:
    """Readings of a log with what speaks for each: a score up to about 1.5, and in words.

    said, units_said  (n_columns,) what names say: a quantity, a unit; "" where they say none
    among             columns to look at
    """
    columns = windows.columns
    slopes = {k: windows.slope(columns[k]) for k in among}
    means = {k: windows.mean(columns[k]) for k in among}
    known = [k for k in among if np.isfinite(slopes[k]).any()]
    moving = [k for k in known if np.nanstd(slopes[k]) > 0.0 or abs(np.nanmean(slopes[k])) > 0.0]
    rates = _rates(moving, slopes, means)
    whole = {a for a, _ in rates}
    found: dict[Track, tuple[float, str]] = {}
    against = {k for k in among if _counts_against(said[k], sample.names[k])}
    # Revolutions, speeds and rates follow a turning ship too, well enough to pass for the position that is missing.
    places = [k for k in moving if not _is(units_said[k], *_NO_PLACES)]
    for i, j in itertools.combinations(places, 2):
        for geographic in _kinds(i, j, sample, slopes, columns, units_said):
            a, b = slopes[i], slopes[j]
            narrow = float(np.cos(np.nanmedian(columns[i]) * DEG)) if geographic else 1.0
            b = b * narrow
            for reading, score, words in _of_pair(
                i, j, a, b, geographic, moving, slopes, means, windows, said, against
            ):
                # What is the rate of something else is no position.
                derived = sum(_derived(k, (i, j), rates) for k in (i, j, reading.psi))
                score -= 0.4 * derived - 0.2 * (reading.psi in whole)
                score += sum(0.15 if said[k] in (*_PLACES, "") else -0.3 for k in (i, j) if said[k])
                if score > found.get(reading, (0.3, ""))[0]:
                    found[reading] = score, words
    best = sorted(found.items(), key=lambda one: -one[1][0])[:40]
    return dict(best)


_PLACES = ("x", "y", "latitude", "longitude")
_SIDES = {
    "latitude": (re.compile(r"\bS\b|south|süd|\bsud\b|\bsur\b"), re.compile(r"\bN\b|nor[td]")),
    "longitude": (re.compile(r"\bW\b|west|ouest|oeste"), re.compile(r"\b[EO]\b|east|\best|\bost")),
}
"""What names of latitudes and longitudes say that count to the south and to the west, and to the north and the east."""
_NO_PLACES = ("1/s", "m/s", "rad/s")
"""Units of no position."""


def _counts_against(quantity: str, name: str) -> bool:
    """Whether a name says that a latitude or longitude counts to the south or the west, and to no other side."""
    text = re.sub(r"(?<=°)(?=\w)", " ", name[:200])
    found = [bool(one.search(text) or one.search(text.lower())) for one in _SIDES.get(quantity, ())]
    return found == [True, False]


def _is(unit: str, *kinds: str) -> bool:
    """Whether a unit, "" where none is said, is one of what these are units of."""
    return any(unit in units.factors(kind) for kind in kinds)


def _derived(k: int, pair: tuple[int, int], rates: Mapping[tuple[int, int], float]) -> bool:
    """Whether a column is the rate of another, where two are read as the position.

    On a circle north is the slope of east but for the yaw rate, which is 1 deg/s on some: of each other, positions have
    rates in units of length alone.
    """
    return any(b == k and not (a in pair and k in pair and factor not in LENGTHS) for (a, b), factor in rates.items())


def _rates(
    moving: Sequence[int], slopes: dict[int, FloatArray], means: dict[int, FloatArray]
) -> dict[tuple[int, int], float]:
    """Pairs of a column and its rate: the one is the other's slope, but for a constant and for a factor between units,
    which stands beside them.
    """
    found = {}
    for a, b in itertools.permutations(moving, 2):
        known = np.isfinite(slopes[a]) & np.isfinite(means[b])
        if known.sum() < 9:
            continue
        slope, rate = slopes[a][known] - slopes[a][known].mean(), means[b][known] - means[b][known].mean()
        size = float(np.sqrt((slope @ slope) * (rate @ rate)))
        if size > 0.0 and abs(slope @ rate) > 0.97 * size:
            factor = abs(float(slope @ rate)) / float(slope @ slope)
            nearest = min(FACTORS, key=lambda one: abs(np.log(factor / one)))
            if abs(np.log(factor / nearest)) < 0.04:
                found[a, b] = nearest
    return found


def _kinds(
    i: int,
    j: int,
    sample: Sample,
    slopes: dict[int, FloatArray],
    columns: Sequence[FloatArray],
    units_said: Sequence[str],
) -> tuple[bool, ...]:
    """Whether two columns may be metres (False), and degrees of latitude and longitude (True)."""
    written = {i, j} & sample.written
    if len(written) == 1:
        return ()
    with np.errstate(over="ignore", invalid="ignore"):
        speed = float(np.nanpercentile(np.hypot(slopes[i], slopes[j]), 80.0))
    kinds = []
    angles, lengths = (any(_is(units_said[k], kind) for k in (i, j)) for kind in ("rad", "m"))
    if not written and not angles and SPEEDS[0] < speed < SPEEDS[1]:
        kinds.append(False)
    largest = [float(np.nanmax(np.abs(columns[k]))) for k in (i, j)]
    degrees = max(largest) <= 360.0 and min(largest) <= 90.0 and SPEEDS[0] < speed * METRES_PER_DEGREE < SPEEDS[1]
    if degrees and not lengths:
        kinds.append(True)
    return tuple(kinds)


def _of_pair(
    i: int,
    j: int,
    a: FloatArray,
    b: FloatArray,
    geographic: bool,
    moving: Sequence[int],
    slopes: dict[int, FloatArray],
    means: dict[int, FloatArray],
    windows: Windows,
    said: Sequence[str],
    against: Collection[int],
) -> list[tuple[Track, float, str]]:
    """Readings of two columns as the position, with any other as the heading.

    against  columns whose names say that they count to the south or the west
    """
    with np.errstate(over="ignore", invalid="ignore"):
        speed = np.hypot(a, b)
    used = np.isfinite(speed) & (speed > 0.3 * np.nanmedian(speed))
    if used.sum() < 8:
        return []
    course = np.exp(1j * np.arctan2(b[used], a[used]))
    spread = 1.0 - abs(course.mean())
    if spread < TURNED:
        return []
    least = CLOSELY if any(said[k] not in (*_PLACES, "") for k in (i, j)) else 0.0
    found = []
    for k in moving:
        if k in (i, j):
            continue
        turn = windows.periods[k]
        for degrees in (True, False):
            if turn and degrees != (turn > 7.0):
                continue
            psi = means[k][used] * (DEG if degrees else 1.0)
            known = np.isfinite(psi)
            if known.sum() < 8 or np.nanmax(np.abs(psi)) > 200.0:
                continue
            heading = np.exp(1j * psi[known])
            if 1.0 - abs(heading.mean()) < 0.2 * TURNED:
                continue
            for sense in (1.0, -1.0):
                off = course[known] * (heading.conj() if sense > 0 else heading)
                told = 1.0 - (1.0 - abs(off.mean())) / spread
                if told < max(0.3, least):
                    continue
                ahead = float(np.angle(np.mean(off * _straight(slopes[k][used][known]))))
                if not (geographic or _alike(a[used][known], b[used][known], sense * psi[known] + ahead)):
                    continue
                for track, cost in _readings(i, j, k, sense, ahead, geographic, degrees, windows, said, against):
                    words = f"the course follows it: {100.0 * told:.0f} % of the course's changes"
                    found.append((track, told - cost, words))
    return found


def _alike(a: FloatArray, b: FloatArray, psi: FloatArray) -> bool:
    """Whether two slopes (n_windows,) are parts of one speed along a heading [rad] that counts from one to the other.

    a = U cos(psi) and b = U sin(psi) make a sin(psi) as large as b cos(psi), however the speed changes meanwhile.
    Where a ship hardly turns this tells nothing.
    """
    if 1.0 - abs(np.exp(1j * psi).mean()) < WIDELY:
        return True
    one, other = np.linalg.norm(a * np.sin(psi)), np.linalg.norm(b * np.cos(psi))
    return bool(max(one, other) < UNLIKE * min(one, other))


def _straight(rates: FloatArray) -> FloatArray:
    """(n_windows,) what windows count by how little a heading changes in them, at these rates in any unit.

    In a turn drift and the lever of an antenna take the course off the heading, 50 deg and more, always to one side.
    """
    most = float(np.nanmax(np.abs(rates), initial=0.0))
    return np.ones(len(rates)) if most == 0.0 else 1.0 / (1.0 + (np.nan_to_num(rates / most, nan=1.0) / SLOWLY) ** 2)


def _readings(
    i: int,
    j: int,
    k: int,
    sense: float,
    offset: float,
    geographic: bool,
    degrees: bool,
    windows: Windows,
    said: Sequence[str],
    against: Collection[int],
) -> list[tuple[Track, float]]:
    """Ways to count in which the course, ``sense`` times column k plus ``offset`` from i towards j, is the heading.

    Each with a cost: what is unusual costs, and what contradicts the names.
    """
    found = []
    for swapped, south, west in itertools.product((False, True), repeat=3):
        x, y = (j, i) if swapped else (i, j)
        # The angle from x towards y is A times the angle from i towards j, plus B.
        A, B = (-1.0, np.pi / 2.0) if swapped else (1.0, 0.0)
        if south:
            A, B = -A, np.pi - B
        if west:
            A, B = -A, -B
        # Degrees count to the south and the west where their names say so, and nowhere else.
        unsaid = (south and x not in against) or (west and y not in against)
        if geographic and (unsaid or np.nanmax(np.abs(windows.columns[x])) > 90.0):
            continue
        for east in (False, True):
            miss = _turned(A * offset + B - (np.pi / 2.0 if east else 0.0))
            if abs(miss) > OFF:
                continue
            left = A * sense < 0.0
            cost = 0.30 * left + 0.15 * east + 0.02 * swapped + 0.1 * abs(miss)
            cost += 0.35 * (south != (x in against)) + 0.20 * (west != (y in against))
            cost += _against(said[x], ("x", "latitude")) + _against(said[y], ("y", "longitude"))
            cost += -0.3 if said[k] == "psi" else 0.25 if said[k] == "cog" else 0.3 if said[k] else 0.0
            # A compass counts clockwise from 0 to 360.
            if left and windows.periods[k] == 0.0 and float(np.nanmax(windows.columns[k])) > 181.0:
                cost += 0.1
            found.append((Track(x, y, k, geographic, south, west, left, east, degrees), cost))
    return found


def _against(name: str, right: tuple[str, str]) -> float:
    return 0.0 if not name else -0.1 if name in right else 0.5 if name in _PLACES else 0.0


def _turned(angle: float) -> float:
    """An angle within half a turn of zero."""
    return float((angle + np.pi) % (2.0 * np.pi) - np.pi)


def keys_of(track: Track, sample: Sample, unit: str) -> dict[str, dict[str, Any]]:
    """What a map says of the position and the heading of a track; ``unit`` of a position in metres."""
    psi: dict[str, Any] = {"unit": "deg" if track.degrees else "rad"}
    psi["positive"] = "counterclockwise" if track.left else "clockwise"
    if track.east:
        psi["zero"] = "east"
    if track.geographic:
        x, y = ({} if k in sample.written else {"unit": "deg"} for k in (track.x, track.y))
        x |= {"positive": "south"} if track.south else {}
        y |= {"positive": "west"} if track.west else {}
        return {"latitude": x, "longitude": y, "psi": psi}
    north = {"unit": unit, "positive": "south" if track.south else "north"}
    return {"x": north, "y": {"unit": unit, "positive": "west" if track.west else "east"}, "psi": psi}
