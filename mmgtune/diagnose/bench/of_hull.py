"""Whether a hull that is further off than it is believed to be would explain a cause as well."""

from __future__ import annotations

import math
from dataclasses import replace

from ...effects import CoefficientsEffect, FactorsEffect, ForceEffect, LagEffect
from .hypotheses import Hypothesis
from .workbench import Point, Workbench

FURTHER = 2.0
"""How many times as far off the coefficients that have leeway are let go."""

AS_WELL, PARTLY = 0.9, 0.5
"""Share of the fall of chi-squared by a cause that such a hull brings, from which the cause is not told from it, and
from which it is spoken of."""


def explained_by_hull(bench: Workbench, cause: Hypothesis, fewer: Point, chi2: float) -> float:
    """Share of the fall of chi-squared by a cause that a hull further off brings without it; 0 where that is not asked.

    fewer  the best fit without the cause, all others in place; chi2: that with it

    It is asked of causes that act on the ship with one value for all: values of runs are no hull's, and a sensor has
    none.
    """
    of_ship = isinstance(cause.effect, CoefficientsEffect | FactorsEffect | ForceEffect | LagEffect)
    fall = fewer.chi2 - chi2
    told = of_ship and not (cause.by or cause.instead) and bench.believed.leeway
    if not told or not 0.0 < fall < math.inf:  # without a cause a run may be lost
        return 0.0
    further = {name: FURTHER * deviation for name, deviation in bench.believed.leeway.items()}
    looser = replace(bench, believed=replace(bench.believed, leeway=further))
    gained, _ = looser.gained(fewer, fewer.unit, fall, hopeless=fewer.chi2 - PARTLY * fall)
    return gained / fall


def in_words(bench: Workbench, tag: str, share: float) -> str:
    """What a hull further off explains of a cause, in a sentence without its full stop; "" for little."""
    if share < PARTLY:
        return ""
    off = 100.0 * FURTHER * bench.options.leeway
    return (
        f"a hull {off:.3g} % off, beside the {100.0 * bench.options.leeway:.3g} % it was given, explains "
        f"{min(share, 1.0):.0%} of what {tag} does; if it may be so far off, look again with leeway={off / 100.0:.3g}"
    )
