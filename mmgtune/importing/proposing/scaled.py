"""Columns in parts of a unit, as buses and receivers write them: tenths of a degree, ten-millionths for positions."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from .sampling import Sample

_TIMES = re.compile(r"(?<=\w)[\s_]*[\s_(\[][x×*]\s?(10{1,9})\b")
""" "HDG_x10", "speed (x100)": what was multiplied before it was written."""
_POWER = re.compile(r"[\s_(\[](1e-?[1-9])\b", re.IGNORECASE)
""" "LAT_1e7", "lat [1e-7 deg]": either way ten-millionths."""
_PART = re.compile(r"[(\[]\s*(0\.0{0,8}1)\s*(?=[a-z°/%])", re.IGNORECASE)
""" "heading [0.1 deg]"."""
_NUMBERED = re.compile(r"[\s_(\[]x(?!10*\b)\d+\b")
"""A name such as "state x2", beside which "state x10" is the tenth."""
WHOLE = 1e6
"""Latitude or longitude that is a whole number and larger than this is in ten-millionths of a degree."""
DEGREES = 1e-7


def factor_named(name: str) -> float:
    """By what the numbers of a column are multiplied for its name: 0.1 for "HDG_x10"; 1 where it says nothing."""
    if found := _TIMES.search(name) or _POWER.search(name):
        power = float(found[1])
        return power if power < 1.0 else 1.0 / power
    found = _PART.search(name)
    return float(found[1]) if found else 1.0


def without_factor(name: str) -> str:
    """A name without the words that ``factor_named`` reads: "heading [deg]" for "heading [0.1 deg]"."""
    for pattern in (_TIMES, _POWER, _PART):
        if found := pattern.search(name):
            opening = next((one for one in "[(" if one in found[0]), "")
            rest = name[: found.start()] + opening + name[found.end() :].lstrip(" _")
            return re.sub(r"\s*[\[(]\s*[\])]", "", rest).strip()
    return name


def scaled(samples: Sequence[Sample], said: Sequence[str]) -> tuple[list[Sample], Mapping[int, float]]:
    """Logs of one kind with the numbers of such columns in whole units, and by what each was multiplied.

    said  (n_columns,) the quantity that the name of each speaks of, "" for none
    """
    first = samples[0]
    factors: dict[int, float] = {}
    if any(_NUMBERED.search(name) for name in first.names):
        return list(samples), factors
    for k, (name, row) in enumerate(zip(first.names, first.units, strict=True)):
        factor = factor_named(f"{name} [{row}]" if row else name)
        if factor == 1.0 and said[k] in ("latitude", "longitude"):
            values = np.concatenate([one.numbers[k] for one in samples])
            values = values[np.isfinite(values)]
            if len(values) and bool(np.all(values == np.round(values))) and np.median(np.abs(values)) > WHOLE:
                factor = DEGREES
        if factor != 1.0:
            factors[k] = factor
    if not factors:
        return list(samples), factors
    changed = [
        replace(one, numbers=[values * factors.get(k, 1.0) for k, values in enumerate(one.numbers)]) for one in samples
    ]
    return changed, factors
