"""Columns that hold a part of the time each: hours, minutes and seconds."""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import FloatArray
from ..cells.periods import Periods
from ..cells.time_parts import going_on, not_parts
from .sampling import Sample
from .words import DATE, TIME, plain

_NAMES = {
    "h": r"\b(h|hh|hrs?|hours?|std|stunden?|uur|uren|heures?|horas?|ora|ore|timme|timmar|timer|godz\w*)\b|時|时|시$",
    "min": r"\b(m|mm|mi|min|mins|minuten?|minutes?|minutos?|minut[oi]|minut|minuter|minutter)\b|分|분",
    "s": r"\b(s|ss|secs?|seconds?|sek|sekunden?|seconden?|secondes?|segundos?|second[oi]|sekunder)\b|秒|초",
    "ms": r"\b(ms|msecs?|millis|millisec\w*|millisek\w*|milisegundos?)\b",
}
"""Names of hours, minutes, seconds and milliseconds, in the words of ``plain``."""
_TOGETHER = (("h", "min", "s", "ms"), ("h", "min", "s"), ("min", "s"), ("h", "min"))
"""Which parts make a time, the most telling first."""


def time_parts(sample: Sample, said: Sequence[str], units_said: Sequence[str]) -> dict[str, int]:
    """Columns whose names and numbers are those of parts of one time, by their units; empty where there are none.

    said, units_said  (n_columns,) what names say: a quantity, a unit
    """
    named: dict[str, list[int]] = {unit: [] for unit in _NAMES}
    for k, name in enumerate(sample.names):
        if said[k] not in ("", TIME, DATE):
            continue
        for unit, pattern in _NAMES.items():
            below = units_said[k] == unit and said[k] == TIME
            if (below or re.search(pattern, plain(name))) and np.isfinite(sample.numbers[k]).mean() > 0.5:
                named[unit].append(k)
    for wanted in _TOGETHER:
        several = itertools.product(*(named[unit][:6] for unit in wanted))
        # Those of one clock stand beside each other.
        for columns in sorted(several, key=lambda of: sum(abs(b - a) for a, b in itertools.pairwise(of))):
            parts = dict(zip(wanted, columns, strict=True))
            if len(set(columns)) == len(columns) and _is_time(parts, sample):
                return parts
    return {}


def seconds_of(parts: Mapping[str, int], sample: Sample) -> FloatArray:
    """The time (n_rows,) [s] that columns hold a part of each."""
    return going_on({unit: sample.numbers[k] for unit, k in parts.items()}, Periods())


def _is_time(parts: Mapping[str, int], sample: Sample) -> bool:
    """Whether numbers are those of such parts, and make a time that goes on, one way or the other."""
    for values in (numbers := {unit: sample.numbers[k] for unit, k in parts.items()}).values():
        if not np.isfinite(values).any():
            return False
    if any(odd.mean() > 0.02 for odd in not_parts(numbers).values()):
        return False
    t = seconds_of(parts, sample)
    steps = np.diff(t[np.isfinite(t)])
    forwards, backwards = (float(np.mean(sign * steps > 0.0)) if len(steps) else 0.0 for sign in (1.0, -1.0))
    return len(steps) > 5 and max(forwards, backwards) > 0.02 and min(forwards, backwards) < 0.02
