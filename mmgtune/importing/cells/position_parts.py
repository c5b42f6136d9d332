"""Latitude or longitude in several columns: degrees, minutes, seconds, and the letter of the hemisphere."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import BoolArray, FloatArray
from .degrees import of_ddmm
from .numerals import holds_numbers, numbers_in

PARTS = ("minutes", "seconds", "hemisphere")
"""What a map may name further columns of a latitude or longitude for."""
HEMISPHERES = {"latitude": "NS", "longitude": "EW"}
_WORDS = {
    "N": ("N", "NORTH", "NORD"),
    "S": ("S", "SOUTH", "SUD", "SÜD"),
    "E": ("E", "EAST", "EST", "OST"),
    "W": ("W", "WEST", "OUEST"),
}
_MARKS = "°º'′’\"″” "


@dataclass(frozen=True, eq=False)
class Position:
    """What columns make together.

    degrees  (n_rows,), NaN where a part is missing or something is wrong
    wrong    (n_rows,) where all parts are there, by what is wrong with them; of several reasons the first counts
    """

    degrees: FloatArray
    wrong: dict[str, BoolArray]


def letters_in(column: Any, name: str) -> Any:
    """The letter (n_rows,) of the hemisphere in a pandas column, "" where a cell is none of this quantity's."""
    texts = column.astype("string").str.strip().str.rstrip(".").str.upper()
    found = texts.where(texts.isna(), "")
    for letter in HEMISPHERES[name]:
        found = found.mask(texts.isin(_WORDS[letter]), letter)
    return found


def position_of(
    name: str,
    columns: Mapping[str, Any],
    decimal: str,
    missing: Collection[str],
    codes: Collection[float],
    ddmm: bool = False,
) -> Position:
    """Degrees of the parts.

    name     "latitude" or "longitude"
    columns  pandas columns (n_rows,) by what they hold, "" being the degrees
    missing  texts for no value, in small letters; codes: numbers for none
    ddmm     whether the column of the degrees holds the minutes too, as in 5206.0001
    """
    sizes, minus, there, unread = [], [], [], []
    for part, column in columns.items():
        known = _there(column, missing)
        if part != "hemisphere":
            values, negative = _number(column, decimal)
            known = known & ~np.isin(values, list(codes))
            values = of_ddmm(values) if ddmm else values
            sizes.append(values)
            minus.append(negative)
            unread.append(np.isnan(values))
        there.append(known)
    zero = np.zeros(len(sizes[0]))
    degrees, minutes, seconds = [*sizes, zero, zero][:3]
    size = np.abs(degrees) + np.abs(minutes) / 60.0 + np.abs(seconds) / 3600.0
    wrong: dict[str, BoolArray] = {
        "a cell is no number": np.any(unread, axis=0),
        "minutes and seconds are 60 at most": np.any([np.abs(one) > 60.0 for one in sizes[1:]], axis=0)
        if sizes[1:]
        else np.zeros(len(zero), dtype=bool),
        "all but the last part are to be whole": np.any([one != np.round(one) for one in [*sizes[:-1], zero]], axis=0),
        # A sign stands before the first part that is not 0, or before all.
        "the parts have different signs": ((minutes < 0.0) & ~minus[0] & (degrees > 0.0))
        | ((seconds < 0.0) & ~np.any(minus[:-1], axis=0) & ((degrees > 0.0) | (minutes > 0.0))),
    }
    negative = np.any([minus[0], *(one < 0.0 for one in sizes[1:])], axis=0)
    if "hemisphere" in columns:
        letters = letters_in(columns["hemisphere"], name)
        side = letters.isin(list("SW")).to_numpy(dtype=bool)
        other = letters.isin(list("NE")).to_numpy(dtype=bool)
        wrong[f"the hemisphere is neither {' nor '.join(HEMISPHERES[name])}"] = ~side & ~other
        wrong["the sign says the other hemisphere than the letter"] = other & negative & (size > 0.0)
        negative = side
    complete = np.all(there, axis=0)
    # What is unread counts before what compares with it, as NaN compares with nothing.
    wrong = {reason: rows & complete for reason, rows in wrong.items()}
    bad = np.any(list(wrong.values()), axis=0) | ~complete
    return Position(np.where(bad, np.nan, np.where(negative, -size, size)), wrong)


def _there(column: Any, missing: Collection[str]) -> BoolArray:
    """Whether cells (n_rows,) hold anything."""
    known = column.notna().to_numpy(dtype=bool)
    if holds_numbers(column):
        return np.asarray(known)
    return np.asarray(known & ~column.astype("string").str.strip().str.lower().isin(missing).to_numpy(dtype=bool))


def _number(column: Any, decimal: str) -> tuple[FloatArray, BoolArray]:
    """Numbers (n_rows,) of a part, and whether they have a minus, which -0 has too."""
    if holds_numbers(column):
        values = column.to_numpy(dtype=np.float64, na_value=np.nan)
        return np.asarray(values), np.asarray(np.signbit(values) & np.isfinite(values))
    texts = column.astype("string").str.strip().str.rstrip(_MARKS)
    return numbers_in(texts, decimal), texts.str.startswith("-").fillna(False).to_numpy(dtype=bool)
