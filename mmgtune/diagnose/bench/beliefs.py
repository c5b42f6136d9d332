"""What is believed before any trial is looked at, of coefficients that are not tuned and of the forms of effects.

Captive tests and formulas are right to some per cent.  A hull that is held exactly at its profile's values leaves an
error that is no cause, and that some effect of about the same form would be named for; so does a wind of exactly the
force of a formula.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase

import numpy as np

from ...arrays import FloatArray
from ...circumstances import unmeasured
from ...components import split_name
from ...effects import Effect, effects
from ...fitting.box import Box, base_of, choose_targets
from ...model import Model
from ...profile import ShipProfile
from ...trial import Trial

FURTHEST = 5.0
"""Standard deviations of ships about its formula within which a target is looked for: what trials say and what is
believed of it hold it, not the end of its box."""

OF_HULL = ("hull.*", "wake.C_*", "particulars.m_x_", "particulars.m_y_", "particulars.k_zz_")
"""What has leeway: forces of the hull, how its wake changes, mass and inertia with what moves along of the water."""

OF_CURVES = {
    **dict.fromkeys(("propeller.K_T0", "propeller.k_0"), 0.3),
    **dict.fromkeys(("propeller.C_PY0", "propeller.C_PN0_*"), 0.4),
    **dict.fromkeys(("rudder.f_alpha", "rudder.f_a0", "rudder.c_l01"), 0.2),
}
"""What has less: the level of the forces of propeller and rudder, with the share of a hull's leeway.  Their curves are
from tests of them alone, and errors that are only a little larger are what is looked for: of revolutions, of the
rudder's angle."""

ENDS = 2.0
"""Standard deviations within which curves of propeller and rudder are looked for: long runs tell thrust so well that no
belief would hold it, and a tow would be another propeller."""

PATTERNS = (*OF_HULL, *OF_CURVES)


@dataclass(frozen=True)
class Beliefs:
    """Standard deviations in the unit cube, about the profile's values.

    leeway    coefficients beside the targets that may move a little
    forms     parameters of the forms of effects, which move wherever their effect does
    formulas  targets from formulas that say how far ships scatter about them
    acting    kinds of the effects that the profile has and that act on the trials: their forms always move
    """

    leeway: Mapping[str, float] = field(default_factory=dict)
    forms: Mapping[str, float] = field(default_factory=dict)
    formulas: Mapping[str, float] = field(default_factory=dict)
    acting: frozenset[str] = frozenset()

    @classmethod
    def of(
        cls,
        box: Box,
        loose: Sequence[str],
        share: float,
        shapes: Mapping[str, float],
        acting: frozenset[str],
        *,
        formulas: bool,
    ) -> Beliefs:
        """Beliefs about coefficients known to a share of their values, and about forms with deviations in units of the
        profile; formulas: whether what is from one is known as well as ships scatter about it."""
        scatter = {}
        if formulas and box.scatter is not None:
            scatter = {box.names[k]: float(box.scatter[k]) for k in box.from_formula}
        own = box.part(loose)
        leeway = {
            name: max(share * part_of(name) * abs(pre), scatter.get(name, 0.0)) / width
            for name, pre, width in zip(loose, own.pre.tolist(), own.width.tolist(), strict=True)
        }
        forms, tuned = (
            {name: deviation / float(box.part([name]).width[0]) for name, deviation in known.items()}
            for known in (shapes, {name: one for name, one in scatter.items() if name not in leeway})
        )
        return cls(leeway, forms, tuned, acting)

    @property
    def deviations(self) -> Mapping[str, float]:
        """All together."""
        return {**self.leeway, **self.forms, **self.formulas}

    @property
    def of_acting(self) -> tuple[str, ...]:
        """Parameters of the forms of effects that act anyway."""
        return tuple(name for name in self.forms if split_name(name)[0] in self.acting)

    def form_of(self, effect: Effect) -> tuple[str, ...]:
        """Parameters of the form of an effect, which are free wherever the effect is."""
        return tuple(name for name in self.forms if name.startswith(f"{effect.kind}."))

    def moving_with(self, names: Sequence[str]) -> tuple[list[str], list[int]]:
        """Form parameters that the effects among ``names``, and those that act anyway, still lack, and the indices of
        the names to keep: all but form parameters of other effects."""
        moving = self.acting | {split_name(base_of(name))[0] for name in names if name not in self.forms}
        asked = [name for name in self.forms if split_name(name)[0] in moving and name not in names]
        kept = [k for k, name in enumerate(names) if name not in self.forms or split_name(name)[0] in moving]
        return asked, kept

    def rows(self, names: Sequence[str]) -> tuple[list[int], FloatArray]:
        """Indices of the names with a belief (k,), and a row for each (k, n_names): 1 over its standard deviation."""
        deviations = self.deviations
        places = [k for k, name in enumerate(names) if name in deviations]
        return places, np.eye(len(names))[places] / np.array([deviations[names[k]] for k in places])[:, None]


