"""The feed-forward networks of Wakita, Akimoto and Maki as pure functions: the only copy of their equations.

They know NumPy alone and work on one network; those of an ensemble are stacked along a first axis of members, of which
``member`` takes one.  Training differentiates the same functions rebuilt on JAX.  Equation numbers are that paper's.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from .motion import Array

Dense = Sequence[tuple[Array, Array]]
"""Layers in their order: W (n_in, n_out) and b (1, n_out) of each."""

Stacked = TypeVar("Stacked", bound=tuple[Array, ...])


class Layers(NamedTuple):
    """Weights of a network of hidden layers of one width (eq. 7-9); leading axes are members."""

    W_in: Array  # (..., n_in, width)
    b_in: Array  # (..., 1, width)
    W_hidden: Array  # (..., n_layers - 1, width, width)
    b_hidden: Array  # (..., n_layers - 1, 1, width)
    W_out: Array  # (..., width, n_out)
    b_out: Array  # (..., 1, n_out)


class Standards(NamedTuple):
    """What inputs and outputs of a network are standardised by (eq. 12-14); leading axes are members."""

    in_mean: Array  # (..., 1, n_in) in the training data
    in_deviation: Array  # (..., 1, n_in)
    raw_mean: Array  # (..., 1, n_out) of the untrained network where standard-normal numbers go in
    raw_deviation: Array  # (..., 1, n_out)
    out_mean: Array  # (..., 1, n_out) of what it is to give, in the training data
    out_deviation: Array  # (..., 1, n_out)


def member(stacked: Stacked, k: int) -> Stacked:
    """One of those stacked along the first axis, without that axis."""
    return stacked._make(one[k] for one in stacked)  # type: ignore[attr-defined, no-any-return]


def dense(w: Layers) -> Dense:
    """The layers of one network in their order; taken out once, so that no step of a roll-out does it again."""
    between = [(w.W_hidden[k], w.b_hidden[k]) for k in range(w.W_hidden.shape[0])]
    return [(w.W_in, w.b_in), *between, (w.W_out, w.b_out)]


def through(x: Array, layers: Dense) -> Array:
    """(n, n_out) of (n, n_in): tanh after each layer but the last (eq. 7-10)."""
    for W, b in layers[:-1]:
        x = np.tanh(x @ W + b)
    W, b = layers[-1]
    return x @ W + b


def standardised(x: Array, s: Standards) -> Array:
    """Inputs (..., n_in) in SI as the network takes them (eq. 12)."""
    return (x - s.in_mean) / s.in_deviation


def scaled(raw: Array, s: Standards) -> Array:
    """What the network gives, (..., n_out), at the scale of the data (eq. 13-14)."""
    return (raw - s.raw_mean) / s.raw_deviation * s.out_deviation + s.out_mean


def evaluated(x: Array, layers: Dense, s: Standards) -> Array:
    """(n, n_out) of inputs (n, n_in) in SI: eq. 12-15."""
    return scaled(through(standardised(x, s), layers), s)


def sequence(observations: Array) -> Array:
    """What the initial-state network sees, (n, 3 K): first velocities, and by how much later ones differ (eq. 21).

    observations  (K, n, 6) states, K of them from the start on

    A linear form of the paper's: differences show noise and motion better than values that are nearly the same.
    Positions and headings are left out, since their errors are ignored in training as well.
    """
    first = observations[:1, :, 3:]
    later = observations[1:, :, 3:] - first
    both = np.concatenate([first, later], axis=0)
    return np.reshape(np.transpose(both, (1, 0, 2)), (both.shape[1], -1))


def begun(observations: Array, layers: Dense, s: Standards) -> Array:
    """States (n, 6) estimated at the first of the observations (K, n, 6): eq. 22; the pose stays as observed."""
    correction = evaluated(sequence(observations), layers, s)
    first = observations[0]
    return np.concatenate([first[:, :3], first[:, 3:] + correction], axis=-1)
