"""Velocities and yaw rates whose factor changes within a run: a sensor that was set anew, or failed.

Over a whole run, as ``motion_checks`` and ``cross_checks`` compare channels, half of that shows at most, and a model
takes it for slow noise.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...physics.frame import to_earth
from ..kinematics import halfway, middle
from ..model import Trial
from .finding import Finding

STRIDES = 60
"""Parts of a record in which channels are compared."""

FEWEST = 6
"""Strides before and behind a change at least."""

LEAST = 0.05
"""Change of a factor that is worth a warning."""

SURE = 8.0
"""The same in standard errors."""

SURE_IN_STEPS = 4.0
"""The same by the strides themselves, not by their sums."""

EXPLAINED = 0.6
"""Share that a change must take out of what is left by one factor, steady errors, those that grow evenly, and any other
habit of a sensor."""

PART, LASTS = 0.15, 0.5
"""Share of the turning or way that each part has at least, and share of the change between any halves of the two, and
by the strides themselves."""

FAR = 1e9
"""Way in a stride [m] that no ship makes: nothing can be told of such a log."""

KNOWN = 0.9
"""Share of the intervals that must be known: what gaps leave has noise that grows."""

TURNED = 0.3
"""Angle [rad] turned in each part at least."""


class Change(NamedTuple):
    """A factor that changes within a run: at which row, and how many times as far as the channel says the ship goes."""

    row: int
    before: float
    behind: float


def changes_within(trial: Trial) -> dict[str, Change]:
    """Channels, "u" and "r", whose factor changes within the run."""
    dt = np.diff(trial.t)
    if len(dt) < 4 * STRIDES:
        return {}
    bounds = np.linspace(0, len(dt), STRIDES + 1).astype(np.intp)[:-1]
    with np.errstate(all="ignore"):
        found = {"r": _yaw(trial, dt, bounds), "u": _way(trial, dt, bounds)}
    return {name: one._replace(row=int(bounds[one.row])) for name, one in found.items() if one is not None}


def part_findings(trial: Trial, where: str, but: Collection[str] = ()) -> list[Finding]:
    """Findings on factors that change within the run, of channels ``but`` these."""
    against = {"r": ("the heading turns", "columns 'r' and 'psi'"), "u": ("positions go", "columns 'u', 'x' and 'y'")}
    return [
        Finding(
            "warning",
            f"the factor of '{name}' changes within the run",
            f"{where}, {against[name][1]}, row {one.row}",
            f"{against[name][0]} {one.before:.3g} times as far as it says, and {one.behind:.3g} times from about "
            f"{trial.t[one.row]:.4g} s on: a sensor was set anew or failed, and no force does that",
            f"cut the trial there, or mark '{name}' as NaN where it is wrong",
        )
        for name, one in changes_within(trial).items()
        if name not in but
    ]


def _yaw(trial: Trial, dt: FloatArray, bounds: IntArray) -> Change | None:
    """Of the yaw rate against the heading, by number of the stride."""
    turned, rate = np.diff(trial.psi), middle(trial.r)
    turned = np.where(np.abs(turned) > 3.0, np.nan, turned)  # a full turn
    logged = rate * dt
    late = np.diff(trial.r)  # a rate or a heading that follows late
    course = trial.psi[0] + np.concatenate([[0.0], np.cumsum(np.nan_to_num(logged))])
    deviating = [np.diff(of(k * course)) for k in (1, 2) for of in (np.sin, np.cos)]  # a compass
    known = np.isfinite(turned) & np.isfinite(logged)
    if known.mean() < KNOWN:
        return None
    a, b, T, late, *deviating = _sums(known, bounds, logged, turned, dt, late, *deviating)
    off = np.column_stack([T, T * np.linspace(-1.0, 1.0, STRIDES)])  # a zero error, and one that grows
    return _change(a, b, off, [late[:, None], np.column_stack(deviating)], enough=TURNED)


def _way(trial: Trial, dt: FloatArray, bounds: IntArray) -> Change | None:
    """Of the speed ahead against the positions, by number of the stride."""
    psi, u, v = halfway(trial.psi), middle(trial.u), middle(trial.v_m)
    moved = np.column_stack([np.diff(trial.x), np.diff(trial.y)])
    ahead = np.column_stack(to_earth(psi, u, 0.0 * u)) * dt[:, None]
    known = np.isfinite(moved).all(axis=1) & np.isfinite(ahead).all(axis=1) & np.isfinite(v)
    if known.mean() < KNOWN:
        return None
    t = np.linspace(-1.0, 1.0, len(dt))
    lever = [np.diff(np.column_stack(to_earth(trial.psi, *of)), axis=0) for of in ((1.0, 0.0), (0.0, 1.0))]
    north, east = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    others = [
        np.column_stack(to_earth(psi, 0.0 * v, v)) * dt[:, None],  # sway with a factor of its own
        np.column_stack(to_earth(psi, 0.0 * u, u)) * dt[:, None],  # a speed log at an angle
        *(np.nan_to_num(one) for one in lever),  # positions of another point
        *(dt[:, None] * axis for axis in (north, east)),  # a current
        *((dt * t)[:, None] * axis for axis in (north, east)),  # that grows
    ]
    at_speed = ahead * u[:, None]  # whose factor changes with speed
    a, b, s, *rest = (np.concatenate(_sums(known, bounds, *one.T)) for one in (ahead, moved, at_speed, *others))
    return _change(a, b, np.column_stack(rest), [s[:, None]], enough=0.0)


def _sums(known: BoolArray, bounds: IntArray, *values: FloatArray) -> list[FloatArray]:
    """Each (n_intervals,) summed over strides, what is not known left out."""
    return [np.add.reduceat(np.where(known, one, 0.0), bounds) for one in values]


def _change(
    a: FloatArray, b: FloatArray, others: FloatArray, instead: Sequence[FloatArray], enough: float
) -> Change | None:
    """Where the factor of ``b`` on ``a`` changes, and how much it is before and behind; None where it does not.

    a, b     (n_rows,) of strides, one axis after the other
    others   (n_rows, n) what b may follow besides, all the time
    instead  (n_rows, n) what it may follow all the time in the place of a change, each alone
    enough   sum of |a| before and behind at least
    """
    if not max(float(np.abs(one).max()) for one in (a, b, others, *instead)) < FAR:
        return None
    axes = len(a) // STRIDES
    stride = np.tile(np.arange(STRIDES), axes)

    def summed(columns: FloatArray) -> FloatArray:
        """Since the start: positions and headings have noise that does not grow, their differences have twice of it."""
        return np.cumsum(columns.reshape(axes, STRIDES, -1), axis=1).reshape(len(columns), -1)

    begun = np.repeat(np.eye(axes), STRIDES, axis=0)
    Q = _basis(np.column_stack([begun, summed(others)]))
    rest_b = summed(b)[:, 0] - Q @ (Q.T @ summed(b)[:, 0])
    least = np.inf
    for more in (a[:, None], *(np.column_stack([a, other]) for other in instead)):
        P = _basis(np.column_stack([Q, summed(more)]))
        least = min(least, float(np.sum((rest_b - P @ (P.T @ rest_b)) ** 2)))
    # All places where it may change at once: (n_places,) of them, and behind that before and behind each.
    places = np.arange(FEWEST, STRIDES - FEWEST + 1)
    before_it = stride < places[:, None]
    sides = np.stack([np.where(before_it, a, 0.0), np.where(before_it, 0.0, a)])
    size = np.abs(sides).sum(axis=2)
    own = summed(sides.reshape(-1, len(a)).T)
    own = (own - Q @ (Q.T @ own)).reshape(len(a), 2, len(places)).transpose(2, 0, 1)
    square = own.transpose(0, 2, 1) @ own
    fair = (size.min(axis=0) >= np.maximum(enough, PART * size.sum(axis=0))) & np.isfinite(square).all(axis=(1, 2))
    fair[fair] = np.linalg.cond(square[fair]) < 1e8  # of a ship at rest it is no number
    if not fair.any():
        return None
    places, own, square = places[fair], own[fair], square[fair]
    every = np.linalg.solve(square, own.transpose(0, 2, 1) @ rest_b[:, None])
    left = ((rest_b[:, None] - own @ every) ** 2).sum(axis=(1, 2))
    least_at = int(np.argmin(left))
    squares, k, factors = float(left[least_at]), int(places[least_at]), every[least_at, :, 0]
    inverse = np.linalg.inv(square[least_at])
    # Each half of what comes before differs from each half behind, or it was something else that passed.
    halves = []
    for part in (stride < k, stride >= k):
        way = np.cumsum(np.bincount(stride, np.where(part, np.abs(a), 0.0)))
        first = (way <= 0.5 * way[-1])[stride]
        halves += [np.where(part & first, a, 0.0), np.where(part & ~first, a, 0.0)]
    own = summed(np.column_stack(halves))
    of_halves = np.linalg.lstsq(own - Q @ (Q.T @ own), rest_b, rcond=1e-8)[0]
    lasts = np.subtract.outer(of_halves[2:], of_halves[:2]) / (factors[1] - factors[0])
    variance = squares / max(1, len(a) - Q.shape[1] - 3)
    error = np.sqrt(variance * (inverse[0, 0] + inverse[1, 1] - 2.0 * inverse[0, 1]))
    before, behind = factors.tolist()
    changed = abs(behind - before)
    in_steps, error_in_steps = _change_in_steps(a, b, others, stride < k)
    alike = np.sign(behind - before) * in_steps >= max(LASTS * changed, SURE_IN_STEPS * error_in_steps)
    sure = changed >= SURE * error and alike
    if changed < LEAST or not sure or squares > (1.0 - EXPLAINED) * least or lasts.min() < LASTS:
        return None
    return Change(k, before, behind)


def _change_in_steps(a: FloatArray, b: FloatArray, others: FloatArray, before: BoolArray) -> tuple[float, float]:
    """A change of the factor and its standard error by strides themselves, of which one may tell the next: of noise
    that fades slowly the sums, by which a change is looked for, walk at random.

    before  (n_rows,) whether a stride is before the change
    """
    A = np.column_stack([np.where(before, a, 0.0), np.where(before, 0.0, a), others])
    fit, _, rank, _ = np.linalg.lstsq(A, b, rcond=1e-8)
    left = b - A @ fit
    variance = float(np.sum(left**2)) / max(1, len(b) - rank)
    alike = float(left[1:] @ left[:-1]) / max(float(left @ left), 1e-300)
    fades = (1.0 + alike) / (1.0 - alike) if alike > 0.0 else 1.0
    inverse = np.linalg.pinv(A.T @ A, rcond=1e-12)
    error = np.sqrt(fades * variance * (inverse[0, 0] + inverse[1, 1] - 2.0 * inverse[0, 1]))
    return float(fit[1] - fit[0]), float(error)


def _basis(columns: FloatArray) -> FloatArray:
    """(n_rows, k) an orthonormal basis of columns, each over its length; directions that hardly show are left out."""
    length = np.linalg.norm(columns, axis=0)
    U, sizes, _ = np.linalg.svd(columns[:, length > 0.0] / length[length > 0.0], full_matrices=False)
    return np.asarray(U[:, sizes > 1e-6])
