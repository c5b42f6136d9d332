"""Cases under limits of time and memory."""

from __future__ import annotations

import contextlib
import faulthandler
import functools
import resource
import shutil
import signal
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from mmgtune.errors import MmgtuneError

from .kinds import Files, Kind

BYTES = 1 << 30
"""Memory a case may ask for on top of what the process has."""


class TooLong(BaseException):
    """A case is over its time; no ``except Exception`` of the program may take it for something else."""


@dataclass(frozen=True)
class Outcome:
    """What came of a case.

    end      "good", "refused" or, where it failed, "crash", "time" or "memory"
    said     what ``Kind.run`` returned, the error's text, or the traceback
    seconds  CPU time it took
    """

    end: str
    said: str
    seconds: float

    @property
    def failed(self) -> bool:
        """Whether the program did something it must not."""
        return self.end not in ("good", "refused")


@dataclass
class Campaign:
    """Many cases: how they ended, those that failed by number, and the longest."""

    ends: Counter[str] = field(default_factory=Counter)
    failures: dict[int, Outcome] = field(default_factory=dict)
    longest: float = 0.0


def files_of(kind: Kind, seed: int, number: int) -> Files:
    """Case ``number`` of a seed, whichever were made before it."""
    return kind.make(np.random.default_rng([seed, number]))


def run_files(kind: Kind, files: Files) -> Outcome:
    """What becomes of a case, in a folder that is gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="mmgtune-fuzz-") as name:
        folder = Path(name) / "case"
        folder.mkdir()
        for file, content in files.items():
            (folder / file).write_bytes(content)
        return run_folder(kind, folder)


def run_folder(kind: Kind, folder: Path) -> Outcome:
    """What becomes of the case whose files are in ``folder``."""
    began = time.process_time()

    def ended(end: str, said: str) -> Outcome:
        return Outcome(end, said, time.process_time() - began)

    try:
        with warnings.catch_warnings(), limited(kind.seconds):
            warnings.simplefilter("ignore")
            said = kind.run(folder)
        outcome = ended("good", said)
    except MmgtuneError as error:
        outcome = ended("refused", str(error))
    except TooLong:
        outcome = ended("time", traceback.format_exc())
    except MemoryError:
        outcome = ended("memory", traceback.format_exc())
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        outcome = ended("crash", traceback.format_exc())
    # A signal waits for compiled code to return: what took too long there is seen here.
    if not outcome.failed and outcome.seconds > kind.seconds:
        return Outcome("time", f"{outcome.seconds:.1f} s; {outcome.said}", outcome.seconds)
    return outcome


def campaign(kind: Kind, count: int, seed: int, keep: Path | None = None, seconds: float = float("inf")) -> Campaign:
    """Run cases 0 to ``count``, as many as ``seconds`` allow; the files of those that fail go to ``keep``."""
    found = Campaign()
    began = time.monotonic()
    for number in range(count):
        if time.monotonic() - began > seconds:
            break
        files = files_of(kind, seed, number)
        if keep is not None:
            _keep(keep / kind.name / f"{seed}-running", files)
            # Compiled code that never returns cannot be stopped otherwise: its case is then the one left there.
            faulthandler.dump_traceback_later(20.0 * kind.seconds, exit=True)
        outcome = run_files(kind, files)
        found.ends[outcome.end] += 1
        found.longest = max(found.longest, outcome.seconds)
        if outcome.failed:
            found.failures[number] = outcome
            if keep is not None:
                folder = keep / kind.name / f"{seed}-{number}"
                _keep(folder, files)
                Path(f"{folder}.txt").write_text(f"{outcome.end}\n{outcome.said}\n", encoding="utf-8")
    if keep is not None:
        faulthandler.cancel_dump_traceback_later()
        shutil.rmtree(keep / kind.name / f"{seed}-running", ignore_errors=True)
    return found


def _keep(folder: Path, files: Files) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)


@functools.cache
def _reserve() -> None:
    """Have Arrow take the gigabyte of addresses that its allocator begins with, which is no case's doing."""
    pa.array([0.0])


@contextlib.contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Limits of time and memory while the block runs."""

    def stop(*_: Any) -> None:
        raise TooLong

    before = [signal.signal(one, stop) for one in (signal.SIGPROF, signal.SIGALRM)]
    _reserve()
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    pages = int(Path("/proc/self/statm").read_text().split()[5])
    most = pages * resource.getpagesize() + BYTES
    resource.setrlimit(resource.RLIMIT_DATA, (most if soft == resource.RLIM_INFINITY else min(soft, most), hard))
    signal.setitimer(signal.ITIMER_PROF, seconds)
    signal.setitimer(signal.ITIMER_REAL, 10.0 * seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))
        for one, handler in zip((signal.SIGPROF, signal.SIGALRM), before, strict=True):
            signal.signal(one, handler)
