"""Writing a profile: its sections are what counts, the text it was read from is where they are put.

What is unchanged stays as its owner wrote it, comments, units and words.  What differs is written in the unit of its
field with every digit, so that reading gives back the same profile.
"""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from dataclasses import asdict, replace
from typing import Any

import tomlkit
from tomlkit.items import InlineTable, Table

from ..components import UNTAGGED, Field
from ..effects import Effect
from ..inputs import INPUTS
from ..metrics import METRICS
from ..units import DIMENSIONLESS, shown
from .model import Coefficient, Section, ShipProfile
from .reading import (
    APPROACH,
    SCHEMA,
    STEERING_GEAR,
    actuator_fields,
    default_of,
    limit_field,
    parse_profile,
    with_wind_coefficients,
)

EMPTY = ShipProfile("", "", "", {}, None, None, ())


def profile_text(profile: ShipProfile) -> str:
    """TOML text of a profile, put into its template where it has one."""
    before = parse_profile(profile.template) if profile.template else EMPTY
    if profile == before:
        return profile.template
    document = tomlkit.parse(profile.template)
    document.setdefault("schema", SCHEMA)
    _write_ship(_table(document, "ship"), profile, before)
    if profile.arrangement is not before.arrangement:
        _table(document, "arrangement")["model"] = profile.arrangement.tag
    for kind in before.sections.keys() - profile.sections.keys():
        _remove(document, kind)
    for kind, section in profile.sections.items():
        _write_section(document, section, before.sections.get(kind), _derived(profile, kind))
    for name, fields in (("steering_gear", STEERING_GEAR), ("approach", APPROACH)):
        now, was = getattr(profile, name), getattr(before, name)
        if now and now.source != (was.source if was else ""):
            _table(document, name)["source"] = now.source
            if not now.source:
                del _table(document, name)["source"]
        numbers = {key: getattr(now, key) for key in fields} if now else {}
        _write_numbers(document, name, numbers, {key: getattr(was, key) for key in fields} if was else {}, fields)
    for name in dict.fromkeys((*before.actuators, *profile.actuators)):
        now, was = (asdict(ship.actuators[name]) if name in ship.actuators else {} for ship in (profile, before))
        _write_numbers(document, f"actuators.{name}", now, was, actuator_fields(INPUTS[name]))
    if not profile.actuators:
        _remove(document, "actuators")
    if profile.targets != before.targets:
        _table(document, "tuning")["targets"] = list(profile.targets)
    _write_numbers(document, "limits", profile.limits, before.limits, {name: limit_field(name) for name in METRICS})
    if profile.provenance != before.provenance:
        _remove(document, "provenance")
        if profile.provenance:
            document["provenance"] = profile.provenance
    return tomlkit.dumps(document)


def _write_ship(table: Any, profile: ShipProfile, before: ShipProfile) -> None:
    for key in ("name", "id", "source", "licence", "citation"):
        if getattr(profile, key) != getattr(before, key):
            table[key] = getattr(profile, key)
            if not table[key]:
                del table[key]


def _write_numbers(
    document: Any, name: str, now: Mapping[str, float], was: Mapping[str, float], fields: Mapping[str, Field]
) -> None:
    """A section of plain numbers; none of them is no section."""
    if now == was:
        return
    if not now:
        _remove(document, name)
        return
    table = _table(document, name)
    for key in was.keys() - now.keys():
        del table[key]
    for key, value in now.items():
        if was.get(key) != value:
            table[key] = _number(value, fields[key].unit)


