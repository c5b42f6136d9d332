"""Compiled and NumPy lanes give the same motion for every component."""

import os
import subprocess
import sys

import numpy as np
import pytest

from mmgtune.backends import Integrator, get_backend, pad
from mmgtune.components import COMPONENTS, KINDS
from mmgtune.model import Model
from mmgtune.profile import load_profile, with_effects
from mmgtune.resources import profile_names
from tests.runs import driven, measured, states, turn


def zigzag_like(model, seconds=900):
    """Rudder to and fro with revolutions changing: every branch of the components is visited."""
    t = np.arange(seconds + 1.0)
    approach = model.profile.approach
    delta = np.radians(30.0) * np.sin(t / 25.0) * np.sign(np.sin(t / 140.0))
    n = approach.n * (0.8 + 0.3 * np.cos(t / 60.0))
    return pad([t], [driven(model, n, delta)], [np.array([0.0, 0.0, 1.0, approach.speed, 0.0, 0.0])])


def backing(model, seconds=400):
    """Full ahead, stop, full astern until she moves astern, ahead again: all quadrants, with wind and rudder."""
    t = np.arange(0.0, seconds, 0.5)
    n = model.profile.approach.n * np.clip(1.3 * np.cos(t / 40.0), -1.0, 1.0)
    delta = np.radians(30.0) * np.sin(t / 17.0)
    wind = measured(t, wind=(0.4 * np.cos(t / 90.0), 0.4))
    initial = np.array([0.0, 0.0, 1.0, model.profile.approach.speed, 0.0, 0.0])
    return pad([t], [np.column_stack([n, delta])], [initial], around=[wind])


@pytest.mark.parametrize("integrator", [Integrator("euler"), Integrator("heun"), Integrator("rk4")])
def test_ahead_and_astern_agree(esso_osaka, integrator):
    theta = esso_osaka.matrix(["hull.C_D"], np.linspace(0.8, 1.2, 9)[None])
    cases = backing(esso_osaka)
    compiled, reference = (states(esso_osaka, cases, theta, name, integrator) for name in ("compiled", "numpy"))
    assert reference[0, :, :, 3].min() < -0.05 < 0.3 < reference[0, :, :, 3].max()
    assert np.max(np.abs(compiled - reference) / (1.0 + np.abs(reference))) < 1e-9


