"""The record of one manoeuvre, where in it the rudder was ordered over, and which manoeuvre it is."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Literal, get_type_hints

import numpy as np

from ..arrays import FloatArray, numbers_of, robust_deviation
from ..displayed import Brief
from ..errors import Problem, TrialError
from ..trial.schema import FEWEST_SAMPLES
from ..units import DEG

Direction = Literal["starboard", "port"]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Track(Brief):
    """Record of one manoeuvre; every channel of shape (n_samples,), SI units.

    t       time, strictly increasing, need not be uniform [s]
    x, y    midship position over ground, north and east [m]
    psi     heading, clockwise from north, unwrapped [rad]
    u, v_m  velocity over ground in ship axes at midship, v_m positive to starboard [m/s]
    delta   rudder angle, positive to starboard: a positive angle turns the ship to starboard [rad]
    r       yaw rate, positive to starboard [rad/s], or None; the indices take rates from the heading
    n       propeller revolutions [1/s], or None

    Raises TrialError naming every channel that is wrong.
    """

    t: FloatArray
    x: FloatArray
    y: FloatArray
    psi: FloatArray
    u: FloatArray
    v_m: FloatArray
    delta: FloatArray
    r: FloatArray | None = None
    n: FloatArray | None = None

    def __post_init__(self) -> None:
        problems: list[Problem] = []
        shape: tuple[int, ...] | None = None
        for name in (item.name for item in fields(self)):
            if (given := getattr(self, name)) is None:
                continue
            values = numbers_of(given)
            if values is None:
                problems.append(Problem("channel holds what is no number", name, fix=f"give {name} as numbers"))
                continue
            object.__setattr__(self, name, values)
            shape = values.shape if shape is None else shape  # that of t, which comes first
            if values.ndim != 1 or values.shape != shape or values.size < FEWEST_SAMPLES:
                wanted = f"(n_samples,) as t, {FEWEST_SAMPLES} at least"
                problems.append(Problem(f"channel has shape {values.shape}", name, wanted))
            elif not np.all(np.isfinite(values)):
                problems.append(Problem("channel has gaps (NaN or infinite)", name, fix="cut or fill them first"))
            elif name == "t" and np.any(np.diff(values) <= 0.0):
                problems.append(Problem("time does not strictly increase", name))
            elif name == "psi" and np.any(np.abs(np.diff(values)) > np.pi):
                problems.append(Problem("heading jumps by more than half a turn", name, fix="unwrap it"))
        if problems:
            raise TrialError(*problems)

    @property
    def speed(self) -> FloatArray:
        """Speed over ground U = sqrt(u^2 + v_m^2) [m/s], shape (n_samples,)."""
        return np.hypot(self.u, self.v_m)


@dataclass(frozen=True)
class Execute:
    """One rudder order and the time its angle was held."""

    side: int  # +1 starboard, -1 port
    index: int  # last sample on the previous rudder plateau: the moment of the order
    start: int  # first sample at the ordered angle
    end: int  # last sample at it
    angle: float  # median rudder angle held, positive [rad]
    at_start: bool  # the record begins with the rudder already over: index is only its first sample

    @property
    def direction(self) -> Direction:
        """The side as a word."""
        return "starboard" if self.side > 0 else "port"


def find_execute(track: Track) -> Execute:
    """The first order of the manoeuvre.  Raises TrialError if no held rudder turned the ship."""
    if not (executes := find_executes(track)):
        raise TrialError(Problem("no rudder order found", "delta", "no held rudder angle above 2 deg turned the ship"))
    return executes[0]


def find_executes(track: Track) -> tuple[Execute, ...]:
    """Every order to the manoeuvre's rudder angle, in time; empty if no held angle turned the ship.

    The angle is the one at which the ship turned most towards its rudder: course-keeping moves the rudder as
    much, but turns the ship to no side.  Excursions shorter than a tenth of the longest hold are not orders.
    """
    side, size = np.sign(track.delta), np.abs(track.delta)
    noise = noise_level(track.t, track.delta)
    bins = np.floor(size / DEG).astype(np.intp)
    turned = np.where(size >= 2.0 * DEG, side * np.gradient(track.psi), 0.0)
    score = np.convolve(np.bincount(bins, weights=turned, minlength=3), np.ones(3), mode="same")
    top = int(np.argmax(score))
    if score[top] < 0.5 * DEG:
        return ()
    angle = float(np.median(size[(np.abs(bins - top) <= 1) & (size >= 2.0 * DEG)]))
    tolerance = max(1.0 * DEG, 4.0 * noise, 0.1 * angle)
    runs = _runs(track.t, np.where(np.abs(size - angle) <= tolerance, side, 0.0))
    while runs and runs[0][0] * (track.psi[runs[0][2]] - track.psi[runs[0][1]]) <= 0.0:
        runs = runs[1:]
    found = []
    for sign, start, end in runs:
        towards = sign * track.delta
        index = _order_index(track.t, towards, start, noise)
        late = start == 0 or (index == 0 and bool(towards[0] > tolerance))
        found.append(Execute(sign, index, start, end, float(np.median(towards[start : end + 1])), late))
    return tuple(found)


def _runs(t: FloatArray, label: FloatArray) -> list[tuple[int, int, int]]:
    """Stretches (side, first, last) of equal non-zero label (n_samples,); short gaps closed, short stretches out."""
    edges = np.flatnonzero(np.diff(label)) + 1
    bounds = zip(np.r_[0, edges].tolist(), np.r_[edges - 1, label.size - 1].tolist(), strict=True)
    raw = [(int(label[first]), first, last) for first, last in bounds if label[first] != 0.0]
    runs: list[tuple[int, int, int]] = []
    for sign, first, last in raw:
        before = runs[-1] if runs else (0, first, first)
        if before[0] == sign and t[first] - t[before[2]] <= 0.05 * (t[before[2]] - t[before[1]]):
            runs[-1] = (sign, before[1], last)
        else:
            runs.append((sign, first, last))
    longest = max((t[last] - t[first] for _, first, last in runs), default=0.0)
    return [run for run in runs if t[run[2]] - t[run[1]] >= 0.1 * longest]


def _order_index(t: FloatArray, towards: FloatArray, start: int, noise: float) -> int:
    """Last sample on the plateau before the rudder reached its angle at sample ``start``.

    Walks back along the motion until the rudder had rested for half the time of the motion, or had moved the
    other way, and takes the sample nearest to the corner of two straight lines by least squares.
    """
    low = mark = j = start
    while j > 0:
        j -= 1
        margin = max(0.5 * DEG, 4.0 * noise, 0.1 * float(towards[start] - towards[low]))
        if towards[j] > towards[low] + margin:
            break
        low = j if towards[j] < towards[low] else low
        if towards[j] < towards[mark] - margin:
            mark = j
        elif mark - j >= 5 and t[mark] - t[j] > 0.5 * (t[start] - t[mark]):
            break
    part = towards[low : start + 1]
    last = low + int(np.argmax(part >= part[0] + 0.7 * (part[-1] - part[0])))
    time, value = t[j : last + 1], towards[j : last + 1]
    if time.size < 4:
        return low
    line, _ = np.linalg.qr(np.c_[np.ones_like(time), time - time[0]])
    corner = np.maximum(time[:, None] - time[None, 1:-1], 0.0)
    corner -= line @ (line.T @ corner)
    value = value - line @ (line.T @ value)
    factor = (value @ corner) / np.sum(corner**2, axis=0)
    misfit = np.sum((value[:, None] - factor * corner) ** 2, axis=0)
    if float(value @ value) <= 1.5 * float(misfit.min()) + 1e-12:
        return j  # one line fits as well: the record begins with the motion
    return j + 1 + int(np.argmin(misfit))


def noise_level(t: FloatArray, values: FloatArray) -> float:
    """Standard deviation of the noise on a smooth channel (n_samples,), in its unit.

    From each sample's distance to the line through its neighbours; the median leaves steps and corners out.
    """
    weight = (t[2:] - t[1:-1]) / (t[2:] - t[:-2])
    off = values[1:-1] - weight * values[:-2] - (1.0 - weight) * values[2:]
    return robust_deviation(off / np.sqrt(1.0 + weight**2 + (1.0 - weight) ** 2))


def heading_at(track: Track, index: int, L_pp: float) -> float:
    """Heading at a sample [rad]; where it is noisy, from a line through the quarter ship length before."""
    part = _quarter_length_before(track, index, L_pp)
    if part.stop - part.start < 4 or noise_level(track.t, track.psi) < 0.02 * DEG:
        return float(track.psi[index])
    return float(np.polyfit(track.t[part] - track.t[index], track.psi[part], 1)[1])


def turn_rate_at(track: Track, index: int, L_pp: float) -> float:
    """Rate of the heading at a sample [rad/s]: of a line through a quarter length before, of two samples or more."""
    part = _quarter_length_before(track, index, L_pp)
    part = slice(max(min(part.start, index - 1), 0), max(part.stop, 2))
    return float(np.polyfit(track.t[part] - track.t[index], track.psi[part], 1)[0])


def original_course(track: Track, index: int, L_pp: float) -> float:
    """Mean heading of the approach [rad]: over the ship length before an order, ten samples at least if there are any.

    A helmsman counts from the course he was told to keep.  At the moment of the order the ship swings about it by
    course-keeping, and the compass has its noise.
    """
    begin = max(min(_lengths_before(track, index, L_pp), index - 10), 0)
    if begin == index:
        return float(track.psi[index])
    return integral(track.t, track.psi, begin, index) / float(track.t[index] - track.t[begin])


def approach_speed(track: Track, index: int, L_pp: float) -> float:
    """Mean speed over the ship length before a sample [m/s]."""
    begin = _lengths_before(track, index, L_pp)
    U = integral(track.t, track.speed, begin, index) / float(track.t[index] - track.t[begin]) if begin < index else 0.0
    return U or float(track.speed[index])


def _quarter_length_before(track: Track, index: int, L_pp: float) -> slice:
    """Samples of the quarter ship length up to a sample, that one included."""
    return slice(_lengths_before(track, index, 0.25 * L_pp), index + 1)


def _lengths_before(track: Track, index: int, distance: float) -> int:
    """First sample of the ``distance`` [m] before one, at the speed there."""
    return int(np.searchsorted(track.t, track.t[index] - distance / max(float(track.speed[index]), 1e-6)))


def first_crossing(values: FloatArray, level: float, begin: int, end: int) -> float | None:
    """Fractional sample at which rising ``values`` first reach ``level`` in samples begin..end, or None."""
    above = np.flatnonzero(values[begin : end + 1] >= level)
    if above.size == 0:
        return None
    i = begin + int(above[0])
    return float(i) if i == begin else i - 1 + float((level - values[i - 1]) / (values[i] - values[i - 1]))


def value_at(values: FloatArray, position: float) -> float:
    """A channel (n_samples,) at a fractional sample, linearly interpolated."""
    return float(np.interp(position, np.arange(values.size), values))


def integral(t: FloatArray, values: FloatArray, begin: float, end: float) -> float:
    """Integral over time of a channel (n_samples,) between two fractional samples (trapezoidal rule)."""
    inside = np.arange(np.floor(begin) + 1, np.ceil(end))
    position = np.r_[begin, inside, end]
    samples = np.arange(t.size)
    return float(np.trapezoid(np.interp(position, samples, values), np.interp(position, samples, t)))


def with_units(result: Any, L_pp: float) -> dict[str, Any]:
    """A result's fields by names that carry their unit (angles in degrees), lengths also over L_pp."""
    written: dict[str, Any] = {}
    for name, hint in get_type_hints(type(result), include_extras=True).items():
        value = getattr(result, name)
        suffix, factor = _WRITTEN[getattr(hint, "__metadata__", ("",))[0]]
        items = {f"{name}_{i}": v for i, v in enumerate(value, 1)} if isinstance(value, tuple) else {name: value}
        for key, item in items.items():
            written[key + suffix] = item if item is None or not suffix else item * factor
            if suffix == "_m" and name != "L_pp":
                written[f"{key}_over_L"] = None if item is None else item / L_pp
    return written


_WRITTEN = {
    "": ("", 1.0),
    "m": ("_m", 1.0),
    "s": ("_s", 1.0),
    "m/s": ("_m_per_s", 1.0),
    "rad": ("_deg", 1.0 / DEG),
    "rad/s": ("_deg_per_s", 1.0 / DEG),
}
