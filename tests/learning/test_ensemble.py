"""Ensembles trained on runs of a model ship, as small as shows what they are for."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("jax", reason="networks are trained with the extra mmgtune[learn]")

from mmgtune.backends import pad
from mmgtune.bands import pooled
from mmgtune.cli.learn import ensemble_summary
from mmgtune.errors import OptionError
from mmgtune.learning import Hooks, ensemble_run, learn_ensemble, together, training, write_learned
from mmgtune.learning.choosing import pieces_of
from mmgtune.learning.ensemble import EnsembleAim, apart, begun, first_layers, first_member, moments, rolled, untrained
from mmgtune.learning.keeping import named
from mmgtune.learning.planning import plan_ensemble
from mmgtune.learning.starting import differences, features_of
from mmgtune.learning.task import ensemble_task
from mmgtune.networks import EnsemblePredictor, load_network
from mmgtune.networks.feedforward import dense, evaluated
from mmgtune.options.learning import EnsembleOptions
from mmgtune.profile import load_profile
from mmgtune.report import render
from mmgtune.scores import window_scores
from mmgtune.trial import TrialSet
from mmgtune.validating import validate

from .sailed import NOISE, SHIP, noisy, sailed

pytestmark = pytest.mark.xdist_group("ensembles")

TRAINED = EnsembleOptions(
    members=8, width=32, layers=2, steps=1000, validate_every=500, rate=3e-3, horizon=40, initial=10, restart=50.0
)
SMALL = replace(TRAINED, members=2, width=6, steps=6, validate_every=2, batch=8, horizon=10, initial=4)
TRUE = sailed(10, 12.0)


@pytest.fixture(scope="module")
def data():
    """Gentle runs as measured."""
    seen = noisy(TRUE)
    return TrialSet({one.id: one for one in seen}, tuple(one.id for one in seen), ())


@pytest.fixture(scope="module")
def trained(data):
    return learn_ensemble(SHIP, data, TRAINED)


@pytest.fixture(scope="module")
def small(data):
    """One as small as can be, trained in one go."""
    return learn_ensemble(SHIP, data, SMALL)


@pytest.fixture
def task(data):
    return ensemble_task(load_profile(SHIP), data, SMALL)


def weights(result):
    one = result.ensemble
    return np.concatenate([np.ravel(of) for part in (one.motion, one.start) for of in (*part.layers, *part.standards)])


def spread_of(ensemble, trials, sampling="TS-infinity"):
    """L_Eucl, L_Maha and so on of 48 particles on windows of 50 s."""
    particles = EnsemblePredictor(ensemble).drawn(48, 1, sampling)
    scores = window_scores(particles, pieces_of(trials, 50.0))
    return pooled(scores, dict.fromkeys(("x", "y", "psi", "u", "v_m", "r"), 1.0))


@pytest.mark.long
def test_training_comes_near_to_the_noise(trained):
    """With three velocities a model that is right has a loss of 3."""
    for one in trained.members:
        assert 2.5 < one.score < 4.5
        assert one.curve[0]["loss"] > 2.0 * one.curve[-1]["loss"]


@pytest.mark.long
def test_more_members_know_better_what_they_do_not_know(trained):
    """L_Maha falls with the number of members, L_Eucl stays: inside the data and outside."""
    for largest in (12.0, 35.0):
        trials = sailed(4, largest, seed=int(largest), name="test")
        few, all_ = (spread_of(trained.ensemble.only(list(range(n))), trials) for n in (5, 8))
        assert all_.L_Maha < few.L_Maha
        assert all_.L_Eucl == pytest.approx(few.L_Eucl, rel=0.5)


@pytest.mark.long
def test_one_member_for_a_whole_path_spreads_wider_than_another_each_step(trained):
    trials = sailed(4, 35.0, seed=35, name="test")
    keeping, changing = (spread_of(trained.ensemble, trials, sampling) for sampling in ("TS-infinity", "TS1"))
    assert keeping.L_Maha < changing.L_Maha
    assert keeping.covers(0.9) > changing.covers(0.9)
    assert keeping.correlation < changing.correlation


def test_outside_the_data_errors_grow_and_so_does_the_band(trained):
    near, far = (spread_of(trained.ensemble, sailed(4, largest, seed=21, name="test")) for largest in (12.0, 35.0))
    assert far.L_Eucl > 10.0 * near.L_Eucl
    assert far.sharpness > 2.0 * near.sharpness
    assert 0.1 < far.L_Maha / near.L_Maha < 10.0


@pytest.mark.long
def test_estimated_starts_bring_the_fit_nearer_to_the_truth(data, trained):
    """L_fit, eq. 29: roll-outs along the windows learned from, against motions without noise."""
    one = learn_ensemble(SHIP, data, replace(TRAINED, members=1, initial=0)).ensemble
    assert L_fit(trained.ensemble.only([0]), data) < 0.9 * L_fit(one, data)


def L_fit(ensemble, data):
    n, windows = TRAINED.horizon + 1, []
    for true in TRUE:
        seen = data.trials[true.id]
        windows += [(true, seen, slice(k, k + n)) for k in range(0, true.n_samples - n + 1, n)]
    first = np.stack([seen.motion[of][: max(1, ensemble.initial)] for _, seen, of in windows], axis=1)
    start = ensemble.started(first)[0] if ensemble.initial else first[0]
    driven = [true.inputs(("n", "delta"))[of] for true, _, of in windows]
    found = EnsemblePredictor(ensemble).predict(pad([np.arange(float(n))] * len(start), driven, list(start)))
    truth = np.stack([true.motion[of] for true, _, of in windows])
    return float(np.mean(np.sum(((found.states[:, 0] - truth)[:, :, 3:] / NOISE) ** 2, axis=-1)))


def test_estimated_starts_are_nearer_to_the_truth_than_what_was_measured(data, trained):
    n = TRAINED.initial
    of = [(one.motion[k : k + n], data.trials[one.id].motion[k : k + n]) for one in TRUE for k in range(0, 100, 10)]
    true, seen = (np.stack(parts, axis=1) for parts in zip(*of, strict=True))
    for found in trained.ensemble.started(seen):
        before, after = (np.mean(((one - true[0])[:, 3:] / NOISE) ** 2) for one in (seen[0], found))
        assert after < 0.85 * before


def test_the_predictor_is_the_roll_out_that_was_trained(data, trained):
    """On JAX in training, and on NumPy from the file's numbers: the same states but for single precision."""
    trial = data.trials[data.tune[0]]
    member = trained.members[3]
    controls = np.float32(trial.inputs(("n", "delta")))[:-1, None]
    seen = np.float32(trial.motion[: TRAINED.initial, None])
    still = np.zeros((len(controls), 1, 2), dtype=np.float32)
    begin = begun(member.weights, member.standards, seen)
    on_jax = rolled(member.weights, member.standards, begin, controls, still, 1.0)
    start = trained.ensemble.started(trial.motion[: TRAINED.initial, None])[3]
    np.testing.assert_allclose(np.asarray(on_jax[0]), start, atol=1e-6)
    found = EnsemblePredictor(trained.ensemble).predict(pad([trial.t], [trial.inputs(("n", "delta"))], list(start)))
    np.testing.assert_allclose(np.asarray(on_jax)[:, 0, 3:], found.states[0, 3, :, 3:], atol=2e-5)
    np.testing.assert_allclose(np.asarray(on_jax)[:, 0, :3], found.states[0, 3, :, :3], atol=5e-3)


