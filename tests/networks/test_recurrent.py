"""The equations of the networks: eq. 8, 10 and 21-22 of Wakita et al. 2022, written out once more by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mmgtune.networks.motion import moved
from mmgtune.networks.predicting import NetworkRun
from mmgtune.networks.recurrent import Scales, accelerations, features, projected, remembered, truncated
from mmgtune.physics.quantities import UNKNOWN

from .made import network


def by_hand(net, seen):
    """Accelerations of one member along features (T, n_features), unit by unit."""
    w = [np.asarray(one)[0] for one in net.weights]
    W_x, W_r, b_0, W_1, b_1, W_2, b_2, W_3 = w
    width = W_r.shape[0]
    z = np.zeros(width)
    for x in seen:
        new = np.empty(width)
        for j in range(width):
            inside = sum(x[i] * W_x[i, j] for i in range(len(x))) + sum(z[i] * W_r[i, j] for i in range(width))
            new[j] = np.tanh(inside + b_0[0, j]) - np.tanh(b_0[0, j])
        z = new
    for W, b in ((W_1, b_1), (W_2, b_2)):
        z = np.array([np.tanh(z @ W[:, j] + b[0, j]) - np.tanh(b[0, j]) for j in range(width)])
    return (z @ W_3) * np.asarray(net.scales.accelerations)[0, 0]


def test_standard_memory_is_the_paper_s():
    net = network(memory=None)
    seen = np.random.default_rng(2).standard_normal((7, 7))
    memory = np.zeros((1, 1, net.width))
    for x in seen:
        memory = remembered(projected(x[None, None], net.weights), memory, net.weights)
    np.testing.assert_allclose(accelerations(memory, net.weights, net.scales)[0, 0], by_hand(net, seen), rtol=1e-12)


@pytest.mark.parametrize("memory", [1, 2, 3, 9])
def test_truncated_memory_sees_the_last_samples_alone(memory):
    """At each sample what eq. 10 gives begun anew; two lanes side by side do not mix."""
    net = network()
    seen = np.random.default_rng(2).standard_normal((7, 2, 7))
    held = np.zeros((1, (memory - 1) * 2, net.width))
    for k, now in enumerate(seen):
        first, held = truncated(projected(now[None], net.weights), held, net.weights)
        found = accelerations(first, net.weights, net.scales)[0]
        for lane in range(2):
            expected = by_hand(net, seen[max(0, k + 1 - memory) : k + 1, lane])
            np.testing.assert_allclose(found[lane], expected, rtol=1e-12)


def test_nothing_in_gives_nothing_out():
    net = network(members=3)
    still, held = np.zeros((3, 2, 7)), np.zeros((3, 4, net.width))
    for _ in range(3):
        first, held = truncated(projected(still, net.weights), held, net.weights)
        assert not accelerations(first, net.weights, net.scales).any()


def test_a_history_shorter_than_the_memory_is_remembered_whole():
    standard, short = network(memory=None), network(memory=6)
    state = np.array([[[0.0, 0.0, 0.3, 0.5, 0.1, 0.02]]])
    runs = NetworkRun(standard, state), NetworkRun(short, state)
    rng = np.random.default_rng(3)
    for k in range(8):
        controls, around = rng.standard_normal((1, 2)), rng.standard_normal((1, len(UNKNOWN)))
        for run in runs:
            run.step(controls, around, 0.1)
        same = np.allclose(runs[0].states, runs[1].states, rtol=0.0, atol=1e-14)
        assert same == (k < 6)


def test_the_ship_sees_apparent_wind_from_where_it_comes():
    plain = Scales(np.ones(1), np.ones(1))
    heading_east = np.array([0.0, 0.0, np.pi / 2, 2.0, 0.5, 0.1])
    # Air that moves west at 3 m/s: from ahead, at 5 m/s with her own speed; and her drift brings some from starboard.
    seen = features(heading_east, np.array([8.0, 0.2]), np.array([0.0, -3.0]), plain)
    np.testing.assert_allclose(seen, [2.0, 0.5, 0.1, 8.0, 0.2, 5.0, 0.5], atol=1e-15)


@pytest.mark.parametrize("psi", [0.0, 1.0, -2.5])
def test_a_step_is_euler_s(psi):
    state = np.array([1.0, 2.0, psi, 0.8, -0.2, 0.05])
    found = moved(state, np.array([0.1, -0.2, 0.3]), 0.1)
    c, s = np.cos(psi), np.sin(psi)
    by = [0.8 * c + 0.2 * s, 0.8 * s - 0.2 * c, 0.05, 0.1, -0.2, 0.3]
    np.testing.assert_allclose(found, state + 0.1 * np.array(by), rtol=1e-14)


@pytest.mark.parametrize("memory", [None, 3])
def test_mirrored_it_goes_as_far_to_port_as_to_starboard(memory):
    """The mirror image of a run is the run of the mirror image, wind and rudder included; a plain network's is not."""
    plain = network(members=2, memory=memory, size=0.8)
    shown = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
    rng = np.random.default_rng(4)
    state = np.broadcast_to(np.array([0.0, 0.0, 0.3, 0.5, 0.1, 0.02]), (2, 1, 6))
    off = []
    for net in (replace(plain, mirrored=True), plain):
        one, other = NetworkRun(net, state), NetworkRun(net, shown * state)
        for _ in range(9):
            controls = rng.standard_normal((1, 2))
            north, east = rng.standard_normal(2)
            here = np.array([UNKNOWN._replace(wind_north=north, wind_east=east)], dtype=float)
            there = np.array([UNKNOWN._replace(wind_north=north, wind_east=-east)], dtype=float)
            one.step(controls, here, 0.1)
            other.step(controls * [1.0, -1.0], there, 0.1)
        off.append(np.abs(one.states - shown * other.states).max())
    assert off[0] < 1e-14
    assert off[1] > 1e-3


def test_mirrored_it_gives_the_mean_of_both_sides():
    net = replace(network(memory=None), mirrored=True)
    state = np.array([[[0.0, 0.0, 0.0, 0.5, 0.1, 0.02]]])
    run = NetworkRun(net, state)
    run.step(np.array([[7.0, 0.2]]), np.array([UNKNOWN], dtype=float), 1.0)
    seen = np.array([0.5, 0.1, 0.02, 7.0, 0.2, 0.5, 0.1])
    image = np.array([0.5, -0.1, -0.02, 7.0, -0.2, 0.5, -0.1])
    scale = np.asarray(net.scales.features)[0, 0]
    a, b = by_hand(net, seen[None] / scale), by_hand(net, image[None] / scale)
    expected = state[0, 0, 3:] + 0.5 * (a + b * [1.0, -1.0, -1.0])
    np.testing.assert_allclose(run.states[0, 0, 3:], expected, rtol=1e-12)
