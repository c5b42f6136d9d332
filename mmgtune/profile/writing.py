"""Writing a tuned profile: the original text, comments and all, with tuned values and their provenance in it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import tomlkit

from ..units import shown
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
        section, _, symbol = name.partition(".")
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


def _section(document: tomlkit.TOMLDocument, name: str) -> Any:
    return document[name]


def _written(value: float, unit: str) -> float | str:
    return float(value) if unit in ("-", "prime") else shown(float(value), unit)
