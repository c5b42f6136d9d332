"""Effects that a fit is asked to put into the profile and tune besides."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from ..effects import effect_tags, find_effect
from ..errors import OptionError, Problem, closest
from ..options import TuningOptions
from ..profile import ShipProfile, missing_for
from ..profile import with_effects as put_in

T = TypeVar("T", bound=TuningOptions)


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
            raise OptionError(Problem(f"unknown effect '{tag}'", "with_effects", fix=closest(tag, effect_tags())))
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
            added[tag] = {name: parameter.null for name, parameter in effect.parameters.items()}
        names += [f"{effect.kind}.{name}" for name in effect.parameters]
    targets = tuple(dict.fromkeys((*(options.targets or profile.targets), *names)))
    if targets != (options.targets or profile.targets):
        options = replace(options, targets=targets)
    return put_in(profile, added, "put in to be tuned") if added else profile, options
