"""Trained networks as files: weights in the safetensors format, facts as JSON in its header; nothing is executed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from .. import limits
from ..errors import NetworkError, Problem, brief
from ..files import atomic
from .model import Network
from .recurrent import Scales, Weights

SUFFIX = ".safetensors"
FORMAT = "mmgtune network"
SCHEMA = 1
FIX = "give a file that mmgtune learn has written, or train the model again"


def save_network(network: Network, path: Path, *, overwrite: bool = False) -> Path:
    """Write a network, whole or not at all.  Raises OutputError."""
    from safetensors.numpy import save

    header = {
        "ship": network.ship,
        "L_pp": network.L_pp,
        "inputs": list(network.inputs),
        "step": network.step,
        "memory": network.memory,
        "facts": network.facts,
    }
    groups = {"weights": network.weights._asdict(), "scales": network.scales._asdict()}
    arrays = {
        f"{group}.{name}": np.ascontiguousarray(values, dtype=np.float32)
        for group, of in groups.items()
        for name, values in of.items()
    }
    text = json.dumps(header, sort_keys=True, allow_nan=False)
    content = save(arrays, metadata={"format": FORMAT, "schema": str(SCHEMA), "network": text})
    with atomic(path, overwrite) as part:
        part.write_bytes(content)
    return path


def load_network(path: str | Path) -> Network:
    """Read a network.  Raises NetworkError for a file that is none, is damaged, or does not fit together."""
    from safetensors import SafetensorError, safe_open

    path = Path(path)
    where = str(path)
    try:
        limits.NETWORK_BYTES.hold(path.stat().st_size, where, NetworkError)
        with safe_open(path, framework="numpy") as file:
            metadata = file.metadata() or {}
            names = file.keys()
            wanted = [f"weights.{name}" for name in Weights._fields] + [f"scales.{name}" for name in Scales._fields]
            header = _header(metadata, where)
            lacking = sorted({*wanted} - {*names})
            if lacking:
                raise NetworkError(Problem(f"the network lacks {', '.join(lacking)}", where, "", FIX))
            arrays = [np.asarray(file.get_tensor(name)) for name in wanted]
    except (OSError, SafetensorError, ValueError, TypeError, MemoryError) as error:
        raise NetworkError(Problem("the network cannot be read", where, brief(str(error)), FIX)) from error
    if any(one.dtype.kind != "f" for one in arrays):
        raise NetworkError(Problem("the network holds arrays that are no numbers", where, "", FIX))
    wide = [one.astype(np.float64) for one in arrays]
    n = len(Weights._fields)
    return _made(header, Weights(*wide[:n]), Scales(*wide[n:]), where)


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
    return found


def _made(header: dict[str, Any], weights: Weights, scales: Scales, where: str) -> Network:
    """The network of these parts.  Raises NetworkError."""
    kinds: dict[str, tuple[type, ...]] = {
        "ship": (str,),
        "L_pp": (float, int),
        "inputs": (list,),
        "step": (float, int),
        "memory": (int, type(None)),
        "facts": (dict,),
    }
    wrong = [
        Problem(f"{key} of the network is {brief(header.get(key))}", where, "", FIX)
        for key, kind in kinds.items()
        if not isinstance(header.get(key, ...), kind) or isinstance(header.get(key), bool)
    ]
    if not wrong and not all(isinstance(name, str) for name in header["inputs"]):
        wrong = [Problem(f"inputs of the network are {brief(header['inputs'])}", where, "", FIX)]
    if wrong:
        raise NetworkError(*wrong)
    memory = header["memory"]
    if memory is not None:
        limits.NETWORK_MEMORY.hold(memory, where, NetworkError)
    try:
        return Network(
            header["ship"],
            float(header["L_pp"]),
            tuple(header["inputs"]),
            float(header["step"]),
            memory,
            weights,
            scales,
            header["facts"],
        )
    except (ValueError, OverflowError) as error:
        raise NetworkError(Problem(str(error), where, "the parts of the network do not fit", FIX)) from error
