"""Cells in words."""

from __future__ import annotations

import math
from typing import Any

from ..report.wording import shown


def words(value: Any, digits: int = 4) -> str:
    """A cell as people read it; nothing where there is nothing."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, bool | str):
        return str(value)
    if isinstance(value, (list, tuple)):
        return ", ".join(words(one, digits) for one in value)
    if isinstance(value, int):
        return str(value)
    return "∞" if math.isinf(value) else shown(float(value), digits)


def is_number(value: Any) -> bool:
    """Whether a cell belongs in a column of numbers."""
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))
