"""A fleet from its table to its results."""

from __future__ import annotations

import json
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..displayed import Displayed
from ..errors import OptionError, OutputError, Problem
from ..files import alone_in, exists, make_folder, path_of, remove_left_overs, write_text
from ..options import FleetOptions
from ..options.choice import must_be
from ..phrases import counted
from ..provenance import made_by
from ..resources import must_be_name
from ..run_files import FLEET, JOBS
from . import rows
from .expanding import expand
from .job import Job
from .processes import Ran, cores, prepare, run_here
from .reckoning import Reckoned, reckon
from .record import listed_places, made_before, write_record
from .table import FleetTable, read_table
from .work import remove_attempts


@dataclass(frozen=True)
class Progress:
    """How far a run has come: jobs of all, of them those found before it began, answers so far, workers lost."""

    total: int
    before: int
    answers: Mapping[str, int]
    killed: int

    @property
    def done(self) -> int:
        """Jobs that are done."""
        return self.before + sum(self.answers.values())


@dataclass(frozen=True, eq=False, repr=False)
class FleetRun(Displayed):
    """A finished run of a fleet.

    jobs      all of them
    ran       what became of those that were run now, by key: answer and time [s]
    killed    jobs that had to be run again since their worker was killed
    wall_s    of the run [s]
    workers   processes or threads that ran them
    document  the record, as in ``fleet.json``
    """

    jobs: tuple[Job, ...]
    ran: Mapping[str, tuple[str, float]]
    killed: int
    wall_s: float
    workers: int
    document: Mapping[str, Any]

    def __repr__(self) -> str:
        """In a line."""
        ships, dates, of = self.document["ships"], self.document["dates"], self.document["jobs"]
        words = ((len(ships), "ship"), (len(dates), "date"), (of["total"], "job"))
        several = [f"{n} {noun}{'s' * (n != 1)}" for n, noun in words]
        return f"FleetRun({several[0]}, {several[1]}: {several[2]}, {of['failed']} failed)"

    def to_dict(self) -> dict[str, Any]:
        """The document of ``fleet.json``."""
        return dict(self.document)


@dataclass(frozen=True, eq=False, repr=False)
class FleetPlan(Displayed):
    """What a run would do: its jobs, those that are there already, and about how long the rest takes on one worker."""

    jobs: tuple[Job, ...]
    there: frozenset[str]
    reckoned: Reckoned

    def __repr__(self) -> str:
        """In a line."""
        return f"FleetPlan({counted(len(self.jobs), 'job')}, {sum(job.key in self.there for job in self.jobs)} done)"


def plan_fleet(table: FleetTable | Path | str, out: Path | str | None = None) -> FleetPlan:
    """The jobs of a table, and about how long they take.  Raises OptionError for what a run would refuse."""
    out = None if out is None else path_of(out)
    jobs = expand(table if isinstance(table, FleetTable) else read_table(table))
    there = frozenset(rows.done(out)) if out is not None else frozenset()
    return FleetPlan(tuple(jobs), there, reckon([job for job in jobs if job.key not in there]))


def run_fleet(
    table: FleetTable | Path | str,
    out: Path | str,
    options: FleetOptions = FleetOptions(),
    *,
    resume: bool = False,
    on_progress: Callable[[Progress], None] | None = None,
    command: str = "",
) -> FleetRun:
    """Run all jobs of a table that are not done yet, and write the record and the classes of sister ships.

    resume       whether ``out`` may hold results already: jobs of the same data, options and program are not run again
    on_progress  called as jobs are done

    Raises OptionError for a table that makes no sense or a scheduler that does not answer, OutputError for ``out``.
    """
    must_be(options, FleetOptions)
    if options.scheduler is None:
        prepare()
    out = path_of(out).absolute()
    read = table if isinstance(table, FleetTable) else read_table(table)
    jobs = expand(read)
    _prepare(out, resume, jobs)
    with alone_in(out):
        remove_attempts(out)
        for folder in out.glob("results/*"):
            remove_left_overs(folder)
        write_text(out / JOBS, json.dumps(_listed(jobs), indent=1) + "\n")
        left = _left(jobs, out, options.retry)
        began = time.perf_counter()
        ran, killed, workers = _ran(jobs, left, out, options, on_progress or (lambda _: None))
        document = write_record(out, {**made_by(command), "table": read.path.name})
        return FleetRun(tuple(jobs), ran, killed, time.perf_counter() - began, workers, document)


