"""Logs as text, with the map that fits them."""

from __future__ import annotations

import functools
import json
from pathlib import Path

import numpy as np
import pandas as pd

from mmgtune.importing import import_logs, load_map
from tests.importing.made import MAP, logged, turn

from ..mutating import encoded, line_doubled, mutated_bytes, mutated_cells, mutated_lines, pick, several
from . import Files, Kind

ENCODINGS = ("utf-16", "utf-16-le", "cp1252", "utf-8-sig", "utf-32", "cp037")


@functools.cache
def whole() -> str:
    """A log that can be imported: 120 rows of a turn."""
    columns = {name: values[:120] for name, values in logged(turn()).items()}
    return pd.DataFrame(columns).to_csv(index=False, float_format="%.5g")


def make(rng: np.random.Generator) -> Files:
    """A log with something wrong in its cells, lines, bytes or encoding."""
    lines = whole().splitlines()
    how = rng.random()
    if how < 0.6:
        lines = several(rng, lines, [lambda rng, lines: mutated_cells(rng, lines, ","), mutated_lines])
        content = encoded("\n".join(lines))
    elif how < 0.9:
        content = several(rng, encoded("\n".join(line_doubled(rng, lines))), [mutated_bytes])
    else:
        content = whole().replace(",", pick(rng, (";", "\t", " ", "|"))).encode(pick(rng, ENCODINGS))
    return {"log.csv": content, "map.toml": MAP.encode()}


def imports(folder: Path, log: str) -> str:
    """Import a log by the map beside it, as the command does, and write trials, report and JSON."""
    made = import_logs([folder / log], load_map(folder / "map.toml"), folder / "out")
    json.dumps(made.to_dict(), allow_nan=False)
    made.text().encode("utf-8")
    return f"{len(made.trials)} trials"


def run(folder: Path) -> str:
    """Import it."""
    return imports(folder, "log.csv")


KIND = Kind("csv", make, run)
