"""Reading a run folder: the record of a run, checked so far that a report can be made of it."""

from __future__ import annotations

import json
import re
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import limits
from ..arrays import FloatArray
from ..documents import parsed
from ..errors import OptionError, Problem, reason
from ..inputs import INPUTS, Role
from ..physics.quantities import STATES
from ..resources import looked_for
from ..run_files import HISTORY, MOTIONS
from ..trial.footer import rows_of
from .forces import NO_SHIP, Ship
from .wording import Channel, clean, input_channel

if TYPE_CHECKING:
    from .blocks import Page

    Motion = Mapping[str, FloatArray]

SCHEMA = 1
_COLUMNS = ("t", *STATES)
_ROLES: tuple[Role, ...] = ("rudder", "propeller", "thruster")
_EVERY_SHIP = ("n", "delta")
"""Inputs of a run whose record does not name them: a ship with one propeller and one rudder."""


_HALF = re.compile(r"\\u[dD][89a-fA-F]")
"""What JSON writes halves of characters as, most of them beside their other half."""


@dataclass(frozen=True)
class Kind:
    """A kind of run that there are reports of.

    name    "kind" of its record, which is the file of that name in the run folder where ``record`` names no other
    needed  keys of the record without which there can be no page
    read    (folder, record file) -> the run as its page wants it
    build   that -> the page
    inside  that -> folders of further runs that the page leads to
    """

    name: str
    needed: tuple[str, ...]
    read: Callable[[Path, Mapping[str, Any]], Any]
    build: Callable[[Any], Page]
    inside: Callable[[Any], Iterable[Path]] = lambda _: ()
    record: str = ""

    @property
    def file(self) -> str:
        """Name of the record's file: sweep.json."""
        return self.record or f"{self.name.replace('-', '_')}.json"


@dataclass(frozen=True)
class RunRecord:
    """A fit as its folder holds it.

    data      fit.json
    history   columns of history.parquet by name; empty where no evolution strategy ran
    motions   trial -> "measured", "before" or "after" -> column -> values in SI
    inputs    what drove the ship, columns of ``motions`` too: rudders, propellers, thrusters
    ship      her length and her model with the tuned coefficients
    """

    folder: Path
    data: Mapping[str, Any]
    history: Mapping[str, FloatArray]
    motions: Mapping[str, Mapping[str, Motion]]
    inputs: tuple[Channel, ...]
    ship: Ship = NO_SHIP

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
    inputs: tuple[Channel, ...] = ()
    ship: Ship = NO_SHIP

    @property
    def results(self) -> list[dict[str, Any]]:
        """The held-out trials' results; where a position jumps they are of parts, which are no windows."""
        piece = {"piece": "part"} if self.data.get("jumped") else {}
        return [{**row, **piece} for row in self.data["trial_results"]]


def find(folder: Path, kinds: Iterable[Kind]) -> tuple[Kind, Any]:
    """The kind of run in a folder, told by the file it holds, and the run as its page wants it.

    Raises OptionError for a folder that is missing, unreadable, not a run folder, or from a newer program.
    """
    if not folder.is_dir():
        raise _problem(
            "there is no such run folder", folder, looked_for(folder), "give the folder that --out of a run named"
        )
    for kind in kinds:
        path = folder / kind.file
        if path.is_file():
            with whole(path):
                return kind, kind.read(folder, _read(path, kind))
    raise _problem(
        "this is not a run folder",
        folder,
        f"it holds none of {', '.join(kind.file for kind in kinds)}",
        "give the folder that --out of a run named; an interrupted run may have written none of them",
    )


def _problem(what: str, where: Path, why: str, fix: str) -> OptionError:
    return OptionError(Problem(what=what, where=str(where), why=why, fix=fix))


@contextmanager
def whole(path: Path) -> Iterator[None]:
    """Where a page is made of a record.

    Raises OptionError where it does not hold what records hold: any program may have written it.
    """
    try:
        yield
    except (
        ArithmeticError,
        AttributeError,
        LookupError,
        RecursionError,
        StopIteration,
        TypeError,
        ValueError,
    ) as error:
        # Deep in the page, so the innermost place says which part of it that was.
        names = [frame.name for frame in traceback.extract_tb(error.__traceback__) if not frame.name.startswith("<")]
        why = f"{reason(error)}, needed for '{names[-1].strip('_').replace('_', ' ')}'"
        fix = "run it again; if nothing but mmgtune wrote there, please report it"
        raise _problem("no report can be made of the run's record", path, why, fix) from error


