"""Files of networks: what is written is read, what is no network is refused."""

from __future__ import annotations

import contextlib
import json
from dataclasses import replace

import numpy as np
import pytest

from mmgtune import limits
from mmgtune.errors import NetworkError, OutputError
from mmgtune.networks import load_network, named_ship, save_network
from mmgtune.networks.file import _described

from .made import network


@pytest.mark.parametrize("memory", [None, 3])
def test_round_trip(tmp_path, memory):
    net = network(members=2, memory=memory)
    again = load_network(save_network(net, tmp_path / "model.safetensors"))
    assert (again.ship, again.L_pp, again.inputs, again.step, again.memory, again.facts) == (
        net.ship,
        net.L_pp,
        net.inputs,
        net.step,
        net.memory,
        net.facts,
    )
    for a, b in zip((*net.weights, *net.scales), (*again.weights, *again.scales), strict=True):
        np.testing.assert_array_equal(np.float32(a), b)


def test_a_mirrored_network_stays_one(tmp_path):
    path = save_network(replace(network(), mirrored=True), tmp_path / "model.safetensors")
    assert load_network(path).mirrored
    assert load_network(path).member(0).mirrored


def test_never_overwritten_silently(tmp_path):
    path = save_network(network(), tmp_path / "model.safetensors")
    with pytest.raises(OutputError):
        save_network(network(seed=2), path)


def test_a_path_is_told_from_a_profile(tmp_path):
    path = save_network(network(), tmp_path / "model.safetensors")
    assert named_ship(str(path)).L_pp == 3.0
    assert named_ship("suzaku").id == "suzaku"
    assert named_ship(5.0) == 5.0


def altered(tmp_path, change):
    """A file in whose header, and arrays, something is changed."""
    from safetensors.numpy import save_file

    net = network()
    arrays = {f"weights.{k}": np.float32(v) for k, v in net.weights._asdict().items()}
    arrays |= {f"scales.{k}": np.float32(v) for k, v in net.scales._asdict().items()}
    header = {
        "kind": "recurrent",
        "ship": "toy",
        "L_pp": 3.0,
        "inputs": ["n", "delta"],
        "step": 0.1,
        "memory": 3,
        "facts": {},
    }
    metadata = {"format": "mmgtune network", "schema": "1"}
    change(arrays, header, metadata)
    metadata.setdefault("network", json.dumps(header))
    save_file(arrays, tmp_path / "changed.safetensors", metadata=metadata)
    return tmp_path / "changed.safetensors"


