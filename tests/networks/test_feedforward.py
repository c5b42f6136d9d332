"""The equations of the ensemble's networks, eq. 7-15 and 22 of Wakita, Akimoto and Maki, written out once more."""

from __future__ import annotations

import numpy as np
import pytest

from mmgtune.networks.feedforward import begun, dense, evaluated, member, sequence

from .made import ensemble


def by_hand(x, w, s):
    """One input through one network, unit by unit."""
    z = [(v - m) / d for v, m, d in zip(x, s.in_mean[0], s.in_deviation[0], strict=True)]
    layers = [(w.W_in, w.b_in), *zip(w.W_hidden, w.b_hidden, strict=True)]
    for W, b in layers:
        z = [np.tanh(sum(z[i] * W[i, j] for i in range(len(z))) + b[0, j]) for j in range(W.shape[1])]
    raw = [sum(z[i] * w.W_out[i, j] for i in range(len(z))) + w.b_out[0, j] for j in range(3)]
    return [
        (y - s.raw_mean[0, j]) / s.raw_deviation[0, j] * s.out_deviation[0, j] + s.out_mean[0, j]
        for j, y in enumerate(raw)
    ]


@pytest.mark.parametrize("layers", [1, 2, 3])
def test_a_network_is_the_paper_s(layers):
    of = ensemble(layers=layers).motion
    x = np.random.default_rng(2).standard_normal((5, 7))
    for k in range(of.n_members):
        w, s = member(of.layers, k), member(of.standards, k)
        found = evaluated(x, dense(w), s)
        np.testing.assert_allclose(found, [by_hand(row, w, s) for row in x], rtol=1e-12, atol=1e-15)


def test_the_initial_state_is_the_first_observation_and_a_correction_of_its_velocities():
    one = ensemble(members=2, initial=4)
    seen = np.random.default_rng(3).standard_normal((4, 5, 6))
    found = one.started(seen)
    np.testing.assert_array_equal(found[:, :, :3], np.broadcast_to(seen[0, :, :3], (2, 5, 3)))
    w, s = member(one.start.layers, 1), member(one.start.standards, 1)
    velocities = seen[:, 2, 3:]
    x = np.concatenate([velocities[0], *(later - velocities[0] for later in velocities[1:])])
    np.testing.assert_allclose(found[1, 2, 3:] - velocities[0], by_hand(x, w, s), rtol=1e-10)
    np.testing.assert_allclose(sequence(seen)[2], x)


def test_where_the_ship_is_and_heads_to_says_nothing_of_her_velocities():
    one = member(ensemble().start.layers, 0), member(ensemble().start.standards, 0)
    seen = np.random.default_rng(3).standard_normal((4, 5, 6))
    moved = seen + np.array([100.0, -40.0, 2.0, 0.0, 0.0, 0.0])
    a, b = (begun(of, dense(one[0]), one[1]) for of in (seen, moved))
    np.testing.assert_array_equal(a[:, 3:], b[:, 3:])


def test_without_such_networks_nothing_is_estimated():
    with pytest.raises(ValueError, match="no initial-state networks"):
        ensemble(initial=0).started(np.zeros((4, 1, 6)))
