"""Whether the channels of a trial describe one and the same motion.

Everything here works on increments between samples, so that gaps (NaN) drop out, and is meant to see through sensor
noise of about 0.4 m, 0.2 deg, 0.02 m/s and 0.03 deg/s at 1 Hz.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from enum import Enum, auto
from functools import cached_property

import numpy as np

from ..arrays import BoolArray, FloatArray, robust_deviation
from ..physics.frame import to_earth
from ..units import DEG, KNOT


class Reading(Enum):
    """A way to read positions, heading and velocities: as trials are to have them, or as a log may."""

    AS_ASKED = auto()
    IN_EARTH_AXES = auto()
    TO_PORT = auto()
    IN_DEGREES = auto()
    SWAPPED = auto()
    IN_KNOTS = auto()
    NOT_KNOTS = auto()
    TO_WEST = auto()
    TWICE = auto()

    @property
    def words(self) -> str:
        """For people, behind "if read"."""
        return _WORDS[self]


_WORDS = {
    Reading.AS_ASKED: "in ship axes, in SI units",
    Reading.IN_EARTH_AXES: "in earth axes, u north and v east",
    Reading.TO_PORT: "with v positive to port",
    Reading.IN_DEGREES: "with the heading in degrees",
    Reading.SWAPPED: "with x east and y north",
    Reading.IN_KNOTS: "with velocities in knots",
    Reading.NOT_KNOTS: "with velocities that were in m/s before they were taken for knots",
    Reading.TO_WEST: "with y positive west",
    Reading.TWICE: "with a heading that was in radians before it was taken for degrees",
}

FITS = 0.1
"""Share of the distance run by which velocities may miss the positions."""


OPPOSED, AS_FAR = 0.9, 1.5
"""Correlation of two records of a turn from which they go opposite ways, and times as far as the other one may go."""


@dataclass(frozen=True)
class Turning:
    """Turned angle since the first sample, once from the heading and once from the yaw rate, (n_intervals + 1,).

    Both in the unit of their column: radians, if that is right.  Full-turn jumps of the heading are taken out.
    """

    heading: FloatArray
    yaw: FloatArray

    @property
    def span(self) -> float:
        """The larger range of the two."""
        return float(max(np.ptp(self.heading), np.ptp(self.yaw)))

    @property
    def miss(self) -> float:
        """Largest difference of the two."""
        return float(np.abs(self.heading - self.yaw).max())

    @property
    def ratio(self) -> float:
        """How many times larger the heading's turn is."""
        return float(np.std(self.heading)) / max(float(np.std(self.yaw)), 1e-300)

    @property
    def correlation(self) -> float:
        """Of the two turned angles; 0 where one of them is constant."""
        if np.std(self.heading) == 0.0 or np.std(self.yaw) == 0.0:
            return 0.0
        return float(np.corrcoef(self.heading, self.yaw)[0, 1])

    @property
    def opposed(self) -> bool:
        """Whether the yaw rate turns as far as the heading, the other way."""
        return self.span > 0.3 and self.correlation < -OPPOSED and 1.0 / AS_FAR < self.ratio < AS_FAR

    def in_degrees(self) -> str:
        """The column in degrees, "psi" or "r", where reading it so makes the two agree; else ""."""
        for column, heading, yaw in (("psi", self.heading * DEG, self.yaw), ("r", self.heading, self.yaw * DEG)):
            span = max(np.ptp(heading), np.ptp(yaw))
            # Of either sign: a channel may be in degrees and turned round at once.
            miss = min(np.abs(heading - yaw).max(), np.abs(heading + yaw).max())
            if span > 0.2 and miss < 0.15 * span + 0.03:
                return column
        return ""


def turning(columns: Mapping[str, FloatArray]) -> Turning:
    """Both records of the turn.  Needs t, psi and r, (n_samples,) each."""
    heading = np.diff(columns["psi"])
    usual = float(np.median(np.abs(heading[np.isfinite(heading)]))) if np.isfinite(heading).any() else 0.0
    # A jump is a full turn, in whichever unit, among steps that are small beside it.
    for period in (2.0 * np.pi, 360.0):
        if usual < period / 6.0:
            jumps = np.abs(np.abs(heading) - period) < period / 6.0
            heading = np.where(jumps, heading - np.sign(heading) * period, heading)
    yaw = middle(columns["r"]) * np.diff(columns["t"])
    both = np.isfinite(heading) & np.isfinite(yaw)
    return Turning(_summed(heading[both]), _summed(yaw[both]))


def halfway(psi: FloatArray) -> FloatArray:
    """(n_intervals,) headings halfway between samples [rad]; between two a full turn apart it is the later one."""
    return np.where(np.abs(np.diff(psi)) > 3.0, psi[1:], middle(psi))


