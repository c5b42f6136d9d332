"""Which column of a log is what another one is said to be."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ... import units
from ...arrays import FloatArray
from ...errors import LogError
from ...units import DEG
from ..cells.headers import find_column
from ..maps.mapping import LogMap
from .clocks import Clock, in_seconds
from .sampling import Sample, sample_of
from .windows import Windows


def yaw_rate_elsewhere(log: Path, log_map: LogMap) -> tuple[str, str] | None:
    """Where the yaw rate is if not in the column that a map names: a sentence, and the fix; None where it is nowhere.

    A column is the yaw rate that is the slope of the heading, in one of the units that yaw rates have.
    """
    psi, rate = log_map.sources.get("psi"), log_map.sources.get("r")
    if psi is None or rate is None or psi.column is None or rate.column is None or log_map.time.column is None:
        return None
    try:
        sample = sample_of(log)
    except LogError:
        return None
    heading, named, time = (_position(one, sample) for one in (psi.column, rate.column, log_map.time.column))
    if heading is None or named is None or time is None:
        return None
    clock = Clock(time, log_map.time.format or "", "", 0.0, "")
    if not np.isfinite(sample.numbers[time]).any():
        clock = Clock(time, log_map.time.format or "date", "", 0.0, "")
    with np.errstate(all="ignore"):
        windows = Windows(in_seconds(sample, clock, log_map.time.unit or "s"), sample.numbers)
        slope = windows.slope(windows.columns[heading])
        found = []
        for k in range(len(sample.names)):
            if k in (heading, named, time):
                continue
            mean = windows.mean(windows.columns[k])
            both = np.isfinite(slope) & np.isfinite(mean)
            if both.sum() < 8 or np.std(mean[both]) == 0.0 or np.std(slope[both]) == 0.0:
                continue
            correlation = float(np.corrcoef(slope[both], mean[both])[0, 1])
            if abs(correlation) > 0.95 and (unit := _unit(slope[both], mean[both], psi.unit)):
                found.append((abs(correlation), k, unit, correlation < 0.0))
    if not found:
        return None
    correlation, k, unit, minus = max(found)
    column = sample.reference(k)
    shown = f"'{column}'" if isinstance(column, str) else f"column {column}"
    said = f"{shown} is: it is the slope of the heading, in {unit} and positive to {'port' if minus else 'starboard'}, "
    said += f"with a correlation of {correlation:.3f}"
    return said, f"say column = {f'{chr(34)}{column}{chr(34)}' if isinstance(column, str) else column} in [columns.r]"


def _unit(slope: FloatArray, mean: FloatArray, psi: str | None) -> str:
    """The unit in which a column (n_windows,) is the slope of a heading, "" where it is in none."""
    factor = float(np.std(slope) / np.std(mean)) * (DEG if psi == "deg" else 1.0)
    known = {one: units.factors("rad/s")[one] for one in ("deg/s", "rad/s", "deg/min")}
    best = min(known, key=lambda one: abs(np.log(factor / known[one])))
    return best if abs(np.log(factor / known[best])) < 0.2 else ""


def _position(column: str | int, sample: Sample) -> int | None:
    """Where a column of a map is in a log; of logs without names by number."""
    k = column - 1 if isinstance(column, int) else find_column(column, sample.names)
    return k if k is not None and k < len(sample.names) else None
