"""Diagnosis: what a simulation gets wrong, the cause, the extended model, and the gain on trials it has not seen.

run               from beginning to end; planning: what it would do; result: what comes out; folder: its files
bench/            trials, model with every effect, noise and beliefs: what all else stands on
signatures/       what an effect would change that re-tuning cannot imitate: scores, intervals
searching/        screen, refit, decide, add, and look again
held_out/         what an answer is worth on trials it was not found on
evidence/         residual forces and short horizons, what is left, and where in the runs it lives
causes/           what each cause contributes, which are believed, and which are traces
voyages/          windows of logs of hours, and what differs from voyage to voyage
answering/        the answer and its words
record            how often such an answer was right in the study; calm: the ship without the day

Each uses those above it and none below.  Words of these modules:

bench   ``Workbench``: trials, model with every effect, box and noise, on which everything is fitted
point   a fitted model on the bench: what was free, its values, initial states and chi-squared
look    one round of the search at a point: scores of all hypotheses, refits of the best, a decision
leeway  how far a coefficient that is not tuned may move about the profile's value: some per cent
trace   a cause that is there by the statistics and that a user would not notice; in no profile
aside   a trace with its contribution, as it was set aside
kin     hypotheses that act much like the best one, and may be meant instead
"""

import sys
from types import ModuleType
from typing import Any

from ..options import DiagnoseOptions
from .answering.verdict import VERDICTS
from .folder import write_diagnosis
from .planning import plan_diagnosis
from .result import Diagnosis
from .run import diagnose

__all__ = ["VERDICTS", "DiagnoseOptions", "Diagnosis", "diagnose", "plan_diagnosis", "write_diagnosis"]


class _Callable(ModuleType):
    """The package has the name of its one function, and is called like it: ``mmgtune.diagnose(...)``."""

    def __call__(self, *given: Any, **named: Any) -> Diagnosis:
        return diagnose(*given, **named)


sys.modules[__name__].__class__ = _Callable
