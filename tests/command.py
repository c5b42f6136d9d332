"""The command line as a user runs it: a process with its own folder, its own output and its own exit code.

Most commands are forked from a process that has imported everything (``tests.forked``), which saves the second or two
that Python takes to start; those that are to be interrupted, or are about the start itself, get a new interpreter.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parent.parent


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
        env=_environment(env),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run(*arguments: str | Path, cwd: Path, env: dict[str, str] | None = None, fresh: bool = False) -> Ended:
    """Run ``mmgtune`` in a folder to its end.

    fresh  in a new interpreter; always so where ``env`` says where Python finds its modules
    """
    if fresh or not hasattr(os, "fork") or "PYTHONPATH" in (env or {}):
        process = start(*arguments, cwd=cwd, env=env)
        out, err = process.communicate(timeout=300)
        return Ended(process.returncode, out, err)
    return _forked([str(argument) for argument in arguments], cwd, _environment(env))


def _environment(more: dict[str, str] | None) -> dict[str, str]:
    return {**os.environ, "COLUMNS": "200", "NO_COLOR": "1", **(more or {})}


@lru_cache(maxsize=1)
def _server() -> subprocess.Popen[str]:
    """The process that forks, one for each process that runs tests; it ends with its input."""
    return subprocess.Popen(
        [sys.executable, "-m", "tests.forked"],
        cwd=ROOT,
        env=_environment(None),  # some libraries look at it when they are imported
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def _forked(arguments: list[str], cwd: Path, env: dict[str, str]) -> Ended:
    server = _server()
    assert server.stdin is not None
    assert server.stdout is not None
    with tempfile.TemporaryDirectory(prefix="mmgtune-test-") as folder:
        out, err = Path(folder, "out"), Path(folder, "err")
        request = {"arguments": arguments, "cwd": str(cwd), "env": env, "out": str(out), "err": str(err)}
        server.stdin.write(json.dumps(request) + "\n")
        server.stdin.flush()
        code = int(server.stdout.readline())
        return Ended(code, out.read_text(encoding="utf-8"), err.read_text(encoding="utf-8"))


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

    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
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
