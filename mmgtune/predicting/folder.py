"""What a prediction leaves behind."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..backends import STATES
from ..parquet_tables import write_table
from ..run_files import BANDS, PATHS, PREDICTION, TRACKS
from ..writing_results import place_for, write_record
from .result import Predicted

FAN = ("mean", "low", "q25", "median", "q75", "high")

DRAWN, POINTS = 40, 150
"""Particles whose tracks are kept to be drawn, and places of each."""


def write_prediction(
    result: Predicted,
    folder: Path | str,
    command: str = "",
    *,
    keep_particles: bool = False,
    overwrite: bool = False,
) -> dict[str, Any]:
    """Write the record, the bands and some tracks into a run folder; all particles too where they are to be kept.

    Returns the record.  Raises OutputError where one is there already and ``overwrite`` is false, or the system refuses
    to write.
    """
    with place_for(result, Predicted, folder, PREDICTION, overwrite=overwrite) as place:
        _write(place / BANDS, _bands(result), ("run", "variable", "t", *FAN, "measured"))
        _write(place / TRACKS, _tracks(result, ("x", "y"), DRAWN, POINTS), ("run", "particle", "t", "x", "y"))
        if keep_particles:
            _write(place / PATHS, _tracks(result, STATES), ("run", "particle", "t", *STATES, "diverged"))
        return write_record(result.to_dict(command), place, PREDICTION)


def _bands(result: Predicted) -> list[dict[str, Any]]:
    """Columns of each run and state: t, mean, low, q25, median, q75, high, measured."""
    found = []
    for run in result.runs:
        for k, name in enumerate(STATES):
            band = run.band(name, result.level)
            if not band:
                continue
            measured = run.trial.motion[:, k] if run.trial else np.full(len(run.t), np.nan)
            n = len(run.t)
            found.append(
                {"run": _text(run.id, n), "variable": _text(name, n), "t": run.t, **band, "measured": measured}
            )
    return found


def _tracks(result: Predicted, names: tuple[str, ...], most: int = 0, points: int = 0) -> list[dict[str, Any]]:
    """Columns of each run and particle: t and states; at most so many particles and places, all where 0."""
    found = []
    for run in result.runs:
        few = np.arange(len(run.states))
        kept = few[~run.diverged]
        if most and len(kept) > most:
            kept = kept[np.linspace(0, len(kept) - 1, most).round().astype(int)]
        n = len(run.t)
        at = np.unique(np.linspace(0, n - 1, min(points, n)).round().astype(int)) if points else np.arange(n)
        for k in kept if most else few:
            states = {name: run.states[k, at, STATES.index(name)] for name in names}
            own = {"run": _text(run.id, len(at)), "particle": np.full(len(at), k), "t": run.t[at]}
            found.append({**own, **states, "diverged": np.full(len(at), run.diverged[k])})
    return found


def _text(word: str, n: int) -> Any:
    return np.full(n, word, dtype=object)


def _write(path: Path, parts: list[dict[str, Any]], names: tuple[str, ...]) -> None:
    """These columns of all parts below each other; without parts the columns are empty."""
    write_table(path, {name: np.concatenate([one[name] for one in parts]) if parts else [] for name in names})
