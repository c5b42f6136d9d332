"""Trained networks as files: weights in the safetensors format, facts as JSON in its header; nothing is executed."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .. import limits
from ..documents import parsed
from ..errors import NetworkError, Problem, brief, must_be_a, reason
from ..files import atomic, path_of, require_regular
from ..profile import parse_profile
from ..resources import folder, in_run, looked_for, must_be_name, network_names, taken
from ..run_files import MODEL
from .ensemble import Ensemble, Part
from .feedforward import Layers, Standards
from .hybrid import Hybrid
from .mixture import Mixture
from .model import Network
from .recurrent import Scales, Weights
from .residual import Ranges, ResidualWeights

SUFFIX = ".safetensors"
FORMAT = "mmgtune network"
SCHEMA, SEVERAL = 1, 2
"""Schemas: of all files, and of mixtures of several networks, which versions that know one alone refuse by it."""

Trained = Network | Hybrid | Ensemble | Mixture
FIX = "give a file that mmgtune learn has written, or train the model again"


def save_network(network: Trained, path: Path | str, *, overwrite: bool = False) -> Path:
    """Write networks, with the profile where there is one, whole or not at all.  Raises OutputError."""
    path = path_of(path)
    must_be_a(network, (Network, Hybrid, Ensemble, Mixture), "network")
    content = content_of(network)
    with atomic(path, overwrite) as part:
        part.write_bytes(content)
    return path


def content_of(network: Trained) -> bytes:
    """The file of networks: the same for the same weights and facts."""
    from safetensors.numpy import save

    header, groups = _described(network)
    arrays = {
        f"{group}.{name}": np.ascontiguousarray(values, dtype=np.float32)
        for group, of in groups.items()
        for name, values in of.items()
    }
    text = json.dumps(header, sort_keys=True, allow_nan=False)
    schema = SEVERAL if "networks" in header else SCHEMA
    return in_order(save(arrays, metadata={"format": FORMAT, "schema": str(schema), "network": text}))


def in_order(content: bytes) -> bytes:
    """The same file with its metadata sorted, which the library writes in any order: the same model, the same bytes."""
    size = int.from_bytes(content[:8], "little")
    header = json.loads(content[8 : 8 + size])
    header["__metadata__"] = dict(sorted(header["__metadata__"].items()))
    text = json.dumps(header, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 8)
    return len(text).to_bytes(8, "little") + text + content[8 + size :]


def _described(model: Trained) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """Header of a model, and its arrays by group and name."""
    if isinstance(model, Mixture):
        header: dict[str, Any] = {"kind": "mixture", "share": model.share}
        header["hybrid"], own = _described(model.hybrid)
        groups = {f"hybrid.{group}": of for group, of in own.items()}
        several = [_described(one) for one in model.networks]
        alone = len(several) == 1  # as in files from before there could be several
        header |= {"network": several[0][0]} if alone else {"networks": [of for of, _ in several]}
        for name, (_, own) in zip(["network"] if alone else _numbered(len(several)), several, strict=True):
            groups |= {f"{name}.{group}": of for group, of in own.items()}
    elif isinstance(model, Hybrid):
        header = {"kind": "hybrid", "profile": model.profile.text, "memory": model.memory}
        groups = {"weights": model.weights._asdict(), "ranges": model.ranges._asdict()}
    else:
        header = {"ship": model.ship, "L_pp": model.L_pp, "inputs": list(model.inputs), "step": model.step}
        if isinstance(model, Ensemble):
            header |= {"kind": "ensemble", "initial": model.initial}
            parts = {"motion": model.motion, **({"start": model.start} if model.start else {})}
            groups = {}
            for name, one in parts.items():
                groups |= {name: one.layers._asdict(), f"{name}_standards": one.standards._asdict()}
        else:
            header |= {"kind": "recurrent", "memory": model.memory}
            header |= {"mirrored": True} if model.mirrored else {}
            groups = {"weights": model.weights._asdict(), "scales": model.scales._asdict()}
    return {**header, "facts": model.facts}, groups


def load_network(path: str | Path) -> Trained:
    """Read a network, a hybrid, an ensemble or a mixture: a path, a run folder or a bundled name.

    Raises NetworkError for a file that is none, is damaged, or does not fit together; ProfileError for a hybrid whose
    profile this version cannot read.
    """
    from safetensors import SafetensorError, safe_open

    must_be_name(path, "trained model", NetworkError)
    bundled = folder("ship_profiles") / f"{path}{SUFFIX}"
    path = in_run(path, MODEL) or taken(path, Path(path).exists(), bundled) or Path(path)
    where = str(path)
    try:
        require_regular(path)
        if path.is_dir():
            raise NetworkError(Problem("a folder is no trained model", where, "", _in_folder(path)))
        limits.NETWORK_BYTES.require(path.stat().st_size, where, NetworkError)
        with safe_open(path, framework="numpy") as file:
            header, made = _header(file.metadata() or {}, where)
            _hold(header, made.header, where)
            groups_of = made.groups(header)
            wanted = [f"{group}.{name}" for group, of in groups_of.items() for name in of._fields]
            lacking = sorted({*wanted} - {*file.keys()})
            if lacking:
                raise NetworkError(Problem(f"the network lacks {', '.join(lacking)}", where, "", FIX))
            arrays = [np.asarray(file.get_tensor(name)) for name in wanted]
    except FileNotFoundError as error:
        fix = f"give a file that mmgtune learn has written, or a bundled name: {', '.join(network_names())}"
        raise NetworkError(Problem("no such trained model", where, looked_for(where, "model"), fix)) from error
    except (OSError, SafetensorError, ValueError, TypeError, AttributeError, MemoryError) as error:
        raise NetworkError(Problem("the network cannot be read", where, brief(reason(error)), FIX)) from error
    if any(one.dtype.kind != "f" for one in arrays):
        raise NetworkError(Problem("the network holds arrays that are no numbers", where, "", FIX))
    wide = iter([one.astype(np.float64) for one in arrays])
    groups = [of(*(next(wide) for _ in of._fields)) for of in groups_of.values()]
    try:
        return made.make(header, *groups, where)
    except (ValueError, OverflowError) as error:
        raise NetworkError(Problem(str(error), where, "the parts of the network do not fit", FIX)) from error


def _in_folder(path: Path) -> str:
    """The file to give in place of a folder."""
    inside = sorted(path.glob(f"*{SUFFIX}"))
    return f"give the file in it: {inside[0]}" if inside else FIX


_Kinds = Mapping[str, Any]
"""Types that what stands in a header may have, by key; or what stands in a table of it, likewise, or in each table of
a list."""


class _Made(NamedTuple):
    """How a kind of file is read: its groups of arrays, the types of its header, and what makes the model of both."""

    groups: Callable[[dict[str, Any]], dict[str, Any]]
    header: _Kinds
    make: Callable[..., Trained]


def _recurrent(header: dict[str, Any], weights: Weights, scales: Scales, where: str) -> Network:
    inputs = _inputs(header, where)
    if header["memory"] is not None:
        limits.NETWORK_MEMORY.require(header["memory"], where, NetworkError)
    mirrored = header.get("mirrored", False)  # files from before there were such networks do not say
    if not isinstance(mirrored, bool):
        raise NetworkError(Problem(f"mirrored of the network is {brief(mirrored)}", where, "", FIX))
    length, step = float(header["L_pp"]), float(header["step"])
    return Network(header["ship"], length, inputs, step, header["memory"], weights, scales, header["facts"], mirrored)


def _hybrid(header: dict[str, Any], weights: ResidualWeights, ranges: Ranges, where: str) -> Hybrid:
    limits.PROFILE_BYTES.require(len(header["profile"]), where, NetworkError)
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


def _mixture(header: dict[str, Any], *others: Any) -> Mixture:
    return _of_several({**header, "networks": [header["network"]]}, *others)


def _of_several(header: dict[str, Any], *others: Any) -> Mixture:
    weights, ranges, *of_networks, where = others
    hybrid = _hybrid(header["hybrid"], weights, ranges, where)
    several = zip(header["networks"], of_networks[::2], of_networks[1::2], strict=True)
    networks = tuple(_recurrent(one, net, scales, where) for one, net, scales in several)
    return Mixture(hybrid, networks, float(header["share"]), header["facts"])


def _groups_of_mixture(names: Sequence[str]) -> dict[str, Any]:
    of_networks = {f"{name}.{of}": kind for name in names for of, kind in (("weights", Weights), ("scales", Scales))}
    return {"hybrid.weights": ResidualWeights, "hybrid.ranges": Ranges, **of_networks}


def _numbered(n: int) -> list[str]:
    """What the groups of several networks begin with."""
    return [f"network.{k}" for k in range(n)]


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

_RECURRENT = {**_ALONE, "memory": (int, type(None))}
_HYBRID = {"profile": (str,), "memory": _NUMBER, "facts": (dict,)}

_MIXTURE = {"share": _NUMBER, "hybrid": _HYBRID, "facts": (dict,)}

_MADE = {
    ("recurrent", SCHEMA): _Made(lambda _: {"weights": Weights, "scales": Scales}, _RECURRENT, _recurrent),
    ("ensemble", SCHEMA): _Made(_groups_of_ensemble, {**_ALONE, "initial": (int,)}, _ensemble),
    ("hybrid", SCHEMA): _Made(lambda _: {"weights": ResidualWeights, "ranges": Ranges}, _HYBRID, _hybrid),
    ("mixture", SCHEMA): _Made(
        lambda _: _groups_of_mixture(["network"]), {**_MIXTURE, "network": _RECURRENT}, _mixture
    ),
    ("mixture", SEVERAL): _Made(
        lambda header: _groups_of_mixture(_numbered(len(header["networks"]))),
        {**_MIXTURE, "networks": [_RECURRENT]},
        _of_several,
    ),
}
"""By kind and schema."""


def _header(metadata: dict[str, str], where: str) -> tuple[dict[str, Any], _Made]:
    """The facts of a file, and how such a file is read.  Raises NetworkError where it is not one of ours."""
    if metadata.get("format") != FORMAT:
        raise NetworkError(Problem("the file holds no network of mmgtune", where, "its header does not say so", FIX))
    _schema(metadata, (SCHEMA, SEVERAL), where)
    try:
        found = parsed(metadata.get("network", ""))
    except (ValueError, RecursionError) as error:
        raise NetworkError(Problem("the header of the network cannot be read", where, reason(error), FIX)) from error
    if not isinstance(found, dict):
        raise NetworkError(Problem("the header of the network is no table", where, brief(found), FIX))
    kind: Any = found.get("kind")
    schemas = [of for name, of in _MADE if name == kind]
    if not schemas:
        why = f"known here: {', '.join(dict.fromkeys(name for name, _ in _MADE))}"
        raise NetworkError(Problem(f"the network is of kind {brief(kind)}", where, why, FIX))
    return found, _MADE[kind, _schema(metadata, schemas, where)]


def _schema(metadata: dict[str, str], known: Sequence[int], where: str) -> int:
    """The schema that a file is written in.  Raises NetworkError where it is none of those known."""
    given = metadata.get("schema")
    for one in known:
        if given == str(one):
            return one
    why = f"it is written in schema {brief(given)}, this version reads {' and '.join(map(str, known))}"
    raise NetworkError(Problem("the network is of another version", where, why, FIX))


def _hold(header: dict[str, Any], kinds: _Kinds, where: str) -> None:
    """Raises NetworkError where something in a header is missing or of another type."""
    wrong = []
    for key, kind in kinds.items():
        given = header.get(key, ...)
        if isinstance(kind, dict) and isinstance(given, dict):
            _hold(given, kind, where)
        elif isinstance(kind, list) and isinstance(given, list) and all(isinstance(one, dict) for one in given):
            limits.NETWORKS.require(len(given), where, NetworkError)
            for one in given:
                _hold(one, kind[0], where)
        elif isinstance(kind, (dict, list)) or not isinstance(given, kind) or isinstance(given, bool):
            wrong.append(Problem(f"{key} of the network is {brief(header.get(key))}", where, "", FIX))
    if wrong:
        raise NetworkError(*wrong)
