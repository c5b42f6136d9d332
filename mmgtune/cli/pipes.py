"""Standard streams into a pipe: whoever reads it, such as ``head``, may have seen enough before the end."""

from __future__ import annotations

import io
import os
from typing import Any


class ReaderGone(BaseException):
    """Nobody reads any more; no failure.  Click would take the error of the system for one."""


class Piped:
    """A stream that raises ReaderGone where nobody reads it any more; one that was closed from the start takes all."""

    def __init__(self, stream: Any):
        self._stream = io.StringIO() if stream is None else stream

    def write(self, text: str) -> int:
        """Write; returns the number of characters."""
        try:
            return int(self._stream.write(text))
        except BrokenPipeError:
            raise ReaderGone from None

    def flush(self) -> None:
        """Let what is written go."""
        try:
            self._stream.flush()
        except BrokenPipeError:
            raise ReaderGone from None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def say_no_more() -> None:
    """Let what is still to be written go nowhere, the last flush of the interpreter too."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(nowhere, stream)
