"""A profile changed: tuned, or with effects put in.  Each gives another profile; ``text`` and hash follow from it."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from types import NoneType
from typing import Any

from ..arrays import numbers_of
from ..components import effect_tag, split_name
from ..effects import Effect, Parameter, Scale, Visited, effects
from ..errors import Problem, ProfileError, among, brief, must_be_a
from ..physics.constants import GRAVITY
from .model import ABSENT, Coefficient, Section, ShipProfile
from .possible import impossible

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
    citation of the data it was tuned to join those the profile has.  Raises ProfileError for a name that the profile
    does not have, and for what its coefficient cannot be.
    """
    numbers = _numbers(profile, values)
    changed = {}
    for name, value in numbers.items():
        before = profile.coefficient(name)
        changed[name] = replace(
            before,
            value=value,
            pre_determined=profile.value(name) if before.pre_determined is None else before.pre_determined,
            stderr=stderr.get(name),
            source=before.source if before.source.startswith(TUNED) else TUNED + before.source,
            assumption=False,
        )
    return replace(
        profile,
        name=profile.name if f"({suffix})" in profile.name else f"{profile.name} ({suffix})",
        sections=_sections(profile, changed),
        provenance=dict(provenance),
        licence=joined(profile.licence, licence),
        citation=joined(profile.citation, citation),
    )


def with_values(profile: ShipProfile, values: Mapping[str, float], source: str) -> ShipProfile:
    """The profile with numbers changed by hand: ``values`` {section.symbol: value in the unit of its field}.

    What the profile said of the number before, such as its bounds and standard error, is of the old one and goes.

    source  where the numbers are from
    Raises ProfileError for a name that the profile does not have, and for what its coefficient cannot be, OptionError
    for a source that is no text.
    """
    must_be_a(profile, ShipProfile, "profile")
    must_be_a(source, str, "source")
    numbers = _numbers(profile, values)
    changed = {name: Coefficient(value, source=source) for name, value in numbers.items()}
    return replace(profile, sections=_sections(profile, changed))


def _numbers(profile: ShipProfile, values: Mapping[str, float]) -> dict[str, float]:
    """Values of coefficients as numbers.  Raises ProfileError for all that are none of that profile."""
    must_be_a(values, Mapping, "values")
    found, problems, where = {}, [], str(profile.path or profile.id)
    for name, value in values.items():
        profile.value(name)  # a name that is there, and no table
        kind, symbol = split_name(name)
        field = profile.sections[kind].component.fields[symbol]
        number = numbers_of(value)
        if number is None or number.ndim or isinstance(value, (bool, NoneType)):
            fix = f"give a number in the unit of profiles in memory: {field.unit}"
            problems.append(Problem(f"'{name}' is {brief(value)}", where, "a coefficient is one number", fix))
        elif wrong := impossible(name, field, float(number)):
            problems.append(Problem(where=where, **wrong))
        else:
            found[name] = float(number)
    if problems:
        raise ProfileError(*problems)
    return found


def _sections(profile: ShipProfile, changed: Mapping[str, Coefficient]) -> dict[str, Section]:
    """The sections with these coefficients in place."""
    sections = dict(profile.sections)
    for name, now in changed.items():
        kind, symbol = split_name(name)
        section = sections[kind]
        sections[kind] = replace(section, coefficients={**section.coefficients, symbol: now})
    return sections


def with_effects(
    profile: ShipProfile,
    values: Mapping[str, Mapping[str, float]],
    source: str,
    stderr: Mapping[str, Mapping[str, float | None]] | None = None,
) -> ShipProfile:
    """The profile with effects {tag: {parameter: value}} put in or changed; other parameters of new ones at their null,
    or where they are pivots, at what suits the ship.

    stderr  standard errors in the same form, where known.  Raises ProfileError for an unknown effect or parameter,
            and for what is no number, OptionError for what is no profile or mapping.
    """
    must_be_a(profile, ShipProfile, "profile")
    must_be_a(values, Mapping, "values")
    by_tag = {effect.tag: effect for effect in effects()}
    sections = {kind: section for kind, section in profile.sections.items() if not effect_tag(kind)}
    given = {tag: section for kind, section in profile.sections.items() if (tag := effect_tag(kind))}
    for tag, parameters in values.items():
        if tag not in by_tag:
            raise ProfileError(Problem(f"no effect '{tag}'", "values", **among(tag, list(by_tag))))
        effect = by_tag[tag]
        for name, number in parameters.items():
            if name not in effect.fields:
                raise ProfileError(Problem(f"effect '{tag}' has no '{name}'", tag, **among(name, list(effect.fields))))
            plain = numbers_of(number)
            if plain is None or plain.ndim or math.isnan(float(plain)):
                fix = f"give a number in the unit of profiles in memory: {effect.fields[name].unit}"
                what = f"'{effect.kind}.{name}' is {brief(number)}"
                raise ProfileError(Problem(what, "values", "only finite numbers can be simulated", fix))
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
    must_be_a(profile, ShipProfile, "profile")
    wanted = [e for e in effects() if e.variants and not missing_for(e, profile) and (not tags or e.tag in tags)]
    return with_effects(profile, {effect.tag: {} for effect in wanted}, ABSENT)


def joined(*texts: str) -> str:
    """Licences or citations of several origins as one text, each once."""
    return "; ".join(dict.fromkeys(part for text in texts for part in text.split("; ") if part))
