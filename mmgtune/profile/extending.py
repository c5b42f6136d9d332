"""A profile with effects put in, out, or changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ..effects import Effect, Parameter, Scale, effects
from .model import Coefficient, Section, ShipProfile

GRAVITY = 9.81


def scale_of(profile: ShipProfile) -> Scale:
    """The size of a ship, as bounds of effects are counted in."""
    L, d = profile.L_pp, profile.value("particulars.d")
    U = profile.approach.speed if profile.approach else 0.1 * (GRAVITY * L) ** 0.5
    return Scale(L=L, d=d, U=U, force=0.5 * profile.value("particulars.rho") * L * d * U * U)


def missing_for(effect: Effect, profile: ShipProfile) -> list[str]:
    """Coefficients and parts of the arrangement the effect needs and the profile lacks; empty where it applies."""
    has = {name for section in profile.sections.values() for name in section.numbers}
    has |= {*profile.arrangement.breakdown._fields}
    return [
        name for name in dict.fromkeys((*effect.needs, *effect.borrowed.values(), *effect.of_parts)) if name not in has
    ]


def with_effects(profile: ShipProfile, values: Mapping[str, Mapping[str, float]], source: str) -> ShipProfile:
    """The profile with effects {tag: {parameter: value}} put in or changed; other parameters at their null.

    The text of the profile stays what it was.  Raises KeyError for an unknown effect or parameter.
    """
    by_tag = {effect.tag: effect for effect in effects()}
    sections = {kind: section for kind, section in profile.sections.items() if not kind.startswith("effects.")}
    given = {kind.partition(".")[2]: section for kind, section in profile.sections.items() if "." in kind}
    for tag, parameters in values.items():
        effect = by_tag[tag]
        old = given[tag].coefficients if tag in given else {}
        unknown = set(parameters) - set(effect.fields)
        if unknown:
            raise KeyError(f"effect '{tag}' has no {', '.join(sorted(unknown))}")
        coefficients = {}
        for name, parameter in effect.fields.items():
            assert isinstance(parameter, Parameter)  # an effect has nothing else
            if name in parameters:
                coefficients[name] = Coefficient(float(parameters[name]), source=source)
            else:
                coefficients[name] = old.get(name) or Coefficient(parameter.null, source="absent")
        given[tag] = Section(effect, coefficients, source)
    sections.update({f"effects.{tag}": given[tag] for tag in by_tag if tag in given})
    return replace(profile, sections=sections)


def with_all_effects(profile: ShipProfile) -> ShipProfile:
    """The profile with every effect that applies to it; those it does not have already at their null."""
    return with_effects(profile, {e.tag: {} for e in effects() if not missing_for(e, profile)}, "absent")
