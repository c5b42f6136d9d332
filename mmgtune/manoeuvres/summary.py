"""The indices of a record by whatever manoeuvre it shows, and the IMO criteria that apply to it."""

from __future__ import annotations

from typing import Any

from .criteria import Criterion, check_turning, check_zigzag
from .track import Track
from .turning import turning_indices
from .zigzag import manoeuvre_kind, zigzag_indices


def indices_of(track: Track, L_pp: float) -> dict[str, Any]:
    """Indices with units in their names; empty where the record shows neither a turn nor a zigzag.

    L_pp: length between perpendiculars [m].
    """
    kind = manoeuvre_kind(track)
    if kind == "turning":
        return turning_indices(track, L_pp).to_dict()
    if kind == "zigzag":
        return zigzag_indices(track, L_pp).to_dict()
    return {}


def criteria_of(track: Track, L_pp: float, V: float) -> tuple[Criterion, ...]:
    """Criteria of IMO MSC.137(76) for the manoeuvre shown; L_pp [m], V test speed [m/s]."""
    kind = manoeuvre_kind(track)
    if kind == "turning":
        return check_turning(turning_indices(track, L_pp), L_pp, V)
    if kind == "zigzag":
        return check_zigzag(zigzag_indices(track, L_pp), L_pp, V)
    return ()
