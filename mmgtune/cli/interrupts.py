"""Ctrl-C, SIGTERM and SIGHUP: whenever they come, exit code 130, 143 or 129 and one line that says what is saved.

A handler ends the process itself.  An exception raised by one may come anywhere, in a destructor too, and be lost.
"""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Callable
from pathlib import Path
from shlex import quote
from typing import Any, NoReturn

from ..files import abandon
from .exitcodes import ExitCode
from .output import harmless

NAMES = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}
CODES = {signal.SIGINT: ExitCode.INTERRUPTED, signal.SIGTERM: ExitCode.TERMINATED}
if hasattr(signal, "SIGHUP"):  # which Windows lacks
    NAMES[signal.SIGHUP], CODES[signal.SIGHUP] = "hung up", ExitCode.HUNG_UP

Handler = Callable[[int, Any], None]


def handle(handler: Handler) -> None:
    """Have a function called on Ctrl-C, SIGTERM and SIGHUP from now on; what nohup ignores stays ignored."""
    for number in NAMES:
        if number in (signal.SIGINT, signal.SIGTERM) or signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, handler)


def stop_at_once(words: str) -> Handler:
    """What Ctrl-C does where there is nothing to finish: end, saying ``words``."""

    def handler(number: int, _frame: Any) -> None:
        leave(number, words)

    return handler


def continued(folder: Path) -> str:
    """What to say of a run whose folder holds what was done of it."""
    return f"what is done is in {folder}; --resume --out {quote(str(folder))} continues"


def leave(number: int, words: str) -> NoReturn:
    """End the process at once; of files half-written nothing stays."""
    abandon()
    tell(f"{NAMES[signal.Signals(number)]}: {words}")
    os._exit(CODES[signal.Signals(number)])


def tell(line: str) -> None:
    """A line on stderr from a handler, past the stream, which may be in the middle of writing."""
    with contextlib.suppress(OSError):  # nobody reads it
        os.write(2, f"{harmless(line)}\n".encode())


def over() -> None:
    """The exit code is settled: what comes now is too late to change it."""
    for number in NAMES:
        signal.signal(number, signal.SIG_IGN)