@dataclass(frozen=True)
class _Ways:
    """What positions and velocities say of the way made between samples, (n_intervals,) each.

    moved       (n_intervals, 2) between positions [m]
    psi, u, v   in the middle of each interval, and its length dt [s]
    usable      where all of them are known
    window      intervals that are looked at together, enough for noise not to matter
    """

    moved: FloatArray
    psi: FloatArray
    u: FloatArray
    v: FloatArray
    dt: FloatArray
    usable: BoolArray
    window: int

    def rotated(self, angle: FloatArray, v: FloatArray, scale: float = 1.0) -> FloatArray:
        """(n_intervals, 2) the way by velocities in ship axes."""
        return scale * np.column_stack(to_earth(angle, self.u, v)) * self.dt[:, None]

    def misfit(self, steps: FloatArray) -> float:
        """Of ways (n_intervals, 2) from those moved."""
        whole, length = self._lengths
        if not len(length):
            return 0.0
        error = _windows(np.where(self.usable[:, None], self.moved - steps, 0.0), self.window)[whole]
        return float(np.median(np.minimum(np.hypot(*error.T) / length, 1e6)))

    @cached_property
    def _lengths(self) -> tuple[BoolArray, FloatArray]:
        """Windows in which all is known, and how far the ship moved in each of these [m]."""
        whole = _windows(self.usable.astype(np.float64), self.window) > self.window - 0.5
        way = _windows(np.where(self.usable[:, None], self.moved, 0.0), self.window)[whole]
        return whole, np.maximum(np.hypot(*way.T), 1e-12)


