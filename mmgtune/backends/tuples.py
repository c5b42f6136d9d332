"""Named tuples that hold named tuples, as the breakdown of the forces does."""

from __future__ import annotations

from itertools import count
from typing import Any, get_type_hints


def inner(of: type) -> dict[str, type | None]:
    """Fields of a named tuple, each with the named tuple it holds, None for a number."""
    hints = get_type_hints(of)
    kinds = {name: hints.get(name) for name in of._fields}  # type: ignore[attr-defined]
    return {name: kind if isinstance(kind, type) and hasattr(kind, "_fields") else None for name, kind in kinds.items()}


def leaves(of: type, before: str = "") -> list[str]:
    """Its numbers in order, each as ``field.field``."""
    found = []
    for name, kind in inner(of).items():
        found += leaves(kind, f"{before}{name}.") if kind else [before + name]
    return found


def numbered(of: type, counter: Any = None) -> tuple[Any, ...]:
    """The place of each number among ``leaves``, in tuples as the fields are."""
    counter = count() if counter is None else counter
    return tuple(numbered(kind, counter) if kind else next(counter) for kind in inner(of).values())
