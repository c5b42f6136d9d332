"""The share of a mixture: found on trials made by a mixture whose share is known."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from mmgtune.cli import app
from mmgtune.errors import OptionError, OutputError
from mmgtune.learning import learn_mixture
from mmgtune.networks import Hybrid, Mixture, MixturePredictor, Network, load_network, save_network
from mmgtune.networks.hybrid import silent
from mmgtune.options import MixtureOptions
from mmgtune.profile import load_profile
from mmgtune.simulation import as_trial, simulate
from mmgtune.trial import TrialSet, load_trials, write_trial
from tests.networks.made import network

FEW = MixtureOptions(share=(0.2, 0.4, 0.6))


@pytest.fixture(scope="module")
def parts():
    """SUZAKU, and networks of hers that know nothing, drawn at random but slow enough to stay near her."""
    net = network(members=2, step=1.0, size=0.1)
    scales = net.scales._replace(features=50.0 * net.scales.features, accelerations=0.2 * net.scales.accelerations)
    return load_profile("suzaku"), replace(net, ship="suzaku", L_pp=load_profile("suzaku").L_pp, scales=scales)


@pytest.fixture(scope="module")
def made(parts):
    """Trials that a mixture of a share of 0.4 sailed."""
    plant = MixturePredictor(Mixture(silent(parts[0]), parts[1], 0.4))
    found = {}
    for trial in list(load_trials("suzaku").trials.values())[:3]:
        found[trial.id] = replace(as_trial(plant, simulate(plant, [trial])[0]), id=trial.id, manoeuvre="turning")
    return TrialSet(found, tuple(found), (), ship="suzaku")


def test_the_share_that_made_the_trials_is_found(parts, made):
    result = learn_mixture(*parts, made, FEW)
    assert result.share == 0.4
    by_share = {one.share: one.score for one in result.tried}
    assert list(by_share) == [0.0, 0.2, 0.4, 0.6, 1.0]
    assert by_share[0.4] < 0.01 < by_share[0.2] < by_share[0.0] == 1.0


def test_where_no_mixture_helps_the_better_part_is_kept(parts):
    """Trials that the model of forces sailed itself."""
    profile, net = parts
    trial = next(iter(load_trials("suzaku").trials.values()))
    own = as_trial(MixturePredictor(Mixture(silent(profile), net, 1e-9)), simulate(profile, [trial])[0])
    data = TrialSet({own.id: own}, (own.id,), (), ship="suzaku")
    assert isinstance(learn_mixture(profile, net, data, FEW).model, Hybrid)
    alone = as_trial(
        MixturePredictor(Mixture(silent(profile), net, 0.5)),
        simulate(MixturePredictor(Mixture(silent(profile), net.member(0), 1.0 - 1e-12)), [trial])[0],
    )
    data = TrialSet({alone.id: alone}, (alone.id,), (), ship="suzaku")
    assert isinstance(learn_mixture(profile, net.member(0), data, FEW).model, Network)


def test_runs_that_a_part_learned_from_are_named(parts, made):
    profile, net = parts
    told = replace(net, facts={"trials": {"learned_from": [made.tune[1]]}})
    assert learn_mixture(profile, told, made, FEW).seen == (made.tune[1],)


def test_what_does_not_fit_is_refused(parts):
    profile, net = parts
    with pytest.raises(OptionError, match="nothing chooses the share"):
        learn_mixture(profile, net)
    with pytest.raises(OptionError, match="do not fit"):
        learn_mixture(profile, network(), options=MixtureOptions(share=(0.3,)))
    with pytest.raises(OptionError, match="no model of forces"):
        learn_mixture(net, net, options=MixtureOptions(share=(0.3,)))
    with pytest.raises(OptionError, match="share is"):
        MixtureOptions(share=(1.5,))
    with pytest.raises(OptionError, match="no recurrent network"):
        learn_mixture(profile, "esso_osaka_3m_hybrid", options=MixtureOptions(share=(0.3,)))


def test_the_command_leaves_a_model_that_the_others_take(parts, made, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    save_network(parts[1], tmp_path / "net.safetensors")
    for trial in made.trials.values():
        write_trial(trial, tmp_path / "sailed" / f"{trial.id}.parquet")
    (tmp_path / "sailed" / "split.toml").write_text(f"tune = {json.dumps(list(made.tune))}\ntest = []\n")
    line = "learn mixture suzaku net.safetensors sailed --share 0.2,0.4 --out mixed"
    result = CliRunner().invoke(app, line.split())
    assert result.exit_code == 0, result.output
    assert "0.4" in result.output
    document = json.loads((tmp_path / "mixed" / "mixture.json").read_text())
    assert document["share"] == 0.4
    assert load_network(tmp_path / "mixed" / "model.safetensors").share == 0.4
    assert (tmp_path / "mixed" / "report.html").is_file()
    again = CliRunner().invoke(app, ["validate", "mixed/model.safetensors", "sailed", "--json"])
    assert again.exit_code == 0, again.output
    refused = CliRunner().invoke(app, line.split())
    assert isinstance(refused.exception, OutputError)
