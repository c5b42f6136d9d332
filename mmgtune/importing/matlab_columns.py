"""Columns of MATLAB files: of vectors, matrices and structures, as people and programs put them together."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import LogError, Problem, among
from ..limits import LOG_COLUMNS
from ..phrases import listed
from .cells import table_of
from .mapping import LogMap
from .matlab import Other, Value, variables
from .table import Table

NAMES = ("colheaders", "variablenames", "columns", "headers", "header", "names", "labels", "channels", "textdata")
"""What texts beside a matrix are called that name its columns, in small letters, the likeliest first."""
LYING = 64
"""Rows up to which a matrix that is far wider than high has a row for each quantity."""
RUN = 4
"""Fields, or columns, that two runs have in common at least."""
_DATEVEC = ((1900, 2200), (1, 12), (1, 31), (0, 24), (0, 59), (0, 60.001))
"""Least and most of the columns that ``datevec`` and ``clock`` make."""


@dataclass(frozen=True)
class Columns:
    """What a file holds as columns of one length.

    names     of the columns; where nothing names those of a matrix, "name 1", "name 2", ..., and "column 1", ... of one
              that was asked for
    columns   numbers (n_rows,), or a list of texts
    other     what else there is that has many values, by name: what it is
    notes     what was found out, in sentences
    variable  the one that is read of several runs, "" where there is one
    """

    names: list[str]
    columns: list[Any]
    other: dict[str, str]
    notes: list[str]
    variable: str = ""


def read_matlab(path: Path, log_map: LogMap) -> Table:
    """The columns of a MATLAB file that a map names.  Raises LogError where it cannot be read or lacks one."""
    import pandas as pd

    found = columns_of(path, log_map.variable)
    columns = [pd.Series(one, dtype="string" if isinstance(one, list) else "float64") for one in found.columns]
    table = table_of(path, log_map, found.names, columns, 1, "row", str(path))
    table.notes += [*([f"read from '{log_map.variable}'"] if log_map.variable else []), *found.notes]
    return table


def columns_of(path: Path, variable: str = "") -> Columns:
    """The columns in a file: of a structure or matrix, or the variables that are equally long vectors.

    variable  which structure or matrix, such as "log", "data.run1" or "run(2)"; "" for all there is, or the first of
              several runs

    Raises LogError where the file cannot be read, or holds none.
    """
    held = variables(path)
    notes: list[str] = []
    several: list[str] = [] if variable else runs_in(held)
    if several:
        variable = several[0]
        shown = listed([f"'{one}'" for one in several], 6)
        notes.append(
            f"the file holds {len(several)} runs, {shown}: '{variable}' is read; "
            f'a map with variable = "{several[1]}" in [log] reads the next'
        )
    found = _spread({"column": _at(held, variable, path)} if variable else held, notes)
    arrays = {name: value for name, value in found.items() if not isinstance(value, Other) and len(value) > 1}
    other = {name: str(value) for name, value in found.items() if isinstance(value, Other)}
    # Constants of a ship or a run stand beside what was logged.
    lengths = [len(value) for value in arrays.values()]
    usual = max(set(lengths), key=lambda length: (lengths.count(length), length), default=0)
    columns = {name: value for name, value in arrays.items() if len(value) == usual}
    uneven = {
        name: f"{len(value)} values"
        for name, value in arrays.items()
        if len(value) != usual and not isinstance(value, list)
    }
    if not columns:
        why = "; ".join(f"'{name}' is a {kind}" for name, kind in list(other.items())[:8]) or "it is empty"
        fix = "save vectors of numbers of one length, a structure of them, or a matrix with a column each"
        raise LogError(Problem("the file holds no columns of numbers", str(path), why, fix))
    LOG_COLUMNS.hold(len(columns), str(path), LogError)
    if uneven:
        shown = listed([f"'{name}' ({of})" for name, of in uneven.items()], 6)
        notes.append(f"left out, as the columns have {usual} rows: {shown}")
    if unread := [f"'{name}' ({kind})" for name, kind in other.items() if "complex" in kind or "dimensions" in kind]:
        notes.append(f"left out: {listed(unread, 6)}")
    return Columns(list(columns), list(columns.values()), other | uneven, notes, several[0] if several else "")


def runs_in(held: Mapping[str, Value], within: str = "") -> list[str]:
    """Names of structures, or of matrices, that hold a run each; empty where there are no two."""
    for name, value in held.items():
        if isinstance(value, list) and isinstance(value[0], dict) and all(map(_holds_time, value)):
            return [f"{within}{name}({k})" for k in range(1, len(value) + 1)]
    kinds: dict[Any, list[str]] = {}
    lengths: dict[Any, set[int]] = {}
    for name, value in held.items():
        if isinstance(value, dict) and len(value) >= RUN and _holds_time(value):
            kinds.setdefault(frozenset(value), []).append(name)
        elif isinstance(value, np.ndarray) and value.ndim == 2 and RUN <= value.shape[1] < value.shape[0]:
            kinds.setdefault(value.shape[1], []).append(name)
            lengths.setdefault(value.shape[1], set()).add(len(value))
    # Matrices as long as each other may hold one run.
    several = [names for kind, names in kinds.items() if len(names) > 1 and len(lengths.get(kind, (1, 2))) > 1]
    if several:
        return [f"{within}{name}" for name in max(several, key=len)]
    inside = [name for name, value in held.items() if isinstance(value, dict)]
    if len(inside) == 1 and not within.count("."):
        value = held[inside[0]]
        return runs_in(value, f"{within}{inside[0]}.") if isinstance(value, dict) else []
    return []


def _holds_time(value: Value) -> bool:
    """Whether a field of a structure rises from value to value."""
    fields = value.values() if isinstance(value, dict) else ()
    vectors = (one.ravel() for one in fields if isinstance(one, np.ndarray) and one.size == max(one.shape) > 2)
    return any(bool((np.diff(one) > 0.0).all()) for one in vectors)


def _at(held: Mapping[str, Value], variable: str, path: Path) -> Value:
    """What stands at "a.b(2)" in a file.  Raises LogError where there is nothing."""
    place = f"{path}, [log] variable of the map"
    value: Value = dict(held)
    for part in variable.split("."):
        name, _, number = part.partition("(")
        if not isinstance(value, dict) or name not in value:
            there = [*value] if isinstance(value, dict) else []
            raise LogError(Problem(f"the file has no variable '{variable[:80]}'", place, **among(name, there)))
        value = value[name]
        if isinstance(value, list) and isinstance(value[0], dict):
            k = int(number[:-1]) if re.fullmatch(r"\d{1,6}\)", number) else 0
            if not 1 <= k <= len(value):
                why, fix = f"'{name}' is an array of {len(value)} structures", f'say which, such as "{name}(1)"'
                raise LogError(Problem(f"the file has no variable '{variable[:80]}'", place, why, fix))
            value = value[k - 1]
    return value


Flat = dict[str, FloatArray | list[str] | Other]


def _spread(held: Mapping[str, Value], notes: list[str]) -> Flat:
    """Vectors by name; fields of structures and columns of matrices on their own; what else there is as words."""
    within = sum(isinstance(value, dict) and _series(value) is None for value in held.values())
    several = within > 1 or any(isinstance(value, np.ndarray) and value.size > 1 for value in held.values())
    out: Flat = {}
    times: FloatArray | None = None
    for name, value in held.items():
        if isinstance(value, dict) and (series := _series(value)) is not None:
            if times is None:
                times = series[0]
                out["Time"] = times
            if not np.array_equal(times, series[0]):
                out[name] = Other("series with times of its own")
                notes.append(f"left out: '{name}', which has times of its own; bring it to those of the others first")
                continue
            out |= _of_matrix(name, series[1], {}, notes)
        elif isinstance(value, dict):
            prefix = f"{name}." if several else ""
            inside = _logged_signals(value, notes) or _spread(value, notes)
            out |= {f"{prefix}{key}": one for key, one in inside.items()}
        elif isinstance(value, np.ndarray):
            out |= _of_matrix(name, value, held, notes)
        elif isinstance(value, list) and isinstance(value[0], dict):
            out[name] = Other(f"array of {len(value)} structures")
        elif isinstance(value, list):
            out[name] = [str(one) for one in value]
        else:
            out[name] = value if isinstance(value, Other) else Other("text")
    return out


def _of_matrix(name: str, value: FloatArray, beside: Mapping[str, Value], notes: list[str]) -> Flat:
    """Columns of a matrix, by what names them beside it; a vector as it is."""
    if value.ndim > 2:
        return {name: Other(f"array of {value.ndim} dimensions")}
    if min(value.shape) <= 1:
        return {name: value.ravel()}
    if value.shape[0] <= LYING and value.shape[1] > 8 * value.shape[0]:
        notes.append(f"'{name}' has {value.shape[0]} rows and {value.shape[1]} columns: each row is read as a column")
        value = value.T
    LOG_COLUMNS.hold(value.shape[1], name[:80], LogError)
    if value.shape[1] == len(_DATEVEC) and all(
        bool(((value[:, k] >= low) & (value[:, k] <= high)).all()) for k, (low, high) in enumerate(_DATEVEC)
    ):
        return {name: [_stamp(row) for row in value]}
    names = _names_beside(beside, value.shape[1])
    return {names[k] if names else f"{name} {k + 1}": value[:, k] for k in range(value.shape[1])}


def _names_beside(beside: Mapping[str, Value], width: int) -> list[str]:
    """Names of the columns of a matrix by texts that stand beside it, [] where none do, or two columns share one."""
    found: dict[str, list[str]] = {}
    for key, value in beside.items():
        if isinstance(value, str):
            parts = next((parts for mark in ",;\t| " if len(parts := re.split(re.escape(mark), value)) == width), [])
            found[key.lower()] = [one.strip() for one in parts]
        elif isinstance(value, list) and all(isinstance(one, str) for one in value):
            found[key.lower()] = [str(one).strip() for one in value]
    fitting = {key: names for key, names in found.items() if len(names) == width and len({*names}) == width}
    fitting = {key: names for key, names in fitting.items() if all(names)}
    named = [fitting[key] for key in NAMES if key in fitting]
    return named[0] if named else next(iter(fitting.values())) if len(fitting) == 1 else []


def _stamp(row: Sequence[float]) -> str:
    """A row of year, month, day, hour, minute and second as a date."""
    year, month, day, hour, minute = (int(one) for one in row[:5])
    return f"{year:04d}-{month:02d}-{day:02d}T{hour:02d}:{minute:02d}:{row[5]:09.6f}"


def _series(value: Mapping[str, Value]) -> tuple[FloatArray, FloatArray] | None:
    """Times (n_rows,) and data (n_rows, n_columns) of a structure that holds them as a timeseries does; else None."""
    fields = {key.lower(): one for key, one in value.items()}
    times, data = fields.get("time"), fields.get("data")
    if not isinstance(times, np.ndarray) or not isinstance(data, np.ndarray) or times.size < 2:
        return None
    if data.size % times.size or data.ndim > 3 or times.size not in data.shape:
        return None
    # Of a scalar signal the times may stand along the last axis.
    return times.ravel(), np.moveaxis(data, data.shape.index(times.size), 0).reshape(times.size, -1)


def _two(values: FloatArray) -> FloatArray:
    """An array with two dimensions at least, and no more that have a single place."""
    squeezed = np.squeeze(values)
    return squeezed if squeezed.ndim > 1 else squeezed.reshape(-1, 1)


def _logged_signals(value: Mapping[str, Value], notes: list[str]) -> Flat:
    """Columns of what Simulink logs as a structure: the time, and signals with a label each; {} where it is no such."""
    signals, times = value.get("signals"), value.get("time")
    several = [signals] if isinstance(signals, dict) else signals if isinstance(signals, list) else []
    out: Flat = {"time": times.ravel()} if isinstance(times, np.ndarray) and times.size > 1 else {}
    for k, one in enumerate(several, 1):
        values = one.get("values") if isinstance(one, dict) else None
        if not isinstance(one, dict) or not isinstance(values, np.ndarray):
            return {}
        label = one.get("label")
        name = label if isinstance(label, str) and label and label not in out else f"signal {k}"
        out |= _of_matrix(name, _two(values), {}, notes) if values.size > 1 else {}
    return out if several else {}
