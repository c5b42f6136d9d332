"""The targets re-tuned without any cause: what everything else is held against."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...backends import Integrator
from ...fitting.least_squares import solve
from ..bench.workbench import TOLERANCE, Point, Workbench

STARTS = 6
"""Starts of the base fit."""

QUICK = 20
"""Steps from each."""

BEST = 3
"""Ends of the quick steps that are continued, where they differ."""

SAME = 1e-3
"""Relative difference of the objective within which two ends are the same."""

ROUGHLY = 20.0
"""Fall of chi-squared that counts as none in the quick steps."""

AGAIN = 8
"""Times the base fit may begin again where it ended."""

PRECISE = 0.02
"""Fall of chi-squared that counts as none where parameters are reported."""

OF_EXCESS = 1e-4
"""Fall that counts as none, as a share of chi-squared beyond the noise: where much is left, its last digits decide
nothing."""

HARDLY = 1e-3
"""The same where fits are compared with others that differ by far more."""


def base_fit(bench: Workbench) -> Point:
    """The targets re-tuned without any effect: from several starts, in larger steps of the integration at first.

    Initial states are estimated from the beginning: noise of the measured ones leads long runs astray.
    """
    bench.find_slopes()
    names = bench.targets
    rng = np.random.default_rng(bench.options.seed)
    starts = np.column_stack([bench.null(names), *rng.uniform(size=(STARTS - 1, len(names)))])
    quick = bench.problem_of(names, Integrator("euler"))  # a quarter of the work, and only a start
    ends = solve(quick, starts, max_iterations=QUICK, stop=bench.stop, tolerance=ROUGHLY, trusting=True)
    ends = sorted(ends, key=lambda end: end.J)
    apart = [end for k, end in enumerate(ends) if k == 0 or end.J > (1.0 + SAME) * ends[k - 1].J][:BEST]
    starts = np.column_stack([end.unit for end in apart])
    point = bench.refit(names, starts, ends[0].offsets, tolerance=unnoticed(bench, ends[0].J))
    loose = tuple(bench.believed.leeway)
    names = (*point.names, *loose)
    point = replace(point, names=names, unit=np.concatenate([point.unit, bench.null(loose)]))
    for _ in range(AGAIN):  # initial states at the end of their range make a bad start; from there it is a new one
        tolerance = unnoticed(bench, point.chi2, PRECISE)
        again = bench.refit(names, point.unit[:, None], point.offsets, tolerance=tolerance)
        better = point.chi2 - again.chi2
        point = min(again, point, key=lambda one: one.chi2)
        if better < 1e-3 * point.chi2:
            break
    return point


def hardly_noticed(bench: Workbench, chi2: float) -> float:
    """Fall of chi-squared that counts as none where fits are only compared with others, or judged by other trials."""
    return max(TOLERANCE, HARDLY * (chi2 - bench.problem.n_residuals))


def unnoticed(bench: Workbench, chi2: float, least: float = TOLERANCE) -> float:
    """Fall of chi-squared that counts as none, where chi-squared has this value."""
    return max(least, OF_EXCESS * (chi2 - bench.problem.n_residuals))
