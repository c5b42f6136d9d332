"""What a user can choose about a profile made from main dimensions."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import Problem
from .choice import INPUT, Options, choice

FORMS = ("mmg", "fam")
DERIVATIVES = ("inoue", "clarke", "kijima", "yoshimura")
ADDED_MASSES = ("zhou", "clarke")
HOLTROP = ("1984", "1982")

_OF_FORM = {"mmg": ("yoshimura",), "fam": ("inoue", "clarke", "kijima")}
"""Formulas that give all the derivatives a form has, its default first."""


@dataclass(frozen=True)
class EstimateOptions(Options):
    """Form and formulas of a profile from main dimensions."""

    form: str = choice(
        "mmg",
        "mmg: as the MMG standard method has it. fam: derivatives with v|v|; rudder with lift, drag and stall.",
        values=FORMS,
        panel=INPUT,
    )
    derivatives: str | None = choice(
        None,
        "Formulas of the hull derivatives: yoshimura for mmg; inoue, clarke or kijima for fam. Default: the first.",
        values=DERIVATIVES,
        called="set of hull derivatives",
        panel=INPUT,
    )
    added_mass: str = choice("zhou", "Formulas of the added masses.", values=ADDED_MASSES, panel=INPUT)
    holtrop: str = choice(
        "1984", "Year of Holtrop's formulas of wake and thrust deduction.", values=HOLTROP, panel=INPUT
    )

    surroundings: bool = choice(
        True, "Let measured current, waves and (where above_water is given) wind act where a log has them.", panel=INPUT
    )

    def problems(self) -> list[Problem]:
        """The derivatives must be those of the form."""
        found = super().problems()
        if not found and self.derivatives is not None and self.derivatives not in _OF_FORM[self.form]:
            other = next(form for form in FORMS if self.derivatives in _OF_FORM[form])
            found.append(
                Problem(
                    f"'{self.derivatives}' has no derivatives of the form '{self.form}'",
                    "derivatives",
                    f"its nonlinear terms are those of '{other}'",
                    f"choose form='{other}', or one of: {', '.join(_OF_FORM[self.form])}",
                )
            )
        return found

    @property
    def set_of_derivatives(self) -> str:
        """The formulas of the hull derivatives in use."""
        return self.derivatives or _OF_FORM[self.form][0]
