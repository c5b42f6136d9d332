"""One job from its document to its run folder and its row: what a worker does, whoever started it.

It depends on the document and the files that this names, and on nothing else, so that it may be run again anywhere.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import time
import traceback
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from ..documents import write_json
from ..errors import MmgtuneError, OptionError, Problem, TrialError, cannot_write_reason
from ..files import write_text
from ..run_files import JOB
from . import rows
from .commands import COMMANDS, Facts, Task
from .job import Job, Source
from .places import fetched, hashes
from .table import options_of

ATTEMPT = ".attempt-"
"""Begin of the names of folders in which jobs are at work."""


def one_thread() -> None:
    """One kernel thread and one of linear algebra in this process: the cores are shared out by processes."""
    for name in ("MMGTUNE_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"
    import numpy  # noqa: F401  # its threads are there to be limited
    from threadpoolctl import threadpool_limits

    threadpool_limits(limits=1, user_api="blas")


def run_job(document: Mapping[str, Any], out: str, report: bool = True) -> tuple[str, str, float]:
    """Run a job, write its run folder and then its row; what is there already is not run again.

    report  whether its report is rendered too
    -> key, answer, and the time it took [s].  Never raises for what is wrong with the job itself: its row says it.
    """
    job, folder = Job.from_dict(document), Path(out)
    if rows.path_of(folder, job).is_file():
        return job.key, "there", 0.0
    began = time.perf_counter()
    try:
        record, facts = attempted(job, folder, report)
        row = rows.made(job, facts, record, time.perf_counter() - began)
    except MmgtuneError as error:
        row = rows.failed(job, error.problems, time.perf_counter() - began)
    except OSError as error:
        problem = Problem(cannot_write_reason(error), job.label, fix="see that there is room, and that it may be read")
        row = rows.failed(job, [problem], time.perf_counter() - began)
    except Exception as error:  # a bug: it is the job's, and stops no other
        last = "".join(traceback.format_exception(error)[-2:]).strip().replace("\n", " | ")
        problem = Problem(f"bug: {error!r}", job.label, last, "please report it")
        row = rows.failed(job, [problem], time.perf_counter() - began)
    rows.write(folder, job, row)
    return job.key, str(row["answer"]), float(row["seconds"])


def run_jobs(documents: Sequence[Mapping[str, Any]], out: str, report: bool = True) -> list[tuple[str, str, float]]:
    """Several jobs one after the other, each with its row as soon as it is done."""
    return [run_job(document, out, report) for document in documents]


def attempted(job: Job, out: Path, report: bool = True) -> tuple[str, Facts]:
    """The job run in a folder of its own, which becomes its run folder when all of it is there."""
    final = out / job.place
    final.parent.mkdir(parents=True, exist_ok=True)
    here = Path(tempfile.mkdtemp(prefix=f"{ATTEMPT}{job.name}-", dir=final.parent))
    try:
        os.chmod(here, 0o755)
        record, facts = in_folder(job, here)
        if report:
            from ..report import render

            render(here)
        _says(here / record, str(final))
        write_json(job.to_dict(), here / JOB)
        _replace(here, final)
    finally:
        shutil.rmtree(here, ignore_errors=True)
    return record, facts


def in_folder(job: Job, folder: Path) -> tuple[str, Facts]:
    """The job's command run into a folder.  Raises TrialError where files have changed since the job was made."""
    from ..profile import parse_profile

    ship = parse_profile(job.profile, Path(job.profile_path))
    with ExitStack() as stack:
        trials = _unchanged(job.trials, stack)
        baseline = _unchanged(job.baseline, stack) if job.baseline else None
        label = f"mmgtune fleet run: {job.label}"
        task = Task(ship, trials, options_of(job.command, job.options), baseline, label)
        return COMMANDS[job.command].run(task, folder)


def _unchanged(source: Source, stack: ExitStack) -> Path:
    now = hashes(source.path) if Path(source.path).exists() or "://" in source.path else {}
    if now != dict(source.files):
        other = sorted(name for name in {*now, *source.files} if now.get(name) != source.files.get(name))
        what = "the data changed since the job was made" if now else "the data of the job are not there"
        fix = "look whether workers see that folder"
        if now:
            fix = "run the fleet again with resume=True: changed jobs are made anew"
        raise TrialError(Problem(what, source.path, ", ".join(other[:5]), fix))
    return stack.enter_context(fetched(source.path))


def _says(record: Path, folder: str) -> None:
    """Put the place of the run folder into its record."""
    document = json.loads(record.read_text(encoding="utf-8"))
    if "out" in document:
        text = json.dumps({**document, "out": folder}, indent=1, allow_nan=False, ensure_ascii=False)
        write_text(record, text + "\n")


def _replace(here: Path, final: Path) -> None:
    """Make an attempt the run folder, in place of an older one of the same job."""
    try:
        if final.exists():
            older = Path(tempfile.mkdtemp(prefix=ATTEMPT, dir=final.parent))
            os.replace(final, older / "older")
            shutil.rmtree(older, ignore_errors=True)
        os.rename(here, final)
    except OSError as error:
        if not (final / JOB).is_file():  # else another attempt at the same job was quicker: it is the same
            raise OptionError(Problem(cannot_write_reason(error), str(final), fix="look at the folder")) from error


def remove_attempts(out: Path) -> None:
    """Remove what workers that were killed left behind; nobody else may be running the fleet."""
    for folder in out.glob(f"runs/*/*/{ATTEMPT}*"):
        shutil.rmtree(folder, ignore_errors=True)
