"""What was around the ship in trials and what a model acts on: where they do not meet, in sentences."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

import numpy as np

from .effects import Effect
from .model import Model
from .physics.quantities import Surroundings
from .trial import Trial, measured_around, surroundings

WORDS = {
    "wind": ("wind", "still air"),
    "current": ("current", "still water"),
    "wave": ("waves", "no waves"),
    "depth": ("depth", "deep water"),
}
"""What is measured, and what there is where it is not, by names of ``quantities.KNOWN``."""


def notes_on(
    model: Model, trials: Sequence[Trial], values: Mapping[str, float] | None = None, free: Collection[str] = ()
) -> list[str]:
    """What a reader should know of the surroundings of trials, each once; windows of a trial count as one.

    values  of coefficients in place of the model's own
    free    names of coefficients that are tuned: they count as acting
    """
    numbers = {**model.numbers(), **(values or {})}
    measured: dict[str, frozenset[str]] = {}
    for trial in trials:
        measured[trial.whole] = measured.get(trial.whole, frozenset()) | measured_around(trial)
    said = [
        _missing(effect, name, measured, numbers, free)
        for effect in model.effects
        for name in dict.fromkeys(effect.of_measured.values())
    ]
    holding = [effect.beyond for effect in model.effects if effect.beyond is not None]
    if holding and trials:
        around = Surroundings(*np.concatenate([surroundings(trial, model.draught) for trial in trials]).T)
        said += [beyond(numbers, around) for beyond in holding]
    return list(dict.fromkeys(one for one in said if one))


def unmeasured(effects: Iterable[Effect], trials: Sequence[Trial]) -> dict[str, str]:
    """Coefficients that act on what none of the trials has measured, each with what that is in words."""
    acting = {f"{effect.kind}.{one}": name for effect in effects for one, name in effect.of_measured.items()}
    measured = frozenset[str]().union(*(measured_around(trial) for trial in trials)) if acting else frozenset()
    return {one: WORDS[name][0] for one, name in acting.items() if name not in measured}


def _missing(
    effect: Effect,
    name: str,
    measured: Mapping[str, frozenset[str]],
    numbers: Mapping[str, float],
    free: Collection[str],
) -> str:
    """That an effect acts on what some trials have not measured; "" where they have, or where it does not act."""
    of_name = [f"{effect.kind}.{one}" for one, other in effect.of_measured.items() if other == name]
    stands_in = [f"{effect.kind}.{one}" for one in effect.stand_in]
    null = {f"{effect.kind}.{one}": parameter.null for one, parameter in effect.parameters.items()}

    def acts(one: str) -> bool:
        return numbers[one] != null[one] or one in free

    lacking = sum(name not in found for found in measured.values())
    if not lacking or not any(acts(one) for one in of_name):
        return ""
    what, still = WORDS[name]
    if any(acts(one) for one in stands_in):
        if lacking == len(measured):  # nothing but the steady one was meant
            return ""
        still = f"the steady {what} of [{effect.kind}]"
    if lacking == len(measured):
        return f"no trial has measured {what}: {still} throughout"
    verb = "has" if lacking == 1 else "have"
    return f"{lacking} of {len(measured)} trials {verb} no measured {what}: {still} there"
