"""The networks of Wakita et al. 2022 as pure functions: the only copy of their equations.

They know NumPy alone, and work on one network, or on several whose weights are stacked along a first axis of members;
inputs are then (n_members, n_lanes, n_features).  Training differentiates the same functions rebuilt on JAX.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .layer import layer
from .motion import SIDES, Array, observed


class Weights(NamedTuple):
    """Weights of the network of Wakita et al. 2022, eq. 8; leading axes are members.

    Zero in gives zero out: of each layer its value at zero is subtracted, and the last has no bias.
    """

    W_x: Array  # (..., n_features, width) of velocities, inputs and wind together
    W_r: Array  # (..., width, width) of the layer's own last value: the memory
    b_0: Array  # (..., 1, width)
    W_1: Array  # (..., width, width)
    b_1: Array  # (..., 1, width)
    W_2: Array  # (..., width, width)
    b_2: Array  # (..., 1, width)
    W_3: Array  # (..., width, 3)


class Scales(NamedTuple):
    """What features are divided by and accelerations multiplied with: standard deviations in the training data.

    No mean is subtracted, so that a ship at rest in still air stays zero.
    """

    features: Array  # (..., 1, n_features)
    accelerations: Array  # (..., 1, 3) [m/s^2, m/s^2, rad/s^2]


def features(states: Array, controls: Array, wind: Array, scales: Scales) -> Array:
    """What the network sees, (..., n_features): what is ``observed``, scaled (eq. 7)."""
    return observed(states, controls, wind) / scales.features


def both_sides(seen: Array, signs: Array) -> Array:
    """Lanes as they are and, behind them, with port and starboard exchanged: (..., 2 n_lanes, n_features).

    seen   (..., n_lanes, n_features)
    signs  (n_features,) as of ``mirror``
    """
    return np.concatenate([seen, seen * signs], axis=-2)


def alike(rates: Array) -> Array:
    """Accelerations (..., n_lanes, 3) that are mirror images of those of the mirrored ship, from (..., 2 n_lanes, 3).

    They are the mean of what the network gives for the ship, and for her mirror image mirrored back.
    """
    n = rates.shape[-2] // 2
    return 0.5 * (rates[..., :n, :] + np.array(SIDES) * rates[..., n:, :])


def projected(seen: Array, w: Weights) -> Array:
    """Part of the first layer that what is seen now gives, (..., width)."""
    return seen @ w.W_x


def remembered(part: Array, memory: Array, w: Weights) -> Array:
    """The first layer, (..., width), from what is seen now and its own last value: eq. 8, first line."""
    return layer(part + memory @ w.W_r, w.b_0)


def accelerations(memory: Array, w: Weights, scales: Scales) -> Array:
    """(..., 3) of u [m/s^2], v_m [m/s^2], r [rad/s^2] from the first layer: eq. 8, the other lines."""
    z_2 = layer(memory @ w.W_1, w.b_1)
    z_3 = layer(z_2 @ w.W_2, w.b_2)
    return (z_3 @ w.W_3) * scales.accelerations


def truncated(part: Array, held: Array, w: Weights) -> tuple[Array, Array]:
    """The first layer, (..., n_lanes, width), from the last m samples alone, begun at zero: eq. 10; and what to hold.

    part  what is seen now gives, (..., n_lanes, width)
    held  (..., (m - 1) n_lanes, width) the layer of the last sample, begun at it, one sample before it and so on
          to m - 2 before it, behind each other; before the first sample zero

    The equation begins m samples back at every sample.  Those beginnings that overlap go on side by side here, each
    with one step a sample: the same numbers from one wide product in place of m - 1 narrow ones.
    """
    n = part.shape[-2]
    begun = layer(part, w.b_0)
    older = remembered(np.tile(part, (held.shape[-2] // n, 1)), held, w)
    every = np.concatenate([begun, older], axis=-2)
    kept = held.shape[-2]
    return every[..., kept:, :], every[..., :kept, :]
