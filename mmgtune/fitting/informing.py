"""What the trials of a finished fit say about its targets, whatever was known before; see ``information``."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..trial import TrialSet
from .information import Information
from .least_squares import LeastSquaresResult, fit_offsets
from .result import FitResult
from .setting import in_pieces, make_problem
from .weighing import weight_at


def information_of(result: FitResult, trials: TrialSet) -> Information | None:
    """What the tune trials of a fit say about its targets; None where they are no time series.

    Targets that are searched for by other coordinates, such as a size with a direction, are left out: they are held at
    their values.
    """
    if not trials.tune or not len(result.box):
        return None
    problem = make_problem(result.profile, in_pieces(trials, result.options), result.options)
    problem = replace(problem, terms=tuple(term for term in problem.terms if not term.known_before))
    if problem.sigma is not None:
        problem = problem.with_offsets(fit_offsets(problem, result.unit))
    box = result.box
    if result.beside is not None:
        s2 = result.beside.weight.s2
    else:
        s2 = weight_at(problem, LeastSquaresResult(result.unit, problem.offsets, 0.0, 0, True)).s2
    _, slopes = problem.central_jacobian(result.unit)
    if problem.sigma is not None:
        slopes = problem.without_offsets(slopes, problem.central_offsets(result.unit), problem.prior)
    plain = np.array([k for k in range(len(box)) if k not in box.charted], dtype=int)
    H = (slopes.T @ slopes)[np.ix_(plain, plain)] / np.outer(box.width[plain], box.width[plain]) / s2
    theta = box.from_unit(result.unit)[plain]
    priors = [box.prior_of(int(k)) for k in plain]
    known = np.array([prior[1] if prior else 0.25 * box.width[k] for k, prior in zip(plain, priors, strict=True)])
    b = H @ theta
    if result.beside is not None and "prior" in result.beside.squares:
        # At the optimum trials pull as hard as the prior: what this did is taken back.
        b += [(at - prior[0]) / prior[1] ** 2 if prior else 0.0 for at, prior in zip(theta, priors, strict=True)]
    names = tuple(box.names[k] for k in plain)
    return Information(names, H, b, box.pre[plain], known)
