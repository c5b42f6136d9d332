"""Options of a fit completed for a ship: effects put in to be tuned, the width of the box."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

from ..circumstances import unmeasured
from ..effects import effect_tags, find_effect
from ..errors import OptionError, Problem, among
from ..model import Model
from ..options import DiagnoseOptions, FitOptions, LeaveOutOptions, Options, TuningOptions
from ..profile import ShipProfile, missing_for, read_off
from ..profile import with_effects as put_in
from ..trial import Trial, TrialSet, visited_by
from .box import A_R, choose_targets

T = TypeVar("T", bound=TuningOptions)
O = TypeVar("O", bound=Options)


def settled(profile: ShipProfile, options: T, trials: TrialSet) -> tuple[ShipProfile, T]:
    """The profile with the effects of the options put in, and options that say all there is to say.

    ``a_r`` is None afterwards only where the scatter of formulas makes the box of a target.  Of the effects put in,
    coefficients that act on what no tune trial has measured are ``fixed``: nothing would determine them.
    Raises OptionError for an unknown effect, or one that does not apply, and for unknown targets.
    """
    asked = {*(options.targets or profile.targets), *options.fixed}
    profile, options = with_effects(profile, options)
    profile = read_off(profile, visited_by(tune_trials(trials), profile.L_pp), options.with_effects)
    idle = [name for name in _unmeasured(options.with_effects, tune_trials(trials)) if name not in asked]
    if idle:
        options = replace(options, fixed=(*options.fixed, *idle))
    return profile, with_width(profile, options)


def tune_trials(trials: TrialSet) -> list[Trial]:
    """The time series that a fit tunes to."""
    return [trials.trials[name] for name in trials.tune]


def held_words(profile: ShipProfile, options: TuningOptions, trials: Sequence[Trial]) -> list[str]:
    """What ``settled`` holds because none of these tune trials has measured it, in sentences."""
    return [
        f"{name} is held at {profile.written(name)}: no tune trial has measured {what}."
        for name, what in _unmeasured(options.with_effects, trials).items()
        if name in options.fixed
    ]


def _unmeasured(tags: Sequence[str], trials: Sequence[Trial]) -> dict[str, str]:
    return unmeasured([effect for tag in tags if (effect := find_effect(tag))], trials)


def with_width(profile: ShipProfile, options: O) -> O:
    """Options that say ``a_r``, unless the scatter of formulas makes the box of a target.

    Raises OptionError for unknown targets, and where all of them are fixed.
    """
    if not isinstance(options, (TuningOptions, DiagnoseOptions)):
        return options
    names = _free(profile, options)
    scattered = any(profile.coefficient(name).scatter is not None for name in names)
    if isinstance(options, (FitOptions, LeaveOutOptions, DiagnoseOptions)) and options.a_r is None and not scattered:
        return replace(options, a_r=A_R)
    return options


def _free(profile: ShipProfile, options: TuningOptions | DiagnoseOptions) -> tuple[str, ...]:
    """Targets that are not fixed.  Raises OptionError where there are some and all are."""
    names = choose_targets(Model(profile), options.targets, options.fixed)
    if not names and (held := choose_targets(Model(profile), options.targets)):
        why = (
            f"fixed={','.join(options.fixed)} leaves out all targets: {', '.join(held[:8])}{', ...' * (len(held) > 8)}"
        )
        fix = 'fix less, or name others, such as targets="hull.Y_*"'
        raise OptionError(Problem("no coefficient is left to tune", "fixed", why, fix))
    return names


def with_effects(profile: ShipProfile, options: T) -> tuple[ShipProfile, T]:
    """The profile with the effects of the options written into it at their null, and options that tune them too.

    An effect that the profile has begins where it is.  Both are returned as they are where that has been done already.
    Raises OptionError for an unknown effect, or one that does not apply.
    """
    added: dict[str, dict[str, float]] = {}
    names: list[str] = []
    for tag in options.with_effects:
        effect = find_effect(tag)
        if effect is None:
            raise OptionError(Problem(f"unknown effect '{tag}'", "with_effects", **among(tag, effect_tags())))
        missing = missing_for(effect, profile)
        if missing:
            raise OptionError(
                Problem(
                    f"the effect '{tag}' does not apply to this ship",
                    "with_effects",
                    f"it needs {', '.join(missing)}, which the profile does not have",
                    "add what is missing, or leave the effect out",
                )
            )
        if effect.kind not in profile.sections:
            added[tag] = {name: parameter.null for name, parameter in effect.plain.items()}
        names += [f"{effect.kind}.{name}" for name, parameter in effect.plain.items() if not parameter.choices]
    targets = tuple(dict.fromkeys((*(options.targets or profile.targets), *names)))
    if targets != (options.targets or profile.targets):
        options = replace(options, targets=targets)
    return put_in(profile, added, "put in to be tuned") if added else profile, options
