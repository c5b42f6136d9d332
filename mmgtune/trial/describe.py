"""What a trial holds, in numbers a person can check against the log book."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..units import shown_in
from .model import Trial
from .schema import known_column


def describe(trial: Trial) -> dict[str, Any]:
    """Facts, length and ranges of the channels, angles in degrees and revolutions per minute."""
    ranges = {}
    for name, values in trial.columns.items():
        if name == "t":
            continue
        known = known_column(name)
        shown, factor = shown_in(known.unit if known else "-")
        if np.isfinite(values).any():
            ranges[name] = {
                "min": float(np.nanmin(values) * factor),
                "max": float(np.nanmax(values) * factor),
                "unit": shown,
            }
    return {
        "id": trial.id,
        "ship": trial.ship,
        "manoeuvre": trial.manoeuvre,
        "source": trial.source,
        "note": trial.note,
        "n_samples": trial.n_samples,
        "duration_s": trial.duration,
        "sha256": trial.sha256,
        "ranges": ranges,
    }
