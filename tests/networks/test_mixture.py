"""A hybrid and recurrent networks that drive one ship together."""

from __future__ import annotations

import json
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
    return Mixture(hybrid or a_hybrid(), (net,), share)


def by(predictor):
    return predictor.predict(cases()).states[0, 0]


def test_a_share_of_nothing_is_the_hybrid():
    mixture = a_mixture(1e-12)
    np.testing.assert_allclose(
        by(MixturePredictor(mixture)), by(HybridPredictor(mixture.hybrid, Integrator("euler"))), atol=1e-8
    )


def test_a_share_of_all_is_the_network():
    mixture = a_mixture(1.0 - 1e-12, members=1)
    np.testing.assert_allclose(by(MixturePredictor(mixture)), by(NetworkPredictor(mixture.networks[0])), atol=1e-8)


def test_the_first_step_is_the_weighted_mean():
    mixture = a_mixture(0.3, members=3)
    hybrid = by(HybridPredictor(mixture.hybrid, Integrator("euler")))[1]
    networks = NetworkPredictor(mixture.networks[0]).predict(cases()).states[0, :, 1].mean(axis=0)
    assert np.abs(hybrid - networks)[3:].max() > 1e-4
    np.testing.assert_allclose(by(MixturePredictor(mixture))[1], 0.7 * hybrid + 0.3 * networks, atol=1e-12)


def of_another_type(*, members=1, step=0.5):
    """Networks of the same ship with a memory that runs on, wider, and mirrored."""
    drawn = network(members=members, step=step, size=0.2, memory=None, width=7, seed=4)
    return replace(drawn, ship="esso_osaka_3m", mirrored=True)


def test_networks_of_one_kind_apart_are_those_of_one_file():
    """Two with a member each, and one with the two members: the same equations, to the rounding of other products."""
    one = a_mixture(0.4, members=2)
    apart = replace(one, networks=tuple(one.networks[0].member(k) for k in range(2)))
    np.testing.assert_allclose(by(MixturePredictor(apart)), by(MixturePredictor(one)), rtol=0.0, atol=1e-12)
    again = replace(one, networks=(*apart.networks, *one.networks))  # each member twice
    np.testing.assert_allclose(by(MixturePredictor(again)), by(MixturePredictor(one)), rtol=0.0, atol=1e-12)


def test_networks_of_several_types_count_by_their_members():
    """The first step is the weighted mean of all members, of which one network has three and the other two."""
    one = a_mixture(0.3, members=3)
    mixture = replace(one, networks=(*one.networks, of_another_type(members=2)))
    hybrid = by(HybridPredictor(mixture.hybrid, Integrator("euler")))[1]
    means = [NetworkPredictor(net).predict(cases()).states[0, :, 1].mean(axis=0) for net in mixture.networks]
    assert np.abs(means[0] - means[1])[3:].max() > 1e-5
    found = MixturePredictor(mixture).predict(cases()).states[0, 0, 1]
    np.testing.assert_allclose(found, 0.7 * hybrid + 0.3 * (3.0 * means[0] + 2.0 * means[1]) / 5.0, atol=1e-12)
    other = replace(one, networks=mixture.networks[::-1])
    np.testing.assert_allclose(by(MixturePredictor(other)), by(MixturePredictor(mixture)), rtol=0.0, atol=1e-12)


def test_each_network_keeps_a_memory_of_its_own():
    """With hardly any share of the forces, and one network twice: its memory runs on as that of the network alone."""
    net = of_another_type()
    mixture = Mixture(a_hybrid(), (net, net), 1.0 - 1e-12)
    np.testing.assert_allclose(by(MixturePredictor(mixture)), by(NetworkPredictor(net)), atol=1e-8)


def test_networks_of_several_steps_are_refused():
    with pytest.raises(ValueError, match=r"steps of 0\.1 s and 0\.5 s"):
        replace(a_mixture(), networks=(*a_mixture().networks, of_another_type(step=0.1)))
    with pytest.raises(ValueError, match="there are no networks"):
        replace(a_mixture(), networks=())
    with pytest.raises(ValueError, match="mixture of 101 networks: too many"):
        replace(a_mixture(), networks=(of_another_type(),) * 101)


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


