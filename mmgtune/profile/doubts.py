"""Numbers of a profile that may be wrong, as every result and report says it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Doubt:
    """A coefficient that may be wrong.

    name     "section.symbol"
    value    in that unit, None where it is a table
    warning  why, such as a formula outside the range of the ships it was made from
    """

    name: str
    value: float | None
    unit: str
    warning: str

    def to_dict(self) -> dict[str, Any]:
        """For JSON; a value at infinity is null."""
        value = self.value if self.value is not None and math.isfinite(self.value) else None
        return {"name": self.name, "value": value, "unit": self.unit, "warning": self.warning}


def in_words(doubts: Sequence[Doubt | Mapping[str, Any]]) -> list[str]:
    """A sentence, without its stop, for each warning and all coefficients that share it.

    doubts  objects, or what records have of them
    """
    names: dict[str, list[str]] = {}
    for one in doubts:
        row = one.to_dict() if isinstance(one, Doubt) else one
        names.setdefault(str(row["warning"]), []).append(str(row["name"]))
    return [f"{', '.join(of)} {'is' if len(of) == 1 else 'are'} doubtful: {warning}" for warning, of in names.items()]
