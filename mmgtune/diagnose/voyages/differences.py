"""What differs from voyage to voyage: values of each voyage beside one value for all, and which of the two is believed.

A crew, the sea and the months change some things between voyages and leave the ship's coefficients as they are: the
current, and the resistance of a hull that fouls.  At the common solution the problem is made linear with a value of
each voyage for these, by Gauss-Newton, while targets, causes and initial states are re-tuned alongside.  All patterns
are then restrictions of one linear problem.
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import FloatArray
from ..bench import noise as noises
from ..bench.workbench import Point, Workbench
from ..searching.refit import ENOUGH
from .difference import QUANTITIES, Difference, Pattern, Quantity
from .linear_by_voyage import ByVoyage, LinearByVoyage

ITERATIONS = 3
"""Gauss-Newton steps before noise is estimated again, and after."""


def differences(bench: Workbench, point: Point, voyages: Sequence[str]) -> tuple[Difference, ...]:
    """What differs between voyages, at a fitted point.

    voyages  ids in their order; the windows of ``bench.trials`` are parts of them

    Nothing where there are fewer than three voyages, and of quantities that are no part of the problem.
    """
    if len(voyages) < 3:
        return ()
    asked = [q for q in QUANTITIES if set(q.names) <= set(bench.box.names) and not set(q.names) & set(bench.targets)]
    if bench.options.effects:
        asked = [q for q in asked if q.tag in bench.options.effects]
    if not asked:
        return ()
    own = copy.copy(bench)  # with a noise model of its own
    leg = np.array([voyages.index(trial.whole) for trial in bench.trials])
    held = ByVoyage.at(own, point, asked, leg, len(voyages))
    for again in (False, True):
        for _ in range(ITERATIONS):
            linear = held.linear()
            if linear is None:
                return ()
            held = held.moved(linear)
        if again:
            break
        linear = held.linear()
        if linear is None:
            return ()
        left = linear.left_by(held.full)[linear.measured]
        own.know(noises.estimate(own.problem.cases, own.noise.restore(left)))
    linear = held.linear()
    return () if linear is None else _believed(held, linear, tuple(voyages))


def _believed(held: ByVoyage, linear: LinearByVoyage, voyages: tuple[str, ...]) -> tuple[Difference, ...]:
    """The patterns with the most evidence, each simplified as long as the loss of evidence is not decisive."""
    inflation = linear.inflation()
    price = math.log(held.bench.problem.n_residuals)

    def evidence(patterns: Sequence[Pattern]) -> float:
        k = sum(len(q.names) * held.design(q, one).shape[1] for q, one in zip(held.asked, patterns, strict=True))
        left = linear.left_by(patterns)
        return float(-(left @ left) / inflation - k * price)

    known = {patterns: evidence(patterns) for patterns in itertools.product(*map(held.patterns, held.asked))}
    chosen = max(known, key=lambda patterns: known[patterns])
    for i, q in enumerate(held.asked):
        for simpler in held.patterns(q)[: held.patterns(q).index(chosen[i])]:
            other = (*chosen[:i], simpler, *chosen[i + 1 :])
            if known[chosen] - known[other] < ENOUGH:
                chosen = other
                break
    return tuple(_difference(held, linear, voyages, chosen, known, inflation, i) for i in range(len(held.asked)))


def _difference(
    held: ByVoyage,
    linear: LinearByVoyage,
    voyages: tuple[str, ...],
    chosen: Sequence[Pattern],
    known: Mapping[tuple[Pattern, ...], float],
    inflation: float,
    i: int,
) -> Difference:
    q = held.asked[i]
    simplest = (*chosen[:i], held.patterns(q)[0], *chosen[i + 1 :])
    beside = {one: known[(*chosen[:i], one, *chosen[i + 1 :])] - known[simplest] for one in held.patterns(q)}

    before, after = (float(np.sum(linear.left_by(patterns) ** 2)) for patterns in (simplest, chosen))
    above = before - held.bench.problem.n_residuals
    explained = min(1.0, max(0.0, (before - after) / above)) if above > 0.0 else 0.0

    def fitted(pattern: Pattern) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Per name: values (n_voyages, n_names), their deviations, and the last fitted number with its deviation."""
        patterns = (*chosen[:i], pattern, *chosen[i + 1 :])
        A, x, _ = linear.solution(patterns)
        covariance = _covariance(A, inflation)
        n_free = int(linear.inside.sum())
        at = n_free + sum(
            len(one.names) * held.design(one, p).shape[1] for one, p in zip(held.asked[:i], patterns[:i], strict=True)
        )
        E = held.design(q, pattern)
        values, errors, last = [], [], []
        for name in q.names:
            rows = slice(at, at + E.shape[1])
            at += E.shape[1]
            width = float(held.bench.box.width[held.bench.box.names.index(name)])
            low = float(held.bench.box.low[held.bench.box.names.index(name)])
            base = low + width * float(held.common[held.names.index(name)])
            values.append(base + width * (E @ x[rows]))
            deviation = width * np.sqrt(np.maximum(np.diag(E @ covariance[rows, rows] @ E.T), 0.0))
            own = linear.by_leg[:, held.names.index(name)]
            shows = [bool(np.any(own[linear.leg == k])) for k in range(len(voyages))]
            errors.append(np.where(shows, deviation, np.nan))
            last.append((width * float(x[rows][-1]), width * float(np.sqrt(max(covariance[rows, rows][-1, -1], 0.0)))))
        return np.column_stack(values), np.column_stack(errors), np.array(last)

    values, stderr, _ = fitted("each")
    common = None
    if not held.retuned(q):
        one, error, _ = fitted("one")
        common = tuple(zip(one[0].tolist(), error[0].tolist(), strict=True))
    trend: tuple[tuple[float, float], ...] = ()
    if q.trends:
        lines, _, slopes = fitted("trend")
        trend = tuple((float(s / m), float(e / m)) for (s, e), m in zip(slopes, lines.mean(axis=0), strict=True))
    if q.absorbed:
        mean = np.nanmean(values, axis=0)
        values, stderr = values / mean, stderr / mean
        # All are shares of what is absorbed, which is known no better than it is.
        doubt = _doubt(held, linear, q, chosen, inflation)
        stderr = np.hypot(stderr, (values - 1.0) * doubt)
        trend = tuple((slope, math.hypot(error, slope * doubt)) for slope, error in trend)
    return Difference(
        q, chosen[i], beside, _unit(held, q), voyages, values, stderr, common, trend, bool(q.absorbed), explained
    )


