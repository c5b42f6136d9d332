"""What is said of one column: which quantity it is, how it counts, and what speaks for it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ..maps.mapping import ASKS

SURE, LIKELY, ASKED = "sure", "likely", "asked"
"""How far a guess is to be relied on: motion or name and unit show it, it is the likeliest, or it is a question."""
MARK = ASKS


@dataclass(frozen=True)
class Guess:
    """One entry of a map.

    quantity    of a trial, or "t"
    column      position in the log, None where the quantity was not found
    keys        of the entry, besides the column; a value that begins with MARK is a question
    evidence    in sentences
    confidence  SURE, LIKELY or ASKED
    """

    quantity: str
    column: int | None
    keys: dict[str, Any] = field(default_factory=dict)
    evidence: tuple[str, ...] = ()
    confidence: str = SURE