@pytest.mark.long
def test_gradients_are_those_of_finite_differences(task):
    import jax

    weights, standards = first_member(task, 1)
    aim = EnsembleAim(task).of(standards)
    starts = aim.starts[:5]
    with jax.enable_x64(True):
        wide = jax.tree.map(lambda one: jax.numpy.asarray(np.float64(one)), aim.data)
        aim._sigma = np.float64(aim._sigma)
        loss = jax.jit(lambda w: aim.loss(w, starts, wide))
        gradient = jax.jit(jax.grad(loss))(weights)
        rng = np.random.default_rng(2)
        for part in ("motion", "start"):
            for name in getattr(weights, part)._fields:
                of = getattr(weights, part)
                way = rng.standard_normal(getattr(of, name).shape)

                def at(h, part=part, of=of, name=name, way=way):
                    return float(loss(weights._replace(**{part: of._replace(**{name: getattr(of, name) + h * way})})))

                slope = float(np.sum(getattr(getattr(gradient, part), name) * way))
                assert slope == pytest.approx((at(1e-6) - at(-1e-6)) / 2e-6, rel=1e-5)


def test_an_untrained_network_has_the_mean_and_deviation_of_the_accelerations(task):
    """Eq. 13 and 14: for inputs that are normal about the training data."""
    weights, standards = first_member(task, 5)
    s = standards.motion
    x = s.in_mean + s.in_deviation * np.random.default_rng(3).standard_normal((40_000, s.in_mean.shape[1]))
    found = evaluated(x, dense(weights.motion), s)
    rates = differences(task.samples)
    np.testing.assert_allclose(found.mean(axis=0), rates.mean(axis=0), atol=0.05 * rates.std(axis=0).max())
    np.testing.assert_allclose(found.std(axis=0), rates.std(axis=0), rtol=0.05)


