"""Cells that say themselves to which side, as rudder indicators print them: 35.0S, 0.1 P, STB 10."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import LogError, Problem
from ..cells.numerals import numbers_in
from ..maps.mapping import LogMap
from ..maps.quantities import AGAINST, known_quantity, quantity_of

_PORT = ("P", "PT", "PORT", "BB", "左", "左舷", "좌", "좌현")
_STARBOARD = ("S", "SB", "STB", "STBD", "STARBOARD", "右", "右舷", "우", "우현")
_WORD = rf"({'|'.join(sorted((*_PORT, *_STARBOARD), key=len, reverse=True))})"
_CELL = rf"^(?:{_WORD}(?:\.\s+|\s*))?(\d+[.,]?\d*|[.,]\d+)\s*{_WORD}?\.?$"
_MIDSHIPS = (
    r"(?:[0.,]+\s*)?(?:MID(?:[ -]?SHIPS?)?|AMID(?:[ -]?SHIPS?)?|CENT(?:RE|ER)D?|CTR|ZERO|NEUTRAL|MS|MITTE?"
    r"|MITTSCHIFFS|MITTELLAGE|NULL-?LAGE|MIDDEN|MIDSCHEEPS|ZÉRO|MILIEU|CENTRO|MEDIO|中央)\.?(?:\s*[0.,]+)?"
)
SIGNED = re.compile(rf"{_WORD}\.?\s*[-+]\s*[\d.,]+|[-+]\s*[\d.,]+\s*{_WORD}\.?", re.IGNORECASE)
"""A number with a sign, and with a side too: neither says which counts."""


def takes_side(name: str) -> bool:
    """Whether a quantity counts to starboard and port: rudders, yaw rate, a wind seen from the bow."""
    quantity = quantity_of(name)
    if quantity is None or not quantity.positive:
        return False
    return quantity.positive[0] == "starboard" or (quantity.positive[0] == "clockwise" and not quantity.origin)


def midships(texts: Any) -> Any:
    """(n_rows,) whether texts of a pandas column are words for a rudder that stands amidships: MID, MIDSHIPS."""
    return texts.str.slice(0, 40).str.upper().str.fullmatch(_MIDSHIPS).fillna(False).to_numpy(dtype=bool)


def sided(texts: Any, decimal: str) -> FloatArray:
    """Numbers (n_rows,) of a pandas column of texts with a side each, starboard positive; NaN where one has none.

    A zero needs no side, and a word for amidships is one.  A number with a sign and a side is none: which of them
    counts is not told.
    """
    parts = texts.str.slice(0, 40).str.upper().str.extract(_CELL)
    size = numbers_in(parts[1], decimal)
    before, behind = parts[0].fillna(""), parts[2].fillna("")
    words = before + behind
    one = ((before == "") | (behind == "")).to_numpy(dtype=bool, na_value=False)
    port = words.isin(_PORT).to_numpy(dtype=bool)
    starboard = words.isin(_STARBOARD).to_numpy(dtype=bool) | (size == 0.0)
    with_side = np.where(one & port, -size, np.where(one & starboard, size, np.nan))
    return np.where(midships(texts), 0.0, with_side)


def as_cells_say(log_map: LogMap, names: Collection[str], headers: dict[str, str]) -> LogMap:
    """The map with the direction that the cells of these quantities count.

    Raises LogError where the map says the opposite.
    """
    problems = []
    for name in names:
        if log_map.sources[name].positive in AGAINST:
            what = f"the map says '{headers[name]}' is positive to {log_map.sources[name].positive}"
            why = "its cells say the side themselves, such as 10 P: those to starboard are positive"
            fix = (
                f"remove 'positive' from [columns.{name}], or say scale = -1 if the sides of the log are the wrong ones"
            )
            problems.append(Problem(what, log_map.place(name), why, fix))
    if problems:
        raise LogError(*problems)
    said = {name: replace(log_map.sources[name], positive=known_quantity(name).positive[0]) for name in names}
    return replace(log_map, sources={**log_map.sources, **said})
