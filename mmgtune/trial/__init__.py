"""Trials: one Parquet file each, folders of them as data sets."""

from .checks import Finding, check_trial
from .dataset import TrialSet, load_trials
from .model import Trial
from .parquet import read_trial, write_trial

__all__ = ["Finding", "Trial", "TrialSet", "check_trial", "load_trials", "read_trial", "write_trial"]
