"""Calibration: search, least squares, certificate, identifiability, sweep and run folders."""

from ..options import METHODS, FitOptions, LeaveOutOptions, SweepOptions
from .folder import claimed, prepare, refuse_taken, write_document, write_run
from .leaving_out import BandsLeftOut, LeftOut, leave_out, write_left_out
from .planning import Plan, plan_fit, plan_leave_out, plan_sweep
from .result import FitResult
from .run import Hooks, fit, in_pieces, make_problem
from .sweeping import SweepResult, sweep

__all__ = [
    "METHODS",
    "BandsLeftOut",
    "FitOptions",
    "FitResult",
    "Hooks",
    "LeaveOutOptions",
    "LeftOut",
    "Plan",
    "SweepOptions",
    "SweepResult",
    "claimed",
    "fit",
    "in_pieces",
    "leave_out",
    "make_problem",
    "plan_fit",
    "plan_leave_out",
    "plan_sweep",
    "prepare",
    "refuse_taken",
    "sweep",
    "write_document",
    "write_left_out",
    "write_run",
]
