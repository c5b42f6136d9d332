"""Columns of MATLAB files: of vectors, matrices and structures, as people and programs put them together."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import LogError, Problem, among
from ...limits import LOG_COLUMNS, LOG_RUNS
from ...phrases import listed
from ..cells.numerals import holds_numbers
from ..maps.mapping import LogMap
from .in_memory import table_of
from .joining import Apart, Joined, Part, joined
from .matlab import Other, Value, variables
from .table import Table

NAMES = ("colheaders", "variablenames", "columns", "headers", "header", "names", "labels", "channels", "textdata")
"""What texts beside a matrix are called that name its columns, in small letters, the likeliest first."""
LYING = 64
"""Rows up to which a matrix that is far wider than high has a row for each quantity."""
RUN = 4
"""Fields, or columns, that two runs have in common at least."""
RISING = 0.9
"""Share of steps that go up from which numbers may be time."""
TIMES = ("t", "time", "times", "timestamp", "seconds")
"""What a column of times is called in a structure, in small letters."""
EPOCH = 1e5
"""Difference of two first times, in their unit, from which these are counted from another beginning."""
LATER = 0.25
"""Steps by which the times of a structure are usually off those of another one from which they are times of their own:
a clock that is read a little later in each row is not, a sensor that is read half a step later is."""
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
    """The columns in a file, as ``columns_in`` has them.  Raises LogError where it cannot be read too."""
    return columns_in(variables(path), path, variable)


def columns_in(held: Mapping[str, Value], path: Path, variable: str = "") -> Columns:
    """The columns in what a file holds: of a structure or matrix, or the variables that are equally long vectors.

    variable  which structure or matrix, such as "log", "data.run1" or "run(2)"; "" for all there is, or the first of
              several runs
    path      for messages

    Raises LogError where it holds none.
    """
    notes: list[str] = []
    several: list[str] = [] if variable else runs_in(held)
    if len(several) > 1:
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
    for within in _of_other_times(columns):
        columns = {name: value for name, value in columns.items() if name.rpartition(".")[0] != within}
    columns, apart, by_time = _with_timed(columns, arrays, path, notes)
    for within, why in apart.items():
        notes.append(
            f"left out: '{within}', which has times of its own; bring it to those of the others first, as {why}"
        )
        gone = [name for name in arrays if name.rpartition(".")[0] == within]
        other |= {name: f"{len(arrays.pop(name))} values at other times" for name in gone}
    together = list(dict.fromkeys(name.partition(".")[0] for name in columns if "." in name))
    if len(together) > 1 and not by_time:
        shown = listed([f"'{one}'" for one in together], 6)
        notes.append(f"columns of {shown} are taken together, as they have as many rows")
    uneven = {
        name: f"{len(value)} values"
        for name, value in arrays.items()
        if name not in columns
        and len(value) != usual
        and not isinstance(value, list)
        and not (by_time and _is_time(name))
    }
    if not columns:
        why = "; ".join(f"'{name}' is a {kind}" for name, kind in list(other.items())[:8]) or "it is empty"
        fix = "save vectors of numbers of one length, a structure of them, or a matrix with a column each"
        raise LogError(Problem("the file holds no columns of numbers", str(path), why, fix))
    LOG_COLUMNS.require(len(columns), str(path), LogError)
    if uneven:
        shown = listed([f"'{name}' ({of})" for name, of in uneven.items()], 6)
        notes.append(f"left out, as the columns have {usual} rows: {shown}")
    if unread := [f"'{name}' ({kind})" for name, kind in other.items() if "complex" in kind or "dimensions" in kind]:
        notes.append(f"left out: {listed(unread, 6)}")
    return Columns(list(columns), list(columns.values()), other | uneven, notes, variable if several else "")


def _of_other_times(columns: Mapping[str, FloatArray | list[str]]) -> list[str]:
    """Structures whose time is not that of the one with most columns, by what stands before the last point of their
    columns' names.  Clocks with another beginning of time are not compared."""
    sizes = Counter(name.rpartition(".")[0] for name in columns)
    times = {
        name.rpartition(".")[0]: value
        for name, value in columns.items()
        if isinstance(value, np.ndarray) and _is_time(name)
    }
    if len(times) < 2:
        return []
    most = max(times, key=lambda one: sizes[one])
    step = float(np.median(np.abs(np.diff(times[most]))))
    found = []
    for within, own in times.items():
        began = float(abs(own[0] - times[most][0]))
        off = own - times[most] if began < EPOCH else own - own[0] - (times[most] - times[most][0])
        if np.max(np.abs(off)) > 0.5 * step or abs(np.median(off)) > LATER * step:
            found.append(within)
    return found


