"""What differs from voyage to voyage, drawn: a point with its interval for each voyage, in their order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...units import DIMENSIONLESS, NORMAL_95
from ..wording import clean, number
from .plot import Axis, Bar, Dots, Figure, Line, Look, Mark, Panel, Rule

LONGEST = 14
"""Letters of a name that are written under the axis."""

_EACH = Look("after", 1.3, "", "o", 6.0)
_BELIEVED = Look("before", 1.4, "dash")


def differences(found: Sequence[Mapping[str, Any]]) -> Figure:
    """A panel for each parameter of each quantity, as ``Difference.to_dict`` has them; one at least."""
    panels = [_panel(one, name) for one in found for name in one["by_voyage"][0] if name != "voyage"]
    legend = [("of each voyage, with its 95 % interval", _EACH)]
    if {one["pattern"] for one in found} & {"one", "trend"}:
        legend.append(("the value or trend that is believed", _BELIEVED))
    return Figure("differences", "What differs from voyage to voyage", tuple(panels), tuple(legend), 1)


def axis_words(one: Mapping[str, Any], name: str) -> str:
    """What a panel shows, with its unit."""
    unit = "–" if one["unit"] in DIMENSIONLESS else clean(one["unit"])
    relative = " over mean" if one["relative_to_mean"] else ""
    return f"{clean(one['quantity'])} {clean(name)}{relative} [{unit}]"


def _panel(one: Mapping[str, Any], name: str) -> Panel:
    rows = one["by_voyage"]
    values = np.array([_number(row[name]["value"]) for row in rows])
    errors = np.array([_number(row[name]["stderr"]) for row in rows])
    known = np.isfinite(values) & np.isfinite(errors)
    at = np.arange(len(rows))
    common, slope = one.get("for_all"), one.get("trend_per_voyage")
    marks: list[Mark] = []
    if one["pattern"] == "trend" and slope:
        middle = float(np.mean((values - slope[name]["value"] * at)[known])) if known.any() else np.nan
        marks.append(Line(at, middle + slope[name]["value"] * at, _BELIEVED))
    elif one["pattern"] == "one" and common:
        value, error = _number(common[name]["value"]), _number(common[name]["stderr"])
        if np.isfinite(error):
            ends = value - NORMAL_95 * error, value + NORMAL_95 * error
            marks.append(Bar((-0.6, len(rows) - 0.4), ends, "before", 0.15))
        marks.append(Rule(value, _BELIEVED, upright=False))
    marks.append(Rule(1.0 if one["relative_to_mean"] else 0.0, Look("muted", 1.0), upright=False))
    for place in np.flatnonzero(known):
        ends = values[place] - NORMAL_95 * errors[place], values[place] + NORMAL_95 * errors[place]
        marks.append(Line((float(place), float(place)), ends, Look("after", 1.3)))
    marks.append(Dots(at[known], values[known], _EACH))
    ticks = tuple((float(k), clean(row["voyage"])[-LONGEST:]) for k, row in enumerate(rows))
    x = Axis(low=-0.6, high=len(rows) - 0.4, ticks=ticks, grid=False)
    return Panel(tuple(marks), x, Axis(), axis_words(one, name), shape=0.55)


def _number(value: Any) -> float:
    found = number(value)
    return float("nan") if found is None else found
