"""Networks for tests, drawn at random: not trained, and small."""

from __future__ import annotations

import numpy as np

from mmgtune.networks import Network
from mmgtune.networks.model import shapes
from mmgtune.networks.recurrent import Scales, Weights


def network(
    *, members: int = 1, width: int = 5, memory: int | None = 3, step: float = 0.1, seed: int = 1, size: float = 0.4
) -> Network:
    """A network of a ship with one propeller and one rudder."""
    rng = np.random.default_rng(seed)
    weights, scales = shapes(members, 2, width)
    return Network(
        ship="toy",
        L_pp=3.0,
        inputs=("n", "delta"),
        step=step,
        memory=memory,
        weights=Weights(*(size * rng.standard_normal(shape) for shape in weights)),
        scales=Scales(
            features=0.5 + rng.random(scales.features), accelerations=0.05 * (0.5 + rng.random(scales.accelerations))
        ),
        facts={"type": "type 1"},
    )
