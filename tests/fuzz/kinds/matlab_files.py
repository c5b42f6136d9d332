"""MATLAB files: of all classes, in each other, compressed, with sizes that are not theirs, and damaged."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io

from tests.importing.made import MAP, logged, turn

from ..mutating import mutated_bytes, pick, several
from . import Files, Kind
from .csv_logs import imports
from .proposals import proposes

ODD: tuple[Any, ...] = (
    np.zeros((0, 0)), np.zeros((3, 3, 3)), np.array([[1, "a"]], dtype=object), "text", {"a": {"b": {"c": [1.0]}}}, 1.0,
    np.full(120, np.nan), np.full(120, np.inf), np.arange(120) * 1j, np.array(["a", "bb"]), np.ones((120, 1), bool),
    np.arange(120, dtype=np.uint64) + 2**63, np.full(120, 1e300),
)  # fmt: skip


def make(rng: np.random.Generator) -> Files:
    """A file with something wrong in its variables or bytes."""
    columns: dict[str, Any] = {name: values[:120] for name, values in logged(turn()).items()}
    how = rng.random()
    if how < 0.5:
        for _ in range(int(rng.integers(1, 4))):
            columns[pick(rng, (*columns, "other", "a" * 30, "x1"))] = pick(rng, ODD)
    held: dict[str, Any] = columns
    if rng.random() < 0.3:
        held = {"log": columns, "more": pick(rng, ODD)}
    elif rng.random() < 0.3:
        held = _put_together(rng, columns)
    elif rng.random() < 0.2:
        held = {"data": np.column_stack([one for one in columns.values() if np.shape(one) == (120,)] or [np.zeros(3)])}
    out = io.BytesIO()
    scipy.io.savemat(out, held, do_compression=bool(rng.random() < 0.4))
    # The time it was written at stands in the beginning.
    content = b"MATLAB 5.0 MAT-file".ljust(116) + out.getvalue()[116:]
    if how > 0.4:
        content = several(rng, content, [mutated_bytes, _sizes, _wrapped])
    return {"log.mat": content, "map.toml": MAP.encode()}


def _put_together(rng: np.random.Generator, columns: dict[str, Any]) -> dict[str, Any]:
    """Columns as arrays of structures, timeseries, signals, or beside cells that name them, some not as they should."""
    names = np.array([*columns], dtype=object)
    kind = np.dtype([(name, "O") for name in columns])
    many = np.array([tuple(columns.values())] * int(rng.integers(1, 4)), dtype=kind).reshape(1, -1)
    times = pick(rng, (np.arange(120.0), np.arange(40.0), *ODD))
    signals = np.array([(one, name) for name, one in columns.items()], dtype=[("values", "O"), ("label", "O")])
    return pick(
        rng,
        (
            {"run": many, "other": pick(rng, ODD)},
            {name: {"Time": times, "Data": one} for name, one in columns.items()},
            {"out": {"time": times, "signals": signals.reshape(1, -1)}},
            {"names": names[: int(rng.integers(1, 12))], "data": np.ones((120, len(names)))},
            {"a": columns, "b": columns, "c": {"d": columns}},
            {"clock": rng.uniform(0.0, 2100.0, (120, 6)), **columns},
        ),
    )


def _sizes(rng: np.random.Generator, content: bytes) -> bytes:
    """A word of four bytes replaced by an odd number."""
    at = int(rng.integers(128, max(129, len(content) - 4))) // 4 * 4
    number = int(pick(rng, (0, 1, 7, 8, 14, 15, 17, 2**31 - 1, 2**32 - 1, 2**16, 128)))
    return content[:at] + struct.pack("<I", number) + content[at + 4 :]


def _wrapped(rng: np.random.Generator, content: bytes) -> bytes:
    """All of it in a compressed element, or in many of them."""
    body = content[128:]
    for _ in range(int(pick(rng, (1, 2, 40)))):
        packed = zlib.compress(body)
        body = struct.pack("<II", 15, len(packed)) + packed
    return content[:128] + body


def run(folder: Path) -> str:
    """Propose a map for it, and import it by another one."""
    return proposes(folder, "log.mat") + "; " + imports(folder, "log.mat")


KIND = Kind("matlab", make, run)
