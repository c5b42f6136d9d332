"""Trial files: one Parquet file a trial, with facts about it in the file's metadata."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Problem, TrialError, closest
from ..files import atomic
from .checks import unusable
from .model import FloatArray, Trial
from .schema import COLUMNS, METADATA, METADATA_KEY, REQUIRED, SCHEMA, SOURCES


def read_trial(path: Path | str) -> Trial:
    """Read a trial and make sure it can be used.  Raises TrialError with everything that is wrong in it."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = Path(path)
    try:
        content = path.read_bytes()
        table = pq.read_table(pa.BufferReader(content), use_threads=False)
    except (OSError, pa.ArrowException) as error:
        raise TrialError(
            Problem(
                "the file cannot be read as Parquet",
                str(path),
                str(error).splitlines()[0],
                "copy it again from where it was made: it may be cut off",
            )
        ) from error
    facts, problems = _metadata(table.schema.metadata or {}, path)
    columns: dict[str, FloatArray] = {}
    for name in table.column_names:
        kind = table.schema.field(name).type
        if pa.types.is_floating(kind) or pa.types.is_integer(kind):
            columns[name] = np.array(table.column(name).to_numpy(zero_copy_only=False), dtype=np.float64)
        elif name in COLUMNS:
            problems.append(
                Problem(
                    f"column '{name}' holds {kind}, not numbers",
                    str(path),
                    fix=f"write it as float64 in {COLUMNS[name].unit}",
                )
            )
    for name in REQUIRED:
        if name not in table.column_names:
            others = [other for other in table.column_names if other not in REQUIRED]
            problems.append(
                Problem(
                    f"column '{name}' is missing",
                    str(path),
                    f"it is {COLUMNS[name].meaning} [{COLUMNS[name].unit}]",
                    closest(name, others) if others else f"add it in {COLUMNS[name].unit}",
                )
            )
    if problems:
        raise TrialError(*problems)
    trial = Trial(
        id=facts.get("id", path.stem),
        ship=facts.get("ship", ""),
        manoeuvre=facts.get("manoeuvre", ""),
        source=facts.get("source", ""),
        **{"v_m" if name == "v" else name: columns[name] for name in REQUIRED},
        extra={name: values for name, values in columns.items() if name not in REQUIRED},
        noise=facts.get("noise", {}),
        note=facts.get("note", ""),
        path=path,
        sha256=hashlib.sha256(content).hexdigest(),
    )
    wrong = unusable(trial)
    if wrong:
        raise TrialError(*wrong)
    return trial


def write_trial(trial: Trial, path: Path | str, *, overwrite: bool = False) -> Path:
    """Write a trial, whole or not at all.  Raises OutputError where the file exists and ``overwrite`` is false."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = Path(path)
    values = {name: getattr(trial, "v_m" if name == "v" else name) for name in REQUIRED}
    values.update(trial.extra)
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
        "noise": trial.noise,
        "note": trial.note,
    }
    schema = pa.schema(fields, metadata={METADATA_KEY: json.dumps(facts).encode()})
    table = pa.table([pa.array(column) for column in values.values()], schema=schema)
    with atomic(path, overwrite) as part:
        pq.write_table(table, part, compression="zstd")
    return path


def _metadata(raw: dict[bytes, bytes], path: Path) -> tuple[dict[str, Any], list[Problem]]:
    """Facts of the file; a file without any still loads."""
    if METADATA_KEY not in raw:
        return {}, []
    where = f"{path}, metadata 'mmgtune'"
    try:
        facts = json.loads(raw[METADATA_KEY])
        if not isinstance(facts, dict):
            raise ValueError("not an object")
    except ValueError as error:
        return {}, [Problem("the metadata is not a JSON object", where, str(error), "write it again, or leave it out")]
    problems = [
        Problem(f"unknown key '{key}'", where, fix=closest(key, METADATA)) for key in facts if key not in METADATA
    ]
    if facts.get("schema", SCHEMA) != SCHEMA:
        problems.append(
            Problem(
                f"schema is {facts['schema']!r}, not {SCHEMA}", where, fix="update mmgtune, or write the file again"
            )
        )
    for key in ("id", "ship", "manoeuvre", "source", "note"):
        if key in facts and not isinstance(facts[key], str):
            problems.append(Problem(f"'{key}' is {facts[key]!r}, not text", where))
    if facts.get("source", "") not in ("", *SOURCES):
        problems.append(Problem(f"source is {facts['source']!r}", where, fix=f"one of: {', '.join(SOURCES)}"))
    noise = facts.get("noise", {})
    if not (isinstance(noise, dict) and all(isinstance(v, (int, float)) and v >= 0 for v in noise.values())):
        problems.append(Problem("'noise' is not an object of standard deviations", where, fix='write {"x": 0.5, ...}'))
    return facts, problems
