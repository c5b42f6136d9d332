"""Diagnosis: what a simulation gets wrong, the cause, the extended model, and the gain on trials it has not seen.

result            what comes out; run: from beginning to end; planning: what it would do
hypotheses        what may be the cause
workbench         trials, model with every effect, refits
noise, inputs     what chance does to residuals; beliefs, winds: what is not known of the hull and of causes
linear, screening signatures beyond re-tuning, scores, critical values
search            forward search, backward look, rivals; base_fit: where it begins
shortlist, refitter which hypotheses are refitted in a look; one of them: from where, and how far
refitting, refit  all of a look, the best first; whether one is believed, and what rivals it
contributions     what each cause brings beside the others; traces; record: how often such an answer was right
unseen, gain      fitted points on trials they were not fitted to, and what causes gain there
intervals, leftover, separate         sizes, what is left, the trial that would tell; one_clock: two scales that are one
runs, hierarchy, by_run, elsewhere    what differs from run to run: groups, evidence, words, runs held out
voyages, legs     windows of logs of hours; what differs from voyage to voyage
evidence          residual forces and short horizons, before any cause
whereabouts       where an error lives that nothing explains; narrow: whether the box of the targets is in the way

Words of these modules:

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
from .folder import write_diagnosis
from .planning import plan_diagnosis
from .result import Diagnosis
from .run import diagnose
from .verdict import VERDICTS

__all__ = ["VERDICTS", "DiagnoseOptions", "Diagnosis", "diagnose", "plan_diagnosis", "write_diagnosis"]


class _Callable(ModuleType):
    """The package has the name of its one function, and is called like it: ``mmgtune.diagnose(...)``."""

    def __call__(self, *given: Any, **named: Any) -> Diagnosis:
        return diagnose(*given, **named)


sys.modules[__name__].__class__ = _Callable
