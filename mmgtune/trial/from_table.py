"""A trial from a table in memory, such as a pandas DataFrame."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import Problem, TrialError, brief, kind_of
from ..units import canonical, name_and_unit
from .metadata import as_json, nameless, problems_in, without_id
from .model import Trial, fields_of
from .raw_logs import TABLE_TO_LOG, table_instead
from .schema import REQUIRED, known_column
from .unusable import unusable

FACTS = ("ship", "manoeuvre", "source", "note", "group", "cut_from", "noise", "derived", "antenna")
"""What may be said of a trial besides."""


def trial_of(table: Any, id: str, **facts: Any) -> Trial:
    """A trial from columns as a trial file has them: SI units, angles in radians, ``v`` to starboard.

    table  a DataFrame, or a mapping of names to (n_samples,) numbers; time may be the index of a DataFrame, called "t"
           or of dates and times, which count from the first; columns the program does not know are kept where they hold
           numbers; units may stand behind the names of those it knows, as in ``to_frame()`` of a trial and of a
           simulated run: "u [m/s]"
    id     name of the trial, unique within a data set; files are named after it
    facts  fields of ``Trial``: ship, manoeuvre, source ("measured" or "generated"), note, group, cut_from, noise,
           derived and antenna

    Raises TrialError with everything that is wrong in id, facts and columns, as for a file.
    """
    unknown = [name for name in facts if name not in FACTS]
    if unknown:
        what, fix = f"a trial has no fact '{unknown[0]}'", f"known here: {', '.join(FACTS)}"
        raise TrialError(Problem(what, unknown[0], "what a trial is beside its columns has a name", fix))
    where = id if isinstance(id, str) else brief(id)
    table = with_time(table)
    if not hasattr(table, "keys"):
        fix = "give a DataFrame, or a dict of arrays"
        raise TrialError(Problem("this is no table", "table", f"{kind_of(table)} has no named columns", fix))
    columns: dict[str, FloatArray] = {}
    ignored, words = [], []
    for given in table.keys():  # noqa: SIM118  the names of a DataFrame, and of a mapping
        name, column = _named(str(given)), numbers_of(table[given])
        if name in columns or hasattr(table[given], "columns"):  # a name that a DataFrame has twice is a DataFrame
            why, fix = f"'{given}' is '{name}', and a trial has one of it", "leave one of the two out"
            raise TrialError(Problem(f"column '{name}' is there twice", where, why, fix))
        if column is None and name not in REQUIRED:
            ignored.append(name)
            continue
        if column is None:
            words.append(_no_numbers(name, table[given], where))
        else:
            columns[name] = column
    if words:
        raise TrialError(*words)
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        longest = max(columns, key=lambda name: len(columns[name]))
        shortest = min(columns, key=lambda name: len(columns[name]))
        what = f"'{longest}' has {len(columns[longest])} samples, '{shortest}' {len(columns[shortest])}"
        raise TrialError(
            Problem(what, where, "all columns of a trial are as long as t", "write NaN where one has a gap")
        )
    log = table_instead([*columns, *ignored], where)
    problems = [without_id("id")] if nameless(id) else []
    problems += problems_in(as_json({"id": id, **facts}), brief(id), tuple(columns))
    problems += [log] if log else unusable(columns, where, importing=TABLE_TO_LOG)
    if problems:
        raise TrialError(*problems)
    named = {"ship": "", "manoeuvre": "", "source": "", **facts}
    return Trial(id=id, **named, **fields_of(columns), ignored=tuple(ignored))


def with_time(table: Any) -> Any:
    """The table with its index for its time, where that is called so or holds dates and times, and with dates and times
    in a column "t" as seconds; else as it is."""
    index: Any = getattr(table, "index", None)
    if not hasattr(table, "keys"):
        return table
    if "t" in table:
        dated = _dated(table["t"])
        return {**{name: table[name] for name in table}, "t": _seconds(table["t"])} if dated else table
    time = str(getattr(index, "name", None))
    if not (_dated(index) or name_and_unit(time)[0] == "t") or time in table:
        return table
    if _dated(index):
        index, time = _seconds(index), "t"
    return {time: index, **{name: table[name] for name in table}}


def _dated(column: Any) -> bool:
    """Whether a column holds dates and times, or lengths of time."""
    return getattr(getattr(column, "dtype", None), "kind", "") in ("M", "m")


def _seconds(column: Any) -> Any:
    """Dates and times in seconds from the first."""
    return (column - column[:1].min()) / np.timedelta64(1, "s")  # of no rows too


def _named(header: str) -> str:
    """A column by its name alone, where the program knows it.  Raises TrialError for one in another unit."""
    name, unit = name_and_unit(header)
    known = known_column(name)
    if known is None or not unit:
        return header
    if canonical(unit) != known.unit:
        why = f"columns of trials are in SI units, and {name} in {known.unit}"
        fix = f"give it as '{name} [{known.unit}]'"
        raise TrialError(Problem(f"column '{name}' is in {unit}", header, why, fix))
    return name


def _no_numbers(name: str, column: Any, where: str) -> Problem:
    """That a column a trial needs holds something else."""
    first = next(iter(np.ravel(np.asarray(column, dtype=object)).tolist()), None)
    why = f"it begins with {brief(first)}, {kind_of(first)}"
    fix = f"give numbers, by pandas.to_numeric(table['{name}']) perhaps"
    return Problem(f"column '{name}' holds no numbers", where, why, fix)


def numbers_of(column: Any) -> FloatArray | None:
    """A column (n_samples,) as numbers, NaN where it is masked, None or what pandas writes as <NA>; None where it holds
    anything else, such as words or dates."""
    try:
        found = np.asarray(column)
        if found.ndim != 1 or found.dtype.kind not in "fiubO":
            return None
        if found.dtype.kind == "O":
            found = np.array([_number(value) for value in found.tolist()])
        numbers = found.astype(float)
        return np.where(np.ma.getmaskarray(column), np.nan, numbers) if np.ma.isMaskedArray(column) else numbers
    except (TypeError, ValueError, OverflowError):
        return None


def _number(value: Any) -> float:
    """A value among others of any type.  Raises TypeError for text, which is no number even where it reads like one."""
    if value is None or type(value).__name__ == "NAType":
        return float("nan")
    if isinstance(value, str | bytes):
        raise TypeError
    return float(value)
