"""Calibration: search, least squares, certificate, identifiability, sweep and run folders."""

from .folder import prepare, write_run
from .options import METHODS, FitOptions
from .result import FitResult
from .run import Hooks, fit, make_problem
from .sweeping import SweepResult, sweep

__all__ = [
    "METHODS",
    "FitOptions",
    "FitResult",
    "Hooks",
    "SweepResult",
    "fit",
    "make_problem",
    "prepare",
    "sweep",
    "write_run",
]
