"""Results as JSON: the numbers it has words for, and documents written whole or not at all."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .errors import brief
from .files import write_text


class RepeatedKey(ValueError):
    """An object of a JSON document says something twice."""


def parsed(text: str | bytes) -> Any:
    """What JSON says.  Raises ValueError where it is none, RepeatedKey where a key is written twice in one object: the
    second would count in silence."""
    return json.loads(text, object_pairs_hook=_once)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = Counter(name for name, _ in pairs).most_common(1)[0][0]
        raise RepeatedKey(f"the key {brief(twice)} is written twice in one object")
    return found


def finite(value: float | None) -> float | None:
    """The number, or None where JSON has no word for it."""
    return float(value) if value is not None and math.isfinite(value) else None


def finite_values(values: Mapping[str, float | None]) -> dict[str, float | None]:
    """Numbers by name, None for those that JSON has no word for."""
    return {name: finite(value) for name, value in values.items()}


def write_json(document: Mapping[str, Any], path: Path, overwrite: bool = True) -> Path:
    """Write a document; its path.  Raises ValueError for a number that is not finite, OutputError as ``write_text``."""
    return write_text(path, json.dumps(document, indent=1, allow_nan=False, ensure_ascii=False) + "\n", overwrite)
