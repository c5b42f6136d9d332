"""Logs of every kind given to ``trials map``, without a map."""

from __future__ import annotations

import importlib
import json
from pathlib import Path

import numpy as np

from mmgtune.errors import LogError
from mmgtune.importing import propose_map
from mmgtune.importing.maps.reading_map import parse_map
from mmgtune.toml_reading import toml_of

from ..mutating import TEXTS, encoded, odd_text, pick
from . import Files, Kind


def proposes(folder: Path, log: str) -> str:
    """Propose a map, which must be TOML, and print all of it; a log may be refused."""
    try:
        made = propose_map([folder / log])
    except LogError as error:
        str(error).encode("utf-8", "surrogatepass")
        return "refused"
    json.dumps(made.to_dict(), allow_nan=False)
    "\n".join(made.lines()).encode("utf-8", "surrogatepass")
    toml_of(made.text, "the map", "map", LogError, log_map=True)
    if not made.asks:
        parse_map(made.text)
    return f"{len(made.asks)} asked"


def _names(rng: np.random.Generator, content: bytes) -> bytes:
    """Odd names of columns: the same twice, empty, huge, with marks that steer."""
    head, _, body = content.partition(b"\n")
    names = head.split(b",")
    for _ in range(int(rng.integers(1, 6))):
        k = int(rng.integers(len(names)))
        names[k] = pick(
            rng, (names[0], b"", encoded(odd_text(rng)), encoded(pick(rng, TEXTS)), b"time", b"n", b"\xff\xfe")
        )
    return b",".join(names) + b"\n" + body


def make(rng: np.random.Generator) -> Files:
    """A log of another kind's cases, by its own name; of text perhaps with odd names of columns."""
    name = pick(rng, ("csv_logs", "csv_logs", "csv_logs", "parquet_logs", "nmea_logs", "matlab_files"))
    files = importlib.import_module(f"{__package__}.{name}").make(rng)
    log = next(one for one in files if one.startswith("log."))
    content = files[log]
    if name == "csv_logs" and rng.random() < 0.4:
        content = _names(rng, content)
    if rng.random() < 0.05:
        log = pick(rng, ("log.csv", "log.xlsx", "log.mat", "log.parquet"))
    return {log: content}


def run(folder: Path) -> str:
    """Propose a map for it."""
    (log,) = (one.name for one in folder.iterdir() if one.name.startswith("log."))
    return proposes(folder, log)


KIND = Kind("proposals", make, run, seconds=4.0)
