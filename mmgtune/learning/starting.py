"""How weights begin: scaled so that each layer passes on about the spread it gets."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..networks.model import shapes
from ..networks.motion import observed
from ..networks.recurrent import Scales, Weights
from .samples import Samples

LAST = 0.1
"""Scale of the last layer: nearly silent, so that the first roll-outs stay with the ship."""

RECURRENT = 0.5
"""Scale of the memory."""

BIAS = 0.3
"""Scale of the biases: tanh less its bias is odd without them, and a ship is not."""


def first_weights(n_inputs: int, width: int, seed: int) -> Weights:
    """Weights of one member, normal with the deviation that keeps the spread; not the paper's U(-1/root, 1/root)."""
    rng = np.random.default_rng([seed, 2])
    wanted, _ = shapes(1, n_inputs, width)
    scale = {"W_r": RECURRENT, "W_3": LAST}

    def drawn(name: str, shape: tuple[int, ...]) -> FloatArray:
        if name.startswith("b_"):
            return np.asarray(BIAS * rng.standard_normal(shape[1:]))
        return np.asarray(scale.get(name, 1.0) / np.sqrt(shape[-2]) * rng.standard_normal(shape[1:]))

    return Weights(*(drawn(name, shape) for name, shape in zip(wanted._fields, wanted, strict=True)))


def scales_of(samples: Samples) -> Scales:
    """Standard deviations of features and of accelerations in the training data; 1 for a feature that never varies."""
    whole = samples.whole
    seen = features_of(samples)[whole]
    deviation = np.sqrt(np.mean(seen**2, axis=0))
    return Scales(
        features=np.where(deviation > 0.0, deviation, 1.0)[None],
        accelerations=acceleration_deviations(samples)[None],
    )


def acceleration_deviations(samples: Samples) -> FloatArray:
    """(3,) root mean squares of accelerations [m/s^2, m/s^2, rad/s^2]; 1 where there are none."""
    rates = differences(samples)
    moving = np.sqrt(np.mean(rates**2, axis=0)) if len(rates) else np.ones(3)
    return np.asarray(np.where(moving > 0.0, moving, 1.0))


def differences(samples: Samples) -> FloatArray:
    """(n, 3) accelerations [m/s^2, m/s^2, rad/s^2] wherever they are known.

    They are differences over a second or a step, whichever is longer: those of single samples are noise.
    """
    stride = max(1, round(1.0 / samples.step))
    starts = samples.starts(stride)
    return np.asarray((samples.states[starts + stride, 3:] - samples.states[starts, 3:]) / (stride * samples.step))


def features_of(samples: Samples) -> FloatArray:
    """(n_rows, n_features) as the network sees them, undivided."""
    return np.asarray(observed(samples.states, samples.controls, samples.wind))


def accelerations_of(samples: Samples) -> FloatArray:
    """(n_rows, 3) central differences of measured velocities, NaN where there are none."""
    found = np.full((len(samples.states), 3), np.nan)
    for begin, end in zip(samples.first[:-1], samples.first[1:], strict=True):
        if end - begin > 1:
            found[begin:end] = np.gradient(samples.states[begin:end, 3:], samples.step, axis=0)
    return found