@pytest.mark.daily("integrator1")
@pytest.mark.parametrize("integrator", [Integrator("euler"), Integrator("rk4"), Integrator("euler", 3)])
def test_900_steps_to_1e_9(any_model, integrator):
    """As many steps of the method whichever it is: stages and substeps count."""
    rng = np.random.default_rng(1)
    names = [next(iter(any_model.profile.sections[kind].numbers)) for kind in any_model.arrangement.kinds[1:]]
    values = np.array([[any_model.profile.value(name)] for name in names]) * rng.uniform(0.8, 1.2, (len(names), 11))
    theta = any_model.matrix(names, values)
    cases = zigzag_like(any_model, 900 // max(integrator.substeps, len(integrator.tableau[0])))
    compiled, reference = (states(any_model, cases, theta, backend, integrator) for backend in ("compiled", "numpy"))
    assert np.max(np.abs(compiled - reference) / (1.0 + np.abs(reference))) < 1e-9


@pytest.mark.parametrize(("name", "order"), [("euler", 1), ("heun", 2), ("rk4", 4)])
def test_half_the_step_brings_the_error_down_by_the_order_of_the_method(suzaku, name, order):
    t = np.arange(0.0, 400.0, 8.0)
    controls = np.column_stack([np.full(len(t), 1.7), 0.2 + 0.0 * t])
    cases = pad([t], [controls], [np.array([0.0, 0.0, 0.0, 3.2, 0.0, 0.0])])
    exact = states(suzaku, cases, integrator=Integrator("rk4", 64))
    off = [np.abs(states(suzaku, cases, integrator=Integrator(name, n)) - exact).max() for n in (4, 8)]
    assert np.log2(off[0] / off[1]) == pytest.approx(order, abs=0.4)


def test_every_component_is_in_a_bundled_profile():
    used = {tag for name in profile_names() for tag in Model(load_profile(name)).tags}
    assert {tag for tag in used if not tag.startswith(("effects.", "arrangement:"))} == {
        f"{component.kind}:{component.tag}" for component in COMPONENTS if component.kind in KINDS
    }


def test_costs_agree(suzaku):
    cases = turn(suzaku, 20.0)
    rng = np.random.default_rng(2)
    cases.target[:] = rng.standard_normal(cases.target.shape)
    cases.weight[:] = rng.uniform(0.0, 1.0, cases.weight.shape)
    theta = suzaku.matrix(["hull.R_0"], np.linspace(0.01, 0.03, 5)[None])
    a, b = (get_backend(name).run(suzaku, theta, cases).cost for name in ("compiled", "numpy"))
    np.testing.assert_allclose(a, b, rtol=1e-9)


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
def test_a_lane_equals_a_single_run(suzaku, backend):
    names = ["hull.R_0", "rudder.eps"]
    values = np.random.default_rng(3).uniform(0.9, 1.1, (2, 13)) * np.array([[0.017], [1.27]])
    cases = turn(suzaku, -35.0, 200.0)
    together = states(suzaku, cases, suzaku.matrix(names, values), backend)
    for k in (0, 7, 12):
        alone = states(suzaku, cases, suzaku.matrix(names, values[:, [k]]), backend)
        np.testing.assert_allclose(together[0, k], alone[0, 0], rtol=1e-13, atol=1e-13)


def test_compiled_lanes_are_bit_equal_to_single_runs(suzaku):
    values = np.linspace(0.01, 0.03, 21)[None]
    cases = turn(suzaku, 10.0)
    together = states(suzaku, cases, suzaku.matrix(["hull.R_0"], values))
    alone = states(suzaku, cases, suzaku.matrix(["hull.R_0"], values[:, [17]]))
    assert np.array_equal(together[0, 17], alone[0, 0])


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
def test_cases_of_different_length_do_not_touch(suzaku, backend):
    long, short = turn(suzaku, 35.0, 300.0), turn(suzaku, -20.0, 120.0)
    both = pad([long.t[0], short.t[0]], [long.controls[0], short.controls[0]], [long.initial[0], short.initial[0]])
    together = states(suzaku, both, backend=backend)
    np.testing.assert_array_equal(together[0, 0], states(suzaku, long, backend=backend)[0, 0])
    np.testing.assert_array_equal(together[1, 0, :121], states(suzaku, short, backend=backend)[0, 0])
    assert np.all(together[1, 0, 121:] == together[1, 0, 120])


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
def test_a_diverging_lane_is_a_status_and_leaves_the_others_alone(suzaku, backend):
    cases = turn(suzaku, 35.0)
    theta = suzaku.matrix(["hull.R_0"], [[0.017, 0.017]])
    theta[suzaku.rows["hull.X_vvvv"], 1] = 1e9
    result = get_backend(backend).run(suzaku, theta, cases)
    assert result.diverged.tolist() == [[False, True]]
    assert np.isfinite(result.cost[0, 0])
    assert result.cost[0, 1] == np.inf


@pytest.mark.parametrize("backend", ["compiled", "numpy"])
def test_residuals_are_the_roots_of_the_cost(suzaku, backend):
    long, short = turn(suzaku, 35.0, 120.0), turn(suzaku, -20.0, 60.0)
    rng = np.random.default_rng(4)
    weight = [rng.uniform(size=(n, 6)) * (rng.uniform(size=(n, 6)) > 0.3) for n in (121, 61)]
    for w in weight:
        w[0] = 0.0
    target = [rng.standard_normal((n, 6)) for n in (121, 61)]
    cases = pad(
        [long.t[0], short.t[0]],
        [long.controls[0], short.controls[0]],
        [long.initial[0], short.initial[0]],
        target,
        weight,
    )
    theta = suzaku.matrix(["hull.R_0"], np.linspace(0.01, 0.03, 5)[None])
    result = get_backend(backend).run(suzaku, theta, cases, keep_residuals=True, keep_states=True)
    np.testing.assert_allclose(np.sum(result.residuals**2, axis=0), result.cost.sum(axis=0), rtol=1e-12)
    for case, i, channel in ((0, 5, 0), (1, 60, 5), (0, 120, 2)):
        row = cases.rows[case, i, channel]
        expected = np.sqrt(weight[case][i, channel]) * (result.states[case, :, i, channel] - target[case][i, channel])
        if row >= 0:
            np.testing.assert_allclose(result.residuals[row], expected, atol=1e-12)


@pytest.mark.parametrize("n_candidates", [1, 3, 11])
def test_lanes_over_cases_and_candidates_are_bit_equal_to_single_runs(esso_osaka, n_candidates):
    """Few candidates on cases of many lengths share blocks: nothing of one lane may show in another."""
    rng = np.random.default_rng(6)
    whole = backing(esso_osaka, 120)
    lengths = rng.integers(2, len(whole.t[0]), size=21)
    begins = [rng.integers(0, len(whole.t[0]) - n + 1) for n in lengths]
    pieces = [slice(a, a + n) for a, n in zip(begins, lengths, strict=True)]
    weight = [rng.uniform(size=(n, 6)) * (rng.uniform(size=(n, 6)) > 0.4) for n in lengths]
    for w in weight:
        w[0] = 0.0

    def cases(chosen):
        return pad(
            [whole.t[0, pieces[k]] for k in chosen],
            [whole.controls[0, pieces[k]] for k in chosen],
            [whole.initial[0]] * len(chosen),
            [np.ones((lengths[k], 6)) for k in chosen],
            [weight[k] for k in chosen],
            [whole.around[0, pieces[k]] for k in chosen],
        )

    model = Model(with_effects(esso_osaka.profile, {"clock-offset": {"seconds": -0.7}}, "a test"))
    theta = model.matrix(["hull.C_D"], np.linspace(0.8, 1.2, n_candidates)[None])
    everything, run = cases(range(21)), get_backend("compiled").run
    together = run(model, theta, everything, integrator=Integrator("rk4", 2), keep_states=True, keep_residuals=True)
    rows = everything.rows
    for k in range(21):
        for candidate in range(n_candidates):
            one = cases([k])
            alone = run(
                model,
                theta[:, [candidate]],
                one,
                integrator=Integrator("rk4", 2),
                keep_states=True,
                keep_residuals=True,
            )
            n = lengths[k]
            assert alone.cost[0, 0] == together.cost[k, candidate]
            assert np.array_equal(alone.states[0, 0], together.states[k, candidate, :n])
            assert np.all(together.states[k, candidate, n:] == together.states[k, candidate, n - 1])
            own = rows[k][rows[k] >= 0]
            assert np.array_equal(alone.residuals[:, 0], together.residuals[own, candidate])


@pytest.mark.parametrize("backend", ["compiled", "numpy", pytest.param("jax", marks=pytest.mark.long)])
def test_a_candidate_for_each_case_is_the_same_as_every_case_with_every_candidate(suzaku, backend):
    """Cases of many lengths and steps, with a lag that remembers and a clock that is late."""
    if backend == "jax":
        pytest.importorskip("jax")
    rounding = 1e-11 if backend == "jax" else 0.0  # which sums in another order for other counts of lanes
    effects = {
        "steering-lag": {"time_constant": 4.0},
        "clock-offset": {"seconds": -0.7},
        "memory": {"time_constant": 9},
    }
    model = Model(with_effects(suzaku.profile, effects, "a test"))
    rng = np.random.default_rng(7)
    runs = [turn(model, 35.0 * (-1.0) ** k, 60.0 + 7.0 * k, 0.5 + 0.1 * k) for k in range(11)]
    weight = [rng.uniform(size=(len(one.t[0]), 6)) for one in runs]
    for w in weight:
        w[0] = 0.0
    cases = pad(
        [one.t[0] for one in runs],
        [one.controls[0] for one in runs],
        [one.initial[0] for one in runs],
        [rng.standard_normal(w.shape) for w in weight],
        weight,
    )
    theta = model.matrix(["hull.R_0"], np.linspace(0.01, 0.03, 11)[None])
    known = {"integrator": Integrator("rk4"), "keep_states": True, "keep_residuals": True}
    run, own = get_backend(backend).run, np.arange(11)
    paired, product = run(model, theta, cases, paired=True, **known), run(model, theta, cases, **known)
    assert paired.cost.shape == (11, 1)
    np.testing.assert_allclose(paired.cost[:, 0], product.cost[own, own], rounding, rounding)
    np.testing.assert_allclose(paired.states[:, 0], product.states[own, own], rounding, rounding)
    case_of = np.argwhere(cases.rows >= 0)[:, 0]
    expected = product.residuals[np.arange(len(case_of)), case_of]
    np.testing.assert_allclose(paired.residuals[:, 0], expected, rounding, rounding)
    one = pad([runs[3].t[0]], [runs[3].controls[0]], [runs[3].initial[0]])
    alone = run(model, theta[:, [3]], one, paired=True, **known)
    np.testing.assert_allclose(alone.states[0, 0], paired.states[3, 0, : one.n_samples[0]], rounding, rounding)


@pytest.mark.parametrize(
    ("backend", "n_candidates"),
    [
        ("compiled", 1), ("compiled", 9), ("numpy", 1), ("numpy", 9),
        pytest.param("jax", 9, marks=pytest.mark.long),
    ],
)  # fmt: skip
def test_candidates_that_differ_from_case_to_case_are_those_of_each_case_alone(suzaku, backend, n_candidates):
    turns = [turn(suzaku, degrees, seconds) for degrees, seconds in ((20.0, 90.0), (-35.0, 60.0), (10.0, 90.0))]
    whole = pad([one.t[0] for one in turns], [one.controls[0] for one in turns], [one.initial[0] for one in turns])
    values = np.random.default_rng(4).uniform(0.9, 1.1, (3, n_candidates)) * 0.017
    theta = np.stack([suzaku.matrix(["hull.R_0"], own[None]) for own in values], axis=1)
    together = states(suzaku, whole, theta, backend)
    for k, one in enumerate(turns):
        alone = states(suzaku, one, theta[:, k], backend)[0]
        np.testing.assert_allclose(together[k, :, : one.t.shape[1]], alone, rtol=1e-12, atol=1e-12)


def test_weights_at_the_first_sample_are_refused(suzaku):
    cases = turn(suzaku, 20.0)
    weight = np.ones((len(cases.t[0]), 6))
    with pytest.raises(ValueError, match="first sample"):
        pad([cases.t[0]], [cases.controls[0]], [cases.initial[0]], [0.0 * weight], [weight])


@pytest.mark.parametrize("size", [float("nan"), float("inf"), -1.0])
def test_weights_that_are_no_sizes_are_refused(suzaku, size):
    """A weight without a row among the residuals was written where there is none."""
    cases = turn(suzaku, 20.0)
    weight = np.vstack([np.zeros((1, 6)), np.full((len(cases.t[0]) - 1, 6), size)])
    with pytest.raises(ValueError, match="no numbers"):
        pad([cases.t[0]], [cases.controls[0]], [cases.initial[0]], [np.zeros_like(weight)], [weight])


def test_a_process_may_be_told_how_many_cores_it_has():
    say = "from mmgtune.backends.compiled import _pool, cores; print(cores(), _pool()._max_workers)"
    done = subprocess.run(
        [sys.executable, "-c", say], env={**os.environ, "MMGTUNE_THREADS": "1"}, capture_output=True, text=True
    )
    assert done.stdout.split() == ["1", "1"], done.stderr
