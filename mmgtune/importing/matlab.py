"""Reading MATLAB files of version 5 to 7 (.mat): vectors, matrices, and structures of them.

The format is read here and not by a library, since only arrays of numbers and texts are wanted, and cells, objects and
structures in each other are passed over without being made, however many there are and whatever sizes they state.
Source: MathWorks, MAT-File Format, "Level 5 MAT-File Format".
"""

from __future__ import annotations

import math
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import LogError, Problem, among, reason
from ..limits import LOG_COLUMNS, MATLAB_BYTES, content
from .cells import table_of
from .mapping import LogMap
from .table import Table

HEADER = 128
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
"""How elements hold numbers, by type."""
_TEXTS = {1: "latin-1", 2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
"""How elements hold texts, by type."""
_MATRIX, _COMPRESSED = 14, 15
_CLASSES = {1: "cell array", 2: "structure", 3: "object", 4: "text", 5: "sparse matrix", 17: "object", 18: "object"}
_STRUCTURE, _TEXT = 2, 4
_NUMERIC = range(6, 16)
_COMPLEX = 0x0800


@dataclass(frozen=True)
class Columns:
    """What a file holds as columns of one length.

    names    of the columns: of a matrix "name 1", "name 2", ...
    columns  numbers (n_rows,), or a list of texts
    other    what else there is, by name: what kind it is
    """

    names: list[str]
    columns: list[Any]
    other: dict[str, str]


class _Damaged(Exception):
    """The bytes are not what the format says."""


def read_matlab(path: Path, log_map: LogMap) -> Table:
    """The columns of a MATLAB file that a map names.  Raises LogError where it cannot be read or lacks one."""
    import pandas as pd

    found = columns_of(path, log_map.variable)
    columns = [pd.Series(one, dtype="string" if isinstance(one, list) else "float64") for one in found.columns]
    return table_of(path, log_map, found.names, columns, 1, "row", str(path))


def columns_of(path: Path, variable: str = "") -> Columns:
    """The columns in a file: of a structure or matrix, or the variables that are equally long vectors.

    Raises LogError where the file cannot be read, or holds none.
    """
    return _columns(path, variables(path), variable)


def _columns(path: Path, held: dict[str, Any], variable: str) -> Columns:
    if variable:
        if variable not in held:
            place = f"{path}, [log] variable of the map"
            raise LogError(Problem(f"the file has no variable '{variable[:80]}'", place, **among(variable, [*held])))
        found = _spread({variable: held[variable]})
    else:
        found = _spread(held)
    other = {name: value for name, value in found.items() if isinstance(value, str)}
    arrays = {name: value for name, value in found.items() if not isinstance(value, str) and len(value) > 1}
    # Constants of a ship or a run stand beside what was logged.
    lengths = [len(value) for value in arrays.values()]
    usual = max(set(lengths), key=lambda length: (lengths.count(length), length), default=0)
    columns = {name: value for name, value in arrays.items() if len(value) == usual}
    other |= {name: f"{len(value)} numbers" for name, value in arrays.items() if len(value) != usual}
    if not columns:
        why = "; ".join(f"'{name}' is a {kind}" for name, kind in list(other.items())[:8]) or "it is empty"
        fix = "save vectors of numbers of one length, a structure of them, or a matrix with a column each"
        raise LogError(Problem("the file holds no columns of numbers", str(path), why, fix))
    LOG_COLUMNS.hold(len(columns), str(path), LogError)
    return Columns(list(columns), list(columns.values()), other)


def _spread(held: dict[str, Any]) -> dict[str, Any]:
    """Vectors by name; fields of structures and columns of matrices on their own; what else there is as words."""
    inside = [value for value in held.values() if isinstance(value, dict)]
    out: dict[str, Any] = {}
    for name, value in held.items():
        if isinstance(value, dict):
            prefix = f"{name}." if len(inside) > 1 else ""
            out |= {f"{prefix}{key}": one for key, one in _spread(value).items()}
        elif isinstance(value, np.ndarray) and value.ndim == 2 and min(value.shape) > 1:
            LOG_COLUMNS.hold(value.shape[1], name[:80], LogError)
            out |= {f"{name} {k + 1}": value[:, k] for k in range(value.shape[1])}
        elif isinstance(value, np.ndarray) and value.ndim > 2:
            out[name] = f"array of {value.ndim} dimensions"
        else:
            out[name] = value.ravel() if isinstance(value, np.ndarray) else value
    return out


def variables(path: Path) -> dict[str, Any]:
    """Arrays of numbers (of any shape), lists of texts and structures of them by name; words for anything else.

    Raises LogError where it is damaged, for files of version 4 and 7.3, and where there is more in it than may be.
    """
    data = content(path, MATLAB_BYTES, LogError)
    fix = 'save it again with save("file.mat", "-v7")'
    if b"MATLAB 7.3" in data[:HEADER] or data.startswith(b"\x89HDF"):
        why = "files of version 7.3 are HDF5"
        raise LogError(Problem("the MATLAB file is of version 7.3", str(path), why, fix))
    mark = data[126:128]
    if len(data) < HEADER or mark not in (b"IM", b"MI"):
        raise LogError(Problem("the file is no MATLAB file of version 5 to 7", str(path), fix=fix))
    try:
        return _Reader("<" if mark == b"IM" else ">").variables(data)
    except (_Damaged, struct.error, zlib.error, ValueError) as error:
        raise LogError(Problem("the MATLAB file cannot be read", str(path), reason(error), fix)) from error


class _Reader:
    """One pass over a file.

    order  of bytes: "<" or ">"
    """

    def __init__(self, order: str):
        self.order = order
        self.left = MATLAB_BYTES.most

    def variables(self, data: bytes) -> dict[str, Any]:
        found: dict[str, Any] = {}
        at = HEADER
        while at + 8 <= len(data):
            kind, body, at = self.element(data, at)
            if kind == _COMPRESSED:
                unpacker = zlib.decompressobj()
                whole = unpacker.decompress(body, self.left + 1)
                self.left -= len(whole)
                if self.left < 0:
                    raise _Damaged(f"it unpacks to more than {MATLAB_BYTES.most} bytes, which is the limit")
                kind, body, _ = self.element(whole, 0)
            if kind == _MATRIX and body:
                name, value = self.matrix(body, 0)
                # What MATLAB keeps for itself has no name.
                if name and not name.startswith("__"):
                    found[name] = value
        return found

    def element(self, data: bytes, at: int) -> tuple[int, bytes, int]:
        """Type, content and end of the element at a place."""
        kind, size = struct.unpack_from(f"{self.order}II", data, at)
        if kind >> 16:
            # Up to four bytes stand in the tag itself.
            kind, size = kind & 0xFFFF, kind >> 16
            start, end = at + 4, at + 8
        else:
            start = at + 8
            end = start + size + (-size % 8 if kind != _COMPRESSED else 0)
        if start + size > len(data):
            raise _Damaged(f"an element says it has {size} bytes, and {max(0, len(data) - start)} are left")
        return kind, data[start : start + size], end

    def matrix(self, data: bytes, depth: int) -> tuple[str, Any]:
        """Name and value of an array: numbers, texts, a structure; words for anything else."""
        _, flags, at = self.element(data, 0)
        (flag,) = struct.unpack_from(f"{self.order}I", flags)
        form = flag & 0xFF
        if form in (17, 18):
            return self.text(data, at), _CLASSES[form]
        _, sizes, at = self.element(data, at)
        shape = tuple(int(one) for one in np.frombuffer(sizes, f"{self.order}i4"))
        kind, raw, at = self.element(data, at)
        name = self.decoded(kind, raw)
        if min(shape, default=-1) < 0 or len(shape) < 2 or len(shape) > 32:
            raise _Damaged(f"array '{name[:40]}' says it has the shape {shape[:4]}")
        if form == _STRUCTURE and depth < 2 and math.prod(shape) == 1:
            return name, self.structure(data, at, depth)
        if form not in _NUMERIC and form != _TEXT:
            return name, _CLASSES.get(form, "array of an unknown class")
        kind, raw, at = self.element(data, at)
        if form == _TEXT:
            return name, self.texts(kind, raw, shape)
        if kind not in _NUMBERS:
            raise _Damaged(f"array '{name[:40]}' holds numbers of an unknown type, {kind}")
        if flag & _COMPLEX:
            return name, "array of complex numbers"
        values = np.frombuffer(raw, self.order + _NUMBERS[kind])
        if len(values) != math.prod(shape):
            raise _Damaged(f"array '{name[:40]}' holds {len(values)} numbers, and its shape is {shape[:4]}")
        return name, values.astype(np.float64).reshape(shape, order="F")

    def structure(self, data: bytes, at: int, depth: int) -> dict[str, Any]:
        _, raw, at = self.element(data, at)
        (length,) = struct.unpack(f"{self.order}i", raw)
        _, raw, at = self.element(data, at)
        if not 0 < length <= 64 or len(raw) % length:
            raise _Damaged("a structure has no names of fields")
        LOG_COLUMNS.hold(len(raw) // length, "a structure", LogError)
        names = [raw[k : k + length].split(b"\0")[0].decode("latin-1") for k in range(0, len(raw), length)]
        found: dict[str, Any] = {}
        for name in names:
            kind, body, at = self.element(data, at)
            if kind != _MATRIX:
                raise _Damaged(f"field '{name}' is no array")
            found[name] = self.matrix(body, depth + 1)[1] if body else "empty array"
        return found

    def text(self, data: bytes, at: int) -> str:
        kind, raw, _ = self.element(data, at)
        return self.decoded(kind, raw)

    def decoded(self, kind: int, raw: bytes) -> str:
        encoding = _TEXTS.get(kind, "latin-1")
        if encoding.startswith("utf-") and encoding != "utf-8":
            encoding += "-le" if self.order == "<" else "-be"
        return raw.decode(encoding, "replace")

    def texts(self, kind: int, raw: bytes, shape: tuple[int, ...]) -> Any:
        """Rows of a matrix of characters."""
        text = self.decoded(kind, raw)
        if len(shape) != 2 or len(text) != shape[0] * shape[1] or not text:
            return "text"
        return [text[k :: shape[0]].strip() for k in range(shape[0])] if shape[0] > 1 else "text"
