"""A process that has imported everything and forks itself for each command: a command without the start of Python.

    python -m tests.forked

Reads requests, a line of JSON each, and answers each with a line that holds the exit code.  A child is a process like
any other: folder, environment and output of its own.  It does not take apart what was imported, which takes longer than
most commands do.  Tests of the start and of the end use a new interpreter.
"""

from __future__ import annotations

import atexit
import gc
import io
import json
import os
import signal
import sys
from contextlib import redirect_stdout
from importlib import import_module
from pkgutil import walk_packages
from runpy import run_module

SECONDS = 300
"""After which a command counts as stuck and is ended."""

IMPORTED = (
    "cma", "matplotlib.backends.backend_pdf", "matplotlib.backends.backend_svg", "matplotlib.figure", "pandas",
    "pyarrow.parquet", "scipy.interpolate", "scipy.linalg", "scipy.optimize", "scipy.stats",
)  # fmt: skip
"""Libraries that commands import on their way."""

LEFT = ("mmgtune.__main__", "mmgtune.backends.jax_math")
"""Of the program what runs when it is imported, and what starts threads, which a child would not have."""


def _warm() -> None:
    """Import what commands import on their way, and read the compiled simulator that most of them use."""
    import mmgtune.cli

    own = (module.name for module in walk_packages(mmgtune.__path__, "mmgtune."))
    for name in (*IMPORTED, *(name for name in own if name not in LEFT)):
        import_module(name)

    with redirect_stdout(io.StringIO()):
        mmgtune.cli.app(["validate", "suzaku", "trials/suzaku/turn_p10.parquet"], standalone_mode=False)


def _become(request: dict[str, object]) -> None:
    """Turn this child into the command that was asked for."""
    signal.alarm(SECONDS)
    os.chdir(str(request["cwd"]))
    os.environ.clear()
    os.environ.update(request["env"])  # type: ignore[call-overload]
    for descriptor, key, flags in (
        (0, os.devnull, os.O_RDONLY),
        (1, str(request["out"]), os.O_WRONLY | os.O_CREAT),
        (2, str(request["err"]), os.O_WRONLY | os.O_CREAT),
    ):
        os.dup2(os.open(key, flags, 0o600), descriptor)
    sys.argv = ["mmgtune", *request["arguments"]]  # type: ignore[misc]


def main() -> None:
    """Serve until the requests end."""
    _warm()
    gc.freeze()
    requests, answers = os.dup(0), os.dup(1)
    with os.fdopen(requests) as lines, os.fdopen(answers, "w") as told:
        for line in iter(lines.readline, ""):
            child = os.fork()
            if child == 0:
                _become(json.loads(line))
                break
            told.write(f"{os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])}\n")
            told.flush()
        else:
            return
    code = _ended()
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        if not stream.closed:
            stream.flush()
    os._exit(code & 0xFF)


def _ended() -> int:
    """Run the command in this child, and its exit code as an interpreter would have it."""
    try:
        run_module("mmgtune", run_name="__main__", alter_sys=True)
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return end.code or 0
        print(end.code, file=sys.stderr)
        return 1
    except BaseException:
        sys.excepthook(*sys.exc_info())  # type: ignore[arg-type]
        return 1
    return 0


if __name__ == "__main__":
    main()