def _with_timed(
    columns: Mapping[str, FloatArray | list[str]],
    arrays: Mapping[str, FloatArray | list[str]],
    path: Path,
    notes: list[str],
) -> tuple[dict[str, FloatArray | list[str]], dict[str, str], bool]:
    """Columns with those of structures and timeseries that have times of their own, put together by these.

    columns  as long as each other, as they are where no other has times

    Returns them, what could not be put to them by what stands before the last point of its name: why, and whether any
    was.
    """
    found = dict(columns)
    time = next((name for name in found if _is_time(name)), None)
    parts = {} if time is None else _timed(arrays, found)
    apart: dict[str, str] = {}
    if time is None or not parts:
        return found, apart, False
    # Others with the same times say nothing more by these.
    own = [name for name in found if name == time or not (_is_time(name) and _same(found[name], found[time]))]
    own.remove(time)
    taken = [_part(time.rpartition(".")[0] or time, time, own, found)]
    made: Joined | None = None
    for within, (clock, names) in parts.items():
        try:
            made = joined([*taken, one := _part(within, clock, names, arrays)], path)
            taken.append(one)
        except Apart as why:
            apart[within] = str(why)
    if made is not None:
        notes.append(made.note)
        found = {time: _plain(made.times), **dict(zip(made.names, map(_plain, made.columns), strict=True))}
    return found, apart, made is not None


def _is_time(name: str) -> bool:
    return name.rpartition(".")[2].lower() in TIMES


def _same(one: FloatArray | list[str], other: FloatArray | list[str]) -> bool:
    if isinstance(one, list) or isinstance(other, list):
        return one == other
    return bool(np.array_equal(one, other, equal_nan=True))


def _timed(
    arrays: Mapping[str, FloatArray | list[str]], without: Mapping[str, object]
) -> dict[str, tuple[str, list[str]]]:
    """Structures that have times and columns as long as these, by their names: those two; but for some columns."""
    found = {}
    for time in arrays:
        within = time.rpartition(".")[0]
        inside = [name for name in arrays if name.rpartition(".")[0] == within and name != time]
        if not within or time in without or not _is_time(time) or any(map(_is_time, inside)):
            continue
        names = [name for name in inside if len(arrays[name]) == len(arrays[time])]
        if names:
            found[within] = time, names
    return found


def _part(within: str, time: str, names: Sequence[str], arrays: Mapping[str, FloatArray | list[str]]) -> Part:
    import pandas as pd

    def column(name: str) -> Any:
        return pd.Series(arrays[name], dtype="string" if isinstance(arrays[name], list) else "float64")

    return Part(within, column(time), names, [column(name) for name in names])


def _plain(column: Any) -> FloatArray | list[str]:
    """Numbers of a pandas column, or its texts."""
    if holds_numbers(column):
        return np.asarray(column.to_numpy(dtype=np.float64))
    texts: list[str] = column.astype(object).where(column.notna(), None).tolist()
    return texts


def runs_in(held: Mapping[str, Value]) -> list[str]:
    """Names of structures, or of matrices, that hold a run each; empty where there are no two.

    Raises LogError where there are more than any log has.
    """
    structures = _structures(held)
    fields = {path: frozenset(value) for path, value in structures.items() if _is_run(value)}
    LOG_RUNS.require(len(fields), "a MATLAB file", LogError)
    # Runs have most of their fields in common, as both sides of one ship have, which lack the time.
    groups = [[other for other in fields if _in_common(fields[one], fields[other])] for one in fields]
    found = max(groups, key=len, default=[])
    if len(found) > 1:
        around = list(dict.fromkeys(path.rpartition(".")[0] for path in found))
        # What stands in a structure beside others, as navigation beside the engine, is a part of the run that it is.
        parts = len(around) == len(found) and all(
            sum(isinstance(one, dict) for one in structures.get(path, {}).values()) > 1 for path in around
        )
        return around if parts else found
    upright = {name: _upright(one) for name, one in held.items() if isinstance(one, np.ndarray) and one.ndim == 2}
    widths = {
        name: one.shape[1] for name, one in upright.items() if RUN <= one.shape[1] < len(one) and _rises(one[:, 0])
    }
    return max(([one for one in widths if widths[one] == width] for width in widths.values()), key=len, default=[])


def _upright(matrix: FloatArray) -> FloatArray:
    """A matrix with a column for each quantity: one that has few rows, and is far wider than high, turned."""
    return matrix.T if 1 < matrix.shape[0] <= LYING and matrix.shape[1] > 8 * matrix.shape[0] else matrix


