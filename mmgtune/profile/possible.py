"""Which numbers a coefficient may have: one rule for files and for profiles that are changed in memory."""

from __future__ import annotations

import math

from ..components import AT_LEAST_0, AT_MOST_0, Field
from ..effects import Parameter
from ..units import DIMENSIONLESS

FROUDE = 1.0
"""Speed over sqrt(g L_pp) [1] that no ship of displacement comes near: ships stay below 0.5."""

FASTEST_SHAFT = 100.0
"""Revolutions [1/s] that no propeller makes, not even a model's."""


def impossible(name: str, field: Field, number: float) -> dict[str, str] | None:
    """What is wrong with a number in the unit of its field, why, and the fix; None where nothing is.

    name  of the coefficient, for the message
    """
    if number == math.inf and may_be_infinite(field):
        return None
    if not math.isfinite(number):
        why, fix = "only finite numbers can be simulated", "check the number; a large one may lack a point"
        return {"what": f"'{name}' is {number}", "why": why, "fix": fix}
    if (field.low is not None and number <= field.low) or (field.high is not None and number >= field.high):
        why = f"{field.label or name.rpartition('.')[2]} must be {limits_in_words(field)}"
        return {"what": f"'{name}' = {number:g} is impossible", "why": why, "fix": "check number and unit"}
    return None


def may_be_infinite(field: Field) -> bool:
    """Whether infinity is a value: the null of an effect that fades only towards it."""
    return isinstance(field, Parameter) and math.isinf(field.null)


def limits_in_words(field: Field) -> str:
    """What a coefficient may be, "" where it has no limits."""
    low, high, unit = field.low, field.high, "" if field.unit in DIMENSIONLESS else f" {field.unit}"
    words = []
    if low is not None:
        words.append("0 or more" if AT_LEAST_0 <= low < 0.0 else f"above {low:g}{unit}")
    if high is not None:
        words.append("0 or less" if 0.0 < high <= AT_MOST_0 else f"below {high:g}{unit}")
    return " and ".join(words)
