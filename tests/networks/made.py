"""Networks for tests, drawn at random: not trained, and small."""

from __future__ import annotations

import numpy as np

from mmgtune.networks import Ensemble, Network
from mmgtune.networks.ensemble import Part
from mmgtune.networks.feedforward import Layers, Standards
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


def ensemble(
    *, members: int = 3, width: int = 6, layers: int = 3, initial: int = 4, step: float = 1.0, seed: int = 1
) -> Ensemble:
    """An ensemble of the same ship, with standards of each member's own; numbers that single precision holds."""
    rng = np.random.default_rng(seed)

    def drawn(*shape: int) -> np.ndarray:
        return np.float64(np.float32(0.5 * rng.standard_normal((members, *shape))))

    def part(n_in: int, n_out: int, scale: float) -> Part:
        of_layers = Layers(
            W_in=drawn(n_in, width),
            b_in=drawn(1, width),
            W_hidden=drawn(layers - 1, width, width),
            b_hidden=drawn(layers - 1, 1, width),
            W_out=drawn(width, n_out),
            b_out=drawn(1, n_out),
        )
        seen, raw, out = (1.0 + np.abs(drawn(1, n)) for n in (n_in, n_out, n_out))
        means = drawn(1, n_in), drawn(1, n_out), scale * drawn(1, n_out)
        return Part(of_layers, Standards(means[0], seen, means[1], raw, means[2], scale * out))

    start = part(3 * initial, 3, 0.01) if initial else None
    return Ensemble("toy", 3.0, ("n", "delta"), step, part(7, 3, 0.01), start, {"type": "ensemble"})
