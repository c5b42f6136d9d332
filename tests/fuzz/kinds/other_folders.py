"""Run folders of predictions, comparisons, simulations, plans and trainings: with records, tables or files damaged."""

from __future__ import annotations

import contextlib
import functools
import io
import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from tests.command import typed
from tests.report import more_runs

from ..mutating import mutated_bytes, pick, several
from ..trees import as_json, mutated
from . import Files, Kind
from .folders import IN_FOLDER, _collected, _lay, _timeless
from .parquet_logs import odd_values, other_type, shorter

MADE = ("simulate", "model-comparison", "learning", "plan")


@functools.cache
def whole() -> dict[str, dict[str, bytes]]:
    """A folder of each kind, times in them taken out."""
    found = {}
    with tempfile.TemporaryDirectory() as name, contextlib.chdir(name):
        for kind in MADE:
            folder = Path(kind)
            folder.mkdir()
            more_runs.HOW[kind](folder)
            found[kind] = {key: _timeless(content) for key, content in _collected(folder).items() if key != "base.json"}
    return found


def _table(rng: np.random.Generator, content: bytes) -> bytes:
    """A table with something wrong in its columns."""
    table = pq.read_table(io.BytesIO(content))
    columns: dict[str, Any] = {name: table[name].to_numpy() for name in table.column_names}
    columns = several(rng, columns, [odd_values, other_type, shorter])
    file = io.BytesIO()
    pq.write_table(pa.table(columns), file)
    return file.getvalue()


def make(rng: np.random.Generator) -> Files:
    """A folder with something wrong in one of its files, or with one missing."""
    kind = pick(rng, list(whole()))
    files = dict(whole()[kind])
    records = [one for one in files if one.endswith(".json")]
    name = pick(rng, records) if rng.random() < 0.6 else pick(rng, list(files))
    how = rng.random()
    if how < 0.06:
        del files[name]
    elif how < 0.9 and name.endswith(".json"):
        files[name] = as_json(several(rng, json.loads(files[name]), [mutated]))
    elif how < 0.8 and name.endswith(".parquet") and IN_FOLDER not in name:
        files[name] = _table(rng, files[name])
    else:
        files[name] = several(rng, files[name], [mutated_bytes])
    return {**files, "what": kind.encode()}


def run(folder: Path) -> str:
    """Report on it."""
    files = {path.name: path.read_bytes() for path in folder.iterdir()}
    kind = files.pop("what").decode()
    out = folder / "out"
    (out / "run").mkdir(parents=True)
    _lay({f"run/{name}": content for name, content in files.items()}, out)
    with contextlib.chdir(out):
        ended = typed("report", "run")
    assert ended.code in (0, 2), ended.err
    return f"{kind}: exit {ended.code}"


KIND = Kind("other_folders", make, run, seconds=20.0)
