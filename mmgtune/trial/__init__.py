"""Trials: one Parquet file each, folders of them as data sets.

schema          columns of a file, their units and meaning
model           a trial in memory
parquet         reading and writing a file; metadata: the facts in it; digest: told from damage; footer: its size
index_trial     a trial of which only indices are known, and its files
dataset         folders of files; split: which of them tune and which test
unusable        what forbids using a trial
checks          everything odd about one: motion_checks, control_checks, cross_checks; kinematics: what they measure
set_checks      what is odd about one among others of the same ship
pieces          long trials cut into windows
wind            the wind it was measured in; surroundings: all that was measured around the ship
smoothing       channels without their noise
describe        what a trial holds, in numbers
"""

from .checks import check_trial
from .dataset import TrialSet, load_trials
from .finding import Finding
from .index_trial import IndexTrial
from .model import Trial
from .parquet import read_trial, write_trial
from .pieces import windows
from .set_checks import check_trials
from .surroundings import surroundings
from .wind import has_measured_wind, measured_wind

__all__ = [
    "Finding",
    "IndexTrial",
    "Trial",
    "TrialSet",
    "check_trial",
    "check_trials",
    "has_measured_wind",
    "load_trials",
    "measured_wind",
    "read_trial",
    "surroundings",
    "windows",
    "write_trial",
]
