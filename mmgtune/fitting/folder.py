"""The run folder: everything a fit leaves behind, each file whole or not there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..backends import STATES
from ..files import write_text
from ..parquet_tables import write_table
from ..run_files import FIT, HISTORY, MOTIONS, PROFILE
from ..writing_results import place_for, write_record
from .cmaes import Generation
from .comparison import TrialComparison
from .journal import finished
from .result import FitResult


def write_run(result: FitResult, folder: Path | str, *, overwrite: bool = False) -> dict[str, Any]:
    """Write a run folder; the result last, so that its presence means the rest is there.  Returns its document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, FitResult, folder, FIT, MOTIONS, overwrite=overwrite) as place:
        write_text(place / PROFILE, result.tuned_text())
        write_table(place / HISTORY, _history(result.history))
        inputs = [one.name for one in result.profile.arrangement.inputs]
        write_table(place / MOTIONS, motions_table(result.compared, inputs))
        document = write_record(result.to_dict(), place, FIT)
        if not result.interrupted:
            finished(place)
        return document


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
