"""How much work least squares usually is, and telling how far it has come."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..hooks import EVALUATIONS, Hooks
from .problem import FitProblem

USUAL_ITERATIONS = 40
"""Iterations of least squares from one start that are seldom exceeded."""


def of_iteration(problem: FitProblem) -> int:
    """Evaluations of an iteration from one start: a Jacobian and some trials."""
    return len(problem.box) + (0 if problem.sigma is None else 6) + 5


def telling(problems: Sequence[FitProblem], starts: int, hooks: Hooks) -> Callable[[], bool]:
    """A ``stop`` for least squares of problems, one after the other, that tells what is evaluated when it is asked.

    problems  share a counter
    starts    from which each of them begins
    """
    counter = problems[0].counter
    before = counter.evaluations
    usual = starts * USUAL_ITERATIONS * sum(map(of_iteration, problems))

    def stop() -> bool:
        hooks.on_progress(counter.evaluations - before, usual, EVALUATIONS)
        return hooks.stop()

    return stop
