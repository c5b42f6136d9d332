"""The weight of what is known beforehand beside J: the variance of J's differences per independent one.

Were the N differences of J independent, each of variance v, J / v would be minus twice the logarithm of their
probability.  Residuals of a ship model follow each other for minutes.  A channel c of variance v_c whose integrated
autocorrelation is tau_c says as much as N_c / tau_c independent differences, and what its sensitivities, which vary
slowly, tell about a coefficient has a variance tau_c times as large as if it were white.  So J over

    s2 = sum_c learnt_c v_c tau_c / sum_c learnt_c,    v_c tau_c = J_c / (N_c / tau_c - learnt_c)

has the curvature that its minimum really has, on average over what is learnt: the magnitude adjustment of a composite
likelihood (Pauli, Racugno & Ventura 2011; Ribatet, Cooley & Davison 2012).  ``learnt_c`` is the number of coefficients
that channel c determines against the rest and the prior, tr((H + s2 P)^-1 H_c) with halves of second derivatives H of
J and P of the terms, as in the evidence approximation of MacKay 1992; degrees of freedom are lost to it.

s2 depends on the optimum and the optimum on s2.  The rounds begin at the pre-determined values, where the misfit is
large and the prior holds firmly, and relax from there: of several fixed points that with the largest s2 is found.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..backends import STATES
from .least_squares import LeastSquaresResult, solve
from .problem import FitProblem
from .quadratic import flat_where_lost

MOST_ROUNDS = 8
"""Fits at most."""

WEIGHT_TOLERANCE = 0.02
"""Change of s2, as a share, that ends the rounds."""

FIT_TOLERANCE = 0.01
"""Fall of what is minimised over s2 that counts as none in these fits: s2 does not show it."""

LEAST_SHARE = 1e-9
"""s2 is kept above this share of its first value: residuals of noise-free trials vanish."""


@dataclass(frozen=True)
class Weight:
    """The weight and how it was found.

    s2           the weight
    independent  differences J counts for, by channel
    learnt       coefficients the trials determine against the terms, by channel
    rounds       fits it took; settled whether the last changed it by less than ``WEIGHT_TOLERANCE``
    """

    s2: float
    independent: dict[str, float]
    learnt: dict[str, float]
    rounds: int
    settled: bool

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


def weigh(
    problem: FitProblem, start: FloatArray, stop: Callable[[], bool] = lambda: False
) -> tuple[FitProblem, Weight | None]:
    """The problem with its terms weighed, from the point ``start`` (n_targets,) of the unit cube; None without terms.

    Without time series there is nothing to weigh them against: the weight is 1.
    """
    if not problem.terms:
        return problem, None
    if not problem.n_residuals:
        return problem.with_weight(1.0), Weight(1.0, {}, {}, 0, True)
    at = LeastSquaresResult(start, problem.offsets, 0.0, 0, True)
    found = weight_at(problem.with_weight(1.0), at, learning=False)
    least = LEAST_SHARE * found.s2
    for k in range(MOST_ROUNDS):
        if stop():
            break
        weighed = problem.with_weight(found.s2).with_offsets(at.offsets)
        at = solve(weighed, at.unit[:, None], stop=stop, tolerance=FIT_TOLERANCE * found.s2)[0]
        new = replace(weight_at(weighed.with_offsets(at.offsets), at), rounds=k + 1)
        new = replace(new, s2=max(new.s2, least))
        change = abs(new.s2 / found.s2 - 1.0)
        found = replace(new, settled=change < WEIGHT_TOLERANCE)
        if found.settled:
            break
    return problem.with_weight(found.s2), found


def weight_at(problem: FitProblem, at: LeastSquaresResult, learning: bool = True) -> Weight:
    """The weight from the residuals at a point; ``learning`` counts degrees of freedom."""
    residuals = problem.residuals(at.unit[:, None], at.offsets[:, None])[0]
    series = series_of(problem)
    learnt = dict.fromkeys(series, 0.0)
    if learning:
        slopes = flat_where_lost(problem.jacobians(at.unit[:, None], at.offsets[:, None])[1])[0]
        free = (at.unit > 0.0) & (at.unit < 1.0)
        whole = slopes[:, free].T @ slopes[:, free]
        for name, parts in series.items():
            own = slopes[np.concatenate(parts)][:, free]
            learnt[name] = float(np.trace(np.linalg.lstsq(whole, own.T @ own, rcond=1e-12)[0]))
    independent, variance = {}, {}
    for name, parts in series.items():
        values = [residuals[rows] for rows in parts]
        independent[name] = n_independent(values)
        J = float(sum(part @ part for part in values))
        variance[name] = J / max(independent[name] - learnt[name], 1.0)
    total = sum(learnt.values())
    share = {name: learnt[name] / total if total > 0.0 else 1.0 / len(series) for name in series}
    return Weight(sum(share[name] * variance[name] for name in series), independent, learnt, 0, False)


def series_of(problem: FitProblem) -> dict[str, list[Any]]:
    """Rows of the residuals of each channel, a part for each case, in time."""
    found: dict[str, list[Any]] = {}
    for case in range(len(problem.cases)):
        for k, name in enumerate(STATES):
            rows = problem.cases.rows[case, :, k]
            rows = rows[rows >= 0]
            if len(rows):
                found.setdefault(name, []).append(rows)
    return found


def n_independent(parts: list[FloatArray]) -> float:
    """How many independent numbers series say as much as: their length over the integrated autocorrelation.

    parts  (n_samples,) each, of one kind; their autocovariances are pooled and their mean counts as 0.  Summed up to
           the first pair of lags whose sum is not positive (Geyer 1992).  At least one a series, at most all.
    """
    longest = max(len(part) for part in parts)
    covariance = np.zeros(longest)
    for part in parts:
        size = 1 << (2 * len(part) - 1).bit_length()
        spectrum = np.fft.rfft(part, size)
        covariance[: len(part)] += np.fft.irfft(spectrum * spectrum.conj(), size)[: len(part)]
    total = sum(len(part) for part in parts)
    if not covariance[0] > 0.0:
        return float(total)
    rho = np.append(covariance / covariance[0], 0.0)[: longest + 1]
    pairs = rho[: len(rho) // 2 * 2].reshape(-1, 2).sum(axis=1)
    ends = np.flatnonzero(pairs <= 0.0)
    tau = 2.0 * float(pairs[: ends[0] if len(ends) else None].sum()) - 1.0
    return float(np.clip(total / max(tau, 1e-12), len(parts), total))