def test_round_trip_of_several(tmp_path):
    mixture = replace(a_mixture(0.35), networks=(*a_mixture().networks, of_another_type()))
    path = save_network(mixture, tmp_path / "model.safetensors")
    again = load_network(path)
    assert repr(again) == repr(mixture) == "Mixture(esso_osaka_3m: hybrid, and 2 + 1 networks with a share of 0.35)"
    assert [(one.memory, one.mirrored, one.width) for one in again.networks] == [(3, False, 5), (None, True, 7)]
    np.testing.assert_allclose(by(MixturePredictor(again)), by(MixturePredictor(mixture)), atol=1e-3)
    assert save_network(again, tmp_path / "again.safetensors").read_bytes() == path.read_bytes()


def header_of(path):
    """What stands in the header of a file."""
    from safetensors import safe_open

    with safe_open(path, framework="numpy") as file:
        return file.metadata() | {"network": json.loads(file.metadata()["network"])}


def test_files_of_one_network_stay_as_they_were_and_those_of_several_say_so(tmp_path):
    """Schema 1 is what versions read that know a single network; to these schema 2 is of another version."""
    one = header_of(save_network(a_mixture(), tmp_path / "one.safetensors"))
    assert one["schema"] == "1"
    assert "networks" not in one["network"]
    several = replace(a_mixture(), networks=(of_another_type(), of_another_type()))
    header = header_of(save_network(several, tmp_path / "several.safetensors"))
    assert header["schema"] == "2"
    assert len(header["network"]["networks"]) == 2


def test_the_mixture_that_travels_along_is_plain_and_mirrored():
    mixture = load_network("esso_osaka_3m_mixture")
    assert [(one.n_members, one.mirrored) for one in mixture.networks] == [(5, False), (5, True)]
    assert mixture.share == 0.35


def test_parts_of_two_ships_are_refused():
    hybrid = a_hybrid()
    with pytest.raises(ValueError, match="the networks are of toy"):
        Mixture(hybrid, (network(),), 0.3)
    with pytest.raises(ValueError, match="not between 0 and 1"):
        a_mixture(1.0)


def test_a_file_of_several_whose_parts_do_not_fit_is_refused(tmp_path):
    from safetensors.numpy import load, save

    mixture = replace(a_mixture(), networks=(*a_mixture().networks, of_another_type()))
    path = save_network(mixture, tmp_path / "model.safetensors")
    arrays, header = load(path.read_bytes()), header_of(path)["network"]
    one, other = header["networks"]
    for schema, broken, words in (
        ("2", header | {"networks": 2}, "networks of the network is 2"),
        ("2", header | {"networks": [one, 5]}, "networks of the network is"),
        ("2", header | {"networks": []}, "there are no networks"),
        ("2", header | {"networks": [one] * 101}, "too many"),
        ("2", header | {"networks": [one] * 3}, "lacks network.2"),
        ("2", header | {"networks": [one, other | {"step": 0.1}]}, "steps of 0.1 s and 0.5 s"),
        ("2", header | {"networks": [one, other | {"memory": 10**9}]}, "memory"),
        ("2", header | {"networks": [one, other | {"ship": "another"}]}, "networks are of another"),
        ("2", header | {"networks": [one, other | {"inputs": ["n"]}]}, "W_x has the shape"),
        ("2", header | {"networks": [one, {"ship": "esso_osaka_3m"}]}, "step of the network is None"),
        ("2", header | {"kind": "recurrent"}, "another version"),
        ("2", header | {"kind": ["mixture"]}, "of kind"),
        ("1", header, "network of the network is None"),
        ("1", header | {"network": one}, "lacks network.scales"),
        ("3", header, "another version"),
    ):
        metadata = {"format": "mmgtune network", "schema": schema, "network": json.dumps(broken)}
        path.write_bytes(save(arrays, metadata=metadata))
        with pytest.raises(NetworkError, match=words):
            load_network(path)


def test_a_file_whose_parts_do_not_fit_is_refused(tmp_path):
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
