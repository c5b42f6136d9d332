"""Whether the wind of a trial is what its columns say: true or apparent, from north or from the bow.

The wind over the ground stays much the same while a ship turns; read as what it is not, it turns with her.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...units import DEG
from ..around.wind import APPARENT, TRUE, Pair, air_over_ground, wind_pair
from ..model import Trial
from .finding import Finding

TURNED = 90.0 * DEG
"""Change of heading [rad] from which readings differ enough."""

UNSTEADY = 0.3
"""Change of the wind over the ground, as a share of its mean speed, from which a reading is doubted."""

STEADIER = 0.4
"""Share of that change that another reading must stay below."""

READINGS = {
    (False, False): "the true wind, its direction from north",
    (True, True): "the apparent wind, its direction from the bow",
    (True, False): "the apparent wind, its direction from north",
    (False, True): "the true wind, its direction from the bow",
}
"""How a speed and a direction may be meant, by (apparent, from the bow)."""


def wind_findings(trial: Trial, where: str) -> list[Finding]:
    """A warning where the wind would be far steadier if its columns meant something else."""
    pair = wind_pair(trial)
    if pair is None or np.ptp(np.unwrap(trial.psi[np.isfinite(trial.psi)])) < TURNED:
        return []
    said = (pair == APPARENT, pair == APPARENT)
    changes = dict(_changes(trial, pair))
    if not changes:
        return []
    best = min(changes, key=lambda reading: changes[reading])
    if not changes[said] > UNSTEADY or not changes[best] < STEADIER * changes[said]:
        return []
    to_be = " and ".join(f"'{name}'" for name in (APPARENT if best == (True, True) else TRUE))
    fix = f"rename them {to_be}" if best in ((True, True), (False, False)) else f"work {to_be} out of them"
    return [
        Finding(
            "warning",
            f"the wind over the ground changes by {100.0 * changes[said]:.0f} % as the ship turns",
            f"{where}, columns '{pair[0]}' and '{pair[1]}'",
            f"it would change by {100.0 * changes[best]:.0f} % if they held {READINGS[best]}",
            f"if they do, {fix}",
        )
    ]


def _changes(trial: Trial, pair: Pair) -> Iterator[tuple[tuple[bool, bool], float]]:
    """By reading, how far the wind over the ground changes, as a share of its mean speed."""
    for apparent, from_bow in READINGS:
        air = np.stack(air_over_ground(trial, pair, apparent, from_bow))
        air = air[:, np.isfinite(air).all(axis=0)]
        if air.size == 0:
            return
        change = float(np.sqrt(np.sum(np.var(air, axis=1))))
        yield (apparent, from_bow), change / max(float(np.hypot(*air).mean()), 1e-300)
