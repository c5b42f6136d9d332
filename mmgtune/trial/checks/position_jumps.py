"""Steps of the logged position that the logged velocities do not make, as a satellite receiver has them."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from ...arrays import FloatArray, runs_of_true
from ...phrases import figures
from ...physics.frame import to_earth
from ..gaps import bridged
from ..kinematics import halfway, middle
from ..model import Trial
from .finding import Finding
from .motion_checks import spikes_of

SPAN = 12.0
"""Time [s] on each side of a step over which the track has to lie on one line and then on another."""
FEWEST, MOST = 5, 100
"""Samples of such a line."""
LINES = 6
"""Lines that a record holds at least."""
BEYOND = 9.0
"""How many times the usual misfit of two neighbouring lines a step exceeds."""
FIRST, AT_ONCE = 4.0, 0.5
"""Time [s] at the beginning in which positions may be off, and way [s] that the first of them exceeds: to leave them
out costs nothing."""
AWAY, NEAR = 6.0, 2.0
"""How many times the usual misfit of the line that follows the first position exceeds where it is off, and up to which
those after it are of the track."""
OUTLIERS, LEFT_OUT = 6, 3
"""Samples on each side of a step that may be outliers, and how many of them may be, a quarter at most."""
WAY = 1.0
"""Way [s] at the ship's speed that a step exceeds: what is smaller hardly matters."""


def position_jumps(trial: Trial) -> list[tuple[int, float]]:
    """Rows after a step of the position, and by how far [m] it goes.

    The way the velocities make is taken off the track; lines fitted to what is left before and after each moment must
    meet there.  Drifts, currents and biases of the velocities are lines themselves and pass.  Where a few velocities
    are missing the way goes on between their neighbours; longer gaps are not judged, and a single outlier is no jump.
    """
    n = _samples(trial)
    left = _without_way(trial, n)
    if left is None:
        return []
    ahead = _line_at(n, 0.5 * n)  # half a sample behind its last
    # Rows k + n: what lies before predicts the middle of the step to row k + n, and so does what lies after.
    steps = [
        np.lib.stride_tricks.sliding_window_view(one[n:], n) @ ahead[::-1]
        - np.lib.stride_tricks.sliding_window_view(one[:-n], n) @ ahead
        for one in left
    ]
    size = np.hypot(*steps)
    # A position that stands for several samples, as of a slow receiver, makes lines of steps; its way in them is usual.
    usual = float(np.nanmedian(size)) if np.isfinite(size).any() else np.inf
    least = max(BEYOND * usual, WAY * _fast(trial))
    found = _peaks(np.nan_to_num(size), least, n)
    return [(k + n, float(size[k])) for k in found if _stays([one[k : k + 2 * n] for one in left], 0.5 * least)]


def first_positions_off(trial: Trial) -> tuple[int, float] | None:
    """The row from which the track is what it goes on as, and how far [m] off its first position is; None where the
    first is of the track.

    A receiver that is late, or that only begins to tell, stands where the log begins.
    """
    n = _samples(trial)
    left = _without_way(trial, n)
    if left is None:
        return None
    most = min(int(np.ceil(FIRST / np.median(np.diff(trial.t)))), n)
    before = [_line_at(n, -0.5 * (n - 1) - (most - row)) for row in range(most)]
    lines = [np.lib.stride_tricks.sliding_window_view(one[most:], n) @ before[0] for one in left]
    everywhere = np.hypot(*(one[: len(line)] - line for one, line in zip(left, lines, strict=True)))
    usual = float(np.nanmedian(everywhere)) if np.isfinite(everywhere).any() else np.inf
    off = [float(np.hypot(*(one[row] - one[most : most + n] @ before[row] for one in left))) for row in range(most)]
    if not off[0] > max(AWAY * usual, AT_ONCE * _fast(trial)):
        return None
    return next((row for row, one in enumerate(off) if not one > NEAR * usual), most), off[0]


