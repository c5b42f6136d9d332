"""Trial files: one Parquet file a trial, with facts about it in the file's metadata."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import Problem, TrialError
from ..files import atomic
from .metadata import facts_of
from .model import Trial
from .schema import ATTRIBUTES, COLUMNS, METADATA_KEY, REQUIRED, SCHEMA
from .unusable import unusable


def read_trial(path: Path | str) -> Trial:
    """Read a trial and make sure it can be used.

    Columns the program does not know are kept in ``extra`` where they hold numbers, and named in ``ignored`` where
    they do not.  Raises TrialError with everything that is wrong in the file.
    """
    path = Path(path)
    content, table = _table(path)
    raw = table.schema.metadata or {}
    columns, ignored, problems = _columns(table, path)
    facts, wrong = facts_of(raw.get(METADATA_KEY), path, table.column_names)
    problems = wrong + problems
    # A column that holds no numbers has been reported; that it is missing as well would be the same news twice.
    unreadable = [name for name in REQUIRED if name in table.column_names and name not in columns]
    problems += [
        problem
        for problem in unusable(columns, str(path))
        if not any(problem.what == f"column '{name}' is missing" for name in unreadable)
    ]
    if problems:
        raise TrialError(*problems)
    motion: dict[str, Any] = {attribute: columns[name] for name, attribute in ATTRIBUTES.items()}
    return Trial(
        id=facts.get("id") or path.stem,
        ship=facts.get("ship", ""),
        manoeuvre=facts.get("manoeuvre", ""),
        source=facts.get("source", ""),
        **motion,
        extra={name: values for name, values in columns.items() if name not in REQUIRED},
        noise={name: float(value) for name, value in facts.get("noise", {}).items()},
        note=facts.get("note", ""),
        cut_from=facts.get("cut_from", ""),
        path=path,
        sha256=hashlib.sha256(content).hexdigest(),
        ignored=ignored,
    )


def write_trial(trial: Trial, path: Path | str, overwrite: bool = False) -> Path:
    """Write a trial, whole or not at all; returns the path.

    Raises OutputError where the file exists and ``overwrite`` is false, or the system refuses to write.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = Path(path)
    values = trial.columns
    fields = [
        pa.field(name, pa.float64(), metadata={"unit": COLUMNS[name].unit} if name in COLUMNS else None)
        for name in values
    ]
    facts = {
        "schema": SCHEMA,
        "ship": trial.ship,
        "id": trial.id,
        "manoeuvre": trial.manoeuvre,
        "source": trial.source,
        "noise": {name: float(value) for name, value in trial.noise.items()},
        "note": trial.note,
    }
    if trial.cut_from:
        facts["cut_from"] = trial.cut_from
    schema = pa.schema(fields, metadata={METADATA_KEY: json.dumps(facts).encode()})
    table = pa.table([pa.array(column) for column in values.values()], schema=schema)
    with atomic(path, overwrite) as part:
        pq.write_table(table, part, compression="zstd")
    return path


def id_in(path: Path) -> str | None:
    """Id of a trial file that may be unusable otherwise; None where even that cannot be read."""
    try:
        raw = _table(path)[1].schema.metadata or {}
    except TrialError:
        return None
    facts, _ = facts_of(raw.get(METADATA_KEY), path, ())
    written = facts.get("id")
    return written if isinstance(written, str) and written else path.stem


def _table(path: Path) -> tuple[bytes, Any]:
    """Content of the file and the table in it.  Raises TrialError."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        content = path.read_bytes()
    except OSError as error:
        fix = "check the path, and that you may read the file"
        raise TrialError(
            Problem("the trial file cannot be opened", str(path), error.strerror or str(error), fix)
        ) from error
    try:
        # Without worker threads: one still starting when a command fails quickly would abort the process at its exit.
        # ``read_table`` starts one whatever it is told.
        return content, pq.ParquetFile(pa.BufferReader(content), pre_buffer=False).read(use_threads=False)
    except (OSError, ValueError, pa.ArrowException) as error:
        if not content:
            what, fix = "the file is empty", "copy it again from where it was made"
        elif content.startswith(b"PAR1"):
            what, fix = "the Parquet file is damaged", "copy it again from where it was made: it may be cut off"
        else:
            what, fix = "the file is not Parquet", "trials are Parquet files; convert it, for example with pandas"
        why = (str(error).splitlines() or [""])[0]
        raise TrialError(Problem(what, str(path), why, fix)) from error


def _numbers(column: Any) -> FloatArray:
    """A column of numbers (n_samples,), NaN where a row has none; its own ``to_numpy`` would load pandas for this."""
    import pyarrow as pa

    whole = column.combine_chunks()
    if whole.type != pa.float64():
        whole = whole.cast(pa.float64(), safe=False)
    if whole.null_count:
        whole = whole.fill_null(np.nan)
    return np.array(np.from_dlpack(whole))


def _columns(table: Any, path: Path) -> tuple[dict[str, FloatArray], tuple[str, ...], list[Problem]]:
    """Columns of numbers (n_samples,) by name, names of other columns, and problems."""
    import pyarrow as pa

    columns: dict[str, FloatArray] = {}
    ignored: list[str] = []
    problems: list[Problem] = []
    twice = {name for name, count in Counter(table.column_names).items() if count > 1}
    for name in sorted(twice):
        problems.append(Problem(f"column '{name}' is there twice", str(path), fix="remove one of them"))
    for k, name in enumerate(table.column_names):
        kind = table.schema.field(k).type
        if pa.types.is_floating(kind) or pa.types.is_integer(kind):
            columns[name] = _numbers(table.column(k))
        elif name in COLUMNS:
            fix = f"write it as float64, in {COLUMNS[name].unit}"
            problems.append(Problem(f"column '{name}' holds {kind}, not numbers", str(path), fix=fix))
        else:
            ignored.append(name)
    return columns, tuple(ignored), problems
