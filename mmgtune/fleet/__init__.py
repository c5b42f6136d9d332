"""Many ships at many dates: jobs from a table, run by processes or on Dask, and what only all of them together tell.

table, expanding  fleet.toml, and the jobs it stands for
job, commands     a job as a document, and what it can do
work              one job from its document to its run folder and its row
processes, cluster  who runs jobs: processes of this machine, or Dask
rows              the results, a Parquet data set
run               all of it from the table to the record
series, changes   the same ship over dates, and when something changed
pooling           sister ships together, for ``fit`` with a prior of them
"""

from .places import EXTRA
from .rows import read as read_results
from .run import FleetPlan, FleetRun, Progress, check_out, plan_fleet, record_anew, run_fleet
from .table import FleetTable, read_table

__all__ = [
    "EXTRA",
    "FleetPlan",
    "FleetRun",
    "FleetTable",
    "Progress",
    "check_out",
    "plan_fleet",
    "read_results",
    "read_table",
    "record_anew",
    "run_fleet",
]
