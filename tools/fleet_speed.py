"""How fast a fleet runs: 200 jobs on two workers against a plain loop, with workers killed, and on Dask.

    python -m tools.fleet_speed FOLDER [--out docs/fleet-speed.json]

Jobs are those of a generated fleet of 20 ships over 10 months (``tools.generate_fleet``).  The plain loop runs them one
after the other in one process that has all cores.  All runs must give the same numbers to the last bit.  Memory is the
most that any process of a run had resident; overhead is the time of the workers that was not spent on jobs.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from mmgtune.files import write_text
from mmgtune.fleet import read_results, read_table
from mmgtune.fleet.expanding import expand
from mmgtune.fleet.work import run_job
from tools.generate_fleet import make

KILL_EVERY = 20.0
"""Seconds between two workers killed."""

SUBREAPER = 36
"""Of ``prctl(2)``: processes whose parent ended become this process's, which waits for them."""

SAME = ("names", "values", "errors", "off_track", "off_heading", "tuned_track", "tuned_heading", "verdict", "key")


def loop(table: Path, out: Path) -> None:
    """All jobs in this process, one after the other."""
    for job in expand(read_table(table)):
        run_job(job.to_dict(), str(out))


def timed(command: list[str], meanwhile: Callable[[int], None] = lambda _: None) -> dict[str, float]:
    """Wall time [s] of a process, time of processors, and the largest resident memory of it or its children [MB]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.perf_counter()
    process = subprocess.Popen(command)
    threading.Thread(target=meanwhile, args=(process.pid,), daemon=True).start()
    if process.wait() != 0:
        raise SystemExit(f"{command} ended with {process.returncode}")
    wall = time.perf_counter() - began
    with suppress(ChildProcessError):  # what workers are forked from ends after the command
        while True:
            os.wait()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"wall_s": wall, "processor_s": spent, "largest_MB": after.ru_maxrss / 1024.0}


def killing(count: list[int]) -> Callable[[int], None]:
    """Kills one worker of a driver every ``KILL_EVERY`` seconds, as long as it lives."""

    def kill(driver: int) -> None:
        while Path(f"/proc/{driver}").exists():
            time.sleep(KILL_EVERY)
            for worker in workers_of(driver)[:1]:
                with suppress(ProcessLookupError):
                    os.kill(worker, signal.SIGKILL)
                    count[0] += 1

    return kill


def workers_of(driver: int) -> list[int]:
    """Worker processes of a driver: children of the one that it started to fork them."""
    forking = [child for child in _children(driver) if "forkserver" in _command(child)]
    return [worker for server in forking for worker in _children(server)]


def _children(process: int) -> list[int]:
    with suppress(OSError):
        return [int(k) for k in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    return []


def _command(process: int) -> str:
    with suppress(OSError):
        return Path(f"/proc/{process}/cmdline").read_text()
    return ""


def numbers(out: Path) -> list[dict[str, Any]]:
    """What must be the same of every run."""
    return [{key: row[key] for key in SAME} for row in read_results(out)]


def measured(folder: Path) -> dict[str, Any]:
    """All runs."""
    table = folder / "fleet.toml"
    if not table.is_file():
        make(folder, n_ships=20, n_months=10, seed=3)
    fleet = [sys.executable, "-m", "mmgtune", "fleet", "run", str(table), "-q", "--no-report"]
    # Kernels are compiled once, before anything is timed.
    run_job(expand(read_table(table))[0].to_dict(), str(folder / "first"))
    kills = [0]
    own = [sys.executable, "-m", "tools.fleet_speed", str(folder), "--loop"]
    runs = {
        "plain loop": lambda out: timed([*own, str(out)]),
        "2 workers": lambda out: timed([*fleet, "--workers", "2", "--out", str(out)]),
        "Dask, 2 workers": lambda out: timed([*fleet, "--scheduler", "local", "--workers", "2", "--out", str(out)]),
        "2 workers, one killed every 20 s": lambda out: timed(
            [*fleet, "--workers", "2", "--out", str(out)], killing(kills)
        ),
    }
    found: dict[str, Any] = {}
    reference: list[dict[str, Any]] = []
    for k, (name, run) in enumerate(runs.items()):
        out = folder / f"out-{k}"
        found[name] = run(out)
        rows = read_results(out)
        reference = reference or numbers(out)
        jobs_s = sum(row["seconds"] for row in rows)
        same = numbers(out) == reference
        found[name] |= {"jobs": len(rows), "jobs_s": jobs_s, "same_numbers": same}
        if k:
            found[name]["overhead_ms_a_job"] = 1000.0 * (2.0 * found[name]["wall_s"] - jobs_s) / len(rows)
            found[name]["times_as_fast"] = found["plain loop"]["wall_s"] / found[name]["wall_s"]
        print(name, found[name], flush=True)
    found["2 workers, one killed every 20 s"]["killed"] = kills[0]
    return found


if __name__ == "__main__":
    ctypes.CDLL(None).prctl(SUBREAPER, 1)
    parser = argparse.ArgumentParser(description="How fast a fleet runs.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, default=Path("docs/fleet-speed.json"))
    parser.add_argument("--loop", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.loop is not None:
        loop(asked.folder / "fleet.toml", asked.loop)
    else:
        command = "python -m tools.fleet_speed FOLDER"
        cores = len(os.sched_getaffinity(0))
        result = {"schema": 1, "command": command, "cores": cores, "runs": measured(asked.folder)}
        write_text(asked.out, json.dumps(result, indent=1) + "\n")
