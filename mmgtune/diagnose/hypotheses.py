"""What may be the cause: every set of parameters of every effect that could be told from the tuned coefficients."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from ..effects import Effect
from ..model import Model
from ..options import DiagnoseOptions
from ..profile import ShipProfile, with_all_effects
from ..trial import Trial, measured_around

INTEGRATION_STEP = "integration-step"


@dataclass(frozen=True)
class Hypothesis:
    """One effect with the parameters that are fitted together.

    names  of the parameters as targets, "effects.<tag>.<parameter>"
    """

    effect: Effect
    variant: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Tag of the effect."""
        return self.effect.tag

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters as targets."""
        return tuple(f"{self.effect.kind}.{name}" for name in self.variant)

    @property
    def label(self) -> str:
        """Effect, and its parameters where it could have others."""
        return self.tag if len(self.effect.variants) == 1 else f"{self.tag} ({', '.join(self.variant)})"


def known_causes(profile: ShipProfile, trials: Sequence[Trial], options: DiagnoseOptions) -> list[Hypothesis]:
    """What a diagnosis of a profile on these trials looks for."""
    present = [f"{effect.kind}.{name}" for effect in Model(profile).effects for name in effect.parameters]
    measured = frozenset[str]().union(*(measured_around(trial) for trial in trials))
    whole = Model(with_all_effects(profile))
    return hypotheses(whole, options.targets or profile.targets, options.effects, measured, present)


def hypotheses(
    model: Model, targets: Sequence[str], tags: Sequence[str], measured: Collection[str], present: Sequence[str]
) -> list[Hypothesis]:
    """Hypotheses for a model that holds every effect that applies.

    targets        coefficients that are tuned: what does the same as one of them cannot be told from it
    tags           effects asked for; empty for all
    measured       what any trial has of wind, current and so on; only then do parameters act that take it from there,
                   and those that stand in for it do not
    present        parameters that the profile itself has already
    """
    found = []
    for effect in model.effects:
        if tags and effect.tag not in tags:
            continue
        for variant in effect.variants:
            taken = any(effect.absorbed.get(name) in targets for name in variant)
            of_log = bool(set(variant) & set(effect.of_measured))
            idle = of_log != bool(set(effect.of_measured.values()) & set(measured)) if effect.of_measured else False
            hypothesis = Hypothesis(effect, variant)
            if not taken and not idle and not set(hypothesis.names) & {*targets, *present}:
                found.append(hypothesis)
    return found
