"""Calibration: search, least squares, certificate, identifiability, sweep and run folders."""

from .folder import prepare, write_run
from .leaving_out import LeftOut, fit_leaving_out
from .options import METHODS, FitOptions
from .result import FitResult
from .run import Hooks, fit, in_pieces, make_problem
from .sweeping import SweepResult, sweep

__all__ = [
    "METHODS",
    "FitOptions",
    "FitResult",
    "Hooks",
    "LeftOut",
    "SweepResult",
    "fit",
    "fit_leaving_out",
    "in_pieces",
    "make_problem",
    "prepare",
    "sweep",
    "write_run",
]