def _samples(trial: Trial) -> int:
    """Samples of a line: fewer where the record is short."""
    long = int(np.clip(np.ceil(SPAN / np.median(np.diff(trial.t))), FEWEST, MOST))
    return max(min(long, trial.n_samples // LINES), FEWEST)


def _fast(trial: Trial) -> float:
    """Speed [m/s] that the ship hardly exceeds."""
    return float(np.nanpercentile(np.hypot(trial.u, trial.v_m), 90.0))


def _without_way(trial: Trial, n: int) -> list[FloatArray] | None:
    """Positions north and east (n_samples,) less the way that the velocities make; None where the record is shorter
    than six lines of n samples, or says nothing of its velocities."""
    if trial.n_samples < LINES * n:
        return None
    made = to_earth(halfway(trial.psi), middle(trial.u), middle(trial.v_m))
    ways = bridged(trial.t[:-1], *made)
    if ways is None:
        return None
    left = [
        _without_spikes(trial, name) - np.concatenate([[0.0], np.cumsum(way * np.diff(trial.t))])
        for name, way in zip(("x", "y"), ways.T, strict=True)
    ]
    for first, last in runs_of_true(np.isnan(made[0])):
        for one in left if last - first > n else ():
            one[first : last + 1] = np.nan
    return left


def _stays(around: list[FloatArray], least: float) -> bool:
    """Whether a step in the middle of two channels (2 n,) exceeds ``least`` whichever few samples are left out on each
    side of it.

    An outlier comes back at the next sample: without it there is no step.
    """
    n = len(around[0]) // 2
    places = np.column_stack(around)
    k = np.arange(2 * n, dtype=np.float64) - n + 0.5
    before, behind = (_ends(k[half], places[half]) for half in (slice(n), slice(n, 2 * n)))
    steps = behind[None] - before[:, None]
    return float(np.hypot(steps[..., 0], steps[..., 1]).min()) >= least


def _ends(k: FloatArray, places: FloatArray) -> FloatArray:
    """Where lines through places (n, 2) at k (n,) are at 0, (n_lines, 2): through all of them, and without one, two or
    three of those that are furthest from the others, as far as enough are left."""
    off = np.hypot(*(places - np.median(places, axis=0)).T)
    furthest = np.argsort(-off)[:OUTLIERS]
    ends = []
    for few in range(min(LEFT_OUT, len(k) // 4) + 1):
        for out in combinations(furthest.tolist(), few):
            kept = np.delete(np.arange(len(k)), out)
            ends.append(np.polynomial.polynomial.polyfit(k[kept], places[kept], 1)[0])
    return np.array(ends)


def _without_spikes(trial: Trial, name: str) -> FloatArray:
    """A channel with single samples off the others put between their neighbours: they are told of as spikes."""
    values, rows = trial.columns[name], spikes_of(trial, name)
    smooth = values.copy()
    smooth[rows] = 0.5 * (values[rows - 1] + values[rows + 1])
    return smooth


def _line_at(n: int, place: float) -> FloatArray:
    """(n,) weights that give the line through n equidistant samples at a place, in samples from their middle."""
    k = np.arange(n) - 0.5 * (n - 1)
    return np.asarray(1.0 / n + place * k / float(k @ k))


def _peaks(size: FloatArray, least: float, apart: int) -> list[int]:
    """Largest values beyond ``least``, none within ``apart`` of a larger one, in the order of the record."""
    left = size.copy()
    found: list[int] = []
    while len(left) and left.max() > least:
        k = int(np.argmax(left))
        found.append(k)
        left[max(0, k - apart) : k + apart + 1] = 0.0
    return sorted(found)


def jump_findings(trial: Trial, where: str) -> list[Finding]:
    """Warnings where the position jumps, with the largest step, and where the first positions are off."""
    begun = first_positions_off(trial)
    told = []
    if begun:
        row, size = begun
        first = "the first position is" if row == 1 else f"the first {row} positions are"
        told.append(
            Finding(
                "warning",
                f"{first} off the track by {'' if row == 1 else 'up to '}{size:.3g} m",
                f"{where}, columns 'x' and 'y', row {row}",
                "it goes on from elsewhere: a receiver that is late stands still where its log begins",
                "cut the trial there",
            )
        )
    found = position_jumps(trial)
    if not found:
        return told
    row, size = max(found, key=lambda one: one[1])
    times = "once" if len(found) == 1 else f"{len(found)} times"
    speed = bridged(trial.t, np.hypot(trial.u, trial.v_m))
    assert speed is not None  # a jump is seen beside what velocities make
    went = float(speed[row, 0] * (trial.t[row] - trial.t[row - 1]))
    return [
        *told,
        Finding(
            "warning",
            f"the position jumps {times}, by {'' if len(found) == 1 else 'up to '}{size:.3g} m",
            f"{where}, columns 'x' and 'y', row {row}",
            f"'u', 'v' and 'psi' make {figures(went)} m there",
            "mark the positions that are wrong as NaN, or cut the trial there",
        ),
    ]
