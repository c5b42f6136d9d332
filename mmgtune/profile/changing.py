"""A profile changed: tuned, or with effects put in.  Each gives another profile; ``text`` and hash follow from it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

from ..components import split_name
from ..effects import Effect, Parameter, Scale, Visited, effects
from ..physics.constants import GRAVITY
from .model import ABSENT, Coefficient, Section, ShipProfile

TUNED = "tuned by mmgtune; before: "


def scale_of(profile: ShipProfile) -> Scale:
    """The size of a ship, as bounds of effects are counted in."""
    L, d = profile.L_pp, profile.value("particulars.d")
    U = profile.approach.speed if profile.approach else 0.1 * (GRAVITY * L) ** 0.5
    n = profile.approach.n if profile.approach else 0.0
    return Scale(L=L, d=d, U=U, force=0.5 * profile.value("particulars.rho") * L * d * U * U, n=n)


def missing_for(effect: Effect, profile: ShipProfile) -> list[str]:
    """Coefficients and parts of the arrangement the effect needs and the profile lacks; empty where it applies."""
    has = {name for section in profile.sections.values() for name in section.numbers}
    has |= {*profile.arrangement.breakdown._fields}
    needed = dict.fromkeys((*effect.needs, *effect.borrowed.values(), *effect.of_parts))
    return [name for name in needed if name not in has]


def tuned(
    profile: ShipProfile,
    values: Mapping[str, float],
    stderr: Mapping[str, float | None],
    provenance: Mapping[str, Any],
    suffix: str = "tuned",
    licence: str = "",
    citation: str = "",
) -> ShipProfile:
    """The profile with ``values`` {section.symbol: value in the field's unit} in place.

    Each tuned number keeps the value it had before any tuning and gets its standard error, where known.  Licence and
    citation of the data it was tuned to join those the profile has.  Raises KeyError for a name it does not have.
    """
    sections = dict(profile.sections)
    for name, value in values.items():
        kind, symbol = split_name(name)
        before = profile.coefficient(name)
        now = replace(
            before,
            value=float(value),
            pre_determined=profile.value(name) if before.pre_determined is None else before.pre_determined,
            stderr=stderr.get(name),
            source=before.source if before.source.startswith(TUNED) else TUNED + before.source,
            assumption=False,
        )
        section = sections[kind]
        sections[kind] = replace(section, coefficients={**section.coefficients, symbol: now})
    return replace(
        profile,
        name=profile.name if f"({suffix})" in profile.name else f"{profile.name} ({suffix})",
        sections=sections,
        provenance=dict(provenance),
        licence=joined(profile.licence, licence),
        citation=joined(profile.citation, citation),
    )


def with_effects(
    profile: ShipProfile,
    values: Mapping[str, Mapping[str, float]],
    source: str,
    stderr: Mapping[str, Mapping[str, float | None]] | None = None,
) -> ShipProfile:
    """The profile with effects {tag: {parameter: value}} put in or changed; other parameters of new ones at their null,
    or where they are pivots, at what suits the ship.

    stderr  standard errors in the same form, where known.  Raises KeyError for an unknown effect or parameter.
    """
    by_tag = {effect.tag: effect for effect in effects()}
    sections = {kind: section for kind, section in profile.sections.items() if not kind.startswith("effects.")}
    given = {kind.partition(".")[2]: section for kind, section in profile.sections.items() if "." in kind}
    for tag, parameters in values.items():
        effect = by_tag[tag]
        unknown = set(parameters) - set(effect.fields)
        if unknown:
            raise KeyError(f"effect '{tag}' has no {', '.join(sorted(unknown))}")
        old = given.get(tag, Section(effect, {}, source))
        errors = (stderr or {}).get(tag, {})
        coefficients = {}
        for name, parameter in effect.fields.items():
            assert isinstance(parameter, Parameter)  # an effect has nothing else
            if name in parameters:
                coefficients[name] = Coefficient(float(parameters[name]), source=source, stderr=errors.get(name))
            elif name in effect.pivots and name not in old.coefficients:
                coefficients[name] = Coefficient(effect.pivots[name](scale_of(profile)), source=source)
            else:
                coefficients[name] = old.coefficients.get(name) or Coefficient(parameter.null, source=ABSENT)
        given[tag] = replace(old, coefficients=coefficients)
    sections.update({f"effects.{tag}": given[tag] for tag in by_tag if tag in given})
    return replace(profile, sections=sections)


def read_off(profile: ShipProfile, visited: Visited, tags: Collection[str]) -> ShipProfile:
    """The profile with what effects of these tags, which it has, read off the trials, such as the noise of a log."""
    values = {
        effect.tag: {name: of(visited) for name, of in effect.read_off.items()}
        for effect in effects()
        if effect.read_off and effect.tag in tags and effect.kind in profile.sections
    }
    return with_effects(profile, values, "read off the trials") if values else profile


def with_all_effects(profile: ShipProfile, tags: Collection[str] = ()) -> ShipProfile:
    """The profile with every effect that applies to it and can be a cause; those it does not have at their null.

    tags  of these alone; empty for all
    """
    wanted = [e for e in effects() if e.variants and not missing_for(e, profile) and (not tags or e.tag in tags)]
    return with_effects(profile, {effect.tag: {} for effect in wanted}, ABSENT)


def joined(*texts: str) -> str:
    """Licences or citations of several origins as one text, each once."""
    return "; ".join(dict.fromkeys(part for text in texts for part in text.split("; ") if part))
