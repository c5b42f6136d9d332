"""Spikes taken out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..inputs import INPUTS
from ..trial.checks.motion_checks import spikes
from ..trial.schema import surrounding
from .record import Record


def without_spikes(record: Record) -> Record:
    """The record with single samples far off their neighbours taken out (NaN), and their number by quantity."""
    series, counts = {}, dict(record.spikes)
    for name, one in record.series.items():
        values = np.array(one.values)
        # Wind is gusty: what jumps by nature is left as it is.
        around = surrounding(name)
        if around is None or not around.gusty:
            rows = spikes(values, share=0.2 if name in INPUTS else 0.02)
            values[rows] = np.nan
            if len(rows):
                counts[name] = counts.get(name, 0) + len(rows)
        series[name] = replace(one, values=values)
    return replace(record, series=series, spikes=counts)
