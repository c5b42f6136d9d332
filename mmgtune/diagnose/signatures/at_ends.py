"""Targets that end at the end of their range: of a ship that is unlike her profile in many ways most do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..bench.workbench import Point, Workbench

FEWEST, MANY = 4, 0.4
"""Targets that must be there, and share of all, for a ship to be unlike her profile in more than a cause or two."""

MOST = 0.5
"""Share of them that must be from formulas for these to be spoken of."""


@dataclass(frozen=True)
class AtEnds:
    """Names of targets at an end of their range.

    alone     re-tuned without any cause
    beside    beside the causes found
    targets   how many there are
    formulas  of ``alone`` those whose range is what ships scatter about a formula
    """

    alone: tuple[str, ...]
    beside: tuple[str, ...]
    targets: int
    formulas: tuple[str, ...] = ()

    @classmethod
    def of(cls, bench: Workbench, base: Point, final: Point) -> AtEnds:
        """Those at a point without causes, and at one with them."""
        alone, beside = (
            tuple(name for name, z in zip(at.names, at.unit, strict=True) if name in bench.targets and z in (0.0, 1.0))
            for at in (base, final)
        )
        of_formula = tuple(name for name in alone if bench.model.profile.coefficient(name).scatter is not None)
        return cls(alone, beside, len(bench.targets), of_formula)

    @property
    def unlike(self) -> bool:
        """Whether the ship is unlike her profile in many ways, whatever causes are put beside it."""
        return len(self.beside) >= max(FEWEST, MANY * self.targets)

    @property
    def sentence(self) -> str:
        """What that says of a model that errs without a cause that can be named; "" where few are at an end."""
        if len(self.alone) < max(FEWEST, MANY * self.targets):
            return ""
        so_many = f"{len(self.alone)} of {self.targets} coefficients"
        told = f"Re-tuned without any cause, {so_many} end at the end of their range"
        if len(self.formulas) >= MOST * len(self.alone):
            return (
                f"{told}, two standard deviations of ships about the formulas they are from: this ship may be unlike "
                "those, which no single cause stands for. Coefficients of her own tests, or a sister's, come first."
            )
        return f"{told}: the ship may be unlike her profile in many ways, which no single cause stands for."

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {"alone": list(self.alone), "with_causes": list(self.beside), "targets": self.targets}
