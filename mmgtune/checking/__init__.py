"""Regression of a profile on trials: its metrics against a committed baseline and its own limits."""

from .baseline import Baseline, Recorded, read_baseline, write_baseline
from .folder import write_check
from .result import Changed, CheckReport, Item
from .run import check, could_not_run, record_baseline, update_baseline

__all__ = [
    "Baseline",
    "Changed",
    "CheckReport",
    "Item",
    "Recorded",
    "check",
    "could_not_run",
    "read_baseline",
    "record_baseline",
    "update_baseline",
    "write_baseline",
    "write_check",
]
