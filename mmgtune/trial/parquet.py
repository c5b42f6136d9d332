"""Trial files: one Parquet file a trial, with facts about it in the file's metadata."""

from __future__ import annotations

import hashlib
import json
import shlex
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import limits
from ..arrays import FloatArray
from ..errors import OptionError, Problem, TrialError, brief, kind_of, reason
from ..files import atomic, path_of, require_regular
from ..resources import must_be_name
from ..units import canonical, factors
from .digest import DIGEST_KEY, digest
from .footer import rows_of
from .metadata import antenna_of, as_json, facts_of, problems_in
from .model import Trial, fields_of
from .raw_logs import import_commands, refuse_log
from .schema import METADATA_KEY, SCHEMA, known_column
from .unusable import unusable

GROUP_ROWS = 65_536
"""Rows of a row group that is written: a log of days can be read group by group."""


def read_trial(path: Path | str) -> Trial:
    """Read a trial and make sure it can be used.

    Columns the program does not know are kept in ``extra`` where they hold numbers, and named in ``ignored`` where
    they do not.  Raises TrialError with everything that is wrong in the file.
    """
    must_be_name(path, "trial", TrialError)
    path = Path(path)
    held = _read(path)
    columns = held.columns
    refuse_log(path, held.names, facts=METADATA_KEY in held.metadata)
    facts, problems = facts_of(held.metadata.get(METADATA_KEY), path, held.names)
    problems = problems + held.problems
    if not problems:
        problems = _unsealed(columns, held.metadata, path)
    problems += unusable(columns, str(path), reported=held.names)
    if problems:
        raise TrialError(*problems)
    return Trial(
        id=facts.get("id") or path.stem,
        ship=facts.get("ship", ""),
        manoeuvre=facts.get("manoeuvre", ""),
        source=facts.get("source", ""),
        **fields_of(columns),
        noise={name: float(value) for name, value in facts.get("noise", {}).items()},
        note=facts.get("note", ""),
        cut_from=facts.get("cut_from", ""),
        group=facts.get("group", ""),
        derived=tuple(facts.get("derived", ())),
        antenna=antenna_of(facts),
        path=path,
        sha256=held.sha256,
        sealed=DIGEST_KEY in held.metadata,
        ignored=held.ignored,
    )


def write_trial(trial: Trial, path: Path | str, overwrite: bool = False) -> Path:
    """Write a trial, whole or not at all; returns the path.

    Raises OutputError where the file exists and ``overwrite`` is false, or the system refuses to write, OptionError for
    what is no trial, and TrialError for facts that ``read_trial`` would refuse, such as an id that cannot name a file.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = path_of(path)
    if not isinstance(trial, Trial):
        why = "a file holds a trial with its ship, manoeuvre and inputs"
        fix = "give a Trial: trial_of makes one of a table in memory, import_logs of logs"
        raise OptionError(Problem(f"{kind_of(trial)} is no trial", brief(trial), why, fix))
    values = trial.columns
    fields = [
        pa.field(name, pa.float64(), metadata={"unit": known.unit} if (known := known_column(name)) else None)
        for name in values
    ]
    facts = {
        "schema": SCHEMA,
        "ship": trial.ship,
        "id": trial.id,
        "manoeuvre": trial.manoeuvre,
        "source": trial.source,
        "noise": trial.noise,
        "note": trial.note,
    }
    if trial.cut_from:
        facts["cut_from"] = trial.cut_from
    if trial.group:
        facts["group"] = trial.group
    if trial.derived:
        facts["derived"] = trial.derived
    if trial.antenna:
        facts["antenna"] = list(trial.antenna)
    facts = as_json(facts)
    problems = problems_in(facts, f"trial {brief(trial.id)}", tuple(values))
    if problems:
        raise TrialError(*problems)
    written = json.dumps(facts).encode()
    limits.FACTS_BYTES.require(len(written), f"trial {brief(trial.id)}", TrialError)
    schema = pa.schema(fields, metadata={METADATA_KEY: written, DIGEST_KEY: digest(values, written)})
    table = pa.table([pa.array(column) for column in values.values()], schema=schema)
    with atomic(path, overwrite) as part:
        pq.write_table(table, part, compression="zstd", write_page_checksum=True, row_group_size=GROUP_ROWS)
    return path


def id_in(path: Path) -> str | None:
    """Id of a trial file that may be unusable otherwise; None where even that cannot be read."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        require_regular(path)
        raw = pq.ParquetFile(path, pre_buffer=False).schema_arrow.metadata or {}
    except (OSError, ValueError, pa.ArrowException):
        return None
    facts, _ = facts_of(raw.get(METADATA_KEY), path, ())
    written = facts.get("id")
    return written if isinstance(written, str) and written else path.stem


def _unsealed(columns: dict[str, FloatArray], raw: Mapping[bytes, bytes], path: Path) -> list[Problem]:
    """What is wrong where the file's digest is not that of what was read; nothing where it has none."""
    if DIGEST_KEY not in raw or raw[DIGEST_KEY] == digest(columns, raw.get(METADATA_KEY, b"")):
        return []
    return [another_digest(path)]


