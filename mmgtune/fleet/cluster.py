"""Jobs on Dask: a scheduler that is given, or one of one's own on this machine.

A task is as many jobs as take some seconds, so that the scheduler, which needs about a millisecond for a task, is never
what is waited for, and no more tasks are under way than keep the workers busy.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..errors import OptionError, Problem, reason
from ..options.fleet import LOCAL, FleetOptions
from .job import Job
from .places import EXTRA
from .processes import Ran, cores
from .work import one_thread, run_jobs

if TYPE_CHECKING:
    from distributed import Client

LOOPBACK = "127.0.0.1"
TASK_SECONDS = 5.0
"""About how long a task should take [s]."""

MOST = 50
"""Jobs in a task at most: what is lost with a worker."""

AHEAD = 3
"""Tasks under way for each worker thread."""

PATIENCE = "20s"
"""How long a scheduler may take to answer."""


@contextlib.contextmanager
def connected(options: FleetOptions) -> Iterator[Client]:
    """A client of the scheduler of the options.

    Raises OptionError where Dask is not installed, nobody answers at the address, or its certificates do not do.
    """
    try:
        from distributed import Client, LocalCluster, Security
    except ImportError as error:
        what = "a scheduler needs Dask, which is not installed"
        fix = f"{EXTRA}, here and on the workers; or leave it out for processes of this machine"
        raise OptionError(Problem(what, "scheduler", reason(error), fix)) from error
    with contextlib.ExitStack() as stack:
        address: Any = options.scheduler
        if address == LOCAL:
            address = stack.enter_context(
                LocalCluster(
                    n_workers=options.workers or cores(),
                    threads_per_worker=1,
                    processes=True,
                    host=LOOPBACK,
                    dashboard_address=None,
                    silence_logs=40,
                )
            )
        try:
            security = _security(Security, options)
            client = stack.enter_context(Client(address, timeout=PATIENCE, security=security))
        except (OSError, TimeoutError, ValueError, ImportError) as error:
            fix = "start it with dask scheduler, and see that its port can be reached from here"
            raise OptionError(Problem("the scheduler does not answer", str(address), reason(error), fix)) from error
        yield client


def _security(of: Any, options: FleetOptions) -> Any:
    if not options.tls:
        return None
    lacking = [path for path in options.tls.values() if not path.is_file()]
    if lacking:
        raise OptionError(*(Problem("there is no such certificate or key", str(path)) for path in lacking))
    return of(
        tls_ca_file=str(options.tls_ca),
        tls_client_cert=str(options.tls_cert),
        tls_client_key=str(options.tls_key),
        require_encryption=True,
    )


def run_there(
    jobs: Sequence[Job], out: str, client: Client, seconds_a_job: float, report: bool = True
) -> Iterator[Ran]:
    """Jobs as they end, on the workers of a client, which all must see ``out``.

    A killed worker's tasks are given to others by the scheduler, as often as its ``allowed-failures`` says.
    """
    from distributed import KilledWorker, as_completed

    size = max(1, min(MOST, int(TASK_SECONDS / max(seconds_a_job, 1e-3))))
    threads = sum(client.nthreads().values())
    if not threads:
        fix = "start workers with dask worker ADDRESS, a process a core and one thread each"
        raise OptionError(Problem("the scheduler has no workers", str(client.scheduler.address), fix=fix))
    size = min(size, max(1, len(jobs) // (AHEAD * threads)))
    batches = iter([jobs[k : k + size] for k in range(0, len(jobs), size)])
    by_task: dict[str, Sequence[Job]] = {}

    def submitted() -> Any:
        batch = next(batches, None)
        if batch is None:
            return None
        future = client.submit(_work, [job.to_dict() for job in batch], out, report, pure=False)
        by_task[future.key] = batch
        return future

    first = [future for _ in range(AHEAD * threads) if (future := submitted()) is not None]
    ending = as_completed(first)
    for future in ending:
        batch = by_task.pop(future.key)
        error = future.exception()
        if error is None:
            for job, (_, answer, seconds) in zip(batch, future.result(), strict=True):
                yield job, answer, seconds
        elif isinstance(error, KilledWorker):
            for job in batch:
                yield job, "killed", 0.0
        else:
            fix = "install the same mmgtune there, and see that workers reach the folders of this machine"
            problem = Problem("a worker cannot run jobs", str(client.scheduler.address), repr(error), fix)
            raise OptionError(problem) from error
        if (more := submitted()) is not None:
            ending.add(more)


def _work(documents: Sequence[Mapping[str, Any]], out: str, report: bool) -> list[tuple[str, str, float]]:
    """A task on a worker."""
    if os.environ.get("MMGTUNE_THREADS") != "1":
        one_thread()
    return run_jobs(documents, out, report)
