"""A digest of what a trial file holds, kept in the file: damage that Parquet does not notice is noticed by it."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping

import numpy as np

from ..arrays import FloatArray

DIGEST_KEY = b"mmgtune.sha256"


def digest(columns: Mapping[str, FloatArray], facts: bytes) -> bytes:
    """SHA-256, in hexadecimal, of columns (n_samples,) by name in their order, to the last bit, and of the facts."""
    return digest_of(((name, len(values), (values,)) for name, values in columns.items()), facts)


def digest_of(columns: Iterable[tuple[str, int, Iterable[FloatArray]]], facts: bytes) -> bytes:
    """The digest of columns that come in parts: name, number of samples, and the parts in order."""
    found = hashlib.sha256(len(facts).to_bytes(8, "little") + facts)
    for name, n_samples, parts in columns:
        raw = name.encode("utf-8", "surrogatepass")
        found.update(len(raw).to_bytes(8, "little") + raw + n_samples.to_bytes(8, "little"))
        for values in parts:
            found.update(np.ascontiguousarray(values, dtype="<f8").data)
    return found.hexdigest().encode()
