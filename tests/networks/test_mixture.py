"""A hybrid and recurrent networks that drive one ship together."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.backends import Integrator
from mmgtune.errors import NetworkError
from mmgtune.networks import (
    HybridPredictor,
    Mixture,
    MixturePredictor,
    NetworkPredictor,
    load_network,
    named_ship,
    save_network,
)
from mmgtune.predictor import stepper_of
from mmgtune.profile import with_effects

from .made import network
from .test_hybrid import a_hybrid, cases


def a_mixture(share=0.3, *, step=0.5, members=2, hybrid=None):
    net = replace(network(members=members, step=step, size=0.2), ship="esso_osaka_3m")
    return Mixture(hybrid or a_hybrid(), net, share)


def by(predictor):
    return predictor.predict(cases()).states[0, 0]


def test_a_share_of_nothing_is_the_hybrid():
    mixture = a_mixture(1e-12)
    np.testing.assert_allclose(
        by(MixturePredictor(mixture)), by(HybridPredictor(mixture.hybrid, Integrator("euler"))), atol=1e-8
    )


def test_a_share_of_all_is_the_network():
    mixture = a_mixture(1.0 - 1e-12, members=1)
    np.testing.assert_allclose(by(MixturePredictor(mixture)), by(NetworkPredictor(mixture.network)), atol=1e-8)


def test_the_first_step_is_the_weighted_mean():
    mixture = a_mixture(0.3, members=3)
    hybrid = by(HybridPredictor(mixture.hybrid, Integrator("euler")))[1]
    networks = NetworkPredictor(mixture.network).predict(cases()).states[0, :, 1].mean(axis=0)
    assert np.abs(hybrid - networks)[3:].max() > 1e-4
    np.testing.assert_allclose(by(MixturePredictor(mixture))[1], 0.7 * hybrid + 0.3 * networks, atol=1e-12)


def test_effects_on_actuators_and_sensors_act_on_its_model_of_forces():
    """A sluggish rudder and a gyro that is off: with hardly any share the hybrid of the same profile, to rounding."""
    plain = a_hybrid()
    profile = with_effects(
        plain.profile, {"steering-lag": {"time_constant": 3.0}, "heading-bias": {"angle": 0.05}}, "assumed"
    )
    mixture = a_mixture(1e-12, hybrid=replace(plain, profile=profile))
    found = by(MixturePredictor(mixture))
    np.testing.assert_allclose(found, by(HybridPredictor(mixture.hybrid, Integrator("euler"))), atol=1e-8)
    assert np.abs(found - by(HybridPredictor(plain, Integrator("euler")))).max() > 0.01


def test_steered_it_goes_where_it_is_predicted_to_go():
    predictor = MixturePredictor(a_mixture())
    given = replace(cases(), around=0.0 * cases().around)  # steered in still air
    states = predictor.predict(given).states[0, 0]
    run = stepper_of(predictor, 0, given.initial[0], given.controls[0, 0])
    for k in range(1, 40):
        found = run.step(given.controls[0, k - 1], given.controls[0, k], 0.5)
        np.testing.assert_allclose(found, states[k], atol=1e-9)


def test_round_trip(tmp_path):
    mixture = a_mixture(0.35)
    path = save_network(mixture, tmp_path / "model.safetensors")
    again = load_network(path)
    assert isinstance(again, Mixture)
    assert again.share == 0.35
    np.testing.assert_allclose(by(MixturePredictor(again)), by(MixturePredictor(mixture)), atol=1e-3)
    assert named_ship(str(path)).method == "mixture, euler at 0.5 s"


def test_parts_of_two_ships_are_refused():
    hybrid = a_hybrid()
    with pytest.raises(ValueError, match="the networks are of toy"):
        Mixture(hybrid, network(), 0.3)
    with pytest.raises(ValueError, match="not between 0 and 1"):
        a_mixture(1.0)


def test_a_file_whose_parts_do_not_fit_is_refused(tmp_path):
    import json

    from safetensors.numpy import load, save

    path = save_network(a_mixture(), tmp_path / "model.safetensors")
    arrays = load(path.read_bytes())
    from safetensors import safe_open

    with safe_open(path, framework="numpy") as file:
        header = json.loads(file.metadata()["network"])
    for broken in (
        header | {"share": 2.0},
        header | {"network": header["network"] | {"ship": "another"}},
        header | {"network": 5},
        header | {"hybrid": header["hybrid"] | {"memory": "long"}},
        {key: value for key, value in header.items() if key != "hybrid"},
    ):
        metadata = {"format": "mmgtune network", "schema": "1", "network": json.dumps(broken)}
        path.write_bytes(save(arrays, metadata=metadata))
        with pytest.raises(NetworkError):
            load_network(path)
