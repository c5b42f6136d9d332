"""Files of trained models: bytes, headers and shapes that do not belong; read, and sailed for a few steps."""

from __future__ import annotations

import functools
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmgtune.backends import pad
from mmgtune.networks import Mixture, load_network, predictor_of, save_network
from mmgtune.networks.file import in_order
from tests.networks.made import ensemble, network
from tests.networks.test_hybrid import a_hybrid

from ..mutating import mutated_bytes, pick, several
from ..trees import mutated
from . import Files, Kind


@functools.cache
def contents() -> tuple[bytes, ...]:
    """A small model of each kind as its file."""
    import tempfile

    net = replace(network(step=0.5), ship="esso_osaka_3m")
    other = replace(network(step=0.5, memory=None, width=4, seed=2), ship="esso_osaka_3m", mirrored=True)
    mixtures = [Mixture(a_hybrid(), of, 0.4) for of in ((net,), (net, other))]
    models = (network(members=2), network(memory=None), a_hybrid(), ensemble(), *mixtures)
    with tempfile.TemporaryDirectory() as place:
        return tuple(save_network(one, Path(place) / f"{k}.safetensors").read_bytes() for k, one in enumerate(models))


def make(rng: np.random.Generator) -> Files:
    """A model with something wrong in its header, its arrays or its bytes."""
    from safetensors.numpy import load, save

    content = pick(rng, contents())
    how = rng.random()
    if how < 0.3:
        return {"model.safetensors": several(rng, content, [mutated_bytes])}
    size = int.from_bytes(content[:8], "little")
    metadata = json.loads(content[8 : 8 + size])["__metadata__"]
    arrays = load(content)
    if how < 0.7:
        metadata["network"] = _text(several(rng, json.loads(metadata["network"]), [mutated]))
    else:
        name = pick(rng, sorted(arrays))
        arrays[name] = pick(rng, ARRAYS)(rng, arrays[name])
        if arrays[name] is None:
            del arrays[name]
    return {"model.safetensors": in_order(save(arrays, metadata=metadata))}


def _text(tree: Any) -> str:
    return json.dumps(tree).encode("utf-8", "replace").decode()


ARRAYS = (
    lambda rng, a: None,
    lambda rng, a: a[:-1].copy(),
    lambda rng, a: np.concatenate([a, a]),
    lambda rng, a: a.ravel(),
    lambda rng, a: a.reshape(1, *a.shape),
    lambda rng, a: np.full_like(a, pick(rng, (np.nan, np.inf, 1e38, -1.0, 0.0))),
    lambda rng, a: a.astype(pick(rng, (np.float16, np.float64, np.int32, np.uint8, np.bool_))),
    lambda rng, a: np.zeros((0, *a.shape[1:]), a.dtype),
    lambda rng, a: (a * 10.0 ** float(rng.integers(-30, 30))).astype(a.dtype),
)
"""What is done to an array."""


def run(folder: Path) -> str:
    """Read it and sail for some steps: what it says is finite, or said to have diverged."""
    with np.errstate(all="ignore"):
        predictor = predictor_of(load_network(folder / "model.safetensors"))
        t = 0.5 * np.arange(7)
        controls = np.column_stack([np.full(7, 8.0 if k == 0 else 0.2) for k in range(len(predictor.inputs))])
        cases = pad([t], [controls], [np.array([0.0, 0.0, 0.0, 0.4, 0.0, 0.0])])
        if predictor.inputs and predictor.L_pp < 1e6 and (t[-1] / _step(predictor)) < 1e4:
            found = predictor.predict(cases)
            assert np.isfinite(found.states[~found.diverged]).all()
            return "diverged" if found.diverged.all() else "sailed"
    return "read"


def _step(predictor: Any) -> float:
    """Its own step [s]; that of the case where it has none."""
    for name in ("network", "ensemble", "mixture"):
        model = getattr(predictor, name, None)
        if model is not None:
            return float(model.step)
    return 0.5


KIND = Kind("networks", make, run)