def _read(path: Path, kind: Kind) -> dict[str, Any]:
    """A record file, with its schema, kind and needed keys checked."""
    again = "run the fit again, or give another folder"
    try:
        text = limits.text(path, limits.RECORD_BYTES, OptionError)
        data = parsed(text)
        if _HALF.search(text):  # no file of a report could hold half a character: a ValueError
            json.dumps(data, ensure_ascii=False).encode()
    except (OSError, ValueError, RecursionError) as error:
        raise _problem("the run's record cannot be read", path, reason(error), again) from error
    if not isinstance(data, dict) or data.get("kind") != kind.name:
        raise _problem(f"this is not the record of a {kind.name}", path, f'it has no "kind": "{kind.name}"', again)
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
    lacking = [key for key in kind.needed if key not in data]
    if lacking:
        raise _problem("the run's record is not whole", path, "it lacks " + ", ".join(lacking), again)
    return data


def inputs_of(folder: Path, data: Mapping[str, Any]) -> tuple[Channel, ...]:
    """The inputs a record names, rudders first, so that every ship's report begins alike."""
    rows = data.get("inputs", [INPUTS[name].to_dict() for name in _EVERY_SHIP])
    keys = ("name", "unit", "words", "role")
    if not isinstance(rows, list) or not all(
        isinstance(row, dict) and all(isinstance(row.get(key), str) for key in keys) for row in rows
    ):
        why = '"inputs" is not a list of ' + ", ".join(keys)
        raise _problem("the run's record is not whole", folder, why, "run the fit again, or give another folder")
    rows = sorted(rows, key=lambda row: _ROLES.index(row["role"]) if row["role"] in _ROLES else len(_ROLES))
    return tuple(input_channel(row["name"], row["words"], row["unit"]) for row in rows)


def history_in(folder: Path) -> dict[str, FloatArray]:
    """Columns of history.parquet by name; empty where there is none."""
    if not (folder / HISTORY).is_file():
        return {}
    columns = _parquet(folder / HISTORY)
    known = {name: values.astype(np.float64) for name, values in columns.items() if values.dtype != object}
    return known if all(len(values) for values in known.values()) else {}


def motions_in(folder: Path, inputs: Sequence[Channel]) -> dict[str, dict[str, Motion]]:
    """The motions of a run folder by trial and which."""
    path = folder / MOTIONS
    if not path.is_file():
        raise _problem(
            "the run folder is not whole", path, "it lacks the measured and simulated motions", "run the fit again"
        )
    columns = _parquet(path)
    names = (*_COLUMNS, *(channel.name for channel in inputs))
    lacking = [name for name in ("trial", "which", *names) if name not in columns]
    if lacking:
        raise _problem("the motions are not whole", path, "columns lack: " + ", ".join(lacking), "run the fit again")
    trials, which = columns["trial"], columns["which"]
    edges = 1 + np.flatnonzero((trials[1:] != trials[:-1]) | (which[1:] != which[:-1]))
    ends = [0, *edges.tolist(), len(trials)] if len(trials) else [0]
    rows: dict[tuple[str, str], list[slice]] = {}
    for first, last in pairwise(ends):
        rows.setdefault((str(trials[first]), str(which[first])), []).append(slice(first, last))
    found: dict[str, dict[str, Motion]] = {}
    for (trial, run), pieces in rows.items():
        found.setdefault(trial, {})[run] = {
            name: np.concatenate([columns[name][piece] for piece in pieces]).astype(np.float64) for name in names
        }
    return found


def columns_in(path: Path, names: Sequence[str], texts: Sequence[str] = ()) -> dict[str, Any]:
    """Columns of a file of the run folder by name, (n_rows,): of numbers, and of texts."""
    if not path.is_file():
        raise _problem("the run folder is not whole", path, "a file of its results is missing", "run it again")
    columns = _parquet(path)
    lacking = [name for name in names if name not in columns]
    if lacking:
        raise _problem("the run's data are not whole", path, "columns lack: " + ", ".join(lacking), "run it again")
    return {name: columns[name].astype(object if name in texts else np.float64) for name in names}


def _parquet(path: Path) -> dict[str, Any]:
    """The columns of a parquet file by name, (n_rows,) each: numbers as they are, NaN for none, and texts as objects.

    Without pandas, which takes longer to import than a page to make; ``read_table`` and ``to_numpy`` would import it.
    """
    import pyarrow.parquet as pq

    try:
        with pq.ParquetFile(path) as file:
            rows_of(file.metadata, path.stat().st_size, str(path), OptionError)
            table = file.read()
        return {name: _column(table.column(name)) for name in table.column_names}
    except OptionError:
        raise
    except Exception as error:
        raise _problem("the run's data cannot be read", path, reason(error), "run the fit again") from error


def _column(column: Any) -> Any:
    """A column of Arrow as an array, (n_rows,)."""
    import pyarrow as pa

    if pa.types.is_integer(column.type) or pa.types.is_floating(column.type):
        if column.null_count:
            return np.array([np.nan if value is None else value for value in column.to_pylist()], dtype=np.float64)
        return np.concatenate([np.empty(0), *(np.from_dlpack(chunk) for chunk in column.chunks)])
    return np.array(column.to_pylist(), dtype=object)
