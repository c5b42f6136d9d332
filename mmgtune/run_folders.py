"""Run folders: what tells one, and one run at a time in each."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator
from contextvars import ContextVar
from pathlib import Path

from . import run_files as names
from .errors import OutputError, Problem
from .files import (
    alone_in,
    cannot_write,
    exists,
    half,
    is_left_over,
    make_folder,
    refuse_file,
    remove_left_overs,
)

RESULTS = (
    names.FIT,
    names.SWEEP,
    names.DIAGNOSIS,
    names.LEFT_OUT,
    names.VOYAGES,
    names.LEARNING,
    names.ENSEMBLE,
    names.HYBRID,
)
"""Results of runs that can be resumed: one is there once its run has ended."""

MARKS = (
    *RESULTS,
    names.VALIDATION,
    names.CHECKED,
    names.SIMULATION,
    names.COMPARISON,
    names.MODEL_COMPARISON,
    names.PREDICTION,
    names.PLAN,
    names.HEADING_STUDY,
    names.BANDS,
    names.TRACKS,
    names.MIXTURE,
    names.MODEL,
    names.POSTERIOR,
    names.PARTICLES,
    names.WINDOWS,
    names.DRAWN_WINDOWS,
    names.JOURNAL,
    names.POSTERIOR_JOURNAL,
    names.CHECKPOINT,
)
"""What tells a run folder: files that nobody else has."""

BESIDE = (
    names.PROFILE,
    names.CALM,
    names.HISTORY,
    names.MOTIONS,
    names.REPORT_HTML,
    names.REPORT_MARKDOWN,
)
"""What lies beside them, and may be somebody's own where they are not."""


_KEPT: ContextVar[list[Path] | None] = ContextVar("kept", default=None)


def remove_kept(paths: Iterable[Path]) -> None:
    """Delete what a run would be continued from, its result being written; within ``kept`` that is noted alone."""
    noted = _KEPT.get()
    if noted is not None:
        noted += paths
        return
    for path in paths:
        path.unlink(missing_ok=True)


@contextlib.contextmanager
def kept() -> Iterator[list[Path]]:
    """What a run would be continued from stays within this context, for whoever has more to write than its result.

    What is noted on the way is to be deleted once all of it is written.
    """
    noted: list[Path] = []
    token = _KEPT.set(noted)
    try:
        yield noted
    finally:
        _KEPT.reset(token)


def prepare(folder: Path, *, force: bool = False, resume: bool = False) -> Path:
    """Make sure results can be written to ``folder``, before any work is done.

    Raises OutputError as ``refuse_taken`` does, and where the folder cannot be written to.
    """
    refuse_taken(folder, force=force, resume=resume)
    make_folder(folder)
    if not os.access(folder, os.W_OK):
        raise cannot_write(folder, PermissionError(13, "permission denied"))
    with half(folder / "writable"):
        pass
    return folder


def refuse_taken(folder: Path, *, force: bool = False, resume: bool = False) -> None:
    """Refuse a folder that results cannot go to, and leave everything as it is.

    What a run that was killed left half-written counts for nothing.
    Raises OutputError where it holds results already (unless ``force`` or ``resume``), or is a file.
    """
    refuse_file(folder)
    taken = folder.is_dir() and any(not is_left_over(one) for one in folder.iterdir())
    if taken and not (force or resume):
        raise OutputError(exists(folder))
    own = any((folder / name).exists() for name in MARKS) or any(folder.glob(names.CHECKPOINTS))
    if taken and force and not own:
        raise OutputError(
            Problem(
                "the folder holds files that are not a run of mmgtune",
                str(folder),
                "force=True would mix them",
                "choose another folder",
            )
        )


def _left_before(folder: Path) -> dict[Path, tuple[int, int]]:
    """What runs before left in a folder: each file with what changes when it is written anew."""
    there = [
        *(folder / name for name in (*MARKS, *BESIDE)),
        *folder.glob(f"{names.FIGURES}/*.svg"),
        *folder.glob(names.CHECKPOINTS),
    ]
    return {path: (path.stat().st_ino, path.stat().st_mtime_ns) for path in there if path.is_file()}


def _refuse_read(folder: Path, reads: Iterable[str | None]) -> None:
    """Raises OutputError where what a command reads lies in the folder whose files it is to replace."""
    for given in reads:
        path = Path(given) if given else None
        with contextlib.suppress(OSError, ValueError):
            if path and path.exists() and folder.resolve() in (path.resolve(), path.resolve().parent):
                why = "force=True would replace what is read, or take it away with what runs before left there"
                raise OutputError(Problem("the folder holds what is read", str(path), why, "choose another folder"))


@contextlib.contextmanager
def claimed(
    folder: Path,
    *,
    force: bool = False,
    resume: bool = False,
    anew: bool = False,
    reads: Iterable[str | None] = (),
) -> Iterator[Path]:
    """The folder made ready as by ``prepare``, and no other run's while the context lasts.

    anew   what runs before left there goes at the end where ``force`` let this one in: a report or a ship of another
           run would be taken for its own
    reads  paths, or names, of what the run is made from: that is not to go

    Raises OutputError as ``prepare`` does, where another run is writing there, and where what is read would go.
    """
    refuse_file(folder)
    if anew and force:
        _refuse_read(folder, reads)
    made = [one for one in (folder, *folder.parents) if not one.exists()]
    if made:
        make_folder(folder)
    with alone_in(folder):
        try:
            prepare(folder, force=force, resume=resume)
            remove_left_overs(folder)
            before = _left_before(folder) if anew and force and not resume else {}
            yield folder
            after = _left_before(folder)
            for path, written in before.items():
                if after.get(path) == written:
                    path.unlink(missing_ok=True)
        except BaseException:
            with contextlib.suppress(OSError):  # of a command that is refused no empty folder stays
                for one in made:  # it goes while nobody else can have it
                    one.rmdir()
            raise