def test_inputs_are_standardised_by_the_training_data(task):
    """Eq. 12; an input that never varies, as the propeller here, stays finite."""
    _, standards = first_member(task, 5)
    x = (features_of(task.samples) - standards.motion.in_mean) / standards.motion.in_deviation
    varies = features_of(task.samples).std(axis=0) > 0.0
    assert varies.tolist() == [True, True, True, False, True, True, True]
    np.testing.assert_allclose(x.mean(axis=0), 0.0, atol=1e-9)
    np.testing.assert_allclose(x.std(axis=0), varies, atol=1e-12)


def test_members_begin_as_in_pytorch_and_apart(task):
    rng = np.random.default_rng(1)
    layers = first_layers(7, 50, 3, 3, rng)
    for W, n_in in ((layers.W_in, 7), (layers.b_in, 7), (layers.W_hidden, 50), (layers.b_hidden, 50)):
        assert 0.8 / np.sqrt(n_in) < np.abs(W).max() <= 1.0 / np.sqrt(n_in)
    mean, deviation = untrained(layers, rng)
    assert (deviation > 0.0).all()
    assert np.abs(mean).max() < 0.5
    a, b = (first_member(task, task.seed(k))[0].motion.W_in for k in range(2))
    assert np.abs(a - b).max() > 0.1


def test_windows_that_watch_do_not_overlap(task):
    starts = apart(task.samples, SMALL.horizon)
    assert (np.diff(starts) >= SMALL.horizon).all()
    assert len(apart(task.samples, SMALL.horizon, most=20)) <= 20
    assert moments(np.array([[1.0, 2.0], [3.0, 2.0]]))[1].tolist() == [[1.0, 1.0]]


@pytest.mark.long
def test_the_same_seed_gives_the_same_weights_and_another_others(data, small, monkeypatch):
    monkeypatch.setattr(ensemble_run, "cores", lambda: 2)  # side by side, and one after the other
    again = learn_ensemble(SHIP, data, SMALL)
    np.testing.assert_array_equal(weights(again), weights(small))
    other = learn_ensemble(SHIP, data, replace(SMALL, seed=2))
    assert not {one.seed for one in small.members} & {one.seed for one in other.members}
    assert np.abs(weights(small) - weights(other)).max() > 0.01


@pytest.mark.daily("4")
@pytest.mark.parametrize("after", [1, 4])
def test_resumed_equals_not_interrupted(data, small, tmp_path, after):
    """Stopped in the first member or in the second, and gone on: the same bits."""
    asked = []
    hooks = Hooks(on_progress=lambda *_: asked.append(1), stop=lambda: len(asked) >= after)
    first = learn_ensemble(SHIP, data, SMALL, hooks=hooks, folder=tmp_path)
    assert first.interrupted
    write_learned(first, tmp_path)
    assert list(tmp_path.glob("training-*"))
    second = learn_ensemble(SHIP, data, SMALL, folder=tmp_path, resume=True)
    write_learned(second, tmp_path, overwrite=True)
    assert not second.interrupted
    assert not list(tmp_path.glob("training-*"))
    np.testing.assert_array_equal(weights(second), weights(small))
    assert [one.to_dict() for one in second.members] == [one.to_dict() for one in small.members]
    with pytest.raises(OptionError, match="nothing to resume"):
        learn_ensemble(SHIP, data, SMALL, folder=tmp_path, resume=True)


