"""Numbers that loggers write where a sensor gives none, such as -999."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ...phrases import listed
from .sampling import Sample

_CODE = re.compile(r"-?9{3,}(\.9+)?|-9{2,}(\.9+)?|-?32767|-32768|65535|-?1e\+?[23]\d")
"""Such numbers, as they are printed shortest."""
FEWEST = 2
"""How often one repeats at least, in all columns together."""


def without_codes(samples: Sequence[Sample]) -> tuple[list[Sample], list[str]]:
    """Logs of one kind with codes for no value as NaN and as ``missing`` of [log], and what is to be said of it.

    A code is a number that loggers write for no value, repeats, and lies far outside of all others of its column.
    A number that another column holds among others is left: [log] speaks of all columns.
    """
    far: dict[float, dict[int, int]] = {}
    for sample in samples:
        for k, numbers in enumerate(sample.numbers):
            for code, count in _codes_outside(numbers).items():
                of = far.setdefault(code, {})
                of[k] = of.get(k, 0) + count
    usual = {
        code: k
        for code in far
        for sample in samples
        for k, numbers in enumerate(sample.numbers)
        if k not in far[code] and (numbers == code).any() and np.isfinite(numbers[numbers != code]).sum() >= 10
    }
    found, notes = [], []
    for code, counts in sorted(far.items()):
        where = listed([samples[0].shown(k) for k in sorted(counts) if k < len(samples[0].names)], 6)
        if sum(counts.values()) < FEWEST:
            continue
        if code in usual:
            other = samples[0].shown(usual[code])
            notes.append(
                f"{code:.10g} in {where} seems to stand for no value, but {other} holds it as a number: "
                f"leave those cells empty in the log"
            )
            continue
        found.append(code)
        notes.append(
            f"{code:.10g} in {where} is far outside of all other values and repeats, {sum(counts.values())} times: "
            "it is taken for no value, by 'missing' in [log]"
        )
    if not found:
        return list(samples), notes
    texts = [f"{code:.10g}" for code in found]
    return [
        replace(
            one,
            layout={**one.layout, "missing": texts},
            numbers=[np.where(np.isin(numbers, found), np.nan, numbers) for numbers in one.numbers],
        )
        for one in samples
    ], notes


def _codes(numbers: FloatArray) -> dict[float, int]:
    """Numbers of a column that may be codes, and how often each is there."""
    values, counts = np.unique(numbers[np.abs(numbers) >= 99.0], return_counts=True)
    # Only what is at an end of a column can be outside of it; of numbers that repeat, few are looked at.
    ends = [k for k in range(len(values)) if k < 50 or k >= len(values) - 50]
    return {float(values[k]): int(counts[k]) for k in ends if _CODE.fullmatch(f"{values[k]:.10g}")}


def _codes_outside(numbers: FloatArray) -> dict[float, int]:
    """Those that lie outside of all of their column that are no codes by more than these spread."""
    codes = _codes(numbers)
    others = numbers[np.isfinite(numbers) & ~np.isin(numbers, list(codes))]
    if not codes or len(others) < 10:
        return {}
    low, high = np.percentile(others, [1.0, 99.0])
    spread = max(float(high - low), 0.1 * float(max(abs(low), abs(high))))
    return {code: count for code, count in codes.items() if not low - spread <= code <= high + spread}
