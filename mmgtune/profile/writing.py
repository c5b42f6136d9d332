"""Writing a tuned profile: the original text, comments and all, with tuned values and their provenance in it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import tomlkit

from ..components import split_name
from ..effects import find_effect
from ..units import DIMENSIONLESS, shown
from .model import ShipProfile


def tuned_text(
    profile: ShipProfile,
    values: Mapping[str, float],
    stderr: Mapping[str, float | None],
    provenance: Mapping[str, Any],
    name_suffix: str = "tuned",
) -> str:
    """TOML text of ``profile`` with ``values`` {section.symbol: value in the field's unit} in place.

    Each tuned number becomes a table with the value it had before and, where known, its standard error.
    """
    document = tomlkit.parse(profile.text)
    for name, value in values.items():
        section, symbol = split_name(name)
        unit = profile.sections[section].component.fields[symbol].unit
        before = profile.coefficient(name)
        entry = tomlkit.inline_table()
        entry["value"] = _written(value, unit)
        first = before.pre_determined if before.pre_determined is not None else before.value
        assert not isinstance(first, tuple)  # a table of values is never a target
        entry["pre_determined"] = _written(first, unit)
        error = stderr.get(name)
        if error is not None:
            entry["stderr"] = _written(error, unit)
        entry["source"] = f"tuned by mmgtune; before: {before.source}"
        if before.note:
            entry["note"] = before.note
        if before.bounds is not None:
            entry["bounds"] = [_written(end, unit) for end in before.bounds]
        _section(document, section)[symbol] = entry
    ship = _section(document, "ship")
    ship["name"] = f"{profile.name} ({name_suffix})" if f"({name_suffix})" not in profile.name else profile.name
    document["provenance"] = dict(provenance)
    return tomlkit.dumps(document)


def extended_text(
    profile: ShipProfile, effects: Mapping[str, Mapping[str, tuple[float, float | None]]], source: str
) -> str:
    """TOML text of ``profile`` with tables [effects.<tag>] of {parameter: (value, standard error or None)} put in."""
    document = tomlkit.parse(profile.text)
    if "effects" not in document:
        document["effects"] = tomlkit.table(is_super_table=True)
    for tag, parameters in effects.items():
        effect = find_effect(tag)
        if effect is None:
            raise KeyError(tag)
        table = _section(document, "effects").get(tag)
        if table is None:
            table = tomlkit.table()
            table["source"] = source
            _section(document, "effects")[tag] = table
        for name, (value, stderr) in parameters.items():
            entry = tomlkit.inline_table()
            entry["value"] = _written(value, effect.fields[name].unit)
            if stderr is not None:
                entry["stderr"] = _written(stderr, effect.fields[name].unit)
            entry["source"] = source
            table[name] = entry
    return tomlkit.dumps(document)


def _section(document: tomlkit.TOMLDocument, name: str) -> Any:
    found: Any = document
    for part in name.split("."):
        found = found[part]
    return found


def _written(value: float, unit: str) -> float | str:
    return float(value) if unit in DIMENSIONLESS else shown(float(value), unit)
