"""What may be the cause: every set of parameters of every effect that could be told from the tuned coefficients."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from ...components import UNTAGGED
from ...effects import Effect, effects, find_effect
from ...fitting.box import AT
from ...fitting.one_sided import LOPSIDED_HULL
from ...model import Model
from ...options import DiagnoseOptions
from ...profile import ShipProfile, with_all_effects
from ...trial import Trial, measured_around
from .runs import IN_WORDS, groupings

INTEGRATION_STEP = "integration-step"
INPUTS_HELD = "inputs-held"
"""Causes that are no effects: they have no parameters."""


@dataclass(frozen=True)
class Hypothesis:
    """One effect with the parameters that are fitted together.

    names  of the parameters as targets, "effects.<tag>.<parameter>"
    by     the grouping of runs that have values of their own, "" for one value for all; see ``runs``
    groups labels of the groups
    stated whether the profile has any of these parameters already: by how much that is off is looked for
    """

    effect: Effect
    variant: tuple[str, ...]
    by: str = ""
    groups: tuple[str, ...] = ()
    stated: bool = False

    @property
    def tag(self) -> str:
        """Tag of the effect."""
        return self.effect.tag

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters as targets, group by group."""
        if self.by:
            return tuple(f"{base}{AT}{group}" for group in self.groups for base in self.bases)
        return self.bases

    @property
    def bases(self) -> tuple[str, ...]:
        """Parameters without the groups of runs they are of."""
        return tuple(f"{self.effect.kind}.{name}" for name in self.variant)

    @property
    def instead(self) -> tuple[str, ...]:
        """Coefficients of the profile that have the same effect; where they are targets, the hypothesis replaces
        them."""
        return tuple(self.effect.absorbed[name] for name in self.variant if name in self.effect.absorbed)

    @property
    def lopsided(self) -> bool:
        """Whether it makes a hull of two like sides push to one of them."""
        return any(LOPSIDED_HULL.fullmatch(name) for name in self.bases)

    @property
    def rough(self) -> bool:
        """Whether what it leaves says little: its formula, or a change that it takes for even, is not that exact."""
        return self.effect.rough or bool(set(self.effect.rough_with) & set(self.variant))

    @property
    def refines(self) -> bool:
        """Whether it is of what shows only beside a part of it that is known."""
        return bool(set(self.effect.refines) & set(self.variant))

    def holds(self, other: Hypothesis) -> bool:
        """Whether the other is a special case of this: fewer parameters, or the same for more runs."""
        finer = self.by == "trial" or self.by == other.by or not other.by
        return self != other and self.tag == other.tag and set(other.variant) <= set(self.variant) and finer

    @property
    def label(self) -> str:
        """Effect, its parameters where it could have others, and whose they are."""
        label = self.tag if len(self.effect.variants) == 1 else f"{self.tag} ({', '.join(self.variant)})"
        return f"{label}, one for each {IN_WORDS[self.by]}" if self.by else label


def n_terms(tags: Sequence[str]) -> int:
    """Terms of a sum of causes by their tags: forms of one effect are one, a memory of the side force and another of
    the moment; of many of one kind each counts."""
    alike = {tag for tag in tags if (effect := find_effect(tag)) is not None and not effect.one_of_many}
    return len(alike) + sum(tag not in alike for tag in tags)


def known_causes(
    profile: ShipProfile, trials: Sequence[Trial], options: DiagnoseOptions, *, in_place: bool = False
) -> list[Hypothesis]:
    """What a diagnosis of a profile on these trials looks for; ``in_place`` as for ``hypotheses``."""
    stated = [
        f"{effect.kind}.{name}"
        for effect in Model(profile).effects
        for name, parameter in effect.parameters.items()
        if profile.value(f"{effect.kind}.{name}") != parameter.null
    ]
    measured = frozenset[str]().union(*(measured_around(trial) for trial in trials))
    whole = Model(with_all_effects(profile))
    return hypotheses(whole, options.targets or profile.targets, options.effects, measured, stated, in_place=in_place)


def not_looked_for(profile: ShipProfile, tags: Sequence[str]) -> list[str]:
    """What was not looked for since the profile lacks a section that it may leave out, in words; of effects of these
    tags, of all where there are none."""
    lacking = set(UNTAGGED) - set(profile.sections)
    return [
        f"{effect.tag} was not looked for: the profile has no [{section}]"
        for effect in effects()
        if not tags or effect.tag in tags
        for section in sorted(lacking & {name.partition(".")[0] for name in effect.needs})
    ]


def hypotheses(
    model: Model,
    targets: Sequence[str],
    tags: Sequence[str],
    measured: Collection[str],
    stated: Sequence[str],
    *,
    in_place: bool = False,
) -> list[Hypothesis]:
    """Hypotheses for a model that holds every effect that applies.

    targets        coefficients that are tuned: what does the same as one of them cannot be told from it
    tags           effects asked for; empty for all
    measured       what any trial has of wind, current and so on; only then do parameters act that take it from there,
                   and those that stand in for it do not
    stated         parameters that the profile itself has already, at other than their null
    in_place       whether to return the hypotheses that do the same as a target and would replace it, instead of the
                   others; none of many
    """
    found = []
    for effect in model.effects:
        if tags and effect.tag not in tags:
            continue
        for variant in effect.variants:
            taken = any(effect.absorbed.get(name) in targets for name in variant)
            if in_place:
                taken = not taken or effect.one_of_many
            of_log = bool(set(variant) & set(effect.of_measured))
            idle = of_log != bool(set(effect.of_measured.values()) & set(measured)) if effect.of_measured else False
            own = {f"{effect.kind}.{name}" for name in variant}
            if not taken and not idle and not own & set(targets):
                found.append(Hypothesis(effect, variant, stated=bool(own & set(stated))))
    return found


def of_runs(known: Sequence[Hypothesis], trials: Sequence[Trial]) -> list[Hypothesis]:
    """Hypotheses whose parameters may differ between runs, with a value for each group of runs; what the profile states
    is one for all."""
    return [
        Hypothesis(one.effect, one.variant, by, groups)
        for by, groups in groupings(trials).items()
        for one in known
        if set(one.variant) <= set(one.effect.varies) and not one.stated
    ]
