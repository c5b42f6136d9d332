"""Spikes taken out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..trial.motion_checks import spikes
from .quantities import CONTROLS
from .record import Record


def without_spikes(record: Record) -> Record:
    """The record with single samples far off their neighbours taken out (NaN), and their number by quantity."""
    series, counts = {}, dict(record.spikes)
    for name, one in record.series.items():
        values = np.array(one.values)
        controls = name in CONTROLS or name.startswith(("delta", "n_"))
        # Wind is gusty and speeds near rest are noise: only what a trial is simulated or compared with is cleaned.
        if not name.startswith(("wind", "wave")):
            rows = spikes(values, share=0.2 if controls else 0.02)
            if len(rows):
                # Where few digits are printed, one step of the last of them looks like a spike.
                steps = np.abs(np.diff(values[np.isfinite(values)]))
                usual = float(np.median(steps[steps > 0.0]))
                off = np.minimum(np.abs(values[rows] - values[rows - 1]), np.abs(values[rows] - values[rows + 1]))
                rows = rows[off > 3.0 * usual]
            values[rows] = np.nan
            if len(rows):
                counts[name] = counts.get(name, 0) + len(rows)
        series[name] = replace(one, values=values)
    return Record(record.path, series, counts, record.notes)
