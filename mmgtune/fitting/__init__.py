"""Calibration: search, least squares, certificate, identifiability, sweep and run folders."""

from ..hooks import Hooks
from ..options import METHODS, FitOptions, LeaveOutOptions, SweepOptions
from .comparison import ComparedTrials, TrialComparison
from .folder import write_run
from .information import Information
from .informing import information_of
from .leaving_out import BandsLeftOut, LeftOut, leave_out, write_left_out
from .planning import Plan, plan_fit, plan_leave_out, plan_sweep
from .pooled import CLASSES, FEWEST, SisterClass, pooled
from .result import FitResult
from .run import fit
from .setting import in_pieces, make_problem
from .sweeping import SweepResult, sweep, write_sweep

__all__ = [
    "CLASSES",
    "FEWEST",
    "METHODS",
    "BandsLeftOut",
    "ComparedTrials",
    "FitOptions",
    "FitResult",
    "Hooks",
    "Information",
    "LeaveOutOptions",
    "LeftOut",
    "Plan",
    "SisterClass",
    "SweepOptions",
    "SweepResult",
    "TrialComparison",
    "fit",
    "in_pieces",
    "information_of",
    "leave_out",
    "make_problem",
    "plan_fit",
    "plan_leave_out",
    "plan_sweep",
    "pooled",
    "sweep",
    "write_left_out",
    "write_run",
    "write_sweep",
]
