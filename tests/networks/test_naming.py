"""Trained models on the command line, where profiles stand."""

from __future__ import annotations

import pytest

from mmgtune.errors import ProfileError
from mmgtune.networks import load_network, named_ship, save_network
from mmgtune.networks.naming import sha256_of
from mmgtune.profile import load_profile
from mmgtune.trial import load_trials, write_trial
from tests.command import run

from .made import network
from .test_hybrid import a_hybrid


@pytest.fixture
def models(tmp_path):
    """A network, a hybrid and one trial of the ship they are of."""
    import dataclasses

    save_network(dataclasses.replace(network(step=1.0), ship="suzaku", L_pp=83.0), tmp_path / "rnn.safetensors")
    save_network(
        dataclasses.replace(a_hybrid(size=0.01), profile=load_profile("suzaku")), tmp_path / "hybrid.safetensors"
    )
    trial = load_trials("suzaku").trials["turn_p35"]
    write_trial(trial, tmp_path / "trials" / "turn_p35.parquet")
    return tmp_path


def test_validate_and_simulate_take_them(models):
    found = run("validate", "suzaku", "rnn.safetensors", "hybrid.safetensors", "trials", "--json", cwd=models)
    assert found.code == 0, found.err
    ids = [one["id"] for one in found.json()["profiles"]]
    assert ids == ["suzaku", "suzaku type 1", "suzaku hybrid"]
    for name in ("rnn", "hybrid"):
        assert run("simulate", "-p", f"{name}.safetensors", "--trials", "trials", cwd=models).code == 0


def test_a_folder_of_a_training_is_its_model(models):
    for name in ("rnn", "hybrid"):
        model = load_network(models / f"{name}.safetensors")
        save_network(model, models / name / "model.safetensors")
        by_folder, by_file = named_ship(models / name), named_ship(models / f"{name}.safetensors")
        assert type(by_folder) is type(by_file)
        assert by_folder.name == by_file.name == named_ship(model).name
        assert type(load_network(models / name)) is type(model)
        with pytest.raises(ProfileError, match=r"is a folder.*(?s:.*)it holds model\.safetensors"):
            load_profile(models / name)


@pytest.mark.long
def test_trials_of_another_ship_are_told(models):
    """Scores of a network on trials of a ship that it was not trained for mean little."""
    from mmgtune import validate
    from mmgtune.trial import TrialSet

    trial = load_trials("suzaku").trials["turn_p35"]
    for ship, told in (("suzaku", 0), ("another", 1)):
        data = TrialSet({trial.id: trial}, (trial.id,), (), ship=ship)
        notes = [
            validate([models / name], data).profiles[0].notes for name in ("rnn.safetensors", "hybrid.safetensors")
        ]
        assert [sum("'another'" in one for one in of) for of in notes] == [told, told]


@pytest.mark.long
def test_validate_on_voyages_takes_them(models):
    from mmgtune.model import Model
    from tools.generate_voyage import make_voyage

    write_trial(make_voyage(Model(load_profile("suzaku")), 1.2), models / "voyages" / "one.parquet")
    found = run("validate", "rnn.safetensors", "hybrid.safetensors", "voyages", "--json", "--quiet", cwd=models)
    assert found.code == 0, found.err
    assert [one["profile"] for one in found.json()["models"]] == ["rnn.safetensors", "hybrid.safetensors"]


@pytest.mark.parametrize("command", ["fit", "diagnose", "sweep"])
def test_what_needs_coefficients_says_so(models, command):
    found = run(command, "-p", "rnn.safetensors", "-t", "trials", cwd=models)
    assert found.code == 2
    assert "rnn.safetensors" in found.err
    assert "Traceback" not in found.err


def test_what_tells_models_of_one_name_apart():
    """A run that goes on takes no other weights under the same name."""
    from dataclasses import replace

    from mmgtune.model import Model
    from mmgtune.predictor import PhysicsPredictor

    ship, nets = load_profile("suzaku"), [network(step=1.0, seed=seed) for seed in (1, 1, 2)]
    one, same, other = (sha256_of(named_ship(net)) for net in nets)
    assert one == same != other
    assert len(one) == 64
    hybrids = [replace(a_hybrid(size=size), profile=ship) for size in (0.01, 0.01, 0.02)]
    one, same, other = (sha256_of(named_ship(hybrid)) for hybrid in hybrids)
    assert one == same != other
    theta = Model(ship).matrix()
    assert sha256_of(PhysicsPredictor(Model(ship), theta)) != sha256_of(PhysicsPredictor(Model(ship), 1.01 * theta))


def test_a_silent_hybrid_is_in_the_current_that_its_profile_is_in():
    """A current that was logged in layers acts over the draught, with a network beside the model or without."""
    from dataclasses import replace

    import numpy as np

    from mmgtune.motions import simulate_trials
    from mmgtune.networks.hybrid import HybridPredictor, silent
    from mmgtune.profile import with_effects

    ship = with_effects(load_profile("suzaku"), {"current": {"measured": 1.0}}, "a test")
    trial = load_trials("suzaku").trials["turn_p35"]
    still, nothing = np.ones(trial.n_samples), np.zeros(trial.n_samples)
    at = {"current_speed_at_1m": still, "current_dir_at_1m": nothing}
    at |= {"current_speed_at_30m": nothing, "current_dir_at_30m": nothing}
    trial = replace(trial, extra={**trial.extra, **at})
    (alone,), (beside,) = simulate_trials(ship, [trial]), simulate_trials(HybridPredictor(silent(ship)), [trial])
    np.testing.assert_allclose(beside.states, alone.states, atol=1e-9)
    assert np.ptp(alone.states[:, 0]) > 100.0