def _ways(columns: Mapping[str, FloatArray], longer: int = 1) -> _Ways | None:
    """None where the ship hardly moves or nothing can be compared.

    longer  times as long the windows are to be as white noise of the positions asks for
    """
    dt = np.diff(columns["t"])
    moved = np.column_stack([np.diff(columns["x"]), np.diff(columns["y"])])
    psi, u, v = halfway(columns["psi"]), middle(columns["u"]), middle(columns["v"])
    usable = np.isfinite(moved).all(axis=1) & np.isfinite(psi) & np.isfinite(u) & np.isfinite(v)
    if usable.sum() < 10:
        return None
    noise = max(white_noise(columns["x"]), white_noise(columns["y"]))
    speed = np.hypot(u, v)
    step = float(np.median(speed[usable] * dt[usable]))
    shortest = max(5, len(dt) // 50)
    longest = max(shortest, len(dt) // 4)
    if step <= 0.0 or 40.0 * noise > step * longest:
        return None
    window = min(longer * int(np.clip(np.ceil(40.0 * noise / step), shortest, longest)), longest)
    return _Ways(moved, psi, u, v, dt, usable, window)


def position_misfits(
    columns: Mapping[str, FloatArray], longer: int = 1, among: Collection[Reading] = tuple(Reading)
) -> dict[Reading, float]:
    """How badly the velocities explain the positions, by the way they are read: 0 perfectly, 1 not at all.

    among  readings that are asked for: each takes as long as the other

    A misfit is the median over windows of the distance between
    measured and integrated displacement, over the displacement; windows are long enough for white noise not to matter,
    or so many times ``longer``.
    Empty where the ship hardly moves or nothing can be compared.  Needs t, x, y, psi, u and v, (n_samples,) each.
    """
    ways = _ways(columns, longer)
    if ways is None:
        return {}
    psi, v = ways.psi, ways.v
    readings: dict[Reading, Callable[[], FloatArray]] = {
        Reading.AS_ASKED: lambda: ways.rotated(psi, v),
        Reading.IN_EARTH_AXES: lambda: np.column_stack([ways.u, v]) * ways.dt[:, None],
        Reading.TO_PORT: lambda: ways.rotated(psi, -v),
        Reading.IN_DEGREES: lambda: ways.rotated(psi * DEG, v),
        Reading.SWAPPED: lambda: ways.rotated(psi, v)[:, ::-1],
        Reading.IN_KNOTS: lambda: ways.rotated(psi, v, KNOT),
        Reading.NOT_KNOTS: lambda: ways.rotated(psi, v, 1.0 / KNOT),
        Reading.TO_WEST: lambda: ways.rotated(psi, v) * [1.0, -1.0],
        Reading.TWICE: lambda: ways.rotated(psi / DEG, v),
    }
    return {reading: ways.misfit(steps()) for reading, steps in readings.items() if reading in among}


OFF = 0.05
"""Share by which factors of time may differ that are one."""

TIMES = {
    "min": 60.0,
    "h": 3600.0,
    "d": 86400.0,
    "ms": 1e-3,
    "sixtieths of a second": 1.0 / 60.0,  # seconds that were taken for minutes
}
"""Units of time [s] that a log may be in."""


def time_unit(columns: Mapping[str, FloatArray]) -> str:
    """The unit that time is in, of ``TIMES``, where both the yaw rate and the velocities say so; else "".

    Needs t, x, y, psi, u, v and r, (n_samples,) each.
    """
    turned = turning(columns)
    if turned.ratio <= 0.0 or abs(turned.correlation) < 0.9:
        return ""
    for unit, seconds in TIMES.items():
        if abs(np.log(turned.ratio / seconds)) < OFF:
            ways = _ways({**columns, "t": seconds * columns["t"]})
            if ways is not None and ways.misfit(ways.rotated(ways.psi, ways.v)) < FITS:
                return unit
    return ""


@dataclass(frozen=True)
class Lever:
    """Where from midship positions would have to be measured to fit velocities of midship best.

    x, y    forward and to starboard [m]
    misfit  what is left, as of ``position_misfits``
    """

    x: float
    y: float
    misfit: float

    @property
    def likely(self) -> bool:
        """Whether antennas stand there: ships are long, and in a steady turn a lever to the side is any error of u."""
        return abs(self.y) < 0.5 * abs(self.x) + 3.0


def lever_of(columns: Mapping[str, FloatArray]) -> Lever | None:
    """The point of the ship that positions are of, by least squares; None where the ship hardly moves or turns."""
    ways, psi = _ways(columns), columns["psi"]
    if ways is None:
        return None
    turned = [np.diff(np.column_stack(to_earth(psi, x, y)), axis=0) for x, y in ((1.0, 0.0), (0.0, 1.0))]
    logged = ways.rotated(ways.psi, ways.v)
    known = ways.usable & np.isfinite(turned[0]).all(axis=1)
    design = np.column_stack([part[known].ravel() for part in turned])
    if np.linalg.matrix_rank(design) < 2:
        return None
    x, y = np.linalg.lstsq(design, (ways.moved - logged)[known].ravel(), rcond=None)[0]
    return Lever(float(x), float(y), ways.misfit(logged + x * turned[0] + y * turned[1]))


@dataclass(frozen=True)
class Stretch:
    """By how much positions are longer to the north and to the east than velocities and heading say.

    misfit  what is left without it, as of ``position_misfits``
    """

    north: float
    east: float
    misfit: float

    @property
    def uneven(self) -> bool:
        """Whether one axis is longer than the other, as no unit of speed makes it."""
        return self.north > 0.0 and self.east > 0.0 and abs(np.log(self.east / self.north)) > OFF

    def explains(self, asked: float) -> bool:
        """Whether that is what is wrong with positions which velocities miss by so much, as of ``position_misfits``."""
        return self.uneven and self.misfit < min(FITS, 0.5 * asked)

    @property
    def axes(self) -> dict[str, float]:
        """Of the positions that are to be divided, by how much."""
        return {name: by for name, by in (("x", self.north), ("y", self.east)) if abs(by - 1.0) > OFF}


def stretch_of(columns: Mapping[str, FloatArray]) -> Stretch | None:
    """The stretch of positions by axis, by least squares; None where the ship hardly moves, or along one axis alone."""
    ways = _ways(columns)
    if ways is None:
        return None
    logged = ways.rotated(ways.psi, ways.v)
    said, moved = logged[ways.usable], ways.moved[ways.usable]
    along = np.sum(said**2, axis=0)
    if np.min(along) < ACROSS**2 * np.max(along):
        return None
    by = np.sum(moved * said, axis=0) / along
    return Stretch(float(by[0]), float(by[1]), ways.misfit(logged * by))


ACROSS = 0.2
"""Share of the way along the other axis that a ship must make along one for its scale to show."""


def _windows(values: FloatArray, window: int) -> FloatArray:
    """Sums over every run of ``window`` intervals."""
    summed = _summed(values)
    return np.asarray(summed[window:] - summed[:-window])


def white_noise(values: FloatArray) -> float:
    """Standard deviation of white noise on a smooth channel, from second differences; NaN samples are left out."""
    bends = np.diff(values[np.isfinite(values)], n=2)
    return robust_deviation(bends) / float(np.sqrt(6.0)) if len(bends) else 0.0


def rounding_noise(values: FloatArray) -> float:
    """Standard deviation of what rounding adds to a motion, as to a speed logged in tenths of a knot; 0 if none shows.

    Its square is a twelfth of that of the step that all values are whole multiples of.  Not for orders: a rudder that
    was only ever ordered to 0 and 35 deg is not logged in steps of 35 deg.
    """
    known = values[np.isfinite(values)]
    found = np.unique(known)
    steps = np.diff(found)
    steps = steps[steps > 1e-12 * np.max(np.abs(known), initial=0.0)]  # the same number, worked out in two ways
    if not len(steps) or (len(found) < FEW_VALUES and len(known) < OFTEN * len(found)):
        return 0.0
    of = (found - found[0]) / np.min(steps)
    return float(np.min(steps) / np.sqrt(12.0)) if np.max(np.abs(of - np.round(of))) < 0.05 else 0.0


FEW_VALUES, OFTEN = 8, 3
"""So few values lie on a grid by chance, unless each comes so often."""


def motion_noise(values: FloatArray) -> float:
    """Standard deviation of the noise of a channel of the motion: white, but no less than that of rounding.

    Of steps longer than the noise most second differences are 0.
    """
    return max(white_noise(values), rounding_noise(values))


def middle(values: FloatArray) -> FloatArray:
    """(n_samples - 1,) means of neighbouring samples."""
    return 0.5 * (values[1:] + values[:-1])


def _summed(values: FloatArray) -> FloatArray:
    return np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
