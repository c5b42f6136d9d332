"""Numbers of a check as people read them."""

from __future__ import annotations

import math

from ..result import Item


def value(number: float | None, unit: str = "") -> str:
    """A metric's value with its unit; a simulation that diverged has none."""
    if number is None:
        return "-"
    if math.isinf(number):
        return "diverged"
    text = f"{number:.4g}"
    return f"{text} {unit}" if unit else text


def change(item: Item) -> str:
    """Change of a metric's size in percent, "" where there is none to tell."""
    if item.change is None or math.isinf(item.change):
        return ""
    if abs(item.change) >= 10.0:
        return f"x{item.change + 1.0:.3g}"
    percent = 100.0 * item.change
    return f"{percent:+.0f} %" if abs(percent) >= 100.0 else f"{percent:+.2g} %"


def told(item: Item) -> str:
    """What is to be said of an item, in one line."""
    if not item.metric:
        return item.reason
    if item.baseline is None:
        numbers = value(item.now, item.unit)
    else:
        numbers = f"{value(item.baseline, item.unit)} -> {value(item.now, item.unit)}"
    parts = [numbers, change(item)]
    if item.allowed is not None:
        parts.append(f"at most {value(item.allowed, item.unit)} passes")
    parts.append(item.reason)
    return ", ".join(part for part in parts if part)
