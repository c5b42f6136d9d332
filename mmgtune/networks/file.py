"""Trained networks as files: weights in the safetensors format, facts as JSON in its header; nothing is executed."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .. import limits
from ..errors import NetworkError, Problem, brief
from ..files import atomic
from ..profile import parse_profile
from .ensemble import Ensemble, Part
from .feedforward import Layers, Standards
from .hybrid import Hybrid
from .model import Network
from .recurrent import Scales, Weights
from .residual import Ranges, ResidualWeights

SUFFIX = ".safetensors"
FORMAT = "mmgtune network"
SCHEMA = 1
Trained = Network | Hybrid | Ensemble
FIX = "give a file that mmgtune learn has written, or train the model again"


def save_network(network: Trained, path: Path, *, overwrite: bool = False) -> Path:
    """Write networks, with the profile where there is one, whole or not at all.  Raises OutputError."""
    from safetensors.numpy import save

    header: dict[str, Any]
    if isinstance(network, Hybrid):
        header = {"kind": "hybrid", "profile": network.profile.text, "memory": network.memory}
        groups = {"weights": network.weights._asdict(), "ranges": network.ranges._asdict()}
    else:
        header = {
            "ship": network.ship,
            "L_pp": network.L_pp,
            "inputs": list(network.inputs),
            "step": network.step,
        }
        if isinstance(network, Ensemble):
            header |= {"kind": "ensemble", "initial": network.initial}
            parts = {"motion": network.motion, **({"start": network.start} if network.start else {})}
            groups = {}
            for name, one in parts.items():
                groups |= {name: one.layers._asdict(), f"{name}_standards": one.standards._asdict()}
        else:
            header |= {"kind": "recurrent", "memory": network.memory}
            groups = {"weights": network.weights._asdict(), "scales": network.scales._asdict()}
    arrays = {
        f"{group}.{name}": np.ascontiguousarray(values, dtype=np.float32)
        for group, of in groups.items()
        for name, values in of.items()
    }
    text = json.dumps({**header, "facts": network.facts}, sort_keys=True, allow_nan=False)
    content = save(arrays, metadata={"format": FORMAT, "schema": str(SCHEMA), "network": text})
    with atomic(path, overwrite) as part:
        part.write_bytes(content)
    return path


def load_network(path: str | Path) -> Trained:
    """Read a network, a hybrid or an ensemble.

    Raises NetworkError for a file that is none, is damaged, or does not fit together; ProfileError for a hybrid whose
    profile this version cannot read.
    """
    from safetensors import SafetensorError, safe_open

    path = Path(path)
    where = str(path)
    try:
        limits.NETWORK_BYTES.hold(path.stat().st_size, where, NetworkError)
        with safe_open(path, framework="numpy") as file:
            header = _header(file.metadata() or {}, where)
            made = _MADE[header["kind"]]
            _hold(header, made.header, where)
            groups_of = made.groups(header)
            wanted = [f"{group}.{name}" for group, of in groups_of.items() for name in of._fields]
            lacking = sorted({*wanted} - {*file.keys()})
            if lacking:
                raise NetworkError(Problem(f"the network lacks {', '.join(lacking)}", where, "", FIX))
            arrays = [np.asarray(file.get_tensor(name)) for name in wanted]
    except (OSError, SafetensorError, ValueError, TypeError, MemoryError) as error:
        raise NetworkError(Problem("the network cannot be read", where, brief(str(error)), FIX)) from error
    if any(one.dtype.kind != "f" for one in arrays):
        raise NetworkError(Problem("the network holds arrays that are no numbers", where, "", FIX))
    wide = iter([one.astype(np.float64) for one in arrays])
    groups = [of(*(next(wide) for _ in of._fields)) for of in groups_of.values()]
    try:
        return made.make(header, *groups, where)
    except (ValueError, OverflowError) as error:
        raise NetworkError(Problem(str(error), where, "the parts of the network do not fit", FIX)) from error


class _Made(NamedTuple):
    """How a kind of file is read: its groups of arrays, the types of its header, and what makes the model of both."""

    groups: Callable[[dict[str, Any]], dict[str, Any]]
    header: dict[str, tuple[type, ...]]
    make: Callable[..., Trained]


def _recurrent(header: dict[str, Any], weights: Weights, scales: Scales, where: str) -> Network:
    inputs = _inputs(header, where)
    if header["memory"] is not None:
        limits.NETWORK_MEMORY.hold(header["memory"], where, NetworkError)
    length, step = float(header["L_pp"]), float(header["step"])
    return Network(header["ship"], length, inputs, step, header["memory"], weights, scales, header["facts"])


def _hybrid(header: dict[str, Any], weights: ResidualWeights, ranges: Ranges, where: str) -> Hybrid:
    limits.PROFILE_BYTES.hold(len(header["profile"]), where, NetworkError)
    profile = parse_profile(header["profile"], Path(where))
    return Hybrid(profile, weights, ranges, float(header["memory"]), header["facts"])


def _ensemble(header: dict[str, Any], motion: Layers, standards: Standards, *others: Any) -> Ensemble:
    *start, where = others
    found = Ensemble(
        ship=header["ship"],
        L_pp=float(header["L_pp"]),
        inputs=_inputs(header, where),
        step=float(header["step"]),
        motion=Part(motion, standards),
        start=Part(*start) if start else None,
        facts=header["facts"],
    )
    if found.initial != header["initial"]:
        raise ValueError(f"the initial-state network sees {found.initial} observations, not {header['initial']}")
    return found


def _groups_of_ensemble(header: dict[str, Any]) -> dict[str, Any]:
    parts = ("motion", "start") if header["initial"] else ("motion",)
    return {name: of for part in parts for name, of in ((part, Layers), (f"{part}_standards", Standards))}


def _inputs(header: dict[str, Any], where: str) -> tuple[str, ...]:
    inputs = header["inputs"]
    if not all(isinstance(name, str) for name in inputs):
        raise NetworkError(Problem(f"inputs of the network are {brief(inputs)}", where, "", FIX))
    return tuple(inputs)


_NUMBER = (float, int)
_ALONE = {"ship": (str,), "L_pp": _NUMBER, "inputs": (list,), "step": _NUMBER, "facts": (dict,)}
"""In the header of networks that need no profile."""

_MADE = {
    "recurrent": _Made(
        lambda _: {"weights": Weights, "scales": Scales}, {**_ALONE, "memory": (int, type(None))}, _recurrent
    ),
    "ensemble": _Made(_groups_of_ensemble, {**_ALONE, "initial": (int,)}, _ensemble),
    "hybrid": _Made(
        lambda _: {"weights": ResidualWeights, "ranges": Ranges},
        {"profile": (str,), "memory": _NUMBER, "facts": (dict,)},
        _hybrid,
    ),
}


def _header(metadata: dict[str, str], where: str) -> dict[str, Any]:
    """The facts of a file.  Raises NetworkError where it is not one of ours."""
    if metadata.get("format") != FORMAT:
        raise NetworkError(Problem("the file holds no network of mmgtune", where, "its header does not say so", FIX))
    if metadata.get("schema") != str(SCHEMA):
        why = f"it is written in schema {brief(metadata.get('schema'))}, this version reads {SCHEMA}"
        raise NetworkError(Problem("the network is of another version", where, why, FIX))
    try:
        found = json.loads(metadata.get("network", ""))
    except (ValueError, RecursionError) as error:
        raise NetworkError(Problem("the header of the network cannot be read", where, str(error), FIX)) from error
    if not isinstance(found, dict):
        raise NetworkError(Problem("the header of the network is no table", where, brief(found), FIX))
    if not isinstance(found.get("kind"), str) or found["kind"] not in _MADE:
        why = f"known here: {', '.join(_MADE)}"
        raise NetworkError(Problem(f"the network is of kind {brief(found.get('kind'))}", where, why, FIX))
    return found


def _hold(header: dict[str, Any], kinds: dict[str, tuple[type, ...]], where: str) -> None:
    """Raises NetworkError where something in a header is missing or of another type."""
    wrong = [
        Problem(f"{key} of the network is {brief(header.get(key))}", where, "", FIX)
        for key, kind in kinds.items()
        if not isinstance(header.get(key, ...), kind) or isinstance(header.get(key), bool)
    ]
    if wrong:
        raise NetworkError(*wrong)
