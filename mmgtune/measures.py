"""Seven distances between a measured and a simulated trajectory (Mathioudakis et al., eq. 10-16).

All take (n_samples, 6) arrays of x, y [m], psi [rad], u, v_m [m/s], r [rad/s] and leave out samples with a gap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .arrays import BoolArray, FloatArray, numbers_of
from .errors import OptionError, Problem, TrialError, brief

UNITS = {"MMD": "m", "MED": "m", "ASD": "mixed", "MSD": "mixed", "PMD": "%", "PED": "%", "cVDM": "%"}
"""Unit of each measure; "mixed" adds metres, radians and their rates as they are."""


@dataclass(frozen=True)
class Reference:
    """What cVDM is relative to, of the measured trajectory.

    length  path length [m]
    speed   mean speed [m/s]
    r_max   the ship's largest yaw rate [rad/s]; the paper has 0.0314 for its ship
    """

    length: float
    speed: float
    r_max: float

    def __post_init__(self) -> None:
        """Raises TrialError where one of them is no number above 0."""
        numbers = (numbers_of(one) for one in (self.length, self.speed, self.r_max))
        if not all(one is not None and one.ndim == 0 and 0.0 < one < math.inf for one in numbers):
            said = f"length {brief(self.length)}, speed {brief(self.speed)}, r_max {brief(self.r_max)}"
            why = f"relative distances are divided by numbers above 0, and here are {said}"
            fix = "give a trajectory of a ship that moves and turns, or r_max"
            raise TrialError(Problem("the measured ship does not move", "reference", why, fix))


def reference_of(measured: FloatArray, r_max: float | None = None) -> Reference:
    """Path length and mean speed of a measured trajectory (n_samples, 6), and its largest yaw rate where none is given.

    Raises OptionError for what is no such array of numbers and where one is infinite, TrialError where fewer than two
    samples are complete or the ship does not move.
    """
    measured = _states(measured, "measured")
    whole = measured[~np.isnan(measured).any(axis=1)]
    if len(whole) < 2:
        why, fix = "a path lies between two samples at least", "give one with two samples in which no state is NaN"
        raise TrialError(Problem("fewer than two complete samples", "measured", why, fix))
    length = float(np.sum(np.hypot(*np.diff(whole[:, :2], axis=0).T)))
    speed = float(np.mean(np.hypot(whole[:, 3], whole[:, 4])))
    r = float(np.abs(whole[:, 5]).max()) if r_max is None else r_max
    return Reference(length, speed, r)


def _states(given: FloatArray, name: str) -> FloatArray:
    """States (n_samples, 6), NaN in gaps.  Raises OptionError for anything else."""
    found = numbers_of(given)
    if found is None or found.ndim != 2 or found.shape[1] != 6:
        there = "what holds no numbers" if found is None else f"{found.shape}"
        what = f"states come in shapes (n_samples, 6), not {there}"
        own = next((f"{name} has them: give .{one}" for one in ("motion", "states") if hasattr(given, one)), "")
        fix = own or "give x, y [m], psi [rad], u, v_m [m/s] and r [rad/s] of each sample"
        raise OptionError(Problem(what, name, "distances are between states", fix))
    if np.isinf(found).any():
        raise OptionError(
            Problem("a state is infinite", name, "it is at no distance", "write NaN where there is a gap")
        )
    return found


def distance_measures(
    measured: FloatArray, simulated: FloatArray, reference: Reference | None = None
) -> dict[str, float]:
    """All seven measures by name, (n_samples, 6) each; units in ``UNITS``.

    reference  what cVDM is relative to; None: ``reference_of(measured)``

    Headings are compared as they are: both unwrapped.  PMD and PED divide by the measured coordinates, so they depend
    on where the origin is; the paper's denominator of PMD can be zero or negative, and the sum of absolute values is
    used instead.  Raises OptionError where shapes differ or no sample is complete, and as ``reference_of`` does.
    """
    measured, simulated = _states(measured, "measured"), _states(simulated, "simulated")
    if measured.shape != simulated.shape:
        what = f"shapes {measured.shape} and {simulated.shape} are not (n_samples, 6) both"
        raise OptionError(Problem(what, "simulated", "samples are compared one by one", "give both at the same times"))
    whole = ~(np.isnan(measured).any(axis=1) | np.isnan(simulated).any(axis=1))
    if not whole.any():
        why, fix = "every one has a state that is NaN", "give trajectories that have a sample without a gap in common"
        raise TrialError(Problem("no complete sample to compare", "measured", why, fix))
    reference = reference_of(measured) if reference is None else reference
    found = distances(measured[None], simulated[None])
    length, speed = np.array([reference.length]), np.array([reference.speed])
    parts = cvdm_parts(found.mean, length, speed, reference.r_max)
    named = {name: float(values[0]) for name, values in found.measures.items()}
    return {**named, "cVDM": float(sum(values[0] for values in parts.values()))}


@dataclass(frozen=True, eq=False)
class Distances:
    """How far many trajectories are apart, (n_trajectories,) and more each.

    measures  the six measures that need no reference, by name
    mean      (n_trajectories, 6) mean absolute difference of each state, over complete samples
    """

    measures: dict[str, FloatArray]
    mean: FloatArray


def distances(measured: FloatArray, simulated: FloatArray) -> Distances:
    """The measures of many trajectories at once, (n_trajectories, n_samples, 6) each, as ``distance_measures``.

    Samples with a NaN do not count, so shorter trajectories end in NaN.  NaN for one without a complete sample.
    """
    whole = np.asarray(~(np.isnan(measured).any(axis=2) | np.isnan(simulated).any(axis=2)))
    d = np.where(whole[:, :, None], np.abs(simulated - measured), 0.0)
    pose = np.where(whole[:, :, None], measured, 0.0)[:, :, :4]
    four = d[:, :, :4]
    dx, dy = d[:, :, 0], d[:, :, 1]

    def mean(values: FloatArray) -> FloatArray:
        return _mean_where(values, whole)

    def share(part: FloatArray, of: FloatArray) -> FloatArray:
        some = whole & (of > 0.0)
        return 100.0 * _mean_where(np.divide(part, of, out=np.zeros_like(part), where=some), some)

    measures = {
        "MMD": mean(dx + dy),
        "MED": mean(np.hypot(dx, dy)),
        "ASD": mean(np.sum(d, axis=2)),
        "MSD": mean(np.sqrt(np.sum(d * d, axis=2))),
        "PMD": share(np.sum(four, axis=2), np.sum(np.abs(pose), axis=2)),
        "PED": share(np.sqrt(np.sum(four**2, axis=2)), np.sqrt(np.sum(pose**2, axis=2))),
    }
    return Distances(measures, np.stack([mean(d[:, :, k]) for k in range(6)], axis=1))


def cvdm_parts(mean: FloatArray, length: FloatArray, speed: FloatArray, r_max: float) -> dict[str, FloatArray]:
    """What cVDM is the sum of, by part [%], (n_trajectories,) each.

    mean    (n_trajectories, 6) mean absolute differences, see ``Distances``
    length, speed  (n_trajectories,) path length [m] and mean speed [m/s] of the measured trajectories
    r_max   the ship's largest yaw rate [rad/s]
    """
    x, y, psi, u, v, r = mean.T
    return {
        "position": 100.0 * (x + y) / length,
        "heading": 100.0 * psi / np.pi,
        "surge": 100.0 * u / speed,
        "sway": 100.0 * v / speed,
        "yaw": 100.0 * r / r_max,
    }


def references(measured: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Path length [m] and mean speed [m/s] of trajectories (n_trajectories, n_samples, 6), (n_trajectories,) each.

    As ``reference_of``: samples with a NaN do not count, and the path goes straight past them.
    """
    whole = np.asarray(~np.isnan(measured).any(axis=2))
    n_samples = measured.shape[1]
    first = np.argmax(whole, axis=1)
    latest = np.maximum.accumulate(np.where(whole, np.arange(n_samples), first[:, None]), axis=1)
    path = np.take_along_axis(measured[:, :, :2], latest[:, :, None], axis=1)
    steps = np.diff(path, axis=1)
    length = np.sum(np.hypot(steps[:, :, 0], steps[:, :, 1]), axis=1)
    speed = np.hypot(np.where(whole, measured[:, :, 3], 0.0), np.where(whole, measured[:, :, 4], 0.0))
    return length, _mean_where(speed, whole)


def _mean_where(values: FloatArray, some: BoolArray) -> FloatArray:
    """(n,) means of rows (n, n_samples) over some of their samples, the others being 0; NaN where there are none."""
    count = some.sum(axis=1)
    return np.where(count > 0, np.sum(values, axis=1) / np.maximum(count, 1), np.nan)
