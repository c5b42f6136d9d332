"""Numbers of causes in words: units people use, with intervals."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ...effects import Effect
from ...effects.signs import UNLIMITED
from ...phrases import on_compass
from ...units import DIMENSIONLESS, read_as
from .intervals import Estimate

MOST_DIGITS = 4
"""Digits of a size in words, however well trials fit it: no sensor is known to more; a factor may have more, as what
counts is how far it is from 1."""


def quantity(value: float, error: float | None, unit: str) -> str:
    """A value with its 95 % half width: "0.47 ± 0.03 m/s"."""
    word, factor = _after_number(unit, value)
    value *= factor
    if not math.isfinite(value):
        return UNLIMITED
    if error is None or not math.isfinite(error) or error <= 0.0:
        return f"{value:.3g}{word}"
    error *= factor
    digits = _digits(error)
    believed = digits if unit in DIMENSIONLESS or value == 0.0 else MOST_DIGITS - 1 - math.floor(math.log10(abs(value)))
    if believed < digits:
        digits = max(believed, 0)
        error = max(error, 10.0**-digits)
    return f"{value:.{digits}f} ± {error:.{digits}f}{word}"


def error_in_words(error: float, unit: str) -> str:
    """A half width alone: "0.03 m/s"."""
    word, factor = _after_number(unit, error)
    return f"{error * factor:.{_digits(error * factor)}f}{word}"


def _digits(error: float) -> int:
    """Places behind the point that a half width is told with."""
    return max(0, min(6, 1 - math.floor(math.log10(error))))


CLOSE, LITTLE = 0.1, 0.03
"""Share of a range up to which its ends may be rounded, and share of them that a range worth more digits has."""


def range_in_words(low: float, high: float, unit: str, little: float = LITTLE) -> str:
    """From the least to the largest: "0.2 to 0.4 m/s", with as many digits as tell them apart.

    little  share of a value by which they must differ to be told apart
    """
    word, factor = _after_number(unit, max(abs(low), abs(high)))
    apart = abs(high - low) * factor
    ends = []
    for end in (low * factor, high * factor):
        short = round(end, 2) if unit in DIMENSIONLESS and abs(end) > 0.1 else float(f"{end:.2g}")  # 590, not 5.9e+02
        digits = max(0, -math.floor(math.log10(apart))) if apart > little * abs(end) else 0
        while apart > little * abs(end) and abs(short - end) > CLOSE * apart:
            short, digits = round(end, digits), digits + 1
        ends.append(f"{short:g}")
    return f"{' to '.join(dict.fromkeys(ends))}{word}"


def _after_number(unit: str, size: float) -> tuple[str, float]:
    """The unit as it stands behind a number of that size in SI, and the factor to it."""
    word, factor = read_as(unit, size)
    return "" if unit in DIMENSIONLESS else word if word.startswith("°") else f" {word}", factor


def parameters_in_words(effect: Effect, estimates: Mapping[str, Estimate]) -> dict[str, str]:
    """Each estimated parameter of an effect as text; for a current, say, its speed and, if known, where it sets too."""
    found = {}
    for name, parameter in effect.parameters.items():
        estimate = estimates.get(f"{effect.kind}.{name}")
        if estimate is not None:
            half = None if estimate.low is None or estimate.high is None else 0.5 * (estimate.high - estimate.low)
            found[name] = quantity(estimate.value, half, parameter.unit)
    for (first, second), (size, direction) in effect.told_as.items():
        if {first, second} <= set(found):
            north, east = (estimates[f"{effect.kind}.{name}"] for name in (first, second))
            length = math.hypot(north.value, east.value)
            error = math.hypot(
                *(
                    e.value / max(length, 1e-12) * 0.5 * ((e.high or e.value) - (e.low or e.value))
                    for e in (north, east)
                )
            )
            found[size] = quantity(length, error, effect.parameters[first].unit)
            if length > error:  # else it may be any
                found[direction] = on_compass(math.atan2(east.value, north.value))
    return found
