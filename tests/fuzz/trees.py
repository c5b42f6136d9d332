"""What is done to values inside one another, as JSON and TOML hold them."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from typing import Any

import numpy as np

from .mutating import encoded, mutated_bytes, mutated_lines, odd_text, pick, several

DEEP: list[Any] = [[[[[[[[[[[[]]]]]]]]]]]]
STEERING = "\x1b]0;x\x07\n::error::planted\r\u202e"
ODD: tuple[Any, ...] = (
    True, False, 0, 1, -1, 3, 10**18, 10**400, -(10**400), 0.0, -0.0, 0.5, 1e308, -1e308, 1e-320, 5e-324,
    float("nan"), float("inf"), -float("inf"), "", " ", "x", "x" * 5000, "1", "1 m", "nan", "../..", "/", STEERING,
    "\udcff",    [], {}, [[]], [{}], {"": {}}, {"value": []}, DEEP,
    [1.0], [1.0, 2.0], ["a", 3], [None], list(range(2000)),
)  # fmt: skip
"""Values where another belongs."""


def places(tree: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Paths of keys and positions to everything in a tree."""
    inside = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in inside:
        yield (*path, key)
        yield from places(value, (*path, key))


def mutated(rng: np.random.Generator, tree: Any, odd: tuple[Any, ...] = ODD) -> Any:
    """One value exchanged for an odd one or for another of the tree, left out, doubled, scaled or named otherwise."""
    tree = copy.deepcopy(tree)
    there = list(places(tree))
    if not there:
        return tree
    # As often near the root as in long tables.
    depth = int(rng.integers(1, 1 + max(len(path) for path in there)))
    path = pick(rng, [one for one in there if len(one) == depth])
    parent = at(tree, path[:-1])
    how = int(rng.integers(8))
    value = parent[path[-1]]
    if how < 3:
        parent[path[-1]] = copy.deepcopy(pick(rng, odd))
    elif how == 3:
        parent[path[-1]] = copy.deepcopy(at(tree, pick(rng, there)))
    elif how == 4:
        del parent[path[-1]]
    elif how == 5 and isinstance(value, (int, float)) and not isinstance(value, bool):
        factor = pick(rng, (-1, 0, 1e-9, 1e9, 1e300, 1e-300, 10, 0.1))
        beyond = isinstance(value, int) and abs(value) > 10**300  # no float holds it, as an earlier change may leave it
        parent[path[-1]] = value * (int(factor) if beyond else factor)
    elif how == 6 and isinstance(parent, dict):
        parent[odd_text(rng)] = value
    else:
        parent[path[-1]] = odd_text(rng)
    return tree


def at(tree: Any, path: tuple[Any, ...]) -> Any:
    """What a path leads to."""
    for key in path:
        tree = tree[key]
    return tree


def as_json(tree: Any) -> bytes:
    """A tree as JSON, with what JSON does not have as Python writes it."""
    return json.dumps(tree, indent=1).encode()


def as_toml(tree: dict[str, Any], prefix: str = "") -> str:
    """A tree as TOML: tables under headers, everything below a list inline."""
    plain = {key: value for key, value in tree.items() if not _headed(value)}
    lines = [f"{_key(key)} = {_inline(value)}" for key, value in plain.items()]
    for key, value in tree.items():
        if _headed(value):
            name = f"{prefix}{_key(key)}"
            lines += [f"[{name}]", as_toml(value, f"{name}.")]
    return "\n".join(lines)


def _headed(value: Any) -> bool:
    return isinstance(value, dict) and "value" not in value


def _key(key: Any) -> str:
    text = str(key)
    return text if text and all(c.isascii() and (c.isalnum() or c in "_-") for c in text) else _inline(text)


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {_inline(one)}" for key, one in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return str(value)
    if value is None:
        return '""'
    text = str(value).encode("utf-8", "replace").decode()
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def hostile_toml(rng: np.random.Generator, text: str, tree: dict[str, Any]) -> bytes:
    """A TOML file with something wrong in its values, lines or bytes; tree is what its text says."""
    how = rng.random()
    if how < 0.7:
        return encoded(as_toml(several(rng, tree, [mutated])))
    if how < 0.85:
        return encoded("\n".join(several(rng, text.splitlines(), [mutated_lines])))
    content = text.encode(pick(rng, ("utf-8", "utf-8", "utf-8-sig", "utf-16", "cp1252")), "replace")
    return several(rng, content, [mutated_bytes])
