"""Diagnosis: what a simulation gets wrong, the cause, the extended model, and the gain on trials it has not seen.

options, result   what goes in and comes out; run: from beginning to end
hypotheses        what may be the cause
workbench         trials, model with every effect, refits
noise, inputs     what chance does to residuals
linear, screening signatures beyond re-tuning, scores, critical values
search            forward search, backward look, rivals
intervals, gain, leftover, separate   sizes, held-out gain, what is left, the trial that would tell
evidence          residual forces and short horizons, before any cause
"""

from .folder import write_diagnosis
from .options import DiagnoseOptions
from .result import VERDICTS, Diagnosis
from .run import diagnose

__all__ = ["VERDICTS", "DiagnoseOptions", "Diagnosis", "diagnose", "write_diagnosis"]
