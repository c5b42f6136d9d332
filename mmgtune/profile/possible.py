"""Which numbers a coefficient may have: one rule for files and for profiles that are changed in memory."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ..components import AT_LEAST_0, AT_MOST_0, Field
from ..effects import Parameter
from ..units import DIMENSIONLESS

FASTEST_SHAFT = 100.0
"""Revolutions [1/s] that no propeller makes, not even a model's."""


class Disproportion(NamedTuple):
    """A number that its fellows make impossible: its section and key, what is wrong and why."""

    section: str
    key: str
    what: str
    why: str


def out_of_proportion(numbers: Mapping[str, float]) -> Iterator[Disproportion]:
    """What is impossible about dimensions that are possible one by one, as where one of them has a wrong unit.

    numbers  by name, as "particulars.L_pp" [m]; what it lacks is not looked at
    """
    L, B, d = (numbers[f"particulars.{symbol}"] for symbol in ("L_pp", "B", "d"))
    if B >= L:
        yield Disproportion("particulars", "B", "the breadth is not below the length", f"B is {B:g} m, L_pp {L:g} m")
    elif d >= B:
        yield Disproportion("particulars", "d", "the draught is not below the breadth", f"d is {d:g} m, B {B:g} m")
    if abs(numbers.get("particulars.x_G", 0.0)) > 0.25 * L:
        what = "the centre of gravity is more than a quarter of L_pp from midship"
        yield Disproportion("particulars", "x_G", what, "x_G is from midship, forward positive")
    A_R, H_R, D_P = (numbers.get(name) for name in ("rudder.A_R", "rudder.H_R", "propeller.D_P"))
    if A_R is not None and not 0.001 * L * d <= A_R <= 0.1 * L * d:
        size = "large" if 0.1 * L * d < A_R else "small"
        why = f"rudders have a fiftieth of L_pp d = {L * d:.4g} m^2 or so"
        yield Disproportion("rudder", "A_R", f"a rudder of {A_R:g} m^2 is too {size} for this ship", why)
    if H_R is not None and 1.5 * d < H_R:
        yield Disproportion("rudder", "H_R", f"a rudder span of {H_R:g} m is more than 1.5 draughts", f"d is {d:g} m")
    if A_R is not None and H_R is not None and not 0.2 < H_R * H_R / A_R < 10.0:
        yield Disproportion("rudder", "H_R", f"span^2 over area is {H_R * H_R / A_R:.3g}", "rudders have 1 to 3")
    if D_P is not None and not 0.02 * d <= D_P <= 1.5 * d:
        side = "more than 1.5 draughts" if d < D_P else "less than a fiftieth of the draught"
        yield Disproportion("propeller", "D_P", f"a propeller of {D_P:g} m is {side}", f"d is {d:g} m")


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
