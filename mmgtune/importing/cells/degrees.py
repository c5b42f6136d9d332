"""Latitudes and longitudes as people write them, to degrees."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import FloatArray
from .numerals import numbers_in

_SIGN, _SIDE = r"([-+]?)", r"([NSEWnsew]?)"
ANGLE = (
    rf"^{_SIDE}\s*{_SIGN}(\d{{1,3}}(?:[.,]\d*)?)\s*[°ºd:\s]?\s*(?:(\d{{1,2}}(?:[.,]\d*)?)\s*['′’m:\s]?\s*"
    rf"(?:(\d{{1,2}}(?:[.,]\d*)?)\s*(?:\"|″|”|''|s)?)?)?\s*['′’]?\s*{_SIDE}$"
)
"""Degrees, minutes and seconds, of which the last may have decimals, and a side before or behind them."""

_COMPACT = rf"^{_SIDE}\s*(\d{{2,3}})(\d{{2}}[.,]\d+)\s*{_SIDE}$"
"""Degrees and minutes in one, as NMEA 0183 writes them: 5206.0001N."""

DDMM = "ddmm"
"""Unit of plain numbers that hold degrees and minutes in one: 5206.0001 is 52 deg 6.0001 min."""

_DASHED = rf"^{_SIDE}\s*(\d{{1,3}})\s*-\s*(\d{{1,2}}(?:[.,]\d*)?)\s*['′’]?\s*{_SIDE}$"
"""Degrees and minutes with a dash between, as people write them in lists of positions: 52-06.0001N."""


def degrees(texts: Any) -> FloatArray:
    """Degrees (n_rows,) of a pandas column of texts such as ``52°06.00001'N``; NaN where one is not.

    A plain number is not: what it counts is for the map to say.  South and west are
    negative.  "O", which is east to some and west to others, is no side.
    """
    short = texts.str.slice(0, 40)
    plain = short.str.fullmatch(r"[-+]?[\d.,]*").fillna(True).to_numpy(dtype=bool)
    if plain.all():
        return np.full(len(texts), np.nan)
    parts = short.str.extract(ANGLE)
    side = (parts[0].fillna("") + parts[5].fillna("")).str.upper()
    whole, minutes, seconds = (numbers_in(parts[k], ",") for k in (2, 3, 4))
    for pattern in (_COMPACT, _DASHED):
        found = short.str.extract(pattern)
        if found[1].isna().all():
            continue
        both = (found[0].fillna("") + found[3].fillna("")).str.upper()
        in_one = (both.str.len() == 1).to_numpy(dtype=bool, na_value=False) & found[1].notna().to_numpy(dtype=bool)
        side = side.where(~in_one, both)
        whole = np.where(in_one, numbers_in(found[1], ","), whole)
        minutes = np.where(in_one, numbers_in(found[2], ","), minutes)
        seconds = np.where(in_one, 0.0, seconds)
    right = np.isfinite(whole) & ~(minutes > 60.0) & ~(seconds > 60.0) & ~plain  # loggers round up to 60
    right &= (side.str.len() <= 1).to_numpy(dtype=bool, na_value=False)
    size = whole + np.nan_to_num(minutes) / 60.0 + np.nan_to_num(seconds) / 3600.0
    negative = side.isin(["S", "W"]).to_numpy(dtype=bool) | (parts[1] == "-").to_numpy(dtype=bool, na_value=False)
    return np.where(right, np.where(negative, -size, size), np.nan)


def of_ddmm(numbers: FloatArray) -> FloatArray:
    """Degrees (n_rows,) of numbers that hold degrees and minutes in one, 5206.0001; NaN where the minutes are more
    than 60."""
    whole, minutes = np.divmod(np.abs(numbers), 100.0)
    return np.copysign(np.where(minutes <= 60.0, whole + minutes / 60.0, np.nan), numbers)
