"""The run folder: everything a fit leaves behind, each file whole or not there."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..backends import STATES
from ..documents import write_json
from ..errors import OutputError, Problem
from ..files import (
    alone_in,
    cannot_write,
    exists,
    half,
    is_left_over,
    make_folder,
    path_of,
    refuse_existing,
    refuse_file,
    remove_left_overs,
    write_text,
)
from ..tables import write_table
from .checkpoint import RESULTS
from .cmaes import Generation
from .comparison import TrialComparison
from .journal import finished
from .result import FitResult

RESULT = "fit.json"
MARKS = (
    *RESULTS,
    "validate.json",
    "simulate.json",
    "comparison.json",
    "model_comparison.json",
    "predict.json",
    "plan.json",
    "heading_keeping.json",
    "bands.parquet",
    "tracks.parquet",
    "mixture.json",
    "model.safetensors",
    "posterior.json",
    "particles.parquet",
    "windows.parquet",
    "drawn.parquet",
    "journal.jsonl",
    "checkpoint.npz",
)
"""What tells a run folder: files that nobody else has."""

BESIDE = ("profile.toml", "calm.toml", "history.parquet", "motions.parquet", "report.html", "report.md")
"""What lies beside them, and may be somebody's own where they are not."""

FIGURES = "figures"

CHECKPOINTS = "training-*.safetensors"
"""What is left of a training that was stopped before it had a result."""


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
    own = any((folder / name).exists() for name in MARKS) or any(folder.glob(CHECKPOINTS))
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
        *folder.glob(f"{FIGURES}/*.svg"),
        *folder.glob(CHECKPOINTS),
    ]
    return {path: (path.stat().st_ino, path.stat().st_mtime_ns) for path in there if path.is_file()}


@contextlib.contextmanager
def claimed(folder: Path, *, force: bool = False, resume: bool = False, anew: bool = False) -> Iterator[Path]:
    """The folder made ready as by ``prepare``, and no other run's while the context lasts.

    anew  what runs before left there goes at the end where ``force`` let this one in: a report or a ship of another
          run would be taken for its own

    Raises OutputError as ``prepare`` does, and where another run is writing there.
    """
    refuse_file(folder)
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


def write_run(result: FitResult, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write a run folder; the result last, so that its presence means the rest is there.  Returns its document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    folder = path_of(folder)
    refuse_existing([folder / RESULT], overwrite)
    write_text(folder / "profile.toml", result.tuned_text())
    write_table(folder / "history.parquet", _history(result.history))
    inputs = [one.name for one in result.profile.arrangement.inputs]
    write_table(folder / "motions.parquet", motions_table(result.compared, inputs))
    document = {**result.to_dict(), "out": str(folder)}
    write_document(document, folder)
    if not result.interrupted:
        finished(folder)
    return document


def write_document(document: dict[str, Any], folder: Path) -> None:
    """Write the document of a fit, anew where something is added to it."""
    write_json(document, folder / RESULT)


def _history(history: Iterable[Generation]) -> dict[str, Any]:
    rows = list(history)
    names = ("restart", "generation", "evaluations", "population", "J", "J_best", "sigma")
    columns: dict[str, Any] = {name: [getattr(row, name) for row in rows] for name in names}
    columns["lambda"] = columns.pop("population")
    columns["J_generation"] = columns.pop("J")
    return columns


def motions_table(compared: Sequence[TrialComparison], inputs: Sequence[str]) -> dict[str, Any]:
    """Columns of motions.parquet: every trial measured, before and after, with what drove the ship."""
    parts: dict[str, list[Any]] = {name: [] for name in ("trial", "which", "t", *STATES, *inputs)}
    for one in compared:
        trial = one.trial
        runs = {"measured": trial.motion, **{which: motion.states for which, motion in one.motions.items()}}
        driven = dict(zip(inputs, trial.inputs(inputs).T, strict=True))
        for which, states in runs.items():
            parts["trial"].append(np.full(trial.n_samples, trial.id, dtype=object))
            parts["which"].append(np.full(trial.n_samples, which, dtype=object))
            for name, values in zip(STATES, states.T, strict=True):
                parts[name].append(values)
            for name, values in {"t": trial.t, **driven}.items():
                parts[name].append(values)
    if not compared:
        texts = ("trial", "which")
        return {name: np.zeros(0, dtype=str if name in texts else float) for name in parts}
    return {name: np.concatenate(values) for name, values in parts.items()}
