r"""Standard streams wherever they lead: whoever reads a pipe, such as ``head``, may have seen enough before the end, a
disk may be full, and an encoding may lack letters, which are written as ``\u00b0`` then, as JSON does.
"""

from __future__ import annotations

import codecs
import contextlib
import io
import json
import os
from collections.abc import Iterator
from typing import Any


class ReaderGone(BaseException):
    """Nobody reads any more; no failure.  Click would take the error of the system for one."""


def _as_in_json(error: UnicodeError) -> tuple[str, int]:
    """What stands for letters that an encoding lacks; a document is JSON still if it was."""
    assert isinstance(error, UnicodeEncodeError)  # nothing is read here
    return json.dumps(error.object[error.start : error.end])[1:-1], error.end


codecs.register_error("as in json", _as_in_json)


class Piped:
    """A stream that raises ReaderGone where nobody reads it any more; one that was closed from the start takes all.

    name  of the stream, for errors of the system that name no file
    """

    def __init__(self, stream: Any, name: str):
        self._stream, self._name = io.StringIO() if stream is None else stream, name

    def write(self, text: str) -> int:
        """Write; returns the number of characters."""
        with self._told():
            try:
                return int(self._stream.write(text))
            except UnicodeEncodeError as error:
                letters = text.encode(error.encoding, "as in json").decode(error.encoding)
                return int(self._stream.write(letters))

    def flush(self) -> None:
        """Let what is written go."""
        with self._told():
            self._stream.flush()

    @contextlib.contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:
            raise ReaderGone from None
        except OSError as error:
            error.filename = error.filename or self._name
            raise

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def say_no_more() -> None:
    """Let what is still to be written go nowhere, the last flush of the interpreter too."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(nowhere, stream)
