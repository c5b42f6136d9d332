"""What is not known of waves that are found: their drift force rises and falls with the groups they come in.

How long groups are, and how far the force differs between them, is assumed, not measured.  Of a run the mean alone is
drawn, which is what positions and heading show most of.
"""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np

from ...arrays import FloatArray
from ...backends import Cases
from ...effects import Effect
from ...effects.wave_drift import EFFECT
from ...model import Model
from ...physics.constants import GRAVITY

DEVIATION = 0.3
"""Deviation of the force about its mean, as a share of it."""

LAST = 8.0
"""Time in which groups fade to 1/e, in sqrt(L_pp / g): 45 s of a ship of 320 m."""


def drifts(effect: Effect | None) -> bool:
    """Whether an effect is the drift force of waves."""
    return effect is EFFECT


def in_words(effects: Collection[Effect]) -> list[dict[str, str]]:
    """What is assumed where such a force is among effects that were found: name, value and note."""
    if EFFECT not in effects:
        return []
    size = f"{100.0 * DEVIATION:.3g} % of the mean force, fading in {LAST:g} sqrt(L_pp/g)"
    return [{"name": "groups of waves", "value": size, "note": "assumed: what they leave is no unknown cause"}]


def other_waves(model: Model, theta: FloatArray, cases: Cases, seed: int) -> FloatArray:
    """Coefficients (n_rows, n_cases, 1 + n_draws) as they are, the first, and with the mean drift force that waves may
    have had in a run just as well."""
    if (row := model.rows.get(f"{EFFECT.kind}.force")) is None:
        return theta
    lasting = LAST * math.sqrt(model.L_pp / GRAVITY)
    durations = np.ptp(cases.t, axis=1)  # a case that is over stays at its last time
    spread = DEVIATION * np.sqrt(np.minimum(2.0 * lasting / np.maximum(durations, lasting), 1.0))
    found = theta.copy()
    drawn = np.random.default_rng(seed).standard_normal((theta.shape[1], theta.shape[2] - 1))
    found[row, :, 1:] *= np.maximum(1.0 + spread[:, None] * drawn, 0.0)
    return found
