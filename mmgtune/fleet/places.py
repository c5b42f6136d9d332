"""Where trials lie: files of this machine or a shared folder, or URLs that fsspec knows, such as s3://bucket/logs."""

from __future__ import annotations

import contextlib
import hashlib
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import OptionError, Problem, TrialError
from ..files import require_regular

EXTRA = "pip install 'mmgtune[cluster]'"
"""What brings fsspec and Dask."""

READ = (".parquet", ".toml")
"""Endings of files that data sets are made of."""

_URL = re.compile(r"[a-z][a-z0-9+]*://")


def is_url(place: str) -> bool:
    """Whether a place is not a path."""
    return _URL.match(place) is not None


def matching(pattern: str, base: Path) -> list[str]:
    """Paths or URLs that a pattern with ``*`` matches, sorted; paths are taken from ``base``, and are absolute."""
    if is_url(pattern):
        system, inner = _system(pattern)
        with _reading(pattern):
            return sorted(str(system.unstrip_protocol(one)) for one in system.glob(inner))
    path = Path(pattern)
    root, inner = (Path(path.anchor), str(path.relative_to(path.anchor))) if path.is_absolute() else (base, pattern)
    literal = re.sub(r"[\[?]", r"[\g<0>]", inner)  # of what globs know, patterns have * alone
    return sorted(str(one.absolute()) for one in root.glob(literal)) if inner not in ("", ".") else [str(root)]


def hashes(place: str) -> dict[str, str]:
    """What tells the content of a file, or of the files of a folder, from another: by name, sorted.

    SHA-256 of files; of a URL what its file system says of the content, which it need not be read for.  Raises
    TrialError where it cannot be read.
    """
    if is_url(place):
        system, inner = _system(place)
        with _reading(place):
            found = system.ls(inner, detail=False) if system.isdir(inner) else [inner]
            return {name_of(one): f"checksum {system.checksum(one)}" for one in sorted(found) if _is_read(one)}
    path = Path(place)
    files = [one for one in sorted(path.iterdir()) if _is_read(one.name)] if path.is_dir() else [path]
    found_here: dict[str, str] = {}
    for file in files:
        try:
            require_regular(file)
            with file.open("rb") as opened:
                found_here[file.name] = hashlib.file_digest(opened, "sha256").hexdigest()
        except OSError as error:
            fix = "check that it is there, and that you may read it"
            raise TrialError(Problem("the trials cannot be read", str(file), error.strerror or "", fix)) from error
    return found_here


@contextlib.contextmanager
def fetched(place: str) -> Iterator[Path]:
    """The path of a place; of a URL that of a copy, for as long as the context lasts."""
    if not is_url(place):
        yield Path(place)
        return
    system, inner = _system(place)
    with tempfile.TemporaryDirectory(prefix="mmgtune-") as folder:
        with _reading(place):
            is_folder = system.isdir(inner)
            own = Path(folder) / name_of(inner)
            if is_folder:
                own.mkdir()
            for one in system.ls(inner, detail=False) if is_folder else [inner]:
                if _is_read(one):
                    system.get_file(one, str(own / name_of(one) if is_folder else own))
        yield own


def name_of(place: str) -> str:
    """The last part of a path or URL."""
    return place.rstrip("/").rsplit("/", 1)[-1]


def _is_read(name: str) -> bool:
    last = name_of(name)
    return last.endswith(READ) and not last.startswith(".")


def _system(url: str) -> tuple[Any, str]:
    """The file system of a URL and the path in it.  Raises OptionError where what reads it is not installed."""
    try:
        import fsspec

        system, inner = fsspec.core.url_to_fs(url)
    except ImportError as error:
        what = "trials at a URL need what is not installed"
        fix = EXTRA if "fsspec" in str(error) and "s3" not in str(error) else f"{EXTRA}, and: {error}"
        raise OptionError(Problem(what, url, str(error), fix)) from error
    except ValueError as error:
        raise OptionError(Problem("no file system is known for the URL", url, str(error))) from error
    return system, str(inner)


@contextlib.contextmanager
def _reading(url: str) -> Iterator[None]:
    try:
        yield
    except Exception as error:  # clients of stores have errors of their own: no credentials, nobody there
        fix = "check the URL, and that you may read it from here"
        why = str(error) or type(error).__name__
        raise TrialError(Problem("the URL cannot be read", url, why, fix)) from error
