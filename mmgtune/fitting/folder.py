"""The run folder: everything a fit leaves behind, each file whole or not there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..backends import STATES
from ..documents import write_json
from ..errors import must_be_a
from ..files import (
    all_or_none,
    path_of,
    refuse_existing,
    write_text,
)
from ..parquet_tables import write_table
from ..run_folders import MOTIONS
from .cmaes import Generation
from .comparison import TrialComparison
from .journal import finished
from .result import FitResult

RESULT = "fit.json"


@all_or_none()
def write_run(result: FitResult, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write a run folder; the result last, so that its presence means the rest is there.  Returns its document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    folder = path_of(folder)
    must_be_a(result, FitResult, "result")
    refuse_existing([folder / RESULT, folder / MOTIONS], overwrite)
    write_text(folder / "profile.toml", result.tuned_text())
    write_table(folder / "history.parquet", _history(result.history))
    inputs = [one.name for one in result.profile.arrangement.inputs]
    write_table(folder / MOTIONS, motions_table(result.compared, inputs))
    document = {**result.to_dict(), "out": str(folder)}
    write_document(document, folder)
    if not result.interrupted:
        finished(folder)
    return document


def write_document(document: dict[str, Any], folder: Path) -> None:
    """Write the document of a fit, again where something is added to it."""
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