def _write_section(document: Any, section: Section, before: Section | None, derived: Mapping[str, Coefficient]) -> None:
    """One component.  ``derived``: what reading works out for numbers that are not written."""
    kind, component = section.component.kind, section.component
    if before is not None and before.component is not component:
        _remove(document, kind)
        before = None
    table = _table(document, kind)
    if before is None and not isinstance(component, Effect) and kind not in UNTAGGED:
        table["model"] = component.tag
    if before is None or before.source != section.source:
        table["source"] = section.source
    for symbol, field in component.fields.items():
        now = section.coefficients.get(symbol)
        written = table.get(symbol)
        was = before.coefficients[symbol] if before and written is not None else None
        reads_as = was or derived.get(symbol) or default_of(field)
        if was is not None and not _has_source(written):
            reads_as = replace(was, source=section.source)
        if now == reads_as:
            continue
        if now is None:
            table.pop(symbol, None)
        elif isinstance(written, Table):
            entry = _facts(now, section.source, field, written, was)
            for key in written.keys() - entry.keys():
                del written[key]
            written.update(entry)
        else:
            table[symbol] = _entry(now, section.source, field, written, was)


def _entry(now: Coefficient, source: str, field: Field, written: Any, was: Coefficient | None) -> Any:
    """A coefficient as it is written: its value, with an inline table around it where more is to be said."""
    facts = _facts(now, source, field, written, was)
    if facts.keys() == {"value"}:
        return facts["value"]
    entry = tomlkit.inline_table()
    entry.update(facts)
    return entry


def _facts(now: Coefficient, source: str, field: Field, written: Any, was: Coefficient | None) -> dict[str, Any]:
    """What is known of a coefficient by key; value and bounds as they were written if they are the same."""
    old = written if isinstance(written, Mapping) else {"value": written}
    facts: dict[str, Any] = {"value": _plain(old["value"]) if was and now.value == was.value else _value(now, field)}
    for key in ("pre_determined", "stderr", "scatter"):
        number = getattr(now, key)
        if number is not None:
            facts[key] = _plain(old[key]) if was and number == getattr(was, key) else _number(number, field.unit)
    if now.source != source:
        facts["source"] = now.source
    if now.assumption:
        facts["assumption"] = True
    for key in ("note", "warning"):
        if getattr(now, key):
            facts[key] = getattr(now, key)
    if now.bounds is not None:
        same = was and now.bounds == was.bounds
        facts["bounds"] = _plain(old["bounds"]) if same else [_number(end, field.unit) for end in now.bounds]
    return facts


def _value(now: Coefficient, field: Field) -> Any:
    for word, number in field.choices.items():
        if number == now.value:
            return word
    if not isinstance(now.value, tuple):
        return _number(now.value, field.unit)
    numbers = ", ".join(repr(float(number)) for number in now.value)
    return numbers if field.unit in DIMENSIONLESS else f"{numbers} {field.unit}"


def _number(value: float, unit: str) -> float | str:
    return float(value) if unit in DIMENSIONLESS else shown(float(value), unit)


def _plain(item: Any) -> Any:
    """A value without the comment that stands behind it."""
    return item.unwrap() if hasattr(item, "unwrap") else item


def _has_source(written: Any) -> bool:
    return isinstance(written, Mapping) and "source" in written


def _derived(profile: ShipProfile, kind: str) -> dict[str, Coefficient]:
    """What reading works out for the coefficients of a section that it may leave out."""
    if kind != "above_water":
        return {}
    section = profile.sections[kind]
    given = {s: c for s, c in section.coefficients.items() if not section.component.fields[s].derived}
    whole = with_wind_coefficients({**profile.sections, kind: replace(section, coefficients=given)})
    return {s: c for s, c in whole.coefficients.items() if s not in given}


def _table(document: Any, name: str) -> Any:
    """The table called "hull" or "effects.current", made where there is none."""
    parent, _, tag = name.rpartition(".")
    if parent and parent not in document:
        document[parent] = tomlkit.table(is_super_table=True)
    within: MutableMapping[str, Any] = document[parent] if parent else document
    key = tag if parent else name
    if key not in within:
        within[key] = tomlkit.inline_table() if isinstance(within, InlineTable) else tomlkit.table()
    return within[key]


def _remove(document: Any, name: str) -> None:
    parent, _, tag = name.rpartition(".")
    within = document.get(parent, {}) if parent else document
    within.pop(tag if parent else name, None)
