"""Reading MATLAB files of version 5 to 7 (.mat): numbers, texts, and structures of them.

The format is read here and not by a library, since only arrays of numbers and texts are wanted: objects, cells of
anything else and structures deep in each other are passed over without being made, whatever sizes they state.
Source: MathWorks, MAT-File Format, "Level 5 MAT-File Format".
"""

from __future__ import annotations

import math
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np

from ...arrays import FloatArray
from ...errors import LogError, Problem, reason
from ...limits import LOG_COLUMNS, MATLAB_BYTES, content
from .kept import opened

HEADER = 128
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
"""How elements hold numbers, by type."""
_TEXTS = {1: "latin-1", 2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
"""How elements hold texts, by type."""
_MATRIX, _COMPRESSED = 14, 15
_CLASSES = {1: "cell array", 2: "structure", 3: "object", 4: "text", 5: "sparse matrix", 17: "object", 18: "object"}
_CELLS, _STRUCTURE, _TEXT = 1, 2, 4
_NUMERIC = range(6, 16)
_COMPLEX = 0x0800
_VERSION_4 = frozenset(1000 * order + 10 * kind + form for order in (0, 1) for kind in range(6) for form in (0, 1))
"""Types of arrays in files of version 4: the order of bytes, the type of number, and whether it is a text."""
DEPTH = 4
"""How deep structures may stand in each other."""
MADE = 200_000
"""Fields and cells that are made of one file at most: of more, those that follow are not looked at."""
RUNS = 500
"""Structures that one array of them may have."""


@dataclass(frozen=True)
class Other:
    """What is held and is neither numbers, texts nor structures: in words, with the article where they need one."""

    kind: str

    def __str__(self) -> str:
        return self.kind


Value: TypeAlias = "FloatArray | str | list[str] | dict[str, Value] | list[dict[str, Value]] | Other"
"""What a variable or field holds: numbers of any shape, a text, texts, a structure, structures of one kind, or what
else it is."""


class _Damaged(Exception):
    """The bytes are not what the format says."""


def variables(path: Path) -> dict[str, Value]:
    """What a file holds, by name.

    Raises LogError where it is damaged, for files of version 4 and 7.3, and where there is more in it than may be.
    """
    with opened(path, "mat", lambda: _variables(path), lambda _: None) as found:
        return found


def _variables(path: Path) -> dict[str, Value]:
    data = content(path, MATLAB_BYTES, LogError)
    fix = 'save it again with save("file.mat", "-v7")'
    if b"MATLAB 7.3" in data[:HEADER] or data.startswith(b"\x89HDF"):
        why = "files of version 7.3 are HDF5"
        raise LogError(Problem("the MATLAB file is of version 7.3", str(path), why, fix))
    if of_version_4(data):
        raise LogError(Problem("the MATLAB file is of version 4", str(path), "files of versions 5 to 7 are read", fix))
    mark = data[126:128]
    if len(data) < HEADER or mark not in (b"IM", b"MI"):
        why = "its first bytes do not say so" if data else "it is empty"
        raise LogError(Problem("the file is no MATLAB file of version 5 to 7", str(path), why, fix))
    try:
        return _Reader("<" if mark == b"IM" else ">").variables(data)
    except (_Damaged, struct.error, zlib.error, ValueError) as error:
        raise LogError(Problem("the MATLAB file cannot be read", str(path), reason(error), fix)) from error


def of_version_4(start: bytes) -> bool:
    """Whether a file begins as those of version 4: with the type, sizes and the name of an array."""
    if len(start) < 21:
        return False
    for order in "<>":
        kind, rows, columns, imaginary, length = struct.unpack_from(f"{order}5i", start)
        if kind in _VERSION_4 and min(rows, columns) >= 0 and imaginary in (0, 1) and 1 < length <= 64:
            name = start[20 : 20 + length - 1]
            return name.isascii() and name.replace(b"_", b"").isalnum()
    return False


class _Reader:
    """One pass over a file.

    order  of bytes: "<" or ">"
    """

    def __init__(self, order: str):
        self.order = order
        self.left = MATLAB_BYTES.most
        self.made = 0

    def variables(self, data: bytes) -> dict[str, Value]:
        found: dict[str, Value] = {}
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

    def matrix(self, data: bytes, depth: int) -> tuple[str, Value]:
        """Name and value of an array."""
        self.made += 1
        _, flags, at = self.element(data, 0)
        (flag,) = struct.unpack_from(f"{self.order}I", flags)
        form = flag & 0xFF
        if form in (17, 18):
            return self.text(data, at), Other(_CLASSES[form])
        _, sizes, at = self.element(data, at)
        shape = tuple(int(one) for one in np.frombuffer(sizes, f"{self.order}i4"))
        kind, raw, at = self.element(data, at)
        name = self.decoded(kind, raw)
        if min(shape, default=-1) < 0 or len(shape) < 2 or len(shape) > 32:
            raise _Damaged(f"array '{name[:40]}' says it has the shape {shape[:4]}")
        many = math.prod(shape)
        if form == _STRUCTURE and depth < DEPTH and 0 < many <= RUNS:
            return name, self.structures(data, at, depth, many)
        if form == _CELLS and depth <= DEPTH and 0 < many <= MADE - self.made:
            return name, self.cells(data, at, many)
        if form not in _NUMERIC and form != _TEXT:
            several = f"array of {many} structures" if form == _STRUCTURE and many > 1 else ""
            return name, Other(several or _CLASSES.get(form, "array of an unknown class"))
        kind, raw, at = self.element(data, at)
        if form == _TEXT:
            return name, self.texts(kind, raw, shape)
        if kind not in _NUMBERS:
            raise _Damaged(f"array '{name[:40]}' holds numbers of an unknown type, {kind}")
        if flag & _COMPLEX:
            return name, Other("array of complex numbers")
        values = np.frombuffer(raw, self.order + _NUMBERS[kind])
        if len(values) != many:
            raise _Damaged(f"array '{name[:40]}' holds {len(values)} numbers, and its shape is {shape[:4]}")
        return name, values.astype(np.float64).reshape(shape, order="F")

    def structures(self, data: bytes, at: int, depth: int, many: int) -> Value:
        """A structure, or several whose fields follow each other, those of the first one first."""
        _, raw, at = self.element(data, at)
        (length,) = struct.unpack(f"{self.order}i", raw)
        _, raw, at = self.element(data, at)
        if not 0 < length <= 64 or len(raw) % length:
            raise _Damaged("a structure has no names of fields")
        LOG_COLUMNS.require(len(raw) // length, "a structure", LogError)
        names = [raw[k : k + length].split(b"\0")[0].decode("latin-1") for k in range(0, len(raw), length)]
        if many * len(names) > MADE - self.made:
            return Other("structure")
        found: list[dict[str, Value]] = []
        for _ in range(many):
            fields: dict[str, Value] = {}
            for name in names:
                kind, body, at = self.element(data, at)
                if kind != _MATRIX:
                    raise _Damaged(f"field '{name}' is no array")
                fields[name] = self.matrix(body, depth + 1)[1] if body else Other("empty array")
            found.append(fields)
        return found if many > 1 else found[0]

    def cells(self, data: bytes, at: int, many: int) -> Value:
        """The texts of an array of cells; words where one of them holds anything else."""
        found: list[str] = []
        for _ in range(many):
            kind, body, at = self.element(data, at)
            value = self.matrix(body, DEPTH + 1)[1] if kind == _MATRIX and body else ""
            if not isinstance(value, str):
                empty = isinstance(value, np.ndarray) and not value.size
                if not empty:
                    return Other(_CLASSES[_CELLS])
                value = ""
            found.append(value)
        return found

    def text(self, data: bytes, at: int) -> str:
        kind, raw, _ = self.element(data, at)
        return self.decoded(kind, raw)

    def decoded(self, kind: int, raw: bytes) -> str:
        encoding = _TEXTS.get(kind, "latin-1")
        if encoding.startswith("utf-") and encoding != "utf-8":
            encoding += "-le" if self.order == "<" else "-be"
        return raw.decode(encoding, "replace")

    def texts(self, kind: int, raw: bytes, shape: tuple[int, ...]) -> Value:
        """A text, or the rows of a matrix of characters."""
        text = self.decoded(kind, raw)
        if len(shape) != 2 or len(text) != shape[0] * shape[1]:
            return Other("text")
        return [text[k :: shape[0]].strip() for k in range(shape[0])] if shape[0] > 1 else text.strip()
