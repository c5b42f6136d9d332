"""What there is to see of a result, whatever shows it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..arrays import FloatArray

Row = Mapping[str, Any]
"""Cells by the head of their column: text, numbers, None where there is nothing."""


@dataclass(frozen=True)
class Line:
    """One motion of a ship.

    words    what it is: "measured", "before", the name of a model
    kind     "measured", "before", "after" or "model": how it is drawn
    t        (n_samples,) [s]
    columns  (n_samples,) each in SI units, by name: x, y, psi, u, v_m, r, and what drives the ship
    """

    words: str
    kind: str
    t: FloatArray
    columns: Mapping[str, FloatArray]


@dataclass(frozen=True)
class Room:
    """A coefficient in the room it had.

    value, low, high, before  in the unit of the profile; None where infinite
    position  0 at the lower bound, 1 at the upper
    reach     half the interval of 95 %, as a share of the room; None where it is not known
    at_bound  "", "low" or "high"
    """

    name: str
    value: float | None
    position: float
    reach: float | None = None
    at_bound: str = ""
    determined: bool = True


Motions = Mapping[str, Sequence[Line]]
"""Motions by trial."""


@dataclass(frozen=True)
class View:
    """What there is to see of a result.

    title    what it is, in a line
    says     sentences, the first of them the answer
    rows     of its table, with the same columns in each
    notes    what a reader must know
    frame    columns (n_samples,) of its frame by name where that is not the table; ``along`` names the index
    rooms    coefficients in their room, by what each picture of them is called; empty where there are none
    motions  by trial; None where there are none
    """

    title: str
    says: Sequence[str] = ()
    rows: Sequence[Row] = ()
    notes: Sequence[str] = ()
    frame: Mapping[str, FloatArray] | None = None
    along: str = ""
    rooms: Callable[[], Mapping[str, Sequence[Room]]] | None = None
    motions: Callable[[], Motions] | None = None
    spare: Sequence[str] = field(default=())
    """Columns that text leaves out first where there is no room."""
