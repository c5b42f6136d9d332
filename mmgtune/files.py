"""Writing files so that a reader never sees half of one and nothing is lost."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import secrets
import stat
import sys
from collections.abc import Iterable, Iterator
from contextvars import ContextVar
from pathlib import Path

from .errors import OptionError, OutputError, Problem, brief, kind_of, reason

_PARTS: set[Path] = set()
"""Temporary files of this process."""

_TOGETHER: ContextVar[list[Path] | None] = ContextVar("together", default=None)
"""New files of which none is to stay where one cannot be written."""

_LEFT = re.compile(r"\..+\.[a-z0-9_]{8}\.part")
"""What ``atomic`` calls its temporary files."""


def path_of(given: object) -> Path:
    """The path that a text or a Path gives.  Raises OptionError for what is neither."""
    if isinstance(given, (str, os.PathLike)):
        if not os.fspath(given):
            raise OptionError(Problem("the path is empty", fix="write '.' for the current folder"))
        path = Path(given)
        if any("\ud800" <= letter <= "\udfff" for letter in str(path)):
            why, fix = "no file of results could name it", "give another name"
            raise OptionError(Problem("a path that is not UTF-8 text", brief(str(path)), why, fix))
        return path
    why = f"files and folders are given as a text or a Path, and {kind_of(given)} is neither"
    raise OptionError(Problem("no path", brief(given), why, "write where the file or folder is to be"))


def can_name_file(text: str) -> bool:
    """Whether a text, such as the id of a trial, can be the name of a file in a folder of results."""
    return text not in (".", "..") and not any(letter in "/\\" or letter < " " for letter in text)


def kept_in(folder: Path | str | None, resume: bool) -> Path | None:
    """The folder in which long work keeps what it has; None for nowhere.

    Raises OptionError for what is no path, and where there is nothing to go on from.
    """
    if folder is not None:
        return path_of(folder)
    if resume:
        raise OptionError(resumed_nowhere("folder"))
    return None


def resumed_nowhere(option: str) -> Problem:
    """The problem of a run that is to be continued, where its folder is not given; ``option`` gives it."""
    what, why = "resume=True needs the folder of the interrupted run", "a run goes on from what it left there"
    return Problem(what, "resume", why, f"add {option}=FOLDER, or leave resume out")


def require_flag(overwrite: object) -> None:
    """Raises OptionError for what is neither true nor false."""
    if not isinstance(overwrite, bool) and type(overwrite).__name__ not in ("bool", "bool_"):  # those of NumPy
        why, fix = "it says whether files that are there may be replaced", "give True or False"
        raise OptionError(Problem(f"overwrite is {brief(overwrite)}", "overwrite", why, fix))


@contextlib.contextmanager
def atomic(path: Path, overwrite: bool = True) -> Iterator[Path]:
    """A temporary path beside ``path``, renamed to it when the block ends well and removed when it does not.

    Raises OutputError where ``path`` exists and ``overwrite`` is false, where a pipe, a socket or a device is there,
    or the system refuses to write.
    """
    require_flag(overwrite)
    if not overwrite and os.path.lexists(path):  # a link to nowhere would be replaced too
        raise OutputError(exists(path))
    refuse_irregular(path)
    with half(path) as part:
        yield part
        with part.open("rb") as file:
            os.fsync(file.fileno())
        made = _TOGETHER.get()
        if made is not None and not os.path.lexists(path):
            made.append(path)
        os.replace(part, path)


@contextlib.contextmanager
def all_or_none() -> Iterator[None]:
    """Where an error ends this context, or the function that it decorates, the new files written in it go again.

    What was there before and was replaced stays replaced.
    """
    made: list[Path] = []
    outer = _TOGETHER.get()
    token = _TOGETHER.set(made)
    try:
        yield
    except BaseException:
        for path in made:
            with contextlib.suppress(OSError):
                path.unlink()
        raise
    else:
        if outer is not None:  # one of several such contexts, of which none is to stay where a later one fails
            outer += made
    finally:
        _TOGETHER.reset(token)


@contextlib.contextmanager
def half(path: Path) -> Iterator[Path]:
    """A temporary file beside ``path``, gone when the block ends.  Raises OutputError where the system refuses."""
    make_folder(path.parent)
    try:
        part = path.parent / f".{path.name}.{secrets.token_hex(4)}.part"
        os.close(os.open(part, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o644))  # less where the user's mask says so
    except (OSError, ValueError) as error:  # the latter for a zero byte in the name
        raise cannot_write(path, error) from error
    _PARTS.add(part)
    try:
        yield part
    except OSError as error:
        raise cannot_write(path, error) from error
    finally:
        part.unlink(missing_ok=True)
        _PARTS.discard(part)


def make_folder(folder: Path) -> None:
    """Make a folder and those it lies in, where they are not there.  Raises OutputError where the system refuses."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise cannot_write(folder, error) from error
    except RecursionError:
        raise cannot_write(folder, ValueError("too many folders lie in each other")) from None


def abandon() -> None:
    """Remove what this process has half-written, before it ends at once."""
    for part in tuple(_PARTS):
        with contextlib.suppress(OSError):
            part.unlink()


def is_left_over(path: Path) -> bool:
    """Whether a file is the half of one, left by a process that was killed while it wrote."""
    return _LEFT.fullmatch(path.name) is not None


def remove_left_overs(folder: Path) -> None:
    """Remove halves of files from a run folder, the runs and figures in it; nobody else may be writing there."""
    for path in (*folder.glob(".*.part"), *folder.glob("*/.*.part"), *folder.glob("*/*/.*.part")):
        if is_left_over(path):
            with contextlib.suppress(OSError):
                path.unlink()


