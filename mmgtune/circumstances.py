"""What was around the ship in trials and what a model acts on: where they do not meet, in sentences."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

import numpy as np

from .arrays import FloatArray
from .components.propeller import ASTERN
from .effects import Effect
from .inputs import INPUTS
from .model import Model
from .phrases import figures, listed
from .physics.quantities import HELD, KNOWN, Surroundings
from .profile import ShipProfile
from .trial import Trial, measured_around, surroundings
from .trial.checks.cross_checks import way_per_turn

WORDS = {
    "wind": ("wind", "still air"),
    "current": ("current", "still water"),
    "wave": ("waves", "no waves"),
    "depth": ("depth", "deep water"),
}
"""What is measured, and what there is where it is not, by names of ``quantities.KNOWN``."""

OFTEN = 0.02
"""Share of the samples of a trial with revolutions astern from which it is one with a reversed propeller."""

AS_FAR = (0.15, 4.0)
"""Times as far as by the approach of her profile that a ship may go with each turn of the propeller: revolutions are
looked for from 0.2 to 3 times those logged."""

_FIELDS = Surroundings._fields


def notes_on(
    model: Model, trials: Sequence[Trial], values: Mapping[str, float] | None = None, free: Collection[str] = ()
) -> list[str]:
    """What a reader should know of the surroundings of trials, each once; windows of a trial count as one.

    values  of coefficients in place of the model's own
    free    names of coefficients that are tuned: they count as acting
    """
    at_odds = [*another_size(model.profile, trials), *reversals(model, trials)]
    around: dict[str, list[FloatArray]] = {}
    if acts_on_surroundings(model):
        for trial in trials:
            around.setdefault(trial.whole, []).append(surroundings(trial, model.draught))
    return at_odds + notes(model, {name: np.concatenate(parts) for name, parts in around.items()}, values, free)


def another_size(profile: ShipProfile, trials: Sequence[Trial]) -> list[str]:
    """A sentence where a ship makes a way with each turn of her propeller that no gear, speed or wind lets that of a
    profile make; else none."""
    found = [way for trial in trials if (way := way_per_turn(trial)) is not None]
    approach = profile.approach
    if approach is None or not found or min(approach.speed, approach.n) <= 0.0:
        return []
    way, own = float(np.median(found)), approach.speed / approach.n
    if AS_FAR[0] * own <= way <= AS_FAR[1] * own:
        return []
    told = (
        f"the ship makes {figures(way, 3)} m with each turn of the propeller, and {figures(own, 3)} m by the approach "
        f"of '{profile.id}': the trials are of a ship of another size, or speeds or revolutions are in other units"
    )
    return [told]


def reversals(model: Model, trials: Sequence[Trial]) -> list[str]:
    """A sentence on trials in which a propeller turns astern that the ship's equations do not have so; else none."""
    ids = reversed_in(model, trials)
    if not ids:
        return []
    propeller = without_reverse(model.profile)
    told = (
        f"the propeller turns astern in {listed(ids, 4)}, and the propeller '{propeller}' of "
        f"'{model.profile.id}' has no revolutions astern: what is off there may be that alone"
    )
    return [told]


def reversed_in(model: Model, trials: Sequence[Trial]) -> list[str]:
    """Ids of trials in which a propeller turns astern that the ship's equations do not have so."""
    if without_reverse(model.profile) is None:
        return []
    turned = [name for name in model.inputs if INPUTS[name].role == "propeller"]
    ids = [one.whole for one in trials if any(np.mean(one.inputs([name]) < 0.0) > OFTEN for name in turned)]
    return list(dict.fromkeys(ids))


def without_reverse(profile: ShipProfile) -> str | None:
    """The propeller of a ship whose equations have no revolutions astern; None where they do."""
    propeller = profile.sections["propeller"].component.tag if "propeller" in profile.sections else ""
    return None if propeller in ASTERN else propeller


def acts_on_surroundings(model: Model) -> bool:
    """Whether anything that can be measured around a ship makes a difference to a model, or has to be in a range."""
    return any(effect.of_measured or effect.beyond is not None for effect in model.effects)


def notes(
    model: Model,
    around: Mapping[str, FloatArray],
    values: Mapping[str, float] | None = None,
    free: Collection[str] = (),
    of: str = "trial",
) -> list[str]:
    """What a reader should know of surroundings (n_samples, n_surroundings), by trial or what else they are of."""
    numbers = {**model.numbers(), **(values or {})}
    measured = {name: _known(rows) for name, rows in around.items()}
    said = [
        _missing(effect, name, measured, numbers, free, of)
        for effect in model.effects
        for name in dict.fromkeys(effect.of_measured.values())
    ]
    if around:
        everywhere = Surroundings(*np.concatenate(list(around.values())).T)
        said += [effect.beyond(numbers, everywhere) for effect in model.effects if effect.beyond is not None]
    return list(dict.fromkeys(one for one in said if one))


def beyond_formulas(model: Model) -> list[str]:
    """What a reader should know of a model's own surroundings, such as its depth, where nothing is measured."""
    nothing = Surroundings(*np.zeros((len(Surroundings._fields), 1)))
    said = [effect.beyond(model.numbers(), nothing) for effect in model.effects if effect.beyond is not None]
    return [one for one in said if one]


def extremes(around: FloatArray) -> FloatArray:
    """Of surroundings (n_samples, n_surroundings) the samples that say as much to ``notes``: (n, n_surroundings).

    Of each thing that may be measured one without it, and of those with it the ones with the least and the largest of
    each of its numbers, and of the length of its vector.
    """
    kept: set[int] = set()
    for name in KNOWN:
        known = around[:, _FIELDS.index(f"{name}_known")] > 0.0
        kept.add(int(np.argmin(known)))
        at = np.flatnonzero(known)
        if not len(at):
            continue
        own = [k for k, one in enumerate(_FIELDS) if one.partition("_")[0] == name and one not in HELD]
        for size in (*around[at][:, own].T, np.linalg.norm(around[at][:, own], axis=1)):
            kept |= {int(at[np.argmin(size)]), int(at[np.argmax(size)])}
    return around[sorted(kept)]


def _known(around: FloatArray) -> frozenset[str]:
    """What was measured in one sample at least."""
    return frozenset(name for name in KNOWN if around[:, _FIELDS.index(f"{name}_known")].any())


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
    of: str,
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
        return f"no {of} has measured {what}: {still} throughout"
    verb = "has" if lacking == 1 else "have"
    return f"{lacking} of {len(measured)} {of}s {verb} no measured {what}: {still} there"