def test_the_unaltered_file_is_read(tmp_path):
    assert load_network(altered(tmp_path, lambda *_: None)).width == 5


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda a, h, m: m.update(format="other"), "no network"),
        (lambda a, h, m: m.update(schema="2"), "another version"),
        (lambda a, h, m: m.update(network="{"), "header"),
        (lambda a, h, m: m.update(network="[1]"), "no table"),
        (lambda a, h, m: m.update(network="[" * 100_000), "header"),
        (lambda a, h, m: a.pop("weights.W_r"), "lacks weights.W_r"),
        (lambda a, h, m: a.update({"weights.W_r": np.zeros((1, 4, 4), np.float32)}), "W_r has the shape"),
        (lambda a, h, m: a.update({"weights.b_1": np.full((1, 1, 5), np.nan, np.float32)}), "not finite"),
        (lambda a, h, m: a.update({"weights.b_1": np.ones((1, 1, 5), np.int64)}), "no numbers"),
        (lambda a, h, m: a.update({"weights.W_x": np.zeros((7, 5), np.float32)}), "members x features x width"),
        (lambda a, h, m: a.update({"scales.features": np.zeros((1, 1, 7), np.float32)}), "divided by 0"),
        (lambda a, h, m: h.update(kind="other"), "of kind"),
        (lambda a, h, m: h.update(kind=["hybrid"]), "of kind"),
        (lambda a, h, m: h.update(inputs=["n", "flaps"]), "no input is called flaps"),
        (lambda a, h, m: h.update(inputs=["n"]), "W_x has the shape"),
        (lambda a, h, m: h.update(inputs="n"), "inputs of the network"),
        (lambda a, h, m: h.update(inputs=[1, 2]), "inputs of the network"),
        (lambda a, h, m: h.update(step=0.0), "step"),
        (lambda a, h, m: h.update(step=1e-9), "the step is 1e-09 s"),
        (lambda a, h, m: h.update(step=1e300), "the step is"),
        (lambda a, h, m: h.update(L_pp=1e-300), "the length is"),
        (lambda a, h, m: h.update(L_pp=1e300), "the length is"),
        (lambda a, h, m: h.update(step="soon"), "step of the network"),
        (lambda a, h, m: h.update(step=True), "step of the network"),
        (lambda a, h, m: h.update(L_pp=-1.0), "length"),
        (lambda a, h, m: h.update(memory=0), "memory"),
        (lambda a, h, m: h.update(memory=10**9), "memory"),
        (lambda a, h, m: h.pop("memory"), "memory"),
        (lambda a, h, m: h.update(mirrored=1), "mirrored"),
        (lambda a, h, m: h.update(mirrored=True, inputs=["n_port", "delta"]), "would change places"),
        (lambda a, h, m: h.update(L_pp=10**400), "too large"),
    ],
)
def test_what_does_not_fit_is_named(tmp_path, change, words):
    with pytest.raises(NetworkError, match=words):
        load_network(altered(tmp_path, change))


@pytest.mark.parametrize("dtype", ["BF16", "F8_E5M2", "F8_E4M3"])
def test_numbers_that_numpy_does_not_have(tmp_path, dtype):
    """The library asks NumPy for a type of that name: an AttributeError."""
    size = {"BF16": 2}.get(dtype, 1)
    metadata = {"format": "mmgtune network", "schema": "1", "network": json.dumps(_described(network())[0])}
    wanted = [f"{group}.{name}" for group, of in _described(network())[1].items() for name in of]
    one = {"dtype": dtype, "shape": [1], "data_offsets": [0, size]}
    places = {name: {**one, "data_offsets": [k * size, k * size + size]} for k, name in enumerate(wanted)}
    header = json.dumps({"__metadata__": metadata, **places}).encode()
    path = tmp_path / "model.safetensors"
    path.write_bytes(len(header).to_bytes(8, "little") + header + bytes(size * len(wanted)))
    with pytest.raises(NetworkError):
        load_network(path)


def test_damaged_and_foreign_files(tmp_path):
    path = save_network(network(), tmp_path / "model.safetensors")
    whole = path.read_bytes()
    rng = np.random.default_rng(1)
    for k in range(60):
        broken = bytearray(whole[: int(rng.integers(len(whole)))] if k % 2 else whole)
        for _ in range(1 + k % 5):
            if broken:
                broken[int(rng.integers(min(len(broken), 2000)))] = int(rng.integers(256))
        (tmp_path / "broken.safetensors").write_bytes(broken)
        with contextlib.suppress(NetworkError):  # a clear error, or read as it stands
            load_network(tmp_path / "broken.safetensors")
    for content in (b"", b"\x80\x04K\x01.", b"\xff" * 8 + b"{}", b"PK\x03\x04", (2**40).to_bytes(8, "little") + b"{"):
        (tmp_path / "other.safetensors").write_bytes(content)
        with pytest.raises(NetworkError):
            load_network(tmp_path / "other.safetensors")
    with pytest.raises(NetworkError):
        load_network(tmp_path / "missing.safetensors")


def test_too_large_is_refused_before_it_is_read(tmp_path, monkeypatch):
    path = save_network(network(), tmp_path / "model.safetensors")
    monkeypatch.setattr(limits, "NETWORK_BYTES", limits.Limit(100, "bytes", "a network", "less"))
    with pytest.raises(NetworkError, match="too many"):
        load_network(path)
