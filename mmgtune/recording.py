"""Run folders of what is computed in one go, a simulation or a validation, so that it has a report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from .arrays import FloatArray
from .files import write_text
from .inputs import INPUTS
from .motions import Motion, motions, orders_of
from .parquet_tables import write_table
from .physics.quantities import STATES
from .predictor import Predictor, profile_of
from .provenance import made_by
from .run_files import DRAWN, MOTIONS, PROFILE, SIMULATION, VALIDATION
from .simulating import Simulated
from .trial import Trial
from .validating import Validation
from .writing_results import place_for, write_record

MOST = 400
"""Trials or windows whose motions are kept for the report of a validation."""


def write_simulation(
    result: Simulated, folder: Path | str, command: str = "", *, overwrite: bool = False
) -> dict[str, Any]:
    """Write simulate.json, and the motions its report draws; ``result.write`` makes trial files.  Returns the document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    drawn = f"{DRAWN}/{MOTIONS}"
    with place_for(result, Simulated, folder, SIMULATION, drawn, overwrite=overwrite) as place:
        write_table(place / drawn, _simulated(result))
        if result.ship is not None:
            write_text(place / DRAWN / PROFILE, result.ship.text)
        document = {
            **result.to_dict(),
            **made_by(command),
            "ship": result.ship.name if result.ship else result.predictor.name,
            "L_pp": result.predictor.L_pp,
            "inputs": [INPUTS[name].to_dict() for name in result.predictor.inputs],
        }
        return write_record(document, place, SIMULATION)


def _simulated(result: Simulated) -> dict[str, Any]:
    """Columns of motions.parquet: the runs of the first member, and beside them the trials they are of."""
    measured = [record.measured.trial if record else None for record in result.records or [None] * len(result.motions)]
    columns = _columns(result.predictor.inputs)
    seen: set[str] = set()
    for motion, trial in zip(result.motions, measured, strict=True):
        if trial is not None and trial.id not in seen:
            _add(columns, motion.id, "measured", trial.t, trial.motion, trial.inputs(result.predictor.inputs))
            seen.add(trial.id)
        if motion.member == 0:
            _add(columns, motion.id, "simulated", motion.t, motion.states, motion.controls)
    return _joined(columns)


def write_validation(
    result: Validation, folder: Path | str, command: str = "", *, overwrite: bool = False
) -> dict[str, Any]:
    """Write validate.json, and the motions of the first member of each predictor.  Returns the document.

    Raises OutputError where a result is there already and ``overwrite`` is false, or the system refuses to write.
    """
    with place_for(result, Validation, folder, VALIDATION, MOTIONS, overwrite=overwrite) as place:
        pieces = result.pieces[:MOST]
        offsets = {one.name: one.offsets[: len(pieces)] for one in result.profiles if one.offsets is not None}
        names = write_motions({one.name: one.predictor for one in result.profiles}, pieces, place, offsets)
        ships = [profile for one in result.profiles if (profile := profile_of(one.predictor)) is not None]
        document = {
            **result.to_dict(),
            **made_by(command),
            "ship": ships[0].name if ships else result.profiles[0].predictor.name,
            "L_pp": result.profiles[0].predictor.L_pp,
            "sources": {trial.id: trial.source for trial in pieces},
            "inputs": [INPUTS[name].to_dict() for name in names],
            "orders": orders_of(result.whole[:MOST], result.profiles[0].predictor.L_pp),
        }
        return write_record(document, place, VALIDATION)


def write_motions(
    models: Mapping[str, Predictor],
    pieces: Sequence[Trial],
    folder: Path,
    offsets: Mapping[str, FloatArray] = MappingProxyType({}),
) -> list[str]:
    """Write motions.parquet: trials as measured, and as the first member of each model makes them.

    offsets  (n_pieces, 6) added to the first measured states, by name of the models that have some

    Returns the names of what drives the models, of which there is a column each.
    """
    names = list(dict.fromkeys(name for predictor in models.values() for name in predictor.inputs))
    columns = _columns(names)
    for trial in pieces:
        _add(columns, trial.id, "measured", trial.t, trial.motion, trial.inputs(names))
    for called, predictor in models.items():
        for motion in _first_members(motions(predictor, pieces, offsets.get(called))):
            given = dict(zip(predictor.inputs, motion.controls.T, strict=True))
            driven = np.column_stack([given.get(name, np.full(len(motion.t), np.nan)) for name in names])
            _add(columns, motion.id, called, motion.t, motion.states, driven)
    write_table(folder / MOTIONS, _joined(columns))
    return names


def _first_members(several: Iterable[Motion]) -> list[Motion]:
    return [motion for motion in several if motion.member == 0]


def _columns(inputs: Sequence[str]) -> dict[str, list[Any]]:
    return {name: [] for name in ("trial", "which", "t", *STATES, *inputs)}


def _add(columns: dict[str, list[Any]], id: str, which: str, t: Any, states: Any, controls: Any) -> None:
    """A motion: t (n,), states (n, 6), controls (n, n_inputs)."""
    values = [np.full(len(t), id, dtype=object), np.full(len(t), which, dtype=object), t, *states.T, *controls.T]
    for column, value in zip(columns.values(), values, strict=True):
        column.append(value)


def _joined(columns: Mapping[str, list[Any]]) -> dict[str, Any]:
    empty = {"trial": np.zeros(0, dtype=str), "which": np.zeros(0, dtype=str)}
    return {
        name: np.concatenate(values) if values else empty.get(name, np.zeros(0)) for name, values in columns.items()
    }