def _prepare(out: Path, resume: bool, jobs: Sequence[Job]) -> None:
    """Raises OutputError for a folder that holds something else, another fleet among it, or results that were not asked
    for.
    """
    make_folder(out)
    if any(out.iterdir()) and not resume:
        problem = exists(out)
        fix = "add resume=True to run what is not done there yet, or choose another folder"
        raise OutputError(Problem(problem.what, problem.where, problem.why, fix))
    if any(out.iterdir()) and not (out / JOBS).is_file() and not (out / FLEET).is_file():
        why = f"it has files, and neither {JOBS} nor {FLEET} is among them"
        raise OutputError(Problem("the folder is not that of a fleet", str(out), why, "choose another folder"))
    held = listed_places(out)
    if held and not held & {job.place for job in jobs}:
        why = f"of its {len(held)} jobs, such as {min(held)}, none is in this table; results of the two would be mixed"
        raise OutputError(Problem("the folder is that of another fleet", str(out), why, "choose another folder"))


def _listed(jobs: Sequence[Job]) -> dict[str, Any]:
    keys = ("ship", "date", "name", "command", "key", "place")
    return {"schema": 1, "kind": "fleet-jobs", "jobs": [{key: getattr(job, key) for key in keys} for job in jobs]}


def _left(jobs: Sequence[Job], out: Path, retry: bool) -> list[Job]:
    """Jobs that are not done; those that failed among them where they are to be tried again."""
    there = rows.done(out)
    if retry and there:
        for row in rows.read(out):
            if row["answer"] == "failed" and row["key"] in there:
                there.pop(row["key"]).unlink(missing_ok=True)
    return [job for job in jobs if job.key not in there]


def _ran(
    jobs: Sequence[Job],
    left: Sequence[Job],
    out: Path,
    options: FleetOptions,
    on_progress: Callable[[Progress], None],
) -> tuple[dict[str, tuple[str, float]], int, int]:
    """Run what is left -> what became of it by key, how many were run again, and on how many workers."""
    killed = [0]
    ran: dict[str, tuple[str, float]] = {}
    answers: Counter[str] = Counter()

    def on_killed(n: int) -> None:
        killed[0] += n

    def followed(ended: Iterator[Ran]) -> None:
        for job, answer, seconds in ended:
            if answer == "killed":
                rows.write(out, job, rows.failed(job, [_given_up(job)], 0.0))
                answer = "failed"
            ran[job.key] = answer, seconds
            answers[answer] += 1
            on_progress(Progress(len(jobs), len(jobs) - len(left), dict(answers), killed[0]))

    on_progress(Progress(len(jobs), len(jobs) - len(left), {}, 0))
    if not left:
        return ran, 0, 0
    if options.scheduler is None:
        workers = min(options.workers or cores(), len(left))
        reckon(left[:1])  # compiles once what all workers need
        followed(run_here(left, str(out), workers, on_killed, options.job_reports))
        return ran, killed[0], workers
    from .cluster import connected, run_there

    with connected(options) as client:
        workers = sum(client.nthreads().values())
        followed(run_there(left, str(out), client, reckon(left).a_job, options.job_reports))
    return ran, killed[0], workers


def _given_up(job: Job) -> Problem:
    why = "it may have needed more memory than there is; or somebody killed workers again and again"
    fix = "give it a machine with more memory, or smaller trials, and add retry=True to resume=True"
    return Problem("the worker was killed while it ran, again and again", job.label, why, fix)


def check_out(out: Path) -> None:
    """Raises OptionError where a folder is not that of a fleet."""
    must_be_name(out, "folder", OptionError)
    if not (out / JOBS).is_file():
        fix = "give the folder that --out of mmgtune fleet run named"
        raise OptionError(Problem("this is not the folder of a fleet", str(out), f"it has no {JOBS}", fix))


def record_anew(out: Path) -> dict[str, Any]:
    """The record of a fleet's results written again, of a run that was stopped or goes on too."""
    made = made_before(out) if (out / FLEET).is_file() else {**made_by(""), "table": ""}
    return write_record(out.absolute(), made)
