"""What may differ from voyage to voyage, and a difference that was found, in numbers and in words."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ...arrays import FloatArray
from ...phrases import on_compass
from ...units import NORMAL_95
from ..signatures.wording import quantity

Pattern = Literal["none", "one", "each", "trend"]
PATTERNS: dict[Pattern, str] = {
    "none": "none, or what the re-tuned model has",
    "one": "one for all voyages",
    "each": "one for each voyage",
    "trend": "a trend from voyage to voyage",
}
"""Patterns of difference between voyages, in words."""


@dataclass(frozen=True)
class Quantity:
    """Something that may differ from voyage to voyage: parameters of an effect.

    absorbed  the coefficient that has the same effect for all voyages, "" for none
    trends    whether it may grow with the voyages
    """

    tag: str
    parameters: tuple[str, ...]
    absorbed: str = ""
    trends: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters as targets."""
        return tuple(f"effects.{self.tag}.{name}" for name in self.parameters)


QUANTITIES = (
    Quantity("current", ("north", "east")),
    Quantity("resistance", ("factor",), absorbed="hull.R_0", trends=True),
)
"""Quantities that may differ between voyages."""

LEG_NAMES = tuple(name for one in QUANTITIES for name in one.names)


@dataclass(frozen=True, eq=False)
class Difference:
    """How one quantity differs between voyages.

    pattern   that is believed
    evidence  gain in chi-squared over its inflation less its cost by BIC, by pattern, beside the others as believed
    unit      of the parameters
    values    (n_voyages, n_parameters) one for each voyage; relative to their mean where ``relative``
    stderr    of them, likewise; NaN where the windows of a voyage do not tell
    common    value for all voyages with standard errors, None where a coefficient has the same effect
    trend     change per voyage with its standard error, by parameter; empty where it cannot have one
    explained share of the error above noise that the pattern removes, beside the others as believed
    """

    quantity: Quantity
    pattern: Pattern
    evidence: Mapping[Pattern, float]
    unit: str
    voyages: tuple[str, ...]
    values: FloatArray
    stderr: FloatArray
    common: tuple[tuple[float, float], ...] | None
    trend: tuple[tuple[float, float], ...]
    relative: bool
    explained: float

    @property
    def sentence(self) -> str:
        """In words."""
        return _current(self) if self.quantity.tag == "current" else _resistance(self)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        parameters = self.quantity.parameters
        return {
            "quantity": self.quantity.tag,
            "pattern": self.pattern,
            "pattern_in_words": PATTERNS[self.pattern],
            "evidence": dict(self.evidence),
            "share_of_error_explained": self.explained,
            "unit": self.unit,
            "relative_to_mean": self.relative,
            "for_all": _told(parameters, self.common) if self.common else None,
            "trend_per_voyage": _told(parameters, self.trend) if self.trend else None,
            "by_voyage": [
                {"voyage": name, **_told(parameters, list(zip(row, errors, strict=True)))}
                for name, row, errors in zip(self.voyages, self.values.tolist(), self.stderr.tolist(), strict=True)
            ],
            "sentence": self.sentence,
        }


def _told(names: Sequence[str], pairs: Sequence[tuple[float, float]]) -> dict[str, Any]:
    return {
        name: {"value": value, "stderr": error if math.isfinite(error) else None}
        for name, (value, error) in zip(names, pairs, strict=True)
    }


def _current(one: Difference) -> str:
    known = np.isfinite(one.stderr).all(axis=1)
    speed = np.hypot(*one.values[known].T) if known.any() else np.zeros(1)
    if one.pattern == "each":
        return f"The current differed from voyage to voyage: {speed.min():.2g} to {speed.max():.2g} m/s."
    if one.pattern == "one" and one.common:
        (north, e_north), (east, e_east) = one.common
        where = on_compass(math.atan2(east, north))
        size = quantity(math.hypot(north, east), NORMAL_95 * max(e_north, e_east), "m/s")
        return f"One current sets through all voyages, of {size} towards {where}: none shows to differ."
    return "No current shows in these voyages beyond what was measured."


def _resistance(one: Difference) -> str:
    n = len(one.voyages)
    if one.pattern == "trend":
        ((slope, error),) = one.trend
        word = "grew" if slope > 0.0 else "fell"
        size = quantity(100.0 * abs(slope), 100.0 * NORMAL_95 * error, "%")
        return f"Resistance {word} by {size} per voyage ({n} voyages)."
    if one.pattern == "each":
        off = 100.0 * (one.values - 1.0)
        return (
            f"Resistance differed from voyage to voyage: {np.nanmin(off):+.0f} to {np.nanmax(off):+.0f} % of its mean."
        )
    return f"Resistance was the same in all {n} voyages, as far as these windows tell."
