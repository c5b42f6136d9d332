"""The command line as a user runs it: a process with its own folder, its own output and its own exit code."""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest


@dataclass(frozen=True)
class Ended:
    """How a process ended."""

    code: int
    out: str
    err: str

    def json(self) -> Any:
        """What it printed, which must be one JSON document and nothing else."""
        return json.loads(self.out)


def start(*arguments: str | Path, cwd: Path, env: dict[str, str] | None = None) -> subprocess.Popen[str]:
    """Start ``mmgtune`` in a folder."""
    return subprocess.Popen(
        [sys.executable, "-m", "mmgtune", *map(str, arguments)],
        cwd=cwd,
        env={**os.environ, "COLUMNS": "200", "NO_COLOR": "1", **(env or {})},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run(*arguments: str | Path, cwd: Path, env: dict[str, str] | None = None) -> Ended:
    """Run ``mmgtune`` in a folder to its end."""
    process = start(*arguments, cwd=cwd, env=env)
    out, err = process.communicate(timeout=300)
    return Ended(process.returncode, out, err)


def run_until(ready: Callable[[], bool], sent: signal.Signals, *arguments: str | Path, cwd: Path) -> Ended:
    """Run ``mmgtune``, send it a signal as soon as ``ready``, and wait for its end."""
    process = start(*arguments, cwd=cwd)
    limit = time.monotonic() + 120.0
    while not ready():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < limit, "never got ready"
        time.sleep(0.01)
    process.send_signal(sent)
    out, err = process.communicate(timeout=120)
    return Ended(process.returncode, out, err)


def typed(*arguments: str | Path) -> Ended:
    """Run ``mmgtune`` in this process and folder, which takes a second less; for what does not end in a signal."""
    from mmgtune.cli import main

    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    before = sys.argv
    sys.argv = ["mmgtune", *map(str, arguments)]
    out, err = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as end:
            main()
    finally:
        sys.argv = before
        for number, handler in handlers.items():
            signal.signal(number, handler)
    return Ended(int(end.value.code or 0), out.getvalue(), err.getvalue())


QUICK = ("--method", "least-squares", "--starts", "2", "--no-report", "--quiet")
