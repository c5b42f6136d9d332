"""Coefficients that are not tuned, let go a little: those of captive tests and formulas are right to some per cent.

A hull that is held exactly at its profile's values leaves an error that is no cause, and that some effect of about the
same form would be named for.
"""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase

import numpy as np

from ..components import split_name
from ..effects import Effect
from ..fitting.box import Box, base_of, choose_targets
from ..model import Model

PATTERNS = ("hull.*", "particulars.m_x_", "particulars.m_y_", "particulars.k_zz_")
"""What has leeway: forces of the hull, and mass and inertia with what moves along of the water."""


def let_go(model: Model, targets: Sequence[str], fixed: Sequence[str]) -> tuple[str, ...]:
    """Coefficients of a model beside the targets that are known no better than to some per cent."""
    there = [pattern for pattern in PATTERNS if any(fnmatchcase(name, pattern) for name in model.profile.names())]
    free = choose_targets(model, there, fixed)
    return tuple(name for name in free if name not in targets and model.profile.value(name) != 0.0)


def forms(model: Model, names: Sequence[str]) -> dict[str, float]:
    """Parameters of the forms of all effects that any of the names is of, with their standard deviations."""
    asked = {split_name(base_of(name))[0] for name in names}
    return {
        f"{effect.kind}.{name}": deviation
        for effect in model.effects
        if effect.kind in asked
        for name, deviation in effect.form.items()
    }


def deviations(box: Box, names: Sequence[str], share: float) -> dict[str, float]:
    """Standard deviations of coefficients in the unit cube of a box, as a share of their values in the profile."""
    at = [box.names.index(name) for name in names]
    return dict(zip(names, (share * np.abs(box.pre[at]) / box.width[at]).tolist(), strict=True))


def in_words(share: float, effects: Sequence[Effect]) -> list[dict[str, str]]:
    """What is believed with a leeway of so much, and beside effects that were found: name, value and note of each."""
    if share <= 0.0:
        return []
    hull = {
        "name": ", ".join(PATTERNS),
        "value": f"the profile's, beside the targets, with a standard deviation of {100.0 * share:.3g} %",
        "note": "how well tests and formulas are expected to tell the hull",
    }
    off = [
        {
            "name": f"{effect.kind}.{name}",
            "value": f"{effect.parameters[name].null:g} with a standard deviation of {deviation:g}",
            "note": f"{effect.parameters[name].label}: how far ships are expected to be off",
        }
        for effect in effects
        for name, deviation in effect.form.items()
    ]
    return [hull, *off]
