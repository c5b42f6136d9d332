"""A clock that runs fast or slow: stamps stretched by a share make speed log and gyro both show too much or too little.

Positions and heading change too slowly by stamps that run fast, and the rates logged beside them are too large by the
same share; no trial tells such a clock from two sensors whose scales are off alike.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..causes.cause import Cause
from ..signatures.intervals import Estimate

SURELY, ALIKE = 3.0, 2.0
"""Standard errors by which both scales are to be off 1, and by which they may differ from each other."""

SCALES = {"speed-scale": "both", "gyro-scale": "factor"}
"""The causes, and the parameter of each."""


def clock_rate(causes: Sequence[Cause]) -> str:
    """What a clock would have to do to make two scales that were found alike, in a sentence; "" where they are not."""
    found: dict[str, Estimate] = {}
    for cause in causes:
        for full, one in cause.estimates.items():
            if SCALES.get(cause.tag) == full.rpartition(".")[2] and cause.runs is None:
                found[cause.tag] = one
    if len(found) < len(SCALES):
        return ""
    log, gyro = (found[tag] for tag in SCALES)
    if not log.stderr or not gyro.stderr:
        return ""
    both = (log, gyro)
    off = [(one.value - 1.0) / (one.stderr or math.inf) for one in both]
    if min(map(abs, off)) < SURELY or off[0] * off[1] < 0.0:
        return ""
    if abs(log.value - gyro.value) > ALIKE * math.hypot(log.stderr, gyro.stderr):
        return ""
    weights = [(one.stderr or math.inf) ** -2 for one in both]
    share = sum(weight * (one.value - 1.0) for weight, one in zip(weights, both, strict=True)) / sum(weights)
    runs = "fast" if share > 0.0 else "slow"
    return f"Both are off alike: a clock of the logger that runs {100.0 * abs(share):.2g} % {runs} would do the same."
