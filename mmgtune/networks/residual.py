"""The accelerations a model of forces lacks, as a small network: the only copy of its equations.

They know NumPy alone; arrays have any leading axes, features last.  Training differentiates them rebuilt on JAX.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..physics.elementary import exp
from ..physics.frame import to_ship
from .layer import layer
from .motion import SIDES

Array = Any
"""An array of NumPy or of JAX, of any number type."""


class ResidualWeights(NamedTuple):
    """Two layers and an output without bias; of each layer its value at zero is subtracted, so zero gives zero."""

    W_1: Array  # (n_features, width)
    b_1: Array  # (width,)
    W_2: Array  # (width, width)
    b_2: Array  # (width,)
    W_3: Array  # (width, 3)


class Ranges(NamedTuple):
    """What the training data says of features and accelerations."""

    deviation: Array  # (n_features,) what features are divided by
    largest: Array  # (n_features,) absolute feature up to which there was data, over its deviation
    accelerations: Array  # (3,) what the output is multiplied with [m/s^2, m/s^2, rad/s^2]
    mirrored: Array  # (n_features,) -1 for features that change sign where port and starboard change places, else 1


FALL = 4.0
"""How fast the network falls silent outside the data: at twice the largest value of one feature to e^-4."""


def seen(velocities: Array, controls: Array, wind: Array, psi: Array, settled: Array, ranges: Ranges) -> Array:
    """Features (..., n_features): u, v_m, r, inputs, apparent wind ahead and to starboard, and how far u, v_m and r
    are from what they have been lately, each over its deviation.

    velocities  (..., 3) u, v_m [m/s], r [rad/s]
    controls    (..., n_inputs)
    wind        (..., 2) velocity of the air over ground, north and east [m/s]; and the heading psi (...) [rad]
    settled     (..., 3) velocities passed through a first-order lag: the memory
    """
    ahead, starboard = to_ship(psi, wind[..., 0], wind[..., 1])
    apparent = np.stack([velocities[..., 0] - ahead, velocities[..., 1] - starboard], axis=-1)
    return np.concatenate([velocities, controls, apparent, velocities - settled], axis=-1) / ranges.deviation


def accelerations(x: Array, w: ResidualWeights, ranges: Ranges) -> Array:
    """(..., 3) of u [m/s^2], v_m [m/s^2], r [rad/s^2] that the network adds.

    It is as strong to port as to starboard, and silent outside the data.
    """
    both = 0.5 * (_layers(x, w) + np.array(SIDES) * _layers(x * ranges.mirrored, w))
    return inside(x, ranges)[..., None] * both * ranges.accelerations


def inside(x: Array, ranges: Ranges) -> Array:
    """1 where every feature is within the data, falling smoothly to 0 outside: (...)."""
    beyond = np.maximum(np.abs(x) / ranges.largest - 1.0, 0.0)
    return exp(-FALL * np.sum(beyond * beyond, axis=-1))


def settling(velocities: Array, settled: Array, time_constant: Array) -> Array:
    """Rates of the memory: a first-order lag of the velocities."""
    return (velocities - settled) / time_constant


def _layers(x: Array, w: ResidualWeights) -> Array:
    z_1 = layer(x @ w.W_1, w.b_1)
    z_2 = layer(z_1 @ w.W_2, w.b_2)
    return z_2 @ w.W_3
