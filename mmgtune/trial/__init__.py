"""Trials: one Parquet file each, folders of them as data sets.

schema          columns of a file, their units and meaning
model           a trial in memory
from_table      one from a table in memory
parquet         reading and writing a file; metadata: the facts in it; digest: told from damage; footer: its size
index_trial     a trial of which only indices are known, and its files
dataset         folders of files, by_hand: sets in memory; split: which tune and which test; splitting: a suggestion
unusable        what forbids using a trial
checks/         everything odd about one, or about one among others; kinematics: what is measured for it
pieces          long trials cut into windows
voyages/        logs of days, read block by block, cut into windows as they are read
around/         what was measured around the ship: wind, current, waves, depth; gaps: what bridges theirs
smoothing       channels without their noise
held            inputs whose log was updated less often than written
describe        what a trial holds, in numbers; coverage: what trials visit and what they do not
"""

from .around.surroundings import measured_around, surroundings
from .around.wind import measured_wind
from .checks.all_checks import check_trial
from .checks.finding import Finding
from .checks.set_checks import another_ship, check_trials, oddities
from .coverage import BY_SIDE, Coverage, visited_by
from .dataset import TrialSet, load_trials
from .from_table import trial_of
from .held import Held
from .index_trial import IndexTrial
from .model import Trial
from .parquet import read_trial, write_trial
from .pieces import windows
from .voyages.voyage import Voyage, open_voyage
from .voyages.voyage_set import VoyageSet, holds_voyages, load_voyages
from .voyages.windows import Cutting, voyage_windows, window_at

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
