"""Terms of the objective besides the squares of time series: further rows of residuals, each over its own deviation.

J is in the units of its paper, not a likelihood.  A row here is a number of known standard deviation, so its square
belongs with minus twice a logarithm of probability, and J with it once it is divided by s2, the variance of J's
differences per independent one.  Times s2 this is

    J + s2 * (squares of the rows),

in the units of J; ``weighing`` finds s2.  A fit without time series has no J, and s2 is 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..arrays import FloatArray
from ..stated_indices import residuals
from ..trial import IndexTrial

if TYPE_CHECKING:
    from .problem import FitProblem


class Term(Protocol):
    """A group of these rows.

    name          what to call them in records: "prior", "indices"
    known_before  whether they are prior knowledge, not data
    sentence      their change by the fit, with places for ``weight`` in words and the squares ``old`` and ``new``
    """

    name: str
    known_before: bool
    sentence: str

    def n_rows(self, problem: FitProblem) -> int:
        """How many rows there are."""
        ...

    def residuals(self, problem: FitProblem, unit: FloatArray) -> FloatArray:
        """The rows of candidates (n_targets, n_candidates) in the unit cube -> (n_rows, n_candidates); finite."""
        ...

    def asked(self, problem: FitProblem) -> list[Any]:
        """Numbers and texts that identify these rows in a journal."""
        ...


class ScatterPrior:
    """How far coefficients are from what their formulas give, in scatters of ships about the formula.

    A formula and its scatter are a normal distribution of the coefficient before anything is known of this ship.  Rows
    for ``Box.from_formula``, in their order; coefficients count as independent of each other.
    """

    name = "prior"
    known_before = True
    sentence = "Prior: scatter of the formulas, {weight}; its squares go from {old:.3g} to {new:.3g}."

    def n_rows(self, problem: FitProblem) -> int:
        """See ``Term``."""
        return len(problem.box.from_formula)

    def residuals(self, problem: FitProblem, unit: FloatArray) -> FloatArray:
        """See ``Term``."""
        box = problem.box
        at = box.from_formula
        if box.scatter is None or box.centre is None:
            return np.zeros((0, unit.shape[1]))
        away: FloatArray = box.from_unit(unit)[at] - box.centre[at, None]
        return away / box.scatter[at, None]

    def asked(self, problem: FitProblem) -> list[Any]:
        """See ``Term``."""
        return [self.name, problem.box.centre, problem.box.scatter]


class StatedIndices:
    """Indices of trials as the model makes them less those stated, in tolerances of the latter."""

    name = "indices"
    known_before = False
    sentence = "Stated indices: {weight}; their squares go from {old:.3g} to {new:.3g} over their tolerances."

    def __init__(self, trials: Sequence[IndexTrial]):
        self.trials = tuple(trials)

    def n_rows(self, problem: FitProblem) -> int:
        """See ``Term``."""
        return sum(len(one.indices) for one in self.trials)

    def residuals(self, problem: FitProblem, unit: FloatArray) -> FloatArray:
        """See ``Term``."""
        return residuals(problem.model, problem.theta(unit), self.trials, problem.backend.name)

    def asked(self, problem: FitProblem) -> list[Any]:
        """See ``Term``."""
        return [self.name, *((one.id, one.sha256) for one in self.trials)]
