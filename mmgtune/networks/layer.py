"""One layer of the networks whose answer to zero is zero."""

from __future__ import annotations

import numpy as np

from .motion import Array


def layer(x: Array, b: Array) -> Array:
    """(..., width) of what comes in by the weights, x (..., width), and the bias b: less its value at zero."""
    return np.tanh(x + b) - np.tanh(b)
