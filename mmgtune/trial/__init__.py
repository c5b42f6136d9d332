"""Trials: one Parquet file each, folders of them as data sets.

schema          columns of a file, their units and meaning
model           a trial in memory
from_table      one from a table in memory
parquet         reading and writing a file; metadata: the facts in it; digest: told from damage; footer: its size
index_trial     a trial of which only indices are known, and its files
dataset         folders of files, by_hand: sets in memory; split: which tune and which test; splitting: a suggestion
unusable        what forbids using a trial
checks          everything odd about one: motion_checks, control_checks, cross_checks; kinematics: what they measure
set_checks      what is odd about one among others of the same ship
pieces          long trials cut into windows
voyage          logs of days, read block by block; voyage_windows: cut as they are read; voyage_set: folders of them
wind            the wind it was measured in; current, waves, depth: the others; gaps: what bridges theirs
surroundings    all that was measured around the ship; surroundings_checks: what is odd about it
smoothing       channels without their noise
held            inputs whose log was updated less often than written
describe        what a trial holds, in numbers; coverage: what trials visit and what they do not
"""

from .checks import check_trial
from .coverage import BY_SIDE, Coverage, visited_by
from .dataset import TrialSet, load_trials
from .finding import Finding
from .from_table import trial_of
from .held import Held
from .index_trial import IndexTrial
from .model import Trial
from .parquet import read_trial, write_trial
from .pieces import windows
from .set_checks import another_ship, check_trials, oddities
from .surroundings import measured_around, surroundings
from .voyage import Voyage, open_voyage
from .voyage_set import VoyageSet, holds_voyages, load_voyages
from .voyage_windows import Cutting, voyage_windows, window_at
from .wind import measured_wind

__all__ = [
    "BY_SIDE",
    "Coverage",
    "Cutting",
    "Finding",
    "Held",
    "IndexTrial",
    "Trial",
    "TrialSet",
    "Voyage",
    "VoyageSet",
    "another_ship",
    "check_trial",
    "check_trials",
    "holds_voyages",
    "load_trials",
    "load_voyages",
    "measured_around",
    "measured_wind",
    "oddities",
    "open_voyage",
    "read_trial",
    "surroundings",
    "trial_of",
    "visited_by",
    "voyage_windows",
    "window_at",
    "windows",
    "write_trial",
]
