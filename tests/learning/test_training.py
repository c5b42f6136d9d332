"""Training of networks on the bundled generated trials, as small as it can be."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("jax", reason="networks are trained with the extra mmgtune[learn]")

from mmgtune.cli.learn import summary
from mmgtune.errors import OptionError, TrialError
from mmgtune.learning import Hooks, learn_hybrid, learn_rnn, write_learned
from mmgtune.learning import run as runs
from mmgtune.learning.aims import RecurrentAim
from mmgtune.learning.keeping import Kept, named
from mmgtune.learning.planning import plan_rnn
from mmgtune.learning.samples import samples_of
from mmgtune.learning.starting import first_weights, scales_of
from mmgtune.learning.training import Plan, Trainer
from mmgtune.networks import NetworkPredictor, load_network
from mmgtune.options.learning import HybridOptions, LearnOptions
from mmgtune.report import render
from mmgtune.scores import L_MSE, by_manoeuvre
from mmgtune.trial import load_trials
from mmgtune.validating import validate

pytestmark = pytest.mark.xdist_group("networks")

ALL = {"validation": 0.0}
"""No run kept back."""

SMALL = LearnOptions(seeds=1, steps=6, validate_every=2, batch=16, width=6, memory=3, horizon=8, restart=60.0)


def weights(result):
    return np.concatenate([np.ravel(one) for one in result.network.weights])


@pytest.fixture(scope="session")
def trained():
    return learn_rnn("suzaku", "suzaku", replace(SMALL, steps=60, validate_every=20, rate=2e-2, width=16, horizon=20))


def test_training_learns(trained):
    losses = [row["loss"] for row in trained.members[0].curve]
    assert losses[-1] < 0.5 * losses[0]


def test_the_best_by_validation_is_kept(trained):
    one = trained.members[0]
    assert one.score == min(row["score"] for row in one.curve)


def test_validation_runs_are_not_learned_from(trained):
    learned = {trial.run for trial in trained.task.split.learn}
    chosen = {trial.run for trial in trained.task.split.choose}
    assert learned
    assert chosen
    assert not learned & chosen
    tested = {score.trial for score in trained.scores["test"]}
    assert tested == set(load_trials("suzaku").test)
    assert not tested & (learned | chosen)


def test_the_score_that_chose_is_that_of_validate(trained, tmp_path):
    """One network, scored in training in single precision on JAX, and by the program on NumPy from its file."""
    write_learned(trained, tmp_path)
    data = load_trials("suzaku")
    chosen = {trial.id for trial in trained.task.split.choose}
    from mmgtune.scores import L_MSE, by_manoeuvre, score
    from mmgtune.trial import TrialSet

    network = load_network(tmp_path / "model.safetensors")
    pieces = TrialSet({id: data.trials[id] for id in chosen}, tuple(chosen), ()).in_windows(60.0).trials.values()
    scores = score(NetworkPredictor(network), list(pieces), trained.task.sigma)
    by_kind = [L_MSE(of) for of in by_manoeuvre(scores).values()]
    assert np.mean(by_kind) == pytest.approx(trained.members[0].score, rel=2e-3)


@pytest.mark.long
def test_the_same_seed_gives_the_same_weights_and_another_others():
    a, b = (learn_rnn("suzaku", "suzaku", SMALL) for _ in range(2))
    other = learn_rnn("suzaku", "suzaku", replace(SMALL, seed=2))
    np.testing.assert_array_equal(weights(a), weights(b))
    assert np.abs(weights(a) - weights(other)).max() > 0.01


@pytest.mark.daily("4-kept3")
@pytest.mark.parametrize(
    ("after", "kept"),
    [(1, {}), (4, {}), (1, ALL), (4, ALL)],
)
def test_resumed_equals_not_interrupted(tmp_path, after, kept):
    """Stopped in the first seed or in the second, and gone on: the same bits."""
    options = replace(SMALL, seeds=2, **kept)
    asked = []

    def stop():
        return len(asked) >= after

    hooks = Hooks(on_progress=lambda *_: asked.append(1), stop=stop)
    first = learn_rnn("suzaku", "suzaku", options, hooks=hooks, folder=tmp_path)
    assert first.interrupted
    write_learned(first, tmp_path)
    assert list(tmp_path.glob("training-*"))
    second = learn_rnn("suzaku", "suzaku", options, folder=tmp_path, resume=True)
    write_learned(second, tmp_path, overwrite=True)
    assert not second.interrupted
    assert not list(tmp_path.glob("training-*"))
    whole = learn_rnn("suzaku", "suzaku", options)
    np.testing.assert_array_equal(weights(second), weights(whole))
    assert [one.to_dict() for one in second.members] == [one.to_dict() for one in whole.members]


@pytest.mark.long
@pytest.mark.parametrize("kept", [{}, ALL])
def test_under_one_compiled_step_networks_become_the_same(monkeypatch, kept):
    """As on a GPU, here on a processor: to the rounding of single precision."""
    options = replace(SMALL, seeds=2, **kept)
    one_by_one = learn_rnn("suzaku", "suzaku", options)
    monkeypatch.setattr(runs, "accelerated", lambda: True)
    at_once = learn_rnn("suzaku", "suzaku", options)
    np.testing.assert_allclose(weights(at_once), weights(one_by_one), atol=2e-5)
    for one, same in zip(at_once.members, one_by_one.members, strict=True):
        assert one.best == pytest.approx(same.best, rel=1e-3)


def in_header(old, new):
    """A change of the numbers of a checkpoint, of the same length."""
    assert len(old) == len(new)
    return lambda content: content.replace(old, new, 1)


@pytest.mark.parametrize(
    "change",
    [
        in_header(rb"\"curve\": []", rb"\"curve\": 10"),
        in_header(rb"\"factor\": 1.0", rb"\"factor\": 8.0"),
        in_header(b'"sha256":"', b'"sha255":"'),
        lambda content: content[:-2] + bytes([content[-2] ^ 1]) + content[-1:],
        lambda content: b"",
    ],
)
def test_a_checkpoint_changed_anywhere_is_refused_before_training(tmp_path, change):
    trainer, path = Trainer(Climbing(), Plan(60, 4, 0.01, 5)), tmp_path / named(0)
    first = trainer.begin({"a": np.float32(0.0)})
    Kept(tmp_path, {}, False).keep(0, first)
    assert Kept(tmp_path, {}, True).begun(0, first).step == 0
    assert change(path.read_bytes()) != path.read_bytes()
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(OptionError, match="checkpoint cannot be read"):
        Kept(tmp_path, {}, True)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pipes by name")
def test_a_checkpoint_that_is_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / named(0))
    with pytest.raises(OptionError, match=r"cannot be read(?s:.*)a pipe"):
        Kept(tmp_path, {}, True)


def test_a_checkpoint_of_another_training_or_damaged_is_refused(tmp_path):
    hooks = Hooks(stop=lambda: True)
    learn_rnn("suzaku", "suzaku", SMALL, hooks=hooks, folder=tmp_path)
    with pytest.raises(OptionError, match=r"another run(?s:.*)rate \(0.001, was 0.0"):
        learn_rnn("suzaku", "suzaku", replace(SMALL, rate=1e-3), folder=tmp_path, resume=True)
    path = tmp_path / named(1)
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(OptionError, match="cannot be read"):
        learn_rnn("suzaku", "suzaku", SMALL, folder=tmp_path, resume=True)
    path.unlink()
    path.mkdir()
    with pytest.raises(OptionError, match=r"cannot be read(?s:.*)a folder"):
        learn_rnn("suzaku", "suzaku", SMALL, folder=tmp_path, resume=True)
    with pytest.raises(OptionError, match="nothing to resume"):
        learn_rnn("suzaku", "suzaku", SMALL, folder=tmp_path / "other", resume=True)


@pytest.mark.daily("[1]")
@pytest.mark.parametrize("type", ["1", "2", "3"])
def test_where_no_run_is_kept_back_the_last_running_mean_of_the_weights_is_kept(type):
    options = replace(SMALL, type=type, **ALL)
    result = learn_rnn("suzaku", "suzaku", options)
    data = load_trials("suzaku")
    assert [trial.id for trial in result.task.split.learn] == list(data.tune)
    assert not result.task.split.choose
    (member,) = result.members
    assert member.score is None
    assert [sorted(row) for row in member.curve] == [["loss", "norm", "step"]] * 3
    assert member.best["step"] == options.steps
    assert list(result.scores) == ["test"]
    plan = Plan(options.steps, options.batch, options.rate, options.validate_every)
    trainer = Trainer(RecurrentAim(result.task, scales_of(result.task.samples)), plan)
    first = first_weights(len(result.task.inputs), options.width, options.seed)
    ended = trainer.run(trainer.begin(in_single(first)), options.seed)
    for kept, mean, last in zip(result.network.weights, ended.mean, ended.parameters, strict=True):
        np.testing.assert_array_equal(kept[0], np.float64(mean))
        assert np.abs(np.float64(mean) - np.float64(last)).max() > 0.0


def in_single(first):
    return first._replace(**{name: np.float32(one) for name, one in first._asdict().items()})


def test_stopped_without_runs_that_choose_the_weights_of_the_last_checkpoint_are_kept(tmp_path):
    from safetensors.numpy import load_file

    asked = []
    hooks = Hooks(on_progress=lambda *told: asked.append(told), stop=lambda: len(asked) >= 2)
    stopped = learn_rnn("suzaku", "suzaku", replace(SMALL, seeds=2, **ALL), hooks=hooks, folder=tmp_path)
    assert stopped.interrupted
    assert [one.step for one in stopped.members] == [4]
    assert [words.split(",")[0] for *_, words in asked] == ["seed 1 of 2"] * 2
    assert not any("validation" in words for *_, words in asked)
    held = [one for one in load_file(tmp_path / named(1)).values() if one.dtype == np.float32]
    for kept in stopped.network.weights:
        assert any(np.array_equal(one, kept[0]) for one in held)
    short = learn_rnn("suzaku", "suzaku", replace(SMALL, **ALL))
    assert np.abs(weights(short) - weights(stopped)).max() > 0.0


def test_without_runs_that_choose_nothing_speaks_of_validation(tmp_path):
    """No trial is held out either: scored are those learned from, and it says so."""
    data = load_trials("suzaku")
    data = replace(data, test=())
    options = replace(SMALL, **ALL)
    result = learn_rnn("suzaku", data, options)
    loss = result.members[0].best["loss"]
    assert repr(result) == f"Learned(suzaku, type 1, loss by seed {loss:.3g})"
    assert result.role == "learned"
    document = write_learned(result, tmp_path)
    assert document["chosen_by"] == []
    assert document["members"][0]["score"] is None
    assert document["members"][0]["best_step"] == options.steps
    assert {one["role"] for one in document["drawn"]} == set(document["scores"]) == {"learned"}
    said = summary(result, document, "runs/x", report=True)
    assert "none chose" in said
    assert f"{loss:.4g}" in said
    assert "trials learned from" in said
    assert "validation" not in said
    assert "validation" not in " ".join(line for line in plan_rnn("suzaku", data, options).lines)
    (path,) = [path for path in render(tmp_path) if path.suffix == ".html"]
    text = path.read_text()
    assert "that they learned from" in text
    assert "none chose" in text
    assert "L_MSE of validation" not in text
    assert "that chose" not in text


def test_a_hybrid_needs_runs_kept_back():
    with pytest.raises(OptionError, match="no run is kept back") as error:
        HybridOptions(validation=0.0)
    assert error.value.problems[0].where == "validation"
    assert HybridOptions(validation=0.0, folds=2).folds == 2


@pytest.mark.long
@pytest.mark.parametrize("type", ["2", "3"])
def test_other_types_learn_too(type):
    result = learn_rnn("suzaku", "suzaku", replace(SMALL, type=type, steps=30, validate_every=10, rate=5e-3))
    losses = [row["loss"] for row in result.members[0].curve]
    assert losses[-1] < losses[0]
    assert (result.network.memory is None) == (type == "2")


@pytest.mark.long
def test_mirrored_it_is_trained_and_scored_as_it_predicts(tmp_path):
    result = learn_rnn("suzaku", "suzaku", replace(SMALL, type="2", mirrored=True))
    write_learned(result, tmp_path)
    network = load_network(tmp_path / "model.safetensors")
    assert network.mirrored
    scores = result.scores["validation"]
    by_kind = [L_MSE(of) for of in by_manoeuvre(scores).values()]
    assert np.mean(by_kind) == pytest.approx(result.members[0].score, rel=2e-3)


def test_a_ship_with_two_rudders_is_not_mirrored():
    with pytest.raises(OptionError, match="change places"):
        learn_rnn("vectwin_3m", "suzaku", replace(SMALL, mirrored=True))


def test_types_on_runs_of_the_paper_say_which_are_missing():
    with pytest.raises(OptionError, match="8 of the runs") as error:
        learn_rnn("suzaku", "suzaku", replace(SMALL, type="5"))
    assert "type=1" in error.value.problems[0].fix


def test_windows_longer_than_any_trial_are_refused():
    with pytest.raises(OptionError, match="no trial is as long"):
        learn_rnn("suzaku", "suzaku", replace(SMALL, horizon=5000))


@pytest.mark.parametrize("library", ["jax", "optax"])
@pytest.mark.parametrize("learn", [learn_rnn, learn_hybrid])
def test_without_the_extra_the_command_that_installs_it_is_named(monkeypatch, library, learn):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(OptionError, match=r"pip install 'mmgtune\[learn\]'"):
        learn("suzaku", "suzaku")


def test_one_run_leaves_nothing_to_choose_by():
    data = load_trials("suzaku")
    one = replace(data, tune=data.tune[:1])
    with pytest.raises(OptionError, match="too few runs"):
        learn_rnn("suzaku", one, SMALL)


@pytest.mark.daily("False-kept0")
@pytest.mark.parametrize("kept", [ALL, {}])
@pytest.mark.parametrize("at_once", [False, True])
def test_divergence_is_told_with_its_step_and_training_goes_back(monkeypatch, kept, at_once):
    """Gradients that are no numbers for a while: training goes back to the last good state at half the rate."""
    from mmgtune.learning import together, training

    monkeypatch.setattr(runs, "accelerated", lambda: at_once)
    drawn = training.batch
    poisoned = range(13, 23)

    def batch(starts, size, seed, step):
        found = drawn(starts, size, seed, step)
        return np.full_like(found, -1_000_000) if step in poisoned else found

    monkeypatch.setattr(training, "batch", batch)
    monkeypatch.setattr(together, "batch", batch)
    spoiled = runs.RecurrentAim.loss

    def loss(self, w, starts, data):
        import jax.numpy as jnp

        return jnp.where(starts[0] < 0, jnp.nan, 1.0) * spoiled(self, w, jnp.abs(starts) % len(self.starts), data)

    monkeypatch.setattr(runs.RecurrentAim, "loss", loss)
    result = learn_rnn("suzaku", "suzaku", replace(SMALL, steps=30, validate_every=5, **kept))
    (event,) = result.members[0].events
    assert (event["step"], event["back_to"], event["rate_factor"]) == (25 if at_once else 23, 10, 0.5)
    assert np.isfinite(weights(result)).all()
    assert np.isfinite(result.members[0].best["loss"])


def test_gradients_that_are_never_numbers_are_an_error(monkeypatch):
    monkeypatch.setattr(runs.RecurrentAim, "loss", lambda self, w, starts, data: sum(one.sum() for one in w) * np.nan)
    with pytest.raises(OptionError, match="diverged 6 times, the last time at step 60") as error:
        learn_rnn("suzaku", "suzaku", replace(SMALL, steps=100, validate_every=5))
    assert error.value.problems[0].where == "rate"


class Climbing:
    """A loss that falls along with a weight, and is no number past an edge: validations fall between lost steps."""

    def __init__(self):
        import jax.numpy as jnp

        self.starts, self.data = np.arange(50), {"nothing": jnp.zeros(1)}

    def loss(self, w, starts, data):
        import jax.numpy as jnp

        return jnp.where(w["a"] > 0.031, jnp.nan, -w["a"])

    def judged(self, w):
        return {"score": float(-w["a"])}


@pytest.mark.parametrize("stopped_after", [1, 2, 3, 5])
def test_resumed_equals_not_interrupted_where_training_goes_back(tmp_path, stopped_after):
    """Stopped at a validation that there is no going back to: the one before is in the checkpoint too."""
    trainer = Trainer(Climbing(), Plan(60, 4, 0.01, 5))
    first = {"a": np.float32(0.0)}
    whole = trainer.run(trainer.begin(first), 1)
    assert {event["back_to"] for event in whole.events} == {5}
    kept, told = Kept(tmp_path, {"of": "a test"}, False), []

    def keep(now):
        kept.keep(0, now)
        told.append(now.step)

    trainer.run(trainer.begin(first), 1, on_validation=keep, stop=lambda: len(told) >= stopped_after)
    again = Kept(tmp_path, {"of": "a test"}, True).begun(0, trainer.begin(first))
    assert again.step == told[-1] < 60
    resumed = trainer.run(again, 1)
    assert resumed.events == whole.events
    assert resumed.curve == whole.curve
    assert float(resumed.parameters["a"]) == float(whole.parameters["a"])


def test_what_is_left_behind_is_json_and_a_predictor(trained, tmp_path):
    write_learned(trained, tmp_path)
    document = json.loads((tmp_path / "learning.json").read_text())
    assert document["kind"] == "learning"
    assert document["scores"]["test"]["L_MSE"] > 0.0
    assert document["provenance"]["trials"]["sources"] == ["generated"]
    result = validate([str(tmp_path / "model.safetensors"), "suzaku"], "suzaku")
    assert [one.predictor.name for one in result.profiles] == ["suzaku type 1", "suzaku"]


def test_a_time_that_jumps_is_no_reason_to_fill_the_machine():
    trial = load_trials("suzaku").trials["turn_p10"]
    jumping = replace(trial, t=np.where(trial.t > 100.0, trial.t + 1e9, trial.t))
    with pytest.raises(TrialError, match="samples would be made of") as error:
        samples_of([trial, jumping], ("n", "delta"), 1.0)
    (problem,) = error.value.problems
    assert "cut the trial where its time jumps" in problem.fix


def test_a_training_is_a_table_and_pictures(trained, tmp_path):
    frame = trained.to_frame()
    assert frame["trials"].tolist() == ["held out", "kept back"]
    assert frame["L_MSE"].iloc[0] == pytest.approx(L_MSE(trained.scores["test"]))
    document = write_learned(trained, tmp_path)
    assert {**trained.to_dict(), "out": str(tmp_path)} == document
    render(tmp_path)
    assert trained.sentence() in (tmp_path / "report.md").read_text()
    assert trained.sentence() in " ".join(trained.summary().split())
    assert dir(trained.plot) == ["histories", "tracks"]
    assert "<table" in trained._repr_html_()


def test_trials_of_another_ship_are_told_in_the_record_and_its_report(tmp_path):
    data = replace(load_trials("suzaku"), ship="sakura")
    document = write_learned(learn_rnn("suzaku", data, SMALL), tmp_path)
    (said,) = document["warnings"]
    assert "sakura" in said
    render(tmp_path)
    assert said in (tmp_path / "report.md").read_text()
