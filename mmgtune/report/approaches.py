"""The speed and the revolutions that runs begin with: an advance without its speed tells nothing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..units import KNOT
from .wording import NONE, number, shown


def words(run: Mapping[str, Any]) -> str:
    """Of one run, "8.01 m/s (15.6 kn) and 106 rpm"; empty where its record, of an older version, does not say."""
    return _span([run])


def sentence(runs: Sequence[Mapping[str, Any]], ordered: bool) -> str:
    """Of all runs of a page, as one sentence; empty where the record does not say.

    ordered  whether they were given as orders, from straight ahead
    """
    found = _span(runs)
    if not found:
        return ""
    if ordered:
        return f"Approach straight ahead at {found}."
    return f"Each run begins as measured, at {found}."


def in_caption(run: Mapping[str, Any]) -> str:
    """What a table's caption says of it: ", from 8.01 m/s (15.6 kn) and 106 rpm"."""
    found = words(run)
    return f", from {found}" if found else ""


def _span(runs: Sequence[Mapping[str, Any]]) -> str:
    found = [run.get("approach") or {} for run in runs]
    speeds, turning = ([value for one in found if (value := number(one.get(key))) is not None] for key in
                       ("speed_m_per_s", "rpm"))  # fmt: skip
    if not speeds:
        return ""
    speed = f"{_range(speeds)} m/s ({_range([one / KNOT for one in speeds])} kn)"
    return f"{speed} and {_range(turning)} rpm" if turning else speed


def _range(values: Sequence[float]) -> str:
    low, high = shown(min(values), 3), shown(max(values), 3)
    return low if low == high else f"{low} to {high}" if NONE not in (low, high) else NONE