def _covariance(A: FloatArray, inflation: float) -> FloatArray:
    """Covariance (n, n) of least-squares values of a matrix (n_rows, n) for noise of variance ``inflation``."""
    size = np.linalg.norm(A, axis=0)
    scale = np.where(size > 0.0, size, 1.0)
    inverse = np.linalg.pinv((A / scale).T @ (A / scale), rcond=1e-12)
    return np.asarray(inflation * inverse / np.outer(scale, scale))


def _doubt(held: ByVoyage, linear: LinearByVoyage, q: Quantity, chosen: Sequence[Pattern], inflation: float) -> float:
    """Relative standard error of the coefficient that absorbs a quantity; 0 where it is held."""
    if not held.retuned(q):
        return 0.0
    at = held.free.index(q.absorbed)
    if not linear.inside[at]:
        return 0.0
    A, _, _ = linear.solution(chosen)
    k = int(linear.inside[:at].sum())
    variance = _covariance(A, inflation)[k, k]
    box = held.bench.sub_box([q.absorbed])
    value = float(box.low[0] + box.width[0] * held.unit[at])
    return float(box.width[0] * math.sqrt(max(float(variance), 0.0)) / max(abs(value), 1e-12))


def _unit(held: ByVoyage, q: Quantity) -> str:
    effect = next(one for one in held.bench.model.effects if one.tag == q.tag)
    return str(effect.parameters[q.parameters[0]].unit)
