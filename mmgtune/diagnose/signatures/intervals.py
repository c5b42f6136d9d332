"""How well the sizes of the causes are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import FloatArray
from ...components import effect_tag
from ...fitting.box import base_of, group_of
from ...units import NORMAL_95
from ..bench.workbench import Point, Workbench
from .linear import linearise, unit_of

AT_END = 0.1
"""Share of an interval on one side of its value from which that is at an end of its range."""

OF_BOX = 1.0 / 12.0
"""Variance of what may be anywhere in a box, over the square of its width."""


@dataclass(frozen=True)
class Estimate:
    """A parameter of a cause: value and 95 % interval in its unit; an end is None where it is infinite.

    apart   of a value of single runs, the standard error of how far it is from the mean of all; else None
    at_end  whether the value is at an end of its range, which its interval ends with
    stated  its value in the profile, None where the effect is absent there
    """

    name: str
    value: float
    low: float | None
    high: float | None
    stderr: float | None
    apart: float | None = None
    at_end: bool = False
    stated: float | None = None


def estimates(bench: Workbench, point: Point) -> dict[str, Estimate]:
    """Values and 95 % intervals of the parameters of effects that are free in a point, by name.

    From the problem made linear, with targets and initial states re-tuned alongside.  Wider than independent noise
    would have it by what the residuals' own blocks and the inputs' noise show; the form of the model is taken as right.
    """
    names = tuple(name for name in point.names if effect_tag(name))
    if not names:
        return {}
    R, noise, size = _told(bench, point, names)
    back = np.linalg.pinv(R, rcond=1e-10)
    spread = back @ noise @ back.T
    believed = bench.beliefs(names, point.spreads)
    if believed is not None:  # what other runs say of a run that says little itself, and what is known of forms
        alike = believed[0] * size
        told = R.T @ np.linalg.solve(noise, R)
        spread = np.linalg.pinv(told + alike.T @ alike, rcond=1e-12, hermitian=True)
    spread = spread * np.outer(size, size)
    return _in_units(bench, point, names, spread)


def covariance(bench: Workbench, point: Point, *, at_bounds: bool = False) -> tuple[tuple[str, ...], FloatArray]:
    """Parameters free within their bounds and common to all runs, and their covariance (n, n) in the unit cube.

    Directions that no trial tells end at the box, everywhere in which is equally likely beforehand.

    at_bounds  what ended at a bound is no better known than what did not, so that the others are not too certain
    """
    inside = [
        name
        for name, z in zip(point.names, point.unit, strict=True)
        if (at_bounds or 0.0 < z < 1.0) and not group_of(name)
    ]
    if not inside:
        return (), np.zeros((0, 0))
    R, noise, size = _told(bench, point, tuple(inside))
    before = np.array([bench.believed.deviations.get(name, np.sqrt(OF_BOX)) for name in inside])
    known = (size / before) ** 2
    told, directions = np.linalg.eigh(R.T @ np.linalg.solve(noise, R) + np.diag(known))
    told = np.maximum(told, known.min())  # trials nearly free of noise tell so much that the rest drowns in rounding
    return tuple(inside), (directions / told) @ directions.T * np.outer(size, size)


def _told(bench: Workbench, point: Point, names: tuple[str, ...]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Information of the residuals on the free parameters, all else re-tuned: the triangle R of their columns, the
    covariance of noise along these, and the step of each column in the unit cube."""
    linear = linearise(bench, point, apart=names)
    columns = linear.columns(names)
    if not bench.is_deformed(point):  # another form explains what gusts would have left, and is told too well then
        linear = linear.with_inputs_seen(point.chi2, columns)
    Q, R = np.linalg.qr(columns)
    by_block, by_trial = linear.chance(Q)
    told = len(R)  # directions of residuals: fewer than columns where there are fewer residuals
    memory = max(1.0, float(np.sum(by_block**2)) / told)
    noise = memory * np.eye(told) + np.einsum("cdk,cdl->kl", by_trial, by_trial) / by_trial.shape[1]
    size = np.array([unit_of(bench, name) for name in names])
    return R, noise, size


def _in_units(bench: Workbench, point: Point, names: Sequence[str], covariance: FloatArray) -> dict[str, Estimate]:
    """Estimates in profile units from a covariance in the unit cube."""
    box = bench.sub_box(names)
    unit = np.array([point.unit[point.names.index(name)] for name in names])
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    values = box.from_unit(unit)
    found: dict[str, Estimate] = {}
    for i, j in box.polar:
        north, east = box.low[[i, j]] + unit[[i, j]] * box.width[[i, j]]
        spread = covariance[np.ix_([i, j], [i, j])] * np.outer(box.width[[i, j]], box.width[[i, j]])
        length = float(np.hypot(north, east))
        along = np.array([north, east]) / max(length, 1e-300)
        across = np.array([-along[1], along[0]])
        sd = float(np.sqrt(along @ spread @ along))
        turn = float(np.sqrt(across @ spread @ across)) / max(length, 1e-300)
        towards = float(values[j]) % (2.0 * np.pi)
        found[names[i]] = Estimate(names[i], length, max(0.0, length - NORMAL_95 * sd), length + NORMAL_95 * sd, sd)
        found[names[j]] = Estimate(names[j], towards, towards - NORMAL_95 * turn, towards + NORMAL_95 * turn, turn)
    for i, name in enumerate(names):
        if name in found:
            continue
        ends = np.repeat(unit[:, None], 2, axis=1)
        ends[i] = np.clip([unit[i] - NORMAL_95 * deviation[i], unit[i] + NORMAL_95 * deviation[i]], 0.0, 1.0)
        low, high = (end if np.isfinite(end) else None for end in sorted(float(end) for end in box.from_unit(ends)[i]))
        stderr = None if low is None or high is None else 0.5 * (high - low) / NORMAL_95
        width = float(np.ptp(ends[i]))
        at_end = width > 0.0 and float(np.min(np.abs(ends[i] - unit[i]))) < AT_END * width
        found[name] = Estimate(name, float(values[i]), low, high, stderr, at_end=at_end)
    for name, spread_of_one in _apart(names, covariance).items():
        i = names.index(name)
        if i not in box.charted:
            found[name] = replace(found[name], apart=float(np.sqrt(spread_of_one) * box.width[i]))
    for name, own in zip(names, box.pre, strict=True):
        if not group_of(name) and own != bench.parameter(name).null:
            found[name] = replace(found[name], stated=float(own))
    return found


def _apart(names: Sequence[str], covariance: FloatArray) -> dict[str, float]:
    """Variance of the distance of each run-specific value from the mean over the runs, in the unit cube."""
    found = {}
    for base in dict.fromkeys(base_of(name) for name in names if group_of(name)):
        rows = [i for i, name in enumerate(names) if base_of(name) == base and group_of(name)]
        less_mean = np.eye(len(rows)) - 1.0 / len(rows)
        spread = less_mean @ covariance[np.ix_(rows, rows)] @ less_mean
        found.update({names[i]: max(float(spread[k, k]), 0.0) for k, i in enumerate(rows)})
    return found
