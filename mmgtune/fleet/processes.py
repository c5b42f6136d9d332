"""Jobs on this machine: a pool of processes, begun anew where one of them was killed."""

from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from .job import Job
from .work import one_thread, run_job

TRIES = 5
"""How often a job may be at work when a worker is killed before it is given up."""

LIFE = 200
"""Jobs of each worker process after which all are replaced, so that their memory stays bounded."""

IMPORTED = (
    "mmgtune.backends.compiling",
    "mmgtune.fleet.commands",
    "mmgtune.fleet.work",
    "mmgtune.report.pages.kinds",
    "pandas",
    "pyarrow.parquet",
)
"""What jobs import: once, by the process that workers are forked from."""

METHOD = "forkserver" if sys.platform == "linux" else "spawn"
"""How a worker starts: forked on Linux alone, elsewhere the libraries of the system do not stand that."""

Ran = tuple[Job, str, float]
"""A job, what became of it ("killed" where it was given up), and its time [s]."""


def prepare() -> None:
    """Begin, in the background, to make workers quick to start: they are forked from a process that has imported what
    jobs need.

    Where each worker starts by itself there is nothing to begin.
    """
    if METHOD == "forkserver":
        from multiprocessing import forkserver

        multiprocessing.get_context(METHOD).set_forkserver_preload(list(IMPORTED))
        forkserver.ensure_running()


def cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run_here(
    jobs: Sequence[Job],
    out: str,
    workers: int,
    on_killed: Callable[[int], None] = lambda _: None,
    report: bool = True,
) -> Iterator[Ran]:
    """Jobs as they end, on ``workers`` processes.

    A killed worker breaks its pool: what was done is done, the jobs that were at work are run again on a new pool.
    ``on_killed`` is told how many of them there are; ``report`` is whether each job's report is rendered.
    """
    left, tries = deque(jobs), dict.fromkeys((job.key for job in jobs), 0)
    while left:
        pending: dict[Future[tuple[str, str, float]], Job] = {}
        broken, life = False, LIFE * workers
        with pool_of(workers) as pool:
            while not broken and (pending or (left and life)):
                try:
                    while left and life and len(pending) < workers:  # so that it is known which were at work
                        pending[pool.submit(run_job, left[0].to_dict(), out, report)] = left[0]
                        left.popleft()
                        life -= 1
                except BrokenProcessPool:
                    broken = True
                for future in wait(pending, return_when=FIRST_COMPLETED).done:
                    if isinstance(future.exception(), BrokenProcessPool):
                        broken = True
                        continue
                    job = pending.pop(future)
                    _, answer, seconds = future.result()
                    yield job, answer, seconds
        if broken:
            on_killed(len(pending))
        for job in pending.values():
            tries[job.key] += 1
            if tries[job.key] < TRIES:
                left.append(job)
            else:
                yield job, "killed", 0.0


@contextmanager
def pool_of(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Worker processes; when nothing is left for them, they end by themselves."""
    context = multiprocessing.get_context(METHOD)
    pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_begin, initargs=(dict(os.environ),))
    waits = True
    try:
        yield pool
        waits = False
    finally:
        pool.shutdown(wait=waits)  # whoever is interrupted waits for the jobs that are at work


def _begin(environment: Mapping[str, str]) -> None:
    """What a worker process does first; the environment is that of its driver now."""
    os.environ.clear()
    os.environ.update(environment)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches it too; its driver decides
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_with, args=(parent.sentinel,), daemon=True).start()
    one_thread()


def _with(sentinel: int) -> None:
    """End this process with the one that started it: a driver that is killed leaves nobody at work."""
    multiprocessing.connection.wait([sentinel])
    os._exit(1)
