"""Latitude and longitude in one cell: 52°06.0001'N 4°23.1'E, 52.1000, 4.3850, or POINT (4.3850 52.1000)."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import FloatArray
from .degrees import degrees
from .numerals import numbers_in

_APART = r"\s*[,;/|\s]\s*"
_NUMBER = r"[-+]?\d{1,3}(?:[.,]\d+)?"
_SIDED = (
    rf"^\(?\s*([^NSEWnsew]+[NSns])(?:{_APART})?([^NSEWnsew]+[EWew])\s*\)?$",
    rf"^\(?\s*([NSns][^NSEWnsew]+?)(?:{_APART})?([EWew][^NSEWnsew]+?)\s*\)?$",
)
"""An angle with its side behind it, or before it, and another one."""
_POINTS, _COMMAS = r"[-+]?\d{1,3}\.\d+", r"[-+]?\d{1,3},\d+"
_PLAIN = (
    rf"^[\[(]?\s*({_POINTS}){_APART}({_POINTS})\s*[\])]?$",
    rf"^[\[(]?\s*({_COMMAS})(?:\s*[;/|]\s*|,?\s+)({_COMMAS})\s*[\])]?$",
)
"""Two plain numbers, the latitude first: with decimals, as 35,0 is one number with a comma."""
_POINT = rf"^(?i:POINT)\s*Z?\s*\(\s*({_NUMBER})\s+({_NUMBER})(?:\s+{_NUMBER})?\s*\)$"
"""A point as geographic programs write it, the longitude first."""
MOST = {"latitude": 90.0, "longitude": 180.0}
"""Largest angle [deg] of each."""


def pair_in(texts: Any) -> dict[str, FloatArray]:
    """Degrees (n_rows,) of "latitude" and "longitude" in a pandas column of texts, NaN where a cell is no position."""
    short = texts.str.strip().str.slice(0, 80)
    found = {name: np.full(len(texts), np.nan) for name in MOST}
    for pattern in _SIDED:
        parts = short.str.extract(pattern)
        if parts[0].isna().all():
            continue
        _fill(found, degrees(parts[0].str.strip(" ,;/|")), degrees(parts[1].str.strip(" ,;/|")))
    for pattern, order in ((_PLAIN[0], (0, 1)), (_PLAIN[1], (0, 1)), (_POINT, (1, 0))):
        parts = short.str.extract(pattern)
        if parts[0].isna().all():
            continue
        latitude, longitude = (numbers_in(parts[k], ",", "none") for k in order)
        _fill(found, latitude, longitude)
    return found


def _fill(found: dict[str, FloatArray], latitude: FloatArray, longitude: FloatArray) -> None:
    """Take positions (n_rows,) where none is yet."""
    good = (np.abs(latitude) <= MOST["latitude"]) & (np.abs(longitude) <= MOST["longitude"])
    good &= np.isnan(found["latitude"])
    found["latitude"] = np.where(good, latitude, found["latitude"])
    found["longitude"] = np.where(good, longitude, found["longitude"])