def another_digest(path: Path) -> Problem:
    """The problem of a file whose digest is not that of what it holds."""
    return Problem(
        "the trial is not what was written: its columns or facts do not have the digest that the file holds",
        f"{path}, metadata '{DIGEST_KEY.decode()}'",
        "the file is damaged, or something other than mmgtune changed it and kept the digest",
        "copy it again from where it was made; after a change that was meant, remove that key of the metadata",
    )


@dataclass(frozen=True)
class _Held:
    """What a file holds.

    columns   of numbers (n_samples,) by name
    names     of all columns; ignored: of those that hold no numbers and are not of a trial
    problems  with the columns
    sha256    of the file
    """

    columns: dict[str, FloatArray]
    names: list[str]
    ignored: tuple[str, ...]
    metadata: Mapping[bytes, bytes]
    problems: list[Problem]
    sha256: str


def _read(path: Path) -> _Held:
    """Read a file, nothing of it that is beyond the limits.  Raises TrialError."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    where = str(path)
    try:
        content = limits.content(path, limits.TRIAL_BYTES, TrialError)
    except OSError as error:
        fix = "check the path, and that you may read the file"
        raise TrialError(Problem("the trial file cannot be opened", where, reason(error), fix)) from error
    try:
        # Without worker threads: one still starting when a command fails quickly would abort the process at its exit.
        # ``read_table`` starts one whatever it is told.
        file = pq.ParquetFile(pa.BufferReader(content), pre_buffer=False, page_checksum_verification=True)
        rows = rows_of(file.metadata, len(content), where, TrialError)
        limits.TRIAL_SAMPLES.require(rows, where, TrialError)
        layout = layout_of(file.schema_arrow, where)
        limits.TRIAL_VALUES.require(rows * layout.n_numeric, where, TrialError)
        wanted = layout.wanted
        table = file.read(columns=wanted, use_threads=False)
        columns = {name: numbers(table.column(name).combine_chunks()) for name in wanted}
    except (OSError, ValueError, pa.ArrowException) as error:
        raise unreadable(content[:4], where, error) from error
    metadata = file.schema_arrow.metadata or {}
    sha256 = hashlib.sha256(content).hexdigest()
    return _Held(columns, layout.names, layout.ignored, metadata, layout.problems, sha256)


@dataclass(frozen=True)
class Layout:
    """What columns a file has.

    names      of all of them; ignored: of those that hold no numbers and are not of a trial
    wanted     of those that are read
    n_numeric  how many hold numbers
    problems   with them
    """

    names: list[str]
    wanted: list[str]
    n_numeric: int
    ignored: tuple[str, ...]
    problems: list[Problem]


def layout_of(schema: Any, where: str) -> Layout:
    """The columns of a file, from its schema (``pyarrow.Schema``); those without numbers are named, never read."""
    import pyarrow as pa

    kinds = [(one.name, one.type) for one in schema]
    names = [name for name, _ in kinds]
    numeric = [name for name, kind in kinds if pa.types.is_floating(kind) or pa.types.is_integer(kind)]
    twice = sorted(name for name, count in Counter(names).items() if count > 1)
    problems = [Problem(f"column '{name}' is there twice", where, fix="remove one of them") for name in twice]
    for name, kind in kinds:
        known = known_column(name)
        if known and name not in numeric:
            fix = f"write it as float64, in {known.unit}"
            problems.append(Problem(f"column '{name}' holds {str(kind)[:80]}, not numbers", where, fix=fix))
    problems += [problem for one in schema if (problem := _another_unit(one, where))]
    wanted = [name for name in numeric if name not in twice]
    ignored = tuple(name for name in names if name not in numeric and known_column(name) is None)
    return Layout(names, wanted, len(numeric), ignored, problems)


def _another_unit(column: Any, where: str) -> Problem | None:
    """The problem of a column (``pyarrow.Field``) whose own metadata says a unit that trials are not in."""
    known, raw = known_column(column.name), (column.metadata or {}).get(b"unit", b"")
    said = canonical(raw.decode("utf-8", "replace"))
    if known is None or factors(known.unit).get(said, 1.0) == 1.0:
        return None
    return Problem(
        f"column '{column.name}' says that it is in {said}",
        where,
        f"trial files are in SI units: read in {known.unit}, every number of it would be wrong",
        f"convert it to {known.unit}, or import the file with a map (mmgtune trials import)",
    )


def unreadable(begins: bytes, where: str, error: Exception) -> TrialError:
    """The error for a file that does not read as Parquet; ``begins`` are its first bytes."""
    if not begins:
        what, fix = "the file is empty", "copy it again from where it was made"
    elif begins.startswith(b"PARE"):
        what, fix = "the Parquet file is encrypted", "decrypt it first, or have it written again without a key"
    elif begins.startswith(b"PAR1"):
        what, fix = "the Parquet file is damaged", "copy it again from where it was made: it may be cut off"
    else:
        what, fix = "the file is not Parquet", import_commands(shlex.quote(where))
    return TrialError(Problem(what, where, reason(error), fix))


def numbers(whole: Any) -> FloatArray:
    """An Arrow array as (n_samples,), NaN where a row has none; its own ``to_numpy`` would load pandas for this."""
    import pyarrow as pa

    if whole.type != pa.float64():
        whole = whole.cast(pa.float64(), safe=False)
    if whole.null_count:
        whole = whole.fill_null(np.nan)
    return np.array(np.from_dlpack(whole))