def _structures(held: Mapping[str, Value], within: str = "") -> dict[str, dict[str, Value]]:
    """All structures by their names, such as "data.run(2)", those in each other too."""
    found: dict[str, dict[str, Value]] = {}
    for name, value in held.items():
        several = [value] if isinstance(value, dict) else value if isinstance(value, list) else []
        for k, one in enumerate(several, 1):
            if isinstance(one, dict) and _series(one) is None:
                path = f"{within}{name}" if isinstance(value, dict) else f"{within}{name}({k})"
                found |= {path: one} | _structures(one, f"{path}.")
    return found


def _in_common(one: frozenset[str], other: frozenset[str]) -> bool:
    """Whether two structures have most of their fields in common."""
    return len(one & other) >= max(min(RUN, len(one), len(other)), 0.5 * len(one))


def _is_run(fields: Mapping[str, Value]) -> bool:
    """Whether a structure holds columns of which one is time, by its numbers: timeseries, dates, or what rises."""
    if sum(_series(one) is not None for one in fields.values() if isinstance(one, dict)) > 1:
        return True
    if isinstance(fields.get("signals"), (dict, list)) and isinstance(fields.get("time"), np.ndarray):
        return True
    if (
        isinstance(matrix := fields.get("data"), np.ndarray)
        and matrix.ndim == 2
        and RUN <= matrix.shape[1] < len(matrix)
    ):
        return True
    vectors = [one for one in fields.values() if isinstance(one, np.ndarray) and one.size == max(one.shape) > 2]
    dates = any(
        (isinstance(one, list) and len(one) > 2) or (isinstance(one, np.ndarray) and _are_dates(one))
        for one in fields.values()
    )
    return len(vectors) >= RUN - 1 and (dates or any(map(_rises, vectors)))


def _rises(values: FloatArray) -> bool:
    """Whether numbers rise from one to the next, but for a few that repeat or are missing."""
    known = values.ravel()[np.isfinite(values.ravel())]
    steps = np.diff(known)
    return len(steps) > 1 and bool(np.mean(steps > 0.0) > RISING and np.mean(steps < 0.0) < 1.0 - RISING)


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
                _join(out, {"Time": times}, name)
            if not np.array_equal(times, series[0]):
                own = _of_matrix("data", series[1], {}, notes)
                _join(out, {f"{name}.{key}": one for key, one in {"Time": series[0], **own}.items()}, name)
                continue
            _join(out, _of_matrix(name, series[1], {}, notes), name)
        elif isinstance(value, dict):
            prefix = f"{name}." if several else ""
            inside = _logged_signals(value, notes) or _spread(value, notes)
            _join(out, {f"{prefix}{key}": one for key, one in inside.items()}, name)
        elif isinstance(value, np.ndarray):
            _join(out, _of_matrix(name, value, held, notes), name)
        elif isinstance(value, list) and isinstance(value[0], dict):
            out[name] = Other(f"array of {len(value)} structures")
        elif isinstance(value, list):
            out[name] = [str(one) for one in value]
        else:
            out[name] = value if isinstance(value, Other) else Other("text")
    return out


def _join(out: Flat, more: Flat, name: str) -> None:
    """Take more columns; those of a name that is taken have that of what they stand in before it."""
    for key, value in more.items():
        own = key if key not in out else f"{name}.{key}"
        out[own if own not in out else f"{own} {len(out) + 1}"] = value


def _of_matrix(name: str, value: FloatArray, beside: Mapping[str, Value], notes: list[str]) -> Flat:
    """Columns of a matrix, by what names them beside it; a vector as it is."""
    if value.ndim > 2:
        return {name: Other(f"array of {value.ndim} dimensions")}
    if min(value.shape) <= 1:
        return {name: value.ravel()}
    if (upright := _upright(value)) is not value:
        notes.append(f"'{name}' has {value.shape[0]} rows and {value.shape[1]} columns: each row is read as a column")
        value = upright
    LOG_COLUMNS.require(value.shape[1], name[:80], LogError)
    if _are_dates(value):
        return {name: [_stamp(row) for row in value]}
    names = _names_beside(beside, value.shape[1])
    return {names[k] if names else f"{name} {k + 1}": value[:, k] for k in range(value.shape[1])}


def _are_dates(value: FloatArray) -> bool:
    """Whether the rows of a matrix are dates as ``datevec`` makes them."""
    return (
        value.ndim == 2
        and value.shape[1] == len(_DATEVEC)
        and all(bool(((value[:, k] >= low) & (value[:, k] <= high)).all()) for k, (low, high) in enumerate(_DATEVEC))
    )


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
