"""Hybrids trained on the bundled generated trials, as small as it can be."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("jax", reason="networks are trained with the extra mmgtune[learn]")

from mmgtune.cli.learn import hybrid_summary
from mmgtune.errors import OptionError
from mmgtune.how_far_off import rms_errors
from mmgtune.learning import Hooks, hybrid_run, learn_hybrid, write_learned
from mmgtune.learning.gains import ratios, relative
from mmgtune.learning.hybrid import HybridAim, ResidualLoss, balanced, first_residual, ranges_of
from mmgtune.learning.refitting import refitted, tuned_names
from mmgtune.learning.samples import samples_of
from mmgtune.model import Model
from mmgtune.networks import HybridPredictor, load_network
from mmgtune.options.learning import HybridOptions
from mmgtune.profile import load_profile
from mmgtune.report import render
from mmgtune.report.pages.hybrid_page import HybridRecord, build
from mmgtune.report.wording import shown
from mmgtune.scores import L_MSE
from mmgtune.trial import load_trials

pytestmark = pytest.mark.xdist_group("hybrids")

SMALL = HybridOptions(steps=24, validate_every=8, batch=24, width=6, restart=80.0, step=2.0)


def weights(result):
    return np.concatenate([np.ravel(one) for one in result.hybrid.weights])


def an_aim(horizon=20, penalty=0.0):
    data = load_trials("suzaku")
    trials = [data.trials[id] for id in data.tune]
    model = Model(load_profile("suzaku"))
    samples = samples_of(trials, model.inputs, 2.0, model.draught)
    ranges = ranges_of(samples, 10.0, [one.role for one in model.arrangement.inputs])
    loss = ResidualLoss(model, memory=10.0, step=2.0, horizon=horizon)
    aim = HybridAim(loss, model, samples, trials, ranges, sigma=np.ones(6), penalty=penalty, restart=80.0)
    return aim, first_residual(len(ranges.deviation), 6, 1)


@pytest.fixture(scope="session")
def trained():
    return learn_hybrid("suzaku", "suzaku", SMALL)


def test_it_removes_error_on_runs_it_has_not_seen(trained):
    """The bundled plant differs from the captive profile by its coefficients: much is there to be gained."""
    assert trained.gained
    assert trained.gains[0].share > 0.3
    before, after = (L_MSE(trained.scores[which]) for which in ("before", "after"))
    assert after < 0.7 * before


def test_what_is_kept_is_a_predictor_from_its_file(trained, tmp_path):
    write_learned(trained, tmp_path)
    document = json.loads((tmp_path / "hybrid.json").read_text())
    assert document["gained"]
    assert document["provenance"]["trials"]["sources"] == ["generated"]
    found = HybridPredictor(load_network(tmp_path / "model.safetensors"))
    assert found.inputs == ("n", "delta")


def test_its_page_begins_with_metres_and_degrees(trained, tmp_path):
    document = write_learned(trained, tmp_path)
    first, last = (rms_errors(document, document["scores"][which]) for which in ("before", "after"))
    off = f"{shown(last[0], 3)} m off track and {shown(last[1], 2)}° off heading"
    instead = f"{shown(first[0], 3)} m and {shown(first[1], 2)}°"
    page = next(path for path in render(tmp_path) if path.suffix == ".html").read_text(encoding="utf-8")
    (headline,) = re.findall("<h1>(.*?)</h1>", page)
    assert headline.startswith(f"On held-out runs the hybrid is {off} instead of {instead} (root mean square); ")
    for pair, unit in (((first[0], last[0]), " m"), ((first[1], last[1]), "°")):  # the same figures on the cards
        digits = 3 if unit == " m" else 2
        assert f"{shown(pair[0], digits)} → {shown(pair[1], digits)}{unit}" in page
    scores = {**document["scores"], "after": {**document["scores"]["after"], "L_MSE_by_state": {}}}
    for changed, said in (
        ({"scores": scores}, "The hybrid diverges on held-out runs; "),
        ({"scores": {}}, "On runs it has not seen the network removes "),
        ({"gained": False}, "No gain: "),
        ({"gained": False, "interrupted": True}, "Stopped before a network was chosen"),
    ):
        built = build(HybridRecord(tmp_path, {**document, **changed}))
        assert built.verdict.startswith(said)


@pytest.mark.long
def test_training_on_jax_and_the_predictor_are_one_model(trained):
    """The roll-out that is trained against, and what users get: the same states but for single precision."""
    import jax.numpy as jnp

    from mmgtune.backends import Integrator
    from mmgtune.predictor import cases_from

    data = load_trials("suzaku")
    trial = next(iter(data.in_windows(80.0).trials.values()))
    model, step = Model(trained.hybrid.profile), float(trial.t[1] - trial.t[0])
    loss = ResidualLoss(model, memory=trained.hybrid.memory, step=step, horizon=2)
    ranges = type(trained.hybrid.ranges)(*(jnp.asarray(one, dtype=np.float32) for one in trained.hybrid.ranges))
    fixed = {"theta": jnp.asarray(model.matrix()[:, 0], dtype=np.float32), "ranges": ranges}
    cut = samples_of([trial], model.inputs, step, model.draught)
    initial = trial.motion[:1].astype(np.float32)
    w = type(trained.hybrid.weights)(*(jnp.asarray(one, dtype=np.float32) for one in trained.hybrid.weights))
    given = (jnp.asarray(one[:, None], dtype=np.float32) for one in (cut.controls, cut.around))
    on_jax = np.asarray(loss.roll(w, fixed, initial, *given)[0])[:, 0]
    predictor = HybridPredictor(trained.hybrid, Integrator("euler"))
    states = predictor.predict(cases_from([trial], model.inputs, model.draught)).states[0, 0]
    np.testing.assert_allclose(on_jax[:, 2:], states[:, 2:], atol=2e-4)
    np.testing.assert_allclose(on_jax[:, :2], states[:, :2], atol=0.02)


def test_gradients_are_those_of_finite_differences():
    import jax

    aim, w = an_aim(horizon=8, penalty=0.3)
    w = w._replace(W_3=0.1 * np.random.default_rng(1).standard_normal(w.W_3.shape).astype(np.float32))
    starts = aim.starts[:6]
    with jax.enable_x64(True):
        wide = type(w)(*(np.float64(one) for one in w))
        aim.data = jax.tree.map(lambda one: jax.numpy.asarray(np.float64(one)), aim.data)
        loss = jax.jit(lambda w: aim.loss(w, starts, aim.data))
        gradient = jax.jit(jax.grad(loss))(wide)
        rng = np.random.default_rng(2)
        for name in w._fields:
            way = rng.standard_normal(getattr(w, name).shape)
            h = 1e-5
            up, down = (loss(wide._replace(**{name: getattr(wide, name) + s * h * way})) for s in (1, -1))
            assert float(np.sum(getattr(gradient, name) * way)) == pytest.approx(float(up - down) / (2 * h), rel=2e-4)


@pytest.mark.long
def test_gradients_are_finite_at_rest_and_astern():
    import jax

    aim, w = an_aim(horizon=8)
    still = np.zeros((9, 2, 6), dtype=np.float32)
    still[:, 1, 3] = -1.0
    controls = np.zeros((9, 2, 2), dtype=np.float32)
    around = np.zeros((9, 2, aim.data["around"].shape[1]), dtype=np.float32)

    def far(w):
        return (aim.loss.roll(w, aim.data["fixed"], still[0], controls, around)[0] ** 2).sum()

    gradient = jax.jit(jax.grad(far))(w)
    assert all(np.isfinite(one).all() for one in gradient)


def test_resumed_equals_not_interrupted(tmp_path, trained):
    asked = []
    hooks = Hooks(on_progress=lambda *_: asked.append(1), stop=lambda: len(asked) >= 2)
    first = learn_hybrid("suzaku", "suzaku", SMALL, hooks=hooks, folder=tmp_path)
    assert first.interrupted
    assert not first.gained  # none was chosen and trained on all runs yet
    document = write_learned(first, tmp_path)
    assert "Stopped before" in hybrid_summary(first, document, "runs/x", report=False)
    second = learn_hybrid("suzaku", "suzaku", SMALL, folder=tmp_path, resume=True)
    np.testing.assert_array_equal(weights(second), weights(trained))
    assert second.gains == trained.gains


@pytest.mark.long
def test_where_nothing_is_missing_it_says_no_gain():
    """Trials simulated by the profile itself: whatever a network adds is wrong."""
    from mmgtune.motions import as_trial
    from mmgtune.motions import simulate_trials as simulated
    from mmgtune.trial import TrialSet

    data = load_trials("suzaku")
    profile = load_profile("suzaku")
    trials = [data.trials[id] for id in data.tune]
    own = {one.id: as_trial(profile, one) for one in simulated(profile, trials)}
    own = {id: replace(trial, manoeuvre="turning") for id, trial in own.items()}
    noise = np.random.default_rng(1)
    own = {
        id: replace(one, x=one.x + 0.05 * noise.standard_normal(one.n_samples), y=one.y + 0.0, psi=one.psi + 0.0)
        for id, one in own.items()
    }
    result = learn_hybrid(profile, TrialSet(own, tuple(own), ()), SMALL)
    assert not result.gained
    assert not result.hybrid.weights.W_3.any()


@pytest.mark.long
def test_losses_that_are_no_numbers_are_null_in_the_record(trained, tmp_path):
    spoiled = replace(trained, tried={15.0: [{"step": 8, "loss": float("nan"), "norm": float("inf"), "score": 1.0}]})
    write_learned(spoiled, tmp_path)
    (row,) = json.loads((tmp_path / "hybrid.json").read_text())["tried"][0]["curve"]
    assert row == {"step": 8, "loss": None, "norm": None, "score": 1.0}
    with pytest.raises(OptionError, match="penalty"):
        HybridOptions(penalty=(15.0, 1e39))


@pytest.mark.long
def test_a_profile_is_not_tuned_anew_where_that_is_not_asked_for(monkeypatch):
    def never(*_, **__):
        raise AssertionError("tuned anew")

    monkeypatch.setattr(hybrid_run, "refitted", never)
    learn_hybrid("suzaku", "suzaku", replace(SMALL, steps=8, refit=False))


def test_a_tuned_profile_is_tuned_anew_without_the_runs():
    """What tuning it found is found again on the same runs, and something else on others."""
    data = load_trials("suzaku")
    from mmgtune.fitting import FitOptions, fit
    from mmgtune.profile import tuned

    profile = load_profile("suzaku")
    assert refitted(profile, [data.trials[id] for id in data.tune], restart=None) is profile
    options = FitOptions(targets=("hull.Y_v", "hull.N_r"), method="least-squares", starts=1, objective="standardised")
    found = fit(profile, data, replace(options, regularise=5e-4))
    once = tuned(profile, found.theta, {}, {"a_r": 0.5})
    assert tuned_names(once) == ("hull.Y_v", "hull.N_r")
    again = refitted(once, [data.trials[id] for id in data.tune], restart=None)
    other = refitted(once, [data.trials[id] for id in data.tune[:2]], restart=None)
    assert again.value("hull.N_r") == pytest.approx(once.value("hull.N_r"), rel=1e-3)
    assert other.value("hull.N_r") != pytest.approx(once.value("hull.N_r"), rel=1e-3)


def test_each_kind_of_manoeuvre_begins_as_many_windows():
    data = load_trials("suzaku")
    model = Model(load_profile("suzaku"))
    several = [replace(one, manoeuvre="zigzag" if k == 0 else "turning") for k, one in enumerate(data.trials.values())]
    samples = samples_of(several, model.inputs, 2.0)
    starts = balanced(samples, 20)
    kinds = np.array(samples.kinds(starts))
    assert (kinds == "zigzag").sum() == (kinds == "turning").sum()
    assert {*starts.tolist()} == {*samples.starts(20).tolist()}


def test_what_one_kind_gains_another_does_not_pay():
    runs = {"a": ("turning", 10), "b": ("turning", 30), "c": ("zigzag", 10)}
    before = {"a": 1.0, "b": 2.0, "c": 1.0}
    after = {"a": 0.5, "b": 1.0, "c": 1.2}
    assert ratios(before, after, runs) == pytest.approx({"turning": 0.5, "zigzag": 1.2})
    assert relative(before, after, runs) == pytest.approx(0.85 + 0.2)
    assert relative(before, before, runs) == pytest.approx(1.0)


def test_a_hybrid_is_a_table_and_pictures(trained):
    frame = trained.to_frame().set_index("trials")
    assert frame.loc["kept back", "share removed"] == trained.gains[0].share
    before, after = (L_MSE(trained.scores[which]) for which in ("before", "after"))
    assert frame.loc["held out", ["L_MSE without", "L_MSE with"]].tolist() == pytest.approx([before, after])
    assert trained.sentence().startswith("On held-out runs the hybrid is ")
    assert dir(trained.plot) == ["histories", "tracks"]
    assert trained.to_dict()["warnings"] == []
