"""Where an axis has its numbers, and how they are written."""

from __future__ import annotations

import math

from ..wording import MINUS, shown


def linear(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """Round numbers from ``low`` to ``high``, at most about ``most``, all with as many decimals."""
    span = high - low
    if not 1e-290 < span < math.inf:  # beyond, powers of ten below have no digits left
        return [(low, shown(low, 3))]
    raw = span / max(most, 1)
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(power * factor for factor in (1.0, 2.0, 2.5, 5.0, 10.0) if power * factor >= raw * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    count = math.floor(high / step + 1e-9) - first + 1
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    if round(step / power, 1) == 2.5:
        decimals = max(0, 1 - math.floor(math.log10(power) + 1e-9))
    places = [(first + k) * step for k in range(count)]
    return [(place, written(place, decimals)) for place in places]


def written(value: float, decimals: int) -> str:
    """A number on an axis, with a true minus and thin thousands."""
    if abs(value) >= 1e7 or (value != 0.0 and decimals > 6):
        return shown(value, 3)
    text = f"{value:,.{decimals}f}".replace(",", "\u202f")
    if not text.strip("-0.\u202f"):
        text = text.lstrip("-")
    return text.replace("-", MINUS) if abs(value) >= 1e4 else text.replace("\u202f", "").replace("-", MINUS)


def logarithmic(low: float, high: float) -> list[tuple[float, str]]:
    """Powers of ten from ``low`` to ``high``, with numbers between them where there are few."""
    decades = math.log10(high / low)
    subs = (1.0, 2.0, 5.0) if decades < 2.2 else (1.0,)
    if decades < 0.8:
        return [(place, text) for place, text in linear(low, high, 5) if place > 0.0]
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    every = max(1, -(-(last - first) // 8))
    found = [sub * 10.0**power for power in range(first, last + 1, every) for sub in subs]
    return [(place, shown(place, 3)) for place in found if low * (1.0 - 1e-9) <= place <= high * (1.0 + 1e-9)]