def require_regular(path: Path) -> None:
    """Raises OSError where a path leads to a pipe, a socket or a device: to open one may wait for ever.

    For what is read more than once, or not from its beginning to its end.
    """
    try:
        mode = path.stat().st_mode
    except ValueError as error:  # a zero byte in its name
        raise OSError(str(error)) from error
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise OSError("it is a pipe, a socket or a device, not a file")


def true_path(path: Path) -> Path:
    """Where a path leads, links followed; of links in a ring the path as it is, from the root."""
    try:
        return path.resolve()
    except (OSError, RuntimeError):
        return path.absolute()


@contextlib.contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """No other process is inside for the same folder, where there are such locks; a lock dies with its holder.

    Raises OutputError where another is.
    """
    if sys.platform == "win32":
        yield
        return
    import fcntl

    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError as error:
        raise cannot_write(folder, error) from error
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            why = "each would write over what the other has found"
            fix = "choose another folder, or wait for the other run to end"
            raise OutputError(Problem("another run is writing there", str(folder), why, fix)) from None
        except OSError:  # some network folders have no locks
            pass
        if not _is_still(handle, folder):
            why = "a command that made it and was refused took it away again at this moment"
            raise OutputError(Problem("the folder is gone", str(folder), why, "run the command again"))
        yield
    finally:
        os.close(handle)


def _is_still(handle: int, folder: Path) -> bool:
    """Whether a path leads to what is open."""
    try:
        return os.path.samestat(os.fstat(handle), os.stat(folder))
    except OSError:
        return False


def write_text(path: Path, text: str, overwrite: bool = True) -> Path:
    """Write ``text`` to ``path`` as UTF-8, whole or not at all; returns the path."""
    with atomic(path, overwrite) as part:
        part.write_text(text, encoding="utf-8", newline="\n")
    return path


def refuse_existing(paths: Iterable[Path], overwrite: bool = False) -> None:
    """Raises OutputError with each of these outputs that is already there, unless they are to be replaced.

    Also, and in any case, where a folder that one is to lie in is a file, and where one is a pipe or a device.
    """
    paths = tuple(paths)
    for folder in dict.fromkeys(path.parent for path in paths):
        refuse_file(folder)
    for path in paths:
        refuse_irregular(path)
    require_flag(overwrite)
    if overwrite:
        return
    found = [exists(path) for path in dict.fromkeys(paths) if os.path.lexists(path)]
    if found:
        raise OutputError(*found)


def refuse_irregular(path: Path) -> None:
    """Raises OutputError where a pipe, a socket or a device is at a path: a file would take its place, not go into it.

    Also for a link such as /dev/stdout, whatever it leads to at this moment.
    """
    try:
        mode = path.stat().st_mode
        stands = stat.S_ISREG(mode) or stat.S_ISDIR(mode)
        if path.is_symlink() and os.readlink(path).startswith("/proc/"):
            stands = False
    except (OSError, ValueError):  # nothing is there, or writing says what is wrong with it
        return
    if not stands:
        why = "it is a pipe, a socket or a device, and results are put in the place of what is there"
        raise OutputError(Problem("the output is not a file", str(path), why, "give the name of a file"))


def refuse_file(folder: Path) -> None:
    """Raises OutputError where a folder for results, or one that it lies in, is a file, or cannot be looked at."""
    try:
        folder.exists()
    except OSError as error:  # such as a name that is too long
        raise cannot_write(folder, error) from error
    found = _file_in(folder)
    if found is not None:
        raise OutputError(_no_folder(found))


def _file_in(path: Path) -> Path | None:
    """The part of a path that is there and no folder, None where there is none."""
    try:
        there = next((one for one in (path, *path.parents) if one.exists()), path)
        return there if there.exists() and not there.is_dir() else None
    except (OSError, ValueError):  # writing says what is wrong with it
        return None


def _link_to_nothing(path: Path) -> Path | None:
    """A path or the nearest folder above it that is a link to nothing; None where none is."""
    return next((one for one in (path, *path.parents) if one.is_symlink() and not one.exists()), None)


def _no_folder(path: Path) -> Problem:
    return Problem("the output is a file, not a folder", str(path), "results are several files", "name a folder")


def exists(path: Path) -> Problem:
    """The problem of an output that is already there."""
    return Problem(
        what="the output exists already",
        where=str(path),
        why="results are never overwritten silently",
        fix="choose another folder, or add overwrite=True to replace it",
    )


def cannot_write(path: Path, error: OSError | ValueError) -> OutputError:
    """The error for a path the system does not let us write, or that can be none."""
    if isinstance(error, (FileExistsError, NotADirectoryError)) and (found := _file_in(path)) is not None:
        return OutputError(_no_folder(found))
    if isinstance(error, FileExistsError) and (link := _link_to_nothing(path)) is not None:
        why = f"it is a link to {os.readlink(link)}, which is not there"
        return OutputError(Problem("cannot write the output", str(link), why, "remove the link, or make what it is to"))
    return OutputError(
        Problem(
            what="cannot write the output",
            where=str(path),
            why=reason(error),
            fix="write a shorter name" if _is_too_long(error) else "choose a folder with room that you may write to",
        )
    )


def _is_too_long(error: OSError | ValueError) -> bool:
    return isinstance(error, OSError) and error.errno == errno.ENAMETOOLONG
