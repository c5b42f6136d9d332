"""Reading a run folder: the record of a fit or of a sweep, checked so far that a report can be made of it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..arrays import FloatArray
from ..errors import OptionError, Problem
from ..inputs import INPUTS, Role
from ..physics.quantities import STATES
from .wording import Channel, clean, input_channel

if TYPE_CHECKING:
    Motion = Mapping[str, FloatArray]

SCHEMA = 1
_COLUMNS = ("t", *STATES)
_ROLES: tuple[Role, ...] = ("rudder", "propeller", "thruster")
_EVERY_SHIP = ("n", "delta")
"""Inputs of a run whose record does not name them: a ship with one propeller and one rudder."""
_NEEDED = {
    "fit": ("profile", "trials", "options", "J_tune", "coefficients", "trial_results"),
    "sweep": ("profile", "trials", "runs", "recommended"),
    "diagnosis": ("profile", "trials", "verdict", "sentence", "causes", "candidates", "gain", "trial_results"),
}


@dataclass(frozen=True)
class RunRecord:
    """A fit as its folder holds it.

    data      fit.json
    history   columns of history.parquet by name; empty where no evolution strategy ran
    motions   trial -> "measured", "before" or "after" -> column -> values in SI
    inputs    what drove the ship, columns of ``motions`` too: rudders, propellers, thrusters
    """

    folder: Path
    data: Mapping[str, Any]
    history: Mapping[str, FloatArray]
    motions: Mapping[str, Mapping[str, Motion]]
    inputs: tuple[Channel, ...]

    @property
    def results(self) -> list[dict[str, Any]]:
        """The trials' results, in the order of the data set."""
        return list(self.data["trial_results"])

    @property
    def coefficients(self) -> list[dict[str, Any]]:
        """The tuned coefficients."""
        return list(self.data["coefficients"])


@dataclass(frozen=True)
class SweepRecord:
    """A sweep as its folder holds it: sweep.json."""

    folder: Path
    data: Mapping[str, Any]

    @property
    def runs(self) -> list[dict[str, Any]]:
        """The runs, narrowest range first."""
        return sorted(self.data["runs"], key=lambda run: float(run["a_r"]))


@dataclass(frozen=True)
class DiagnosisRecord:
    """A diagnosis as its folder holds it: diagnosis.json, and the held-out motions as in ``RunRecord``."""

    folder: Path
    data: Mapping[str, Any]
    motions: Mapping[str, Mapping[str, Motion]]

    @property
    def results(self) -> list[dict[str, Any]]:
        """The held-out trials' results."""
        return list(self.data["trial_results"])


def load(folder: Path) -> RunRecord | SweepRecord | DiagnosisRecord:
    """The record in a run folder, told apart by the file it holds.

    Raises OptionError for a folder that is missing, unreadable, not a run folder, or from a newer program.
    """
    if not folder.is_dir():
        raise _problem(
            "there is no such run folder", folder, "", "give the folder that --out of a fit or a sweep named"
        )
    for kind in ("diagnosis", "sweep", "fit"):
        path = folder / f"{kind}.json"
        if path.is_file():
            data = _read(path, kind)
            if kind == "diagnosis":
                return DiagnosisRecord(folder, data, _motions(folder, _inputs(data, path)))
            return SweepRecord(folder, data) if kind == "sweep" else _run(path, data)
    raise _problem(
        "this is not a run folder",
        folder,
        "it holds neither fit.json nor sweep.json nor diagnosis.json",
        "give the folder that --out of a fit or a sweep named; an interrupted run may have written neither",
    )


def _problem(what: str, where: Path, why: str, fix: str) -> OptionError:
    return OptionError(Problem(what=what, where=str(where), why=why, fix=fix))


def _read(path: Path, kind: str) -> dict[str, Any]:
    """A record file, with its schema, kind and needed keys checked."""
    again = "run the fit again, or give another folder"
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise _problem("the run's record cannot be read", path, str(error), again) from error
    if not isinstance(data, dict) or data.get("kind") != kind:
        raise _problem(f"this is not the record of a {kind}", path, f'it has no "kind": "{kind}"', again)
    schema = data.get("schema")
    if not isinstance(schema, int):
        raise _problem("the run's record has no schema number", path, "it cannot be told how to read it", again)
    if schema > SCHEMA:
        raise _problem(
            "the run was made by a newer mmgtune",
            path,
            f"its record has schema {schema}; this version reads up to {SCHEMA}",
            f"update mmgtune to {clean(data.get('mmgtune', 'the version that made it'))} or later",
        )
    lacking = [key for key in _NEEDED[kind] if key not in data]
    if lacking:
        raise _problem("the run's record is not whole", path, "it lacks " + ", ".join(lacking), again)
    return data


def _inputs(data: Mapping[str, Any], path: Path) -> tuple[Channel, ...]:
    """The inputs a record names, rudders first, so that every ship's report begins alike."""
    rows = data.get("inputs", [INPUTS[name].to_dict() for name in _EVERY_SHIP])
    keys = ("name", "unit", "words", "role")
    if not isinstance(rows, list) or not all(
        isinstance(row, dict) and all(isinstance(row.get(key), str) for key in keys) for row in rows
    ):
        why = '"inputs" is not a list of ' + ", ".join(keys)
        raise _problem("the run's record is not whole", path, why, "run the fit again, or give another folder")
    rows = sorted(rows, key=lambda row: _ROLES.index(row["role"]) if row["role"] in _ROLES else len(_ROLES))
    return tuple(input_channel(row["name"], row["words"], row["unit"]) for row in rows)


def _run(path: Path, data: Mapping[str, Any]) -> RunRecord:
    import numpy as np

    folder = path.parent
    inputs = _inputs(data, path)
    history: dict[str, FloatArray] = {}
    if (folder / "history.parquet").is_file():
        frame = _parquet(folder / "history.parquet")
        history = {str(name): frame[name].to_numpy(dtype=np.float64) for name in frame.columns} if len(frame) else {}
    return RunRecord(folder, data, history, _motions(folder, inputs), inputs)


def _motions(folder: Path, inputs: Sequence[Channel]) -> dict[str, dict[str, Motion]]:
    """The motions of a run folder by trial and which."""
    import numpy as np

    path = folder / "motions.parquet"
    if not path.is_file():
        raise _problem(
            "the run folder is not whole", path, "it lacks the measured and simulated motions", "run the fit again"
        )
    frame = _parquet(path)
    names = (*_COLUMNS, *(channel.name for channel in inputs))
    lacking = [name for name in ("trial", "which", *names) if name not in frame.columns]
    if lacking:
        raise _problem("the motions are not whole", path, "columns lack: " + ", ".join(lacking), "run the fit again")
    motions: dict[str, dict[str, Motion]] = {}
    for (trial, which), rows in frame.groupby(["trial", "which"], sort=False, observed=True):
        columns = {name: rows[name].to_numpy(dtype=np.float64) for name in names}
        motions.setdefault(str(trial), {})[str(which)] = columns
    return motions


def _parquet(path: Path) -> Any:
    """A parquet file as a data frame."""
    import pandas as pd

    try:
        return pd.read_parquet(path)
    except Exception as error:
        raise _problem("the run's data cannot be read", path, str(error), "run the fit again") from error
