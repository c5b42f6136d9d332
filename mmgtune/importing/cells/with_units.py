"""Cells that say their unit themselves, as formatted tables have them: 5.3 kn, 104 rpm."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...units import canonical, is_unit
from .numerals import numbers_in

WITH_UNIT = re.compile(r"([-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*([^\d\s].*)")
"""A number, and what stands behind it."""


def is_with_unit(text: str) -> bool:
    """Whether a text is a number with a unit behind it."""
    match = WITH_UNIT.fullmatch(text)
    return match is not None and is_unit(match.group(2))


def numbers_with_unit(texts: Any, decimal: str) -> tuple[FloatArray, str]:
    """Numbers (n_rows,) of a pandas column of texts that all have one unit behind them, and that unit.

    NaN and "" where a text has none, or another one; missing cells are NaN.
    """
    nothing = np.full(len(texts), np.nan)
    known = texts.notna().to_numpy(dtype=bool)
    if not known.any():
        return nothing, ""
    parts = texts.str.slice(0, 40).str.extract(f"^{WITH_UNIT.pattern}$")
    said = set(parts[1][known].unique())
    found = {canonical(one) for one in said if isinstance(one, str) and is_unit(one)}
    if len(found) != 1 or not all(isinstance(one, str) and is_unit(one) for one in said):
        return nothing, ""
    numbers = numbers_in(parts[0], decimal)
    return (numbers, found.pop()) if np.isfinite(numbers[known]).all() else (nothing, "")