@pytest.mark.long
def test_under_one_compiled_step_members_become_the_same(data, small, tmp_path, monkeypatch):
    """As on a GPU, here on a processor: to the rounding of single precision, and bit for bit where it was stopped.

    One member's checkpoint is lost, so that it stands behind the other.
    """
    monkeypatch.setattr(ensemble_run, "accelerated", lambda: True)
    asked = []
    hooks = Hooks(on_progress=lambda *_: asked.append(1), stop=lambda: len(asked) >= 3)
    first = learn_ensemble(SHIP, data, SMALL, hooks=hooks, folder=tmp_path)
    assert first.interrupted
    assert [one.step for one in first.members] == [4, 4]
    (tmp_path / named(1)).unlink()
    second = learn_ensemble(SHIP, data, SMALL, folder=tmp_path, resume=True)
    assert not second.interrupted
    whole = learn_ensemble(SHIP, data, SMALL)
    np.testing.assert_allclose(weights(second), weights(whole), atol=1e-6)
    np.testing.assert_allclose(weights(whole), weights(small), atol=2e-5)
    assert [one.seed for one in whole.members] == [one.seed for one in small.members]
    for one, other in zip(whole.members, small.members, strict=True):
        for row, same in zip(one.curve, other.curve, strict=True):
            assert row == pytest.approx(same, rel=1e-3)


@pytest.mark.parametrize("one_step", [False, pytest.param(True, marks=pytest.mark.long)])
def test_divergence_goes_back_in_its_member_alone(data, monkeypatch, one_step):
    monkeypatch.setattr(ensemble_run, "accelerated", lambda: one_step)
    drawn = training.batch
    first = 1000 * SMALL.seed

    def batch(starts, size, seed, step):
        found = drawn(starts, size, seed, step)
        return np.full_like(found, -1) if seed == first and step in range(13, 23) else found

    own = EnsembleAim.loss

    def loss(self, w, starts, data):
        import jax.numpy as jnp

        return jnp.where(starts[0] < 0, jnp.nan, 1.0) * own(self, w, jnp.abs(starts), data)

    monkeypatch.setattr(training, "batch", batch)
    monkeypatch.setattr(together, "batch", batch)
    monkeypatch.setattr(EnsembleAim, "loss", loss)
    result = learn_ensemble(SHIP, data, replace(SMALL, steps=30, validate_every=5))
    (event,) = result.members[0].events
    assert (event["step"], event["back_to"], event["rate_factor"]) == (25 if one_step else 23, 10, 0.5)
    assert not result.members[1].events
    assert np.isfinite(weights(result)).all()


@pytest.mark.long
def test_runs_kept_back_watch_and_held_out_ones_are_scored(data, tmp_path):
    ids = data.tune
    split = replace(data, tune=ids[:8], test=ids[8:])
    result = learn_ensemble(SHIP, split, replace(SMALL, validation=0.3), folder=tmp_path)
    learned, watched = ({trial.id for trial in of} for of in (result.task.split.learn, result.task.split.choose))
    assert watched
    assert not learned & watched
    document = write_learned(result, tmp_path)
    assert set(document["scores"]) == {"test", "validation"}
    assert {one["id"] for one in document["scores"]["test"]["trials"]} == set(ids[8:])
    assert set(document["watched_by"]) == watched
    assert document == json.loads((tmp_path / "ensemble.json").read_text())
    assert load_network(tmp_path / "model.safetensors").n_members == 2
    (path,) = [path for path in render(tmp_path) if path.suffix == ".html"]
    text = path.read_text()
    assert "Ensemble of esso_osaka_3m" in text
    assert "runs kept back" in text
    said = ensemble_summary(result, document, "runs/x", report=True)
    assert "2 x 2 x 6 units" in said
    assert "trials held out" in said
    found = validate([str(tmp_path / "model.safetensors"), SHIP], split)
    assert found.profiles[0].predictor.name == "esso_osaka_3m ensemble"


def test_the_plan_says_what_would_be_done(data):
    said = "\n".join(plan_ensemble(SHIP, data, SMALL).lines)
    assert "2 networks of 2 x 6 units" in said
    assert "4 observations" in said


def test_observations_of_a_start_lie_in_its_window():
    with pytest.raises(OptionError, match="50 observations of a window of 10 steps"):
        replace(SMALL, initial=50)


def test_an_ensemble_is_a_table_and_pictures(trained):
    frame = trained.to_frame()
    assert len(frame) == sum(len({one.manoeuvre for one in of}) for of in trained.scores.values())
    assert "its members are" in trained.sentence()
    assert dir(trained.plot) == ["histories", "tracks"]
    assert trained.to_dict()["members"][0]["seed"] == trained.members[0].seed
