"""Checkpoints of a training: what has been learned so far, whole or not at all, and never executed on loading."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..backends.twins import jax_module
from ..errors import OptionError, Problem, reason
from ..files import atomic, require_regular
from ..fitting.checkpoint import differing, nothing_to_resume
from ..run_files import CHECKPOINTS
from .training import Progressed

AnyArray = npt.NDArray[Any]


def named(number: int) -> str:
    """The file of a training in the folder of a run."""
    return f"training-{number}.safetensors"


@dataclass(frozen=True)
class Kept:
    """Checkpoints of the trainings of one run, by number.

    folder    None for nowhere
    identity  everything the weights depend on, but for the versions of what trains them
    resume    whether trainings go on where they were stopped
    """

    folder: Path | None
    identity: dict[str, Any]
    resume: bool

    def __post_init__(self) -> None:
        """Raises OptionError where there is nothing to resume, or a checkpoint is damaged: before any training."""
        versions = {name: version(name) for name in ("jax", "jaxlib", "optax", "numpy")}
        object.__setattr__(self, "identity", {**self.identity, "versions": versions})
        if not self.resume or self.folder is None:
            return
        there = sorted(self.folder.glob(CHECKPOINTS))
        if not there:
            raise nothing_to_resume(self.folder, "checkpoint", "it never came to its first validation")
        for path in there:
            _read(path)

    def begun(self, number: int, first: Progressed) -> Progressed:
        """Where a training goes on: at its checkpoint, or at the beginning.  Raises OptionError as ``load`` does."""
        path = self._path(number)
        return load(path, first, self.identity) if self.resume and path and path.exists() else first

    def keep(self, number: int, now: Progressed) -> None:
        """Write where a training stands.  Raises OutputError."""
        path = self._path(number)
        if path is not None:
            save(path, now, self.identity)

    def _path(self, number: int) -> Path | None:
        return None if self.folder is None else self.folder / named(number)


def save(path: Path, now: Progressed, identity: dict[str, Any]) -> None:
    """Write where a training stands.  Raises OutputError."""
    from safetensors.numpy import save as as_bytes

    stood = [now] if now.good is None else [now, now.good]
    leaves = [leaf for one in stood for leaf in jax_module().tree.leaves(_trees(one))]
    arrays = {f"{k:05d}": np.array(leaf, order="C") for k, leaf in enumerate(leaves)}
    numbers = {**_numbers(now), "good": None if now.good is None else _numbers(now.good), "identity": identity}
    text = json.dumps(numbers)
    content = as_bytes(arrays, metadata={"training": text, "sha256": _sum(text, arrays)})
    with atomic(path) as part:
        part.write_bytes(content)


def load(path: Path, like: Progressed, identity: dict[str, Any]) -> Progressed:
    """Where a training stood; ``like`` is one of the same shapes.

    Raises OptionError where the file is damaged, or belongs to another training.
    """
    jax = jax_module()
    leaves, tree = jax.tree.flatten(_trees(like))
    numbers, held = _read(path)
    differing(numbers["identity"], identity, path)
    stood = [_stood(one) for one in (numbers, numbers["good"]) if one is not None]
    n, arrays = len(leaves), [held[name] for name in sorted(held)]
    wanted = leaves * len(stood)
    if len(arrays) != len(wanted) or any(
        a.shape != np.shape(b) or a.dtype != b.dtype for a, b in zip(arrays, wanted, strict=True)
    ):
        raise _unreadable(path, "its arrays have other shapes or types")
    trees = [
        jax.tree.unflatten(tree, [jax.numpy.asarray(one) for one in arrays[k : k + n]])
        for k in range(0, len(arrays), n)
    ]
    now, *good = (Progressed(*own, *numbers) for own, numbers in zip(trees, stood, strict=True))
    return replace(now, good=good[0] if good else None)


def _read(path: Path) -> tuple[dict[str, Any], dict[str, AnyArray]]:
    """What a checkpoint says besides its arrays, and these by name, as they were written.

    Raises OptionError where the file is damaged.
    """
    from safetensors import safe_open

    try:
        require_regular(path)
        if path.is_dir():
            raise OSError("it is a folder")
        with safe_open(path, framework="numpy") as file:
            metadata = file.metadata() or {}
            names = list(file.keys())
            arrays = {name: np.asarray(file.get_tensor(name)) for name in names}
        text = metadata.get("training", "")
    except Exception as error:  # the library raises what it comes across where a file is damaged
        raise _unreadable(path, reason(error)) from error
    if metadata.get("sha256") != _sum(text, arrays):
        raise _unreadable(path, "its checksum is not that of what it holds")
    numbers: dict[str, Any] = json.loads(text)
    return numbers, arrays


def _sum(text: str, arrays: Mapping[str, AnyArray]) -> str:
    """The checksum of a checkpoint."""
    found = hashlib.sha256(text.encode())
    for name, array in sorted(arrays.items()):
        found.update(f"{name} {array.dtype} {array.shape}".encode())
        found.update(array.tobytes())
    return found.hexdigest()


def _numbers(one: Progressed) -> dict[str, Any]:
    """What a training stands at besides its arrays, for JSON."""
    return {
        "best_score": repr(one.best_score),
        "step": one.step,
        "factor": one.factor,
        "lost": one.lost,
        "curve": one.curve,
        "events": one.events,
    }


def _stood(numbers: dict[str, Any]) -> tuple[Any, ...]:
    """The same from JSON, in the order of ``Progressed``."""
    return (
        float(numbers["best_score"]),
        int(numbers["step"]),
        float(numbers["factor"]),
        int(numbers["lost"]),
        list(numbers["curve"]),
        list(numbers["events"]),
    )


def _trees(now: Progressed) -> tuple[Any, ...]:
    return now.parameters, now.state, now.mean, now.best


def _unreadable(path: Path, why: str) -> OptionError:
    return OptionError(
        Problem("the checkpoint cannot be read", str(path), why, "delete it, or run without resume=True")
    )
