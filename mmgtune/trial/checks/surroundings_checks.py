"""What is odd about what was measured around the ship."""

from __future__ import annotations

import numpy as np

from ..around.current import current_pairs
from ..around.waves import WAVE_PAIR
from ..around.wind import WIND_PAIRS
from ..model import Trial
from ..schema import known_column, surrounding
from .finding import Finding


def surroundings_findings(trial: Trial, where: str) -> list[Finding]:
    """Findings on wind, current, waves and depth."""
    return [*_halves(trial, where), *_sizes(trial, where)]


def _halves(trial: Trial, where: str) -> list[Finding]:
    """Half a wind is none, and nothing uses it."""
    pairs = {
        **dict.fromkeys(WIND_PAIRS, "measured wind"),
        **dict.fromkeys(current_pairs(trial.extra), "a measured current there"),
        WAVE_PAIR: "measured waves",
    }
    found = []
    for pair, what in pairs.items():
        there = [name for name in pair if name in trial.extra]
        if len(there) == 1:
            (missing,) = set(pair) - set(there)
            needed = known_column(missing)
            assert needed is not None  # one of a pair the program knows
            found.append(
                Finding(
                    "warning",
                    f"there is '{there[0]}' without '{missing}'",
                    f"{where}, column '{there[0]}'",
                    f"the trial counts as one without {what}",
                    f"add '{missing}', {needed.meaning} [{needed.unit}]",
                )
            )
    return found


def _sizes(trial: Trial, where: str) -> list[Finding]:
    """Numbers that no wind, current, waves or depth have."""
    found = []
    for name, values in trial.extra.items():
        known = surrounding(name)
        if known is None:
            continue
        beyond = (values < known.low) | (values > known.high)
        if beyond.any():
            row = int(np.flatnonzero(beyond)[0])
            found.append(
                Finding(
                    "warning",
                    f"'{name}' is {values[row]:.4g} {known.unit} in {beyond.sum()} rows",
                    f"{where}, column '{name}', row {row}",
                    f"{known.meaning} lies between {known.low:g} and {known.high:g} {known.unit}",
                    "check unit and sign; mark what was not measured as NaN",
                )
            )
    return found
