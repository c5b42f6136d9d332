"""Targets far off what was believed of them: of a ship that is unlike her profile in many ways many are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...phrases import capital
from ..bench.workbench import Point, Workbench

FEWEST, MANY, OF_FORMULAS = 4, 0.4, 0.15
"""Targets that must be far off, share of all, and share where most are from formulas, for a ship to be unlike her
profile in more than a cause or two: what formulas say holds targets near them as far as the trials let it."""

BEYOND = 2.0
"""Standard deviations of ships about a formula from which a coefficient is far off."""

MOST = 0.5
"""Share of the targets that are from formulas where these are spoken of."""


@dataclass(frozen=True)
class AtEnds:
    """Names of targets at an end of their range, or further from their formula than ships are.

    alone     re-tuned without any cause
    beside    beside the causes found
    targets   how many there are
    formulas  how many of them are from formulas that say how far ships scatter about them
    """

    alone: tuple[str, ...]
    beside: tuple[str, ...]
    targets: int
    formulas: int = 0

    @classmethod
    def of(cls, bench: Workbench, base: Point, final: Point) -> AtEnds:
        """Those at a point without causes, and at one with them."""
        alone, beside = (tuple(_far_off(bench, point)) for point in (base, final))
        return cls(alone, beside, len(bench.targets), len(bench.believed.formulas))

    @property
    def from_formulas(self) -> bool:
        """Whether most targets are from formulas."""
        return self.formulas > MOST * self.targets

    @property
    def unlike(self) -> bool:
        """Whether the ship is unlike her profile in many ways, whatever causes are put beside it."""
        return self._many(self.beside)

    def _many(self, far: tuple[str, ...]) -> bool:
        return len(far) >= max(FEWEST, (OF_FORMULAS if self.from_formulas else MANY) * self.targets)

    @property
    def words(self) -> str:
        """How many are far off beside the causes."""
        beyond = "beyond two standard deviations of ships about their formulas"
        where = beyond if self.from_formulas else "at the end of their range"
        return f"{len(self.beside)} of {self.targets} coefficients that are re-tuned end {where}"

    @property
    def first(self) -> str:
        """What that says first of a model that errs without a cause that can be named; "" where few are far off."""
        no_cause = "which no single cause stands for"
        if self.from_formulas:
            unlike = "This ship is unlike those that the formulas of her profile are from"
            return f"{unlike}, {no_cause}." if self.unlike else ""
        return f"This ship may be unlike her profile in many ways, {no_cause}." if self._many(self.alone) else ""

    def why(self, told: str) -> str:
        """What it is told by, and what to do about it.

        told  what is said already
        """
        if not self.first:
            return ""
        if not self.from_formulas:
            return f"{self._alone}."
        far = "" if self.words in told else f"{capital(self.words)}. "
        return f"{far}What her own tests, or those of a sister ship, say of them comes first."

    @property
    def aside(self) -> str:
        """What is told by them beside causes that explain nearly all and leave few at an end."""
        return f"{self._alone}: the ship may also be unlike her profile in many ways."

    @property
    def _alone(self) -> str:
        far = f"{len(self.alone)} of {self.targets} coefficients"
        return f"Re-tuned without any cause, {far} end at the end of their range"

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"alone": list(self.alone), "with_causes": list(self.beside), "targets": self.targets}


def _far_off(bench: Workbench, point: Point) -> list[str]:
    """Targets at an end of their range, or beyond what ships scatter about the formula they are from."""
    null, known = bench.null(point.names), bench.believed.formulas
    return [
        name
        for name, z, own in zip(point.names, point.unit, null, strict=True)
        if name in bench.targets and (z in (0.0, 1.0) or abs(z - own) > BEYOND * known.get(name, np.inf))
    ]
