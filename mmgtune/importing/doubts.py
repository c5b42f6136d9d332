"""What an imported trial shows of its sensors and of how it was logged, though nobody asked: each with its evidence.

Every fix names a key of the map.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ..arrays import FloatArray
from ..phrases import aboard, listed
from ..physics.frame import to_earth
from ..trial import Trial
from ..trial.checks.finding import Finding, Rescale, Reverse, Shift
from ..trial.kinematics import turning, white_noise
from ..units import DEG
from .cutting import standing
from .gridding import FEWEST
from .maps.mapping import LogMap
from .record import MORE_DIGITS, Coarse, Record
from .yaw import integral_of

DRIFTS = 2.0 * DEG
"""Difference of heading and integrated yaw rate [rad] over a run up to which nothing is said of a steady drift."""
STEADY = 0.9
"""Share of a difference that a straight line in time must explain to be a drift."""
PARTS, CERTAIN = 8, 5.0
"""Parts of a run of which each tells how fast it drifts, and standard errors of their mean from which it is steady."""
LARGEST_FACTOR = 2.0
"""Factor on a yaw rate, or one over it, up to which a gyro may be off."""
TELLS = 0.8
"""Share of what is left of the positions that a lever must explain to be named."""
FAR_LESS = 0.5
"""Share that a lever must leave at most of what velocities that are off steadily would."""
APART = 4.0
"""How many times as much must be left along one axis as along the other to be said."""
OTHER_UNITS = (
    (60.0, "r", "the yaw rate is in deg/s and was read in deg/min"),
    (1.0 / 60.0, "r", "the yaw rate is in deg/min and was read in deg/s"),
    (1.0 / DEG, "r", "the yaw rate is in rad/s and was read in deg/s"),
    (60.0 / DEG, "r", "the yaw rate is in rad/s and was read in deg/min"),
    (DEG, "psi", "the heading is in rad and was read in deg"),
)
"""How many times as far a heading turns as its yaw rate says, the column whose unit is wrong then, and how."""
SAME_UNIT, TURNS_ALIKE = 0.025, 0.95
"""Share by which that may differ, and correlation of the two that is enough to tell."""
HANDLED = 0.1
"""Share of her speed and yaw rate under orders, and angle [rad], by which a ship moves that is handled without any."""


@dataclass(frozen=True)
class Lever:
    """A point of the ship that velocities are of, forward and to starboard of that of the positions [m].

    shifted  whether they were moved from there along earth axes already
    left     share of what the positions are missed by that is left with it
    """

    ahead: float
    abeam: float
    shifted: bool
    left: float

    @property
    def across(self) -> float:
        """To starboard, 0 where that is lost beside the other."""
        return self.abeam if abs(self.abeam) > 0.1 * abs(self.ahead) else 0.0


def doubts(trial: Trial, record: Record, log_map: LogMap) -> list[Finding]:
    """Warnings on one trial."""
    where = record.path.name
    found: list[Finding] = []
    if "r" in record.series and "psi" in record.series:
        found += gyro_drift(trial, where)
    if not log_map.antenna and not log_map.shifted and record.has_velocities:
        found += one_axis(trial, where, log_map)
    found += by_hand(trial, where, log_map)
    found += [_few_digits(name, coarse, record, log_map) for name, coarse in record.coarse.items()]
    return found


def _few_digits(name: str, coarse: Coarse, record: Record, log_map: LogMap) -> Finding:
    """A column printed with few digits; a heading is only to be recovered from a yaw rate that is good enough."""
    why, fix = coarse.why, coarse.fix(name)
    heading, rate = record.series.get("psi"), record.series.get("r")
    if name == "psi" and heading is not None and rate is not None:
        integral = integral_of(heading, rate, np.full(len(heading.t), coarse.size), log_map.gap)
        if integral is not None and integral.wanders:
            adds_up = f"its noise would add up to {integral.wander / DEG:.2g} deg rms"
            why += f"; the rate gives no better one: {adds_up}"
            fix = MORE_DIGITS
    return Finding("warning", f"'{name}' is {coarse.words}", where=record.path.name, why=why, fix=fix)


def gyro_drift(trial: Trial, where: str) -> list[Finding]:
    """A heading that leaves the integral of the yaw rate steadily, in time or as she turns."""
    turned = turning(trial.columns)
    off = turned.heading - turned.yaw
    if len(off) < FEWEST or turned.opposed:  # the check of the trial tells that
        return []
    t = np.linspace(0.0, trial.duration, len(off))
    (slope, in_time), (factor, by_turning) = (_line(one, off) for one in (t, turned.yaw))
    drift = slope * trial.duration
    if max(in_time, by_turning) < STEADY or max(abs(drift), float(np.ptp(off))) < DRIFTS:
        return []
    for ratio, name, why in OTHER_UNITS:
        if abs(turned.ratio / ratio - 1.0) < SAME_UNIT and abs(turned.correlation) > TURNS_ALIKE:
            what = f"the heading turns {turned.ratio:.3g} times as far as the yaw rate says"
            fix = f"say its unit in [columns.{name}], and header_says where the header has another"
            return [Finding("warning", what, where, why, fix)]
    in_time = in_time if _is_steady(t, off) else 0.0
    likely = 1.0 / LARGEST_FACTOR < 1.0 + factor < LARGEST_FACTOR
    by_turning = by_turning if likely and _is_steady(turned.yaw, off) else 0.0
    if max(in_time, by_turning) < STEADY:
        return []
    what = f"heading and integrated yaw rate drift apart by {float(np.ptp(off)) / DEG:.3g} deg over the run"
    scale = f"a factor of {1.0 + factor:.4g} on the yaw rate explains {100.0 * by_turning:.0f} % of it"
    if by_turning > in_time + 0.05:
        return [Finding("warning", what, where, scale, f"say scale = {1.0 + factor:.4g} in [columns.r]")]
    rate = f"{slope / DEG:.2g} deg/s"
    why = f"steadily, by {rate}, which explains {100.0 * in_time:.0f} % of it"
    offset = f'say offset = "{rate}" in [columns.r]'
    # The way she goes over the ground knows neither gyro.
    course = _course_drift(trial)
    if course is not None and abs(course + drift) < 0.35 * abs(drift):
        why += f"; the course turns {abs(course) / DEG:.2g} deg away from the heading meanwhile: the heading drifts"
        fix = "name another compass in [columns.psi], or leave it: mmgtune diagnose looks for such"
    elif by_turning > in_time - 0.05:
        why += f"; {scale} as well, as she turns steadily"
        fix = f"{offset}, or scale = {1.0 + factor:.4g}"
    elif course is not None and abs(course) < 0.35 * abs(drift):
        why += "; course and heading stay together: it is a bias of the yaw rate"
        fix = offset
    else:
        why += "; the course over the ground does not tell which of them drifts"
        fix = f"where the yaw rate has a bias, {offset}"
    return [Finding("warning", what, where, why, fix)]


def _is_steady(by: FloatArray, off: FloatArray) -> bool:
    """Whether a difference (n,) grows with ``by`` in all parts of a run alike: noise that fades slowly adds up to a
    walk at random, and nine in ten parts of one may look like a straight line."""
    rows = np.linspace(0, len(off) - 1, PARTS + 1).astype(int)
    by, off = np.diff(by[rows]), np.diff(off[rows])
    size = float(by @ by)
    if size == 0.0:
        return False
    slope = float(by @ off) / size
    error = np.sqrt(float(np.sum((off - slope * by) ** 2)) / (PARTS - 1) / size)
    return bool(abs(slope) > CERTAIN * error)


def _line(by: FloatArray, off: FloatArray) -> tuple[float, float]:
    """Slope of the best line through a difference (n,), and the share of its variance that it explains."""
    spread, size = float(np.var(off)), float(np.var(by))
    if spread == 0.0 or size == 0.0:
        return 0.0, 0.0
    slope = float(np.mean((by - by.mean()) * (off - off.mean()))) / size
    return slope, slope**2 * size / spread


def _course_drift(trial: Trial) -> float | None:
    """Angle [rad] by which the course made good leaves that of heading and velocities over the run; None if unclear."""
    dt = np.diff(trial.t)
    stride = max(1, len(dt) // 60)
    rows = np.arange(0, len(trial.t), stride)
    north, east = np.diff(trial.x[rows]), np.diff(trial.y[rows])
    ways = [cumulative_trapezoid(np.nan_to_num(one), trial.t, initial=0.0)[rows] for one in
            to_earth(trial.psi, trial.u, trial.v_m)]  # fmt: skip
    off = np.angle((north + 1j * east) * np.conj(np.diff(ways[0]) + 1j * np.diff(ways[1])))
    size = np.hypot(north, east)
    used = np.isfinite(off) & (size > 0.3 * np.nanmedian(size))
    if used.sum() < 12:
        return None
    t = trial.t[rows][:-1][used]
    slope, constant = np.polyfit(t, off[used], 1)
    error = float(np.std(off[used] - slope * t - constant)) / np.sqrt(used.sum()) / max(float(np.std(t)), 1e-9)
    if abs(slope) < 3.0 * error and 3.0 * error * trial.duration > 0.5 * DRIFTS:
        return None
    return float(slope) * trial.duration


def one_axis(trial: Trial, where: str, log_map: LogMap) -> list[Finding]:
    """Positions that velocities miss along one axis, or by a lever: of another point, or moved the wrong way."""
    left = position_residual(trial)
    if left is None:
        return []
    sizes = [float(np.std(one)) for one in left]
    noise = max(white_noise(trial.x), white_noise(trial.y))
    way = float(np.nansum(np.hypot(np.diff(trial.x), np.diff(trial.y))))
    if max(sizes) < 5.0 * noise or max(sizes) < 2e-4 * way:
        return []
    levers = [lever_of(trial, left, shifted) for shifted in (False, True)]
    best = min(levers, key=lambda one: one.left)
    other = max(one.left for one in levers)
    names = ("x", "y")
    large, small = (names[int(np.argmax(sizes))], names[int(np.argmin(sizes))])
    said = f"integrated velocities leave {large} by {max(sizes):.3g} m, {small} by {min(sizes):.3g} m"
    if best.left < 1.0 - TELLS and (best.left < 0.5 * other or not best.shifted) and _is_no_drift(trial, left, best):
        point = f'point = {{ x = "{best.ahead:.3g} m", y = "{best.across:.3g} m" }}'
        if best.shifted:
            what = "velocities seem to have been moved to midship along earth axes instead of the ship's"
            fix = f'say shifted = "earth-axes" and {point} in [velocity]'
        elif log_map.point == "midship":
            return []
        else:
            what = f"velocities seem to be of a point {aboard(best.ahead, best.across)} of that of the positions"
            fix = f"say {point} in [velocity], or where the antenna is in [antenna]"
        why = f"{said}; such a lever explains {100.0 * (1.0 - best.left):.0f} % of it"
        return [Finding("warning", what, where, why, fix, "shifted" if best.shifted else "")]
    if max(sizes) > APART * min(sizes) and max(sizes) > 2e-3 * way:
        why = f"{said}; no lever arm explains it, nor does rounding"
        fix = f"check the column of '{large}' and of the velocity along it, and [velocity] axes and point"
        return [Finding("warning", f"velocities miss the positions along {large} alone", where, why, fix)]
    return []


def position_residual(trial: Trial) -> tuple[FloatArray, FloatArray] | None:
    """Positions less integrated velocities (n_samples,) [m], without their means; None where there are holes."""
    known = (
        np.isfinite(trial.psi)
        & np.isfinite(trial.u)
        & np.isfinite(trial.v_m)
        & np.isfinite(trial.x)
        & np.isfinite(trial.y)
    )
    if known.mean() < 0.98:
        return None
    filled = [
        np.interp(trial.t, trial.t[known], one[known]) for one in (trial.psi, trial.u, trial.v_m, trial.x, trial.y)
    ]
    ways = to_earth(*filled[:3])
    off = [own - cumulative_trapezoid(way, trial.t, initial=0.0) for own, way in zip(filled[3:], ways, strict=True)]
    return off[0] - off[0].mean(), off[1] - off[1].mean()


def lever_of(trial: Trial, left: tuple[FloatArray, FloatArray], shifted: bool) -> Lever:
    """The lever that explains best what is left of positions, by least squares.

    Velocities of a point ahead and abeam of midship leave the way of that point about midship.  Moved along earth axes,
    with r taken for the velocity along them, they leave besides what that way is on a ship that heads north.
    """
    (ahead, abeam), rest = _fitted(_of_lever(trial, shifted), left)
    return Lever(float(ahead), float(abeam), shifted, rest)


def _of_lever(trial: Trial, shifted: bool) -> list[tuple[FloatArray, FloatArray]]:
    """What a metre ahead and a metre abeam leave along x and along y, each (n_samples,)."""
    known = np.isfinite(trial.psi)
    psi = np.unwrap(np.interp(trial.t, trial.t[known], trial.psi[known]))
    c, s = np.cos(psi), np.sin(psi)
    return [(-c, psi - s), (s - psi, -c)] if shifted else [(-c, -s), (s, -c)]


def _fitted(
    bases: Sequence[tuple[FloatArray, FloatArray]], left: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, float]:
    """Sizes (n_bases,) that explain what is left best, by least squares, and the share of its squares that stays."""
    stacked = np.column_stack([np.concatenate([a - a.mean(), b - b.mean()]) for a, b in bases])
    target = np.concatenate(left)
    fit, *_ = np.linalg.lstsq(stacked, target, rcond=None)
    rest = target - stacked @ fit
    return np.asarray(fit), float(rest @ rest) / max(float(target @ target), 1e-300)


def shifted_lever(trial: Trial) -> Lever | None:
    """The lever that velocities were moved by along earth axes; None where what is left does not show one."""
    left = position_residual(trial)
    if left is None:
        return None
    with_it, without = lever_of(trial, left, True), lever_of(trial, left, False)
    shows = with_it.left < min(1.0 - TELLS, 0.5 * without.left) and _is_no_drift(trial, left, with_it)
    return with_it if shows else None


def _is_no_drift(trial: Trial, left: tuple[FloatArray, FloatArray], lever: Lever) -> bool:
    """Whether a lever explains far more of what is left of positions than velocities that are off steadily, beside a
    plain lever where it was moved along earth axes: in a steady turn that leaves a straight line too."""
    t = trial.t - trial.t.mean()
    still = np.zeros_like(t)
    bases = [*(_of_lever(trial, False) if lever.shifted else ()), (t, still), (still, t)]
    return lever.left < FAR_LESS * _fitted(bases, left)[1]


def by_hand(trial: Trial, where: str, log_map: LogMap) -> list[Finding]:
    """A ship that moves while every order still, or again, stands at zero: she is handled."""
    at_rest = standing({name: trial.columns[name] for name in log_map.inputs})
    ordered = np.flatnonzero(~at_rest)
    if not len(ordered):
        return []
    usual = float(np.sqrt(np.nanmean(trial.u[ordered] ** 2 + trial.v_m[ordered] ** 2)))
    usual_rate = float(np.nanpercentile(np.abs(trial.r[ordered]), 95.0))
    found = []
    for words, key, value, rows in (
        ("before the first order", "from", "first-order", slice(0, int(ordered[0]))),
        ("after the last order", "to", "last-order", slice(int(ordered[-1]) + 1, None)),
    ):
        speed, rate, psi = (one[rows] for one in (np.hypot(trial.u, trial.v_m), np.abs(trial.r), trial.psi))
        if np.isfinite(speed).sum() < FEWEST:
            continue
        # A ship whose engine is stopped loses way and turn; one that gains either is pushed.
        gained, turned = _rise(speed), _rise(rate)
        swung = float(np.nanmax(psi) - np.nanmin(psi)) if key == "from" and np.isfinite(psi).any() else 0.0
        if gained < HANDLED * usual and turned < HANDLED * usual_rate and swung < HANDLED:
            continue
        span = float(np.ptp(trial.t[rows]))
        said = f"propeller and rudder stand at zero for {span:.3g} s {words}, and the ship is moved"
        why = f"she gains {gained:.2g} m/s and {turned / DEG:.2g} deg/s of turn meanwhile: people handle her"
        found.append(Finding("warning", said, where, why, f'say {key} = "{value}" in [cut]', f"handled-{key}"))
    return found


def _rise(values: FloatArray) -> float:
    """Largest rise of a channel (n,) above what it was before, over means long enough to see through noise."""
    known = values[np.isfinite(values)]
    width = max(1, len(known) // 20)
    means = known[: len(known) // width * width].reshape(-1, width).mean(axis=1)
    return float(np.max(means - np.minimum.accumulate(means), initial=0.0))


def fix_in_map(fix: str) -> str:
    """A fix by arithmetic as the key of the map to change; any other as it is."""
    if isinstance(fix, Shift):
        return f'say late = "{fix.late:.2g} s" in [columns] of the map, for the rudder and all that was logged with it'
    if isinstance(fix, Reverse):
        first, *others = (f"[columns.{name}]" for name in fix.columns)
        return f'say the other side with positive = "..." in {first} of the map; if it is right, in {listed(others)}'
    if not isinstance(fix, Rescale):
        return fix
    place = "format, unit or scale in [time]" if fix.column == "t" else f"unit or scale in [columns.{fix.column}]"
    return f"correct {place} of the map"
