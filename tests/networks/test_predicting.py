"""Networks as predictors."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from mmgtune.backends import pad
from mmgtune.errors import TrialError
from mmgtune.networks import NetworkPredictor
from mmgtune.networks.model import Network
from mmgtune.networks.recurrent import Weights
from mmgtune.physics.quantities import Surroundings
from mmgtune.predictor import Predictor, Steerable

from .made import network

START = np.array([3.0, -4.0, 0.4, 0.6, 0.05, 0.01])


def a_case(n=41, step=0.1, *, seed=5, wind=True):
    """One run with inputs that change at every sample."""
    rng = np.random.default_rng(seed)
    t = step * np.arange(n)
    controls = np.cumsum(rng.standard_normal((n, 2)), axis=0)
    around = np.zeros((n, len(Surroundings._fields)))
    if wind:
        around[:, :2] = rng.standard_normal((n, 2))
        around[:, 2] = 1.0
    return t, controls, START, around


def predict(predictor, *cases):
    t, controls, initial, around = zip(*cases, strict=True)
    return predictor.predict(pad(list(t), list(controls), list(initial), around=list(around)))


def test_it_is_a_predictor_and_steerable():
    one = NetworkPredictor(network())
    assert isinstance(one, Predictor)
    assert isinstance(one, Steerable)
    assert (one.name, one.method) == ("toy type 1", "network, euler at 0.1 s")


@pytest.mark.parametrize("memory", [None, 3])
def test_each_member_predicts_as_if_alone(memory):
    net = network(members=3, memory=memory)
    together = predict(NetworkPredictor(net), a_case(), a_case(seed=6))
    for k in range(3):
        alone = predict(NetworkPredictor(net.member(k)), a_case(), a_case(seed=6))
        np.testing.assert_allclose(together.states[:, k], alone.states[:, 0], rtol=1e-12, atol=1e-12)


def test_cases_of_other_lengths_beside_it_change_nothing():
    one = NetworkPredictor(network())
    short, long = a_case(11), a_case(61, seed=6)
    both = predict(one, short, long)
    np.testing.assert_allclose(both.states[0, :, :11], predict(one, short).states[0], rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(both.states[1], predict(one, long).states[0], rtol=1e-13, atol=1e-13)


def test_it_marches_in_its_own_step_whatever_the_samples_are():
    one = NetworkPredictor(network())
    n, fine = 401, a_case(401)
    t, _, initial, around = fine
    controls = np.column_stack([np.linspace(0.0, 3.0, n), np.linspace(0.2, -0.4, n)])
    around = np.zeros_like(around)
    each = predict(one, (t, controls, initial, around)).states[0, 0]
    tenth = predict(one, (t[::10], controls[::10], initial, around[::10])).states[0, 0]
    np.testing.assert_allclose(tenth, each[::10], rtol=1e-10, atol=1e-12)


def test_a_time_that_jumps_is_refused():
    """A thousand million steps were marched through."""
    t, *rest = a_case()
    t = np.where(np.arange(len(t)) > 20, t + 1e9, t)
    with pytest.raises(TrialError, match="too many") as error:
        predict(NetworkPredictor(network()), (t, *rest))
    assert "cut the trial where its time jumps" in error.value.problems[0].fix


def test_turned_and_shifted_it_moves_the_same():
    """Only velocities, inputs and apparent wind count: another heading, wind turned with it, is the same motion."""
    one = NetworkPredictor(network())
    t, controls, initial, around = a_case()
    turn = 1.1
    c, s = np.cos(turn), np.sin(turn)
    other = around.copy()
    other[:, 0], other[:, 1] = c * around[:, 0] - s * around[:, 1], s * around[:, 0] + c * around[:, 1]
    a = predict(one, (t, controls, initial, around)).states[0, 0]
    b = predict(one, (t, controls, initial + np.array([10.0, 20.0, turn, 0.0, 0.0, 0.0]), other)).states[0, 0]
    np.testing.assert_allclose(b[:, 3:], a[:, 3:], rtol=1e-9, atol=1e-12)
    dx, dy = (a[:, :2] - a[0, :2]).T
    np.testing.assert_allclose(b[:, :2] - b[0, :2], np.column_stack([c * dx - s * dy, s * dx + c * dy]), atol=1e-10)


@pytest.mark.parametrize("memory", [None, 3])
def test_steered_it_goes_as_predicted(memory):
    net = network(memory=memory)
    t, controls, initial, around = a_case(wind=False)
    run = NetworkPredictor(net).stepper(0, initial, controls[0])
    for now, then in pairwise(controls):
        found = run.step(now, then, 0.1)
    np.testing.assert_allclose(found, predict(NetworkPredictor(net), (t, controls, initial, around)).states[0, 0, -1])


def test_a_run_that_leaves_the_world_is_marked_and_touches_no_other():
    wild = network()
    weights = wild.weights._replace(W_3=1e5 * wild.weights.W_3)
    both = Network(
        "toy",
        3.0,
        wild.inputs,
        wild.step,
        wild.memory,
        Weights(*(np.concatenate(pair) for pair in zip(wild.weights, weights, strict=True))),
        wild.scales,
    )
    found = predict(NetworkPredictor(both), a_case())
    assert found.diverged.tolist() == [[False, True]]
    np.testing.assert_allclose(found.states[0, 0], predict(NetworkPredictor(wild), a_case()).states[0, 0], rtol=1e-12)


@pytest.mark.parametrize("memory", [None, 3])
def test_a_member_on_each_case(memory):
    """What every member makes of every case, and of it the pairs that are asked for."""
    predictor = NetworkPredictor(network(members=3, memory=memory))
    t, controls, initial, around = zip(*(a_case(n, seed=n) for n in (41, 20, 31, 41)), strict=True)
    cases = pad(list(t), list(controls), list(initial), around=list(around))
    every = predictor.predict(cases).states
    members = np.array([2, 0, 2, 1])
    found = predictor.paired(cases, members)
    for k, member in enumerate(members):
        n = cases.n_samples[k]
        np.testing.assert_allclose(found[k, :n], every[k, member, :n], rtol=1e-12)
