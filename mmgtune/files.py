"""Writing files so that a reader never sees half of one and nothing is lost."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from .errors import OutputError, Problem


@contextlib.contextmanager
def atomic(path: Path, overwrite: bool = True) -> Iterator[Path]:
    """A temporary path beside ``path``, renamed to it when the block ends well and removed when it does not.

    Raises OutputError where ``path`` exists and ``overwrite`` is false, or the system refuses to write.
    """
    if not overwrite and path.exists():
        raise OutputError(exists(path))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        os.close(handle)
    except OSError as error:
        raise cannot_write(path, error) from error
    part = Path(name)
    try:
        yield part
        with part.open("rb") as file:
            os.fsync(file.fileno())
        os.chmod(part, 0o644)
        os.replace(part, path)
    except OSError as error:
        raise cannot_write(path, error) from error
    finally:
        part.unlink(missing_ok=True)


def write_text(path: Path, text: str, overwrite: bool = True) -> Path:
    """Write ``text`` to ``path`` as UTF-8, whole or not at all; returns the path."""
    with atomic(path, overwrite) as part:
        part.write_text(text, encoding="utf-8", newline="\n")
    return path


def exists(path: Path) -> Problem:
    """The problem of an output that is already there."""
    return Problem(
        what="the output exists already",
        where=str(path),
        why="results are never overwritten silently",
        fix="choose another folder, or add force=True to replace it",
    )


def cannot_write(path: Path, error: OSError) -> OutputError:
    """The error for a path the system does not let us write."""
    return OutputError(
        Problem(
            what="cannot write the output",
            where=str(path),
            why=error.strerror or str(error),
            fix="choose a folder with room that you may write to",
        )
    )
