"""How far ships are off their measured tracks and headings, out of what records and scores of trials say."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from .toml_reading import finite


def mean(values: Iterable[float | None]) -> float | None:
    """Of the values that are known; None where none is."""
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None


def off_track(row: Mapping[str, Any], when: str) -> float | None:
    """Root-mean-square distance of a trial's simulated track from the measured one [m].

    row   of ``trial_results``
    when  "before" or "after"
    """
    rms = row.get("rms") or {}
    x, y = (finite((rms.get(name) or {}).get(when)) for name in ("x", "y"))
    return None if x is None or y is None else math.hypot(x, y)


def off_heading(row: Mapping[str, Any], when: str) -> float | None:
    """Root-mean-square error of a trial's heading [deg], of what ``off_track`` takes."""
    size = finite(((row.get("rms") or {}).get("psi") or {}).get(when))
    return None if size is None else math.degrees(size)


def mean_off_track(rows: Sequence[Mapping[str, Any]], when: str) -> float | None:
    """The mean of ``off_track`` over trials [m]."""
    return mean(off_track(row, when) for row in rows)


def mean_off_heading(rows: Sequence[Mapping[str, Any]], when: str) -> float | None:
    """The mean of ``off_heading`` over trials [deg]."""
    return mean(off_heading(row, when) for row in rows)


def rms_errors(data: Mapping[str, Any], row: Mapping[str, Any]) -> tuple[float | None, float | None]:
    """Root mean square error of position [m] and heading [deg] that a score stands for; None where it diverged.

    data  the record, with the deviations that scores are counted in
    row   of its scores, with L_MSE by state
    """
    parts, sigma = row["L_MSE_by_state"], data["sigma"]
    squares = {name: finite(parts.get(name)) for name in ("x", "y", "psi")}
    if any(value is None for value in squares.values()):
        return None, None
    x, y, psi = ((squares[name] or 0.0) * sigma[name] ** 2 for name in ("x", "y", "psi"))
    return math.sqrt(x + y), math.degrees(math.sqrt(psi))
