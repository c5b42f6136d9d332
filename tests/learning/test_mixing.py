"""The share of a mixture: found on trials made by a mixture whose share is known."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from mmgtune.cli import app
from mmgtune.cli.learn_mixture import summary
from mmgtune.errors import OptionError, OutputError
from mmgtune.learning import compare_parts, learn_mixture, write_learned
from mmgtune.motions import as_trial, simulate_trials
from mmgtune.networks import Hybrid, Mixture, MixturePredictor, Network, load_network, save_network
from mmgtune.networks.hybrid import silent
from mmgtune.options import MixtureOptions
from mmgtune.profile import load_profile
from mmgtune.trial import TrialSet, load_trials, write_trial
from tests.command import run
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
    plant = MixturePredictor(Mixture(silent(parts[0]), (parts[1],), 0.4))
    found = {}
    for trial in list(load_trials("suzaku").trials.values())[:3]:
        found[trial.id] = replace(as_trial(plant, simulate_trials(plant, [trial])[0]), id=trial.id, manoeuvre="turning")
    return TrialSet(found, tuple(found), (), ship="suzaku")


def test_the_share_that_made_the_trials_is_found(parts, made):
    result = learn_mixture(*parts, made, FEW)
    assert result.share == 0.4
    by_share = {one.share: one.score for one in result.tried}
    assert list(by_share) == [0.0, 0.2, 0.4, 0.6, 1.0]
    assert by_share[0.4] < 0.01 < by_share[0.2] < by_share[0.0] == 1.0


@pytest.mark.long
def test_where_no_mixture_helps_the_better_part_is_kept(parts):
    """Trials that the model of forces sailed itself."""
    profile, net = parts
    trial = next(iter(load_trials("suzaku").trials.values()))
    own = as_trial(MixturePredictor(Mixture(silent(profile), (net,), 1e-9)), simulate_trials(profile, [trial])[0])
    data = TrialSet({own.id: own}, (own.id,), (), ship="suzaku")
    assert isinstance(learn_mixture(profile, net, data, FEW).model, Hybrid)
    alone = as_trial(
        MixturePredictor(Mixture(silent(profile), (net,), 0.5)),
        simulate_trials(MixturePredictor(Mixture(silent(profile), (net.member(0),), 1.0 - 1e-12)), [trial])[0],
    )
    data = TrialSet({alone.id: alone}, (alone.id,), (), ship="suzaku")
    assert isinstance(learn_mixture(profile, net.member(0), data, FEW).model, Network)


def test_runs_that_a_part_learned_from_are_named(parts, made):
    profile, net = parts
    told = replace(net, facts={"trials": {"learned_from": [made.tune[1]]}})
    assert learn_mixture(profile, told, made, FEW).seen == (made.tune[1],)


@pytest.fixture(scope="module")
def other(parts):
    """Networks of another type with the same step: a memory that runs on, wider, mirrored."""
    drawn = network(members=3, step=1.0, size=0.1, memory=None, width=7, seed=5)
    facts = {"trials": {"licence": "CC0", "citation": "Nobody 2020", "sources": ["measured"], "learned_from": ["x_1"]}}
    alike = {"ship": "suzaku", "L_pp": parts[1].L_pp, "scales": parts[1].scales, "facts": facts}
    return replace(drawn, **alike, mirrored=True)


@pytest.mark.long
def test_several_networks_drive_her_together(parts, other):
    """The share of trials made by both is found only with both, and what they were trained on is told together."""
    profile, net = parts
    net = replace(net, facts={"trials": {"licence": "MIT", "sources": ["generated"], "learned_from": ["x_2"]}})
    plant = MixturePredictor(Mixture(silent(profile), (net, other), 0.4))
    trial = next(iter(load_trials("suzaku").trials.values()))
    sailed = replace(as_trial(plant, simulate_trials(plant, [trial])[0]), id="x_1", manoeuvre="turning")
    result = learn_mixture(profile, [net, other], sailed, FEW)
    assert result.share == 0.4
    assert result.network is None
    assert [one.n_members for one in result.model.networks] == [2, 3]
    assert "2 + 3 networks with a share of 0.4" in repr(result)
    rows = {(one.share, one.network): one.score for one in result.tried}
    assert list(rows) == [(0.0, None), (0.2, None), (0.4, None), (0.6, None), (1.0, 1), (1.0, 2)]
    assert rows[0.4, None] == min(rows.values()) < 1e-6
    assert result.seen == ("x_1",)
    told = result.model.facts["trials"]
    assert told["learned_from"] == ["x_2", "x_1"]
    assert told["sources"] == ["generated", "measured"]
    assert "MIT" in told["licence"]
    assert "CC0" in told["licence"]
    assert told["citation"] == "Nobody 2020"
    assert len(result.to_dict()["provenance"]["parts"]["networks"]) == 2
    alone = learn_mixture(profile, net, sailed, FEW)
    assert min(one.score for one in alone.tried) > 100.0 * rows[0.4, None]


def test_the_parts_are_compared_with_the_mixture_where_that_is_kept(parts, made):
    kept = learn_mixture(*parts, made, replace(FEW, restart=60.0))
    compared = compare_parts(kept, made)
    assert [one.name for one in compared.models] == ["model of forces", "networks", "mixture (0.4)"]
    assert compared.options.restart == 60.0
    assert kept.notes == ()
    given = learn_mixture(*parts, options=MixtureOptions(share=(0.3,)))
    assert [one.name for one in compare_parts(given, made).models][-1] == "mixture (0.3)"


def test_where_one_of_several_networks_does_best_alone_it_is_kept(parts, other):
    profile, net = parts
    one = other.member(1)
    plant = MixturePredictor(Mixture(silent(profile), (one,), 1.0 - 1e-12))
    trial = next(iter(load_trials("suzaku").trials.values()))
    sailed = as_trial(plant, simulate_trials(plant, [trial])[0])
    result = learn_mixture(profile, (net, one), sailed, FEW)
    assert (result.share, result.network) == (1.0, 2)
    assert isinstance(result.model, Network)
    assert result.model.mirrored
    assert "networks 2 alone are kept" in result.notes[-1]
    said = summary(result, {**result.to_dict(), "out": "runs/x"}, report=False)
    (kept,) = [line for line in said.splitlines() if line.endswith("*")]
    assert kept.startswith("1, networks 2 ")


def test_networks_of_several_steps_or_too_many_are_refused(parts, other):
    profile, net = parts
    one = MixtureOptions(share=(0.3,))
    with pytest.raises(OptionError, match=r"steps of 0\.5 s and 1 s") as error:
        learn_mixture(profile, [net, replace(other, step=0.5)], options=one)
    assert "one step" in error.value.problems[0].fix
    with pytest.raises(OptionError, match="no networks"):
        learn_mixture(profile, [], options=one)
    with pytest.raises(OptionError, match="101 networks: too many"):
        learn_mixture(profile, [net] * 101, options=one)
    with pytest.raises(OptionError, match="no recurrent network"):
        learn_mixture(profile, [net, profile], options=one)


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


def test_the_function_that_writes_what_was_learned_writes_mixtures(parts, tmp_path):
    mixed = learn_mixture(*parts, options=MixtureOptions(share=(0.3,)))
    document = write_learned(mixed, tmp_path)
    assert document == json.loads((tmp_path / "mixture.json").read_text())
    assert load_network(tmp_path).share == 0.3
    with pytest.raises(OutputError, match="exists already"):
        write_learned(mixed, tmp_path)


def test_the_command_leaves_a_model_that_the_others_take(parts, made, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    save_network(parts[1], tmp_path / "net.safetensors")
    for trial in made.trials.values():
        write_trial(trial, tmp_path / "sailed" / f"{trial.id}.parquet")
    (tmp_path / "sailed" / "split.toml").write_text(f"tune = {json.dumps(list(made.tune))}\ntest = []\n")
    line = "learn mixture suzaku net.safetensors sailed --share 0.2,0.4 --restart 60 --out mixed"
    result = CliRunner().invoke(app, line.split())
    assert result.exit_code == 0, result.output
    assert "0.4" in result.output
    document = json.loads((tmp_path / "mixed" / "mixture.json").read_text())
    assert document["share"] == 0.4
    assert load_network(tmp_path / "mixed" / "model.safetensors").share == 0.4
    assert (tmp_path / "mixed" / "report.html").is_file()
    assert json.loads((tmp_path / "mixed" / "model_comparison.json").read_text())["window_s"] == 60.0
    again = CliRunner().invoke(app, ["validate", "mixed/model.safetensors", "sailed", "--json"])
    assert again.exit_code == 0, again.output
    refused = CliRunner().invoke(app, line.split())
    assert isinstance(refused.exception, OutputError)


@pytest.mark.long
def test_the_command_takes_several_networks_and_then_trials(parts, other, tmp_path):
    """As a user runs it, with what it says where the last word is no trial, and where steps differ."""
    save_network(parts[1], tmp_path / "net.safetensors")
    (tmp_path / "other").mkdir()
    save_network(other, tmp_path / "other" / "model.safetensors")
    save_network(replace(other, step=0.5), tmp_path / "fine.safetensors")
    plant = MixturePredictor(Mixture(silent(parts[0]), (parts[1], other), 0.4))
    for trial in list(load_trials("suzaku").trials.values())[:2]:
        sailed = replace(as_trial(plant, simulate_trials(plant, [trial])[0]), id=trial.id, manoeuvre="turning")
        write_trial(sailed, tmp_path / "sailed" / f"{trial.id}.parquet")
    mixture = ("learn", "mixture", "suzaku", "net.safetensors")
    done = run(*mixture, "other", "sailed", "--share", "0.2,0.4", "--out", "mixed", cwd=tmp_path)
    assert done.code == 0, done.err
    assert "2 + 3 networks" in done.out
    assert "1, networks 2" in done.out
    page = (tmp_path / "mixed" / "report.html").read_text()
    assert "networks 2" in page
    found = load_network(tmp_path / "mixed" / "model.safetensors")
    assert [(one.memory, one.mirrored) for one in found.networks] == [(3, False), (None, True)]
    scored = run("validate", "mixed", "sailed", "--json", cwd=tmp_path)
    assert scored.code == 0, scored.err
    given = run(*mixture, "other", "--share", "0.3", "--out", "given", cwd=tmp_path)
    assert given.code == 0, given.err
    assert len(load_network(tmp_path / "given" / "model.safetensors").networks) == 2
    refused = run(*mixture, "fine.safetensors", "--share", "0.3", "--out", "x", cwd=tmp_path)
    assert refused.code == 2
    assert "steps of 0.5 s and 1 s" in refused.err
    assert not (tmp_path / "x").exists()
    missing = run(*mixture, "nowhere.safetensors", "--share", "0.3", "--out", "x", cwd=tmp_path)
    assert missing.code == 2
    assert "no such trained model" in missing.err


def test_runs_that_the_model_was_tuned_on_are_named(parts, made):
    profile, net = parts
    tuned_on = replace(profile, provenance={**profile.provenance, "tuned_on": [made.tune[0]]})
    assert learn_mixture(tuned_on, net, made, FEW).seen == (made.tune[0],)


def test_results_of_others_are_not_written_over(parts, tmp_path):
    profile, net = parts
    save_network(net, tmp_path / "model.safetensors")
    before = (tmp_path / "model.safetensors").read_bytes()
    mixture = learn_mixture(profile, net, None, MixtureOptions(share=(0.3,)))
    with pytest.raises(OutputError, match="exists"):
        write_learned(mixture, tmp_path)
    assert (tmp_path / "model.safetensors").read_bytes() == before
    write_learned(mixture, tmp_path, overwrite=True)


def test_what_is_no_recurrent_network_is_called_by_its_file(tmp_path):
    with pytest.raises(OptionError) as error:
        learn_mixture("suzaku", "esso_osaka")
    (problem,) = error.value.problems
    assert (problem.what, problem.why) == ("esso_osaka is no recurrent network", "it is a profile")


def test_a_mixture_is_a_table_of_the_shares_tried(parts, made):
    result = learn_mixture(*parts, made, FEW)
    frame = result.to_frame()
    assert frame["share"].tolist() == [0.0, 0.2, 0.4, 0.6, 1.0]
    assert frame.loc[frame["kept"] == "yes", "share"].tolist() == [0.4]
    assert frame["L_MSE turning"].tolist() == [one.errors["turning"] for one in result.tried]
    assert result.sentence().startswith("With a share of 0.4 for the networks the error L_MSE is ")
    given = learn_mixture(*parts, options=MixtureOptions(share=(0.3,)))
    assert given.sentence() == "A share of 0.3 for the networks, as given: no trials chose it."
    assert given.to_frame().empty
    other = learn_mixture(*parts, replace(made, ship="sakura"), FEW)
    assert other.to_dict()["warnings"] == list(other.warnings) != []
    assert other.warnings[0] in summary(other, {**other.to_dict(), "out": ""}, report=False)
