"""The folder that compiled kernels are kept in.

What lies there is run, and read by unpickling, so it must be this user's: a folder that belongs to another or that
others may write to is not used, nor is a file like that, and what is not as it was written is made anew.
"""

from __future__ import annotations

import atexit
import functools
import hashlib
import os
import shutil
import stat
import sys
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..files import write_text

OTHERS = stat.S_IWGRP | stat.S_IWOTH


class KernelFolderWarning(UserWarning):
    """Kernels are not kept, so that every run compiles."""


def kernel_folder() -> Path:
    """Where kernels are kept: MMGTUNE_CACHE, else the user's cache folder, else a new one that ends with the process.

    Warns where a folder is there and is not used, since others may put code into it.
    """
    folder = wanted_folder()
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK):
            return _temporary()
    except OSError:
        return _temporary()
    why = distrusted(folder)
    if why:
        fix = "remove it or name another in MMGTUNE_CACHE"
        warnings.warn(f"compiled kernels are not kept in {folder}: {why}; {fix}", KernelFolderWarning, stacklevel=2)
        return _temporary()
    return folder


def wanted_folder() -> Path:
    """Where kernels would be kept if all is well there."""
    from platformdirs import user_cache_path

    chosen = os.environ.get("MMGTUNE_CACHE")
    return (Path(chosen).absolute() if chosen else user_cache_path("mmgtune")) / "kernels"


def distrusted(path: Path) -> str:
    """Why others may have put something into a folder or a file, "" where they cannot have.

    Folders above it count where all may write to them; those of the user's own group may.
    """
    if sys.platform == "win32":
        return ""
    found = path.lstat()
    if found.st_uid != os.geteuid():
        return f"{path} belongs to another user"
    if not stat.S_ISLNK(found.st_mode) and found.st_mode & OTHERS:
        return f"others may write to {path}"
    if stat.S_ISDIR(found.st_mode):
        for above in path.resolve().parents:
            mode = above.stat().st_mode
            if mode & stat.S_IWOTH and not mode & stat.S_ISVTX:
                return f"all may write to {above}"
        return ""
    return "" if stat.S_ISREG(found.st_mode) else f"{path} is no plain file"


@functools.cache
def _temporary() -> Path:
    folder = Path(tempfile.mkdtemp(prefix="mmgtune-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@contextmanager
def alone(path: Path) -> Iterator[None]:
    """No other process is inside for the same path, where there are such locks; a lock dies with its holder."""
    with path.open("w") as file:
        if sys.platform != "win32":
            import fcntl

            with suppress(OSError):  # some network folders have none: then a kernel may be compiled twice
                fcntl.flock(file, fcntl.LOCK_EX)
        yield


class Entry:
    """What the compiler keeps of one kernel, with the sums of its files; for use by one process at a time.

    folder, name  where it keeps files whose names begin with ``name`` and a dot
    """

    def __init__(self, folder: Path, name: str):
        self.folder, self.name = folder, name
        self._sums = folder / f"{name}.sums"

    @property
    def sealed(self) -> bool:
        """Whether there is one; it may have been broken since."""
        return self._sums.is_file()

    def clean(self) -> None:
        """Throw everything away where a file is not as it was written, or not surely this user's."""
        try:
            whole = self._sums.read_text(encoding="ascii") == self._summed()
        except (OSError, UnicodeDecodeError):
            whole = False
        if not whole or any(distrusted(path) for path in (self._sums, *self._files())):
            for path in (*self._files(), self._sums):
                path.unlink(missing_ok=True)

    def seal(self) -> None:
        """Note what the files are now."""
        text = self._summed()
        if not self._sums.exists() or self._sums.read_text(encoding="ascii") != text:
            write_text(self._sums, text)

    def _files(self) -> list[Path]:
        return sorted(path for path in self.folder.glob(f"{self.name}.*") if path.suffix in (".nbi", ".nbc"))

    def _summed(self) -> str:
        return "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in self._files())
