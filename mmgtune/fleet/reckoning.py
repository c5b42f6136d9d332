"""About how long a fleet takes: one job of each entry is planned or done here, and stands for the others."""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from ..errors import MmgtuneError
from .commands import COMMANDS, Task
from .job import Job
from .places import fetched
from .table import options_of
from .work import in_folder

REPORT = (0.3, 1.0)
"""Time for files and report of a job [s], from and to."""


@dataclass(frozen=True)
class Reckoned:
    """How long jobs take on one worker, all of them, from and to [s]; ``kinds`` is (name, jobs, from, to) each."""

    kinds: tuple[tuple[str, int, float, float], ...]

    @property
    def seconds(self) -> tuple[float, float]:
        """Of all."""
        return sum(low for *_, low, _ in self.kinds), sum(high for *_, high in self.kinds)

    @property
    def a_job(self) -> float:
        """At least, on average [s]."""
        return self.seconds[0] / max(1, sum(count for _, count, *_ in self.kinds))


def reckon(jobs: Sequence[Job]) -> Reckoned:
    """About how long jobs take, those of one name alike.  Compiles the kernels they need, so workers find them."""
    counts = Counter(job.name for job in jobs)
    kinds = []
    for name, count in counts.items():
        low, high = _of_first([job for job in jobs if job.name == name][:3])
        kinds.append((name, count, count * low, count * high))
    return Reckoned(tuple(kinds))


def _of_first(jobs: Sequence[Job]) -> tuple[float, float]:
    """Of the first that can be planned; one that cannot run takes no time."""
    for job in jobs:
        try:
            planned = _planned(job)
            if planned is not None:
                return planned[0] + REPORT[0], planned[1] + REPORT[1]
            with tempfile.TemporaryDirectory(prefix="mmgtune-") as folder:
                in_folder(job, Path(folder))  # compiles what there is to compile
                began = time.perf_counter()
                in_folder(job, Path(folder))
            took = time.perf_counter() - began
            return took + REPORT[0], 2.0 * took + REPORT[1]
        except (MmgtuneError, OSError):
            continue
    return 0.0, REPORT[0]


def _planned(job: Job) -> tuple[float, float] | None:
    from ..profile import parse_profile

    with ExitStack() as stack:
        trials = stack.enter_context(fetched(job.trials.path))
        ship = parse_profile(job.profile, Path(job.profile_path))
        return COMMANDS[job.command].seconds(Task(ship, trials, options_of(job.command, job.options), None, job.label))