def part_of(name: str) -> float:
    """The share of a hull's leeway that a coefficient has."""
    return next((part for pattern, part in OF_CURVES.items() if fnmatchcase(name, pattern)), 1.0)


def with_ends(box: Box, loose: Sequence[str], share: float) -> Box:
    """The box with ends where curves of propeller and rudder that are not from formulas have theirs."""
    low, high = box.low.copy(), box.high.copy()
    for k, name in enumerate(box.names):
        part = part_of(name)
        if name in loose and part < 1.0 and (box.scatter is None or np.isnan(box.scatter[k])):
            half = ENDS * share * part * abs(float(box.pre[k]))
            low[k], high[k] = max(low[k], box.pre[k] - half), min(high[k], box.pre[k] + half)
    return replace(box, low=low, high=high)


def let_go(model: Model, targets: Sequence[str], fixed: Sequence[str]) -> tuple[str, ...]:
    """Coefficients beside the targets that get leeway, as they are known to some per cent only."""
    there = [pattern for pattern in PATTERNS if any(fnmatchcase(name, pattern) for name in model.profile.names())]
    free = choose_targets(model, there, fixed)
    return tuple(name for name in free if name not in targets and model.profile.value(name) != 0.0)


def acting_kinds(profile: ShipProfile, trials: Sequence[Trial]) -> frozenset[str]:
    """Kinds of the effects that a profile has, whose forms are not known for certain, and that act on the trials."""
    own = [effect for effect in effects() if effect.form and effect.kind in profile.sections]
    idle = unmeasured(own, trials)

    def acts(effect: Effect, symbol: str) -> bool:
        name = f"{effect.kind}.{symbol}"
        return name not in idle and profile.value(name) != effect.parameters[symbol].null

    return frozenset(e.kind for e in own if any(acts(e, symbol) for symbol in e.parameters if symbol not in e.form))


def forms(model: Model, kinds: Collection[str]) -> dict[str, float]:
    """Parameters of the forms of the effects of these kinds, with their standard deviations."""
    return {
        f"{effect.kind}.{name}": deviation
        for effect in model.effects
        if effect.kind in kinds
        for name, deviation in effect.form.items()
    }


def in_words(share: float, effects: Sequence[Effect], formulas: int) -> list[dict[str, str]]:
    """Rows on targets from formulas, on the leeway and on the forms of effects that were found, for the table of
    assumptions: name, value and note."""
    tuned = {
        "name": f"{formulas} targets from formulas",
        "value": "the profile's, with the standard deviation of ships about the formula",
        "note": "what the formula expects, beside what the trials say",
    }
    beside = [tuned] if formulas else []
    if share <= 0.0:
        return beside
    parts = {1.0: OF_HULL} | {
        part: tuple(name for name, own in OF_CURVES.items() if own == part) for part in OF_CURVES.values()
    }
    known = [
        {
            "name": ", ".join(names),
            "value": f"the profile's, beside the targets, with a standard deviation of {100.0 * share * part:.3g} %",
            "note": "how well tests and formulas are expected to tell them",
        }
        for part, names in parts.items()
    ]
    off = [
        {
            "name": f"{effect.kind}.{name}",
            "value": f"{effect.parameters[name].null:g} with a standard deviation of {deviation:g}",
            "note": f"{effect.parameters[name].label}: how far ships are expected to be off",
        }
        for effect in effects
        for name, deviation in effect.form.items()
    ]
    return [*beside, *known, *off]
