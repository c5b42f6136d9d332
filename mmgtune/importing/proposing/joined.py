"""Columns that hold a part of a latitude or longitude each: degrees, minutes, seconds and hemisphere."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ..headers import unit_in
from ..numerals import number_in
from ..position_parts import HEMISPHERES, letters_in, position_of
from ..table import MISSING
from .finder import Finder
from .sampling import Sample
from .words import TIME

_NAMES = {"minutes": re.compile(r"min(ute)?s?\b|minut|'|′"), "seconds": re.compile(r"sec(ond)?s?\b|sek|\"|″|''")}
_UNITS = {"minutes": ("min",), "seconds": ("s",)}
MOST = {"latitude": 90.0, "longitude": 180.0}


def join_positions(find: Finder) -> None:
    """Put together latitudes and longitudes that stand in several columns; the first of them stands for all."""
    for name in HEMISPHERES:
        parts = _parts(find, name)
        if len(parts) < 2:
            continue
        found = [_together(sample, name, parts) for sample in find.samples]
        degrees = [np.isfinite(sample.numbers[parts[""]]) for sample in find.samples]
        if sum(np.isfinite(one).sum() for one in found) < 0.9 * sum(one.sum() for one in degrees):
            continue
        first, *others = parts.values()
        find.samples = [_joined(one, first, others, values) for one, values in zip(find.samples, found, strict=True)]
        find.first = find.samples[0]
        find.parts[first] = {part: k for part, k in parts.items() if part}
        find.used.update(others)


def _parts(find: Finder, name: str) -> dict[str, int]:
    """Columns of a quantity by what they hold, "" being degrees; empty where there are none."""
    named = [k for k, word in enumerate(find.said) if word == name]
    whole = [k for k in named if not any(_is(find, k, part) for part in _NAMES)]
    degrees = next((k for k in whole if _in_range(find, k, name)), None)
    if degrees is None:
        return {}
    parts = {"": degrees}
    if is_whole(find, degrees):
        for part in _NAMES:
            # Beside the degrees a name need not say again what it is the minutes of.
            beside = max(parts.values()) + 1
            among = [*named, *([beside] if beside < len(find.said) and find.said[beside] in ("", TIME) else [])]
            k = next((k for k in among if k not in parts.values() and _is(find, k, part)), None)
            if k is None:
                break
            parts[part] = k
    hemisphere = _hemisphere(find, name, degrees, parts.values())
    return parts if hemisphere is None else {**parts, "hemisphere": hemisphere}


def _is(find: Finder, k: int, part: str) -> bool:
    """Whether a column is minutes or seconds by its name or unit, and by its numbers."""
    name = find.first.names[k].lower()
    said = bool(_NAMES[part].search(name)) or (find.units_said[k] or unit_in(name)) in _UNITS[part]
    values = np.concatenate([one.numbers[k] for one in find.samples])
    return said and bool(np.isfinite(values).any()) and float(np.nanmax(np.abs(values))) <= 60.0


def _in_range(find: Finder, k: int, name: str) -> bool:
    values = np.concatenate([one.numbers[k] for one in find.samples])
    return bool(np.isfinite(values).any()) and float(np.nanmax(np.abs(values))) <= MOST[name]


def is_whole(find: Finder, k: int) -> bool:
    """Whether a column holds whole numbers in all logs."""
    known = [one[np.isfinite(one)] for one in (sample.numbers[k] for sample in find.samples)]
    return all(len(one) and (one == np.round(one)).all() for one in known)


def _hemisphere(find: Finder, name: str, degrees: int, parts: Collection[int]) -> int | None:
    """The column of letters nearest to the degrees; None where no column has one wherever there are degrees."""
    found = []
    for k in range(len(find.said)):
        if k in parts or any(np.isfinite(one.numbers[k]).any() for one in find.samples):
            continue
        told = [(letters_in(one.texts[k], name) != "").to_numpy(dtype=bool, na_value=False) for one in find.samples]
        needed = [np.isfinite(one.numbers[degrees]) for one in find.samples]
        lacking = sum(int((need & ~tell).sum()) for need, tell in zip(needed, told, strict=True))
        if lacking <= 0.02 * sum(int(need.sum()) for need in needed):
            found.append(k)
    return min(found, key=lambda k: abs(k - degrees), default=None)


def _together(sample: Sample, name: str, parts: dict[str, int]) -> FloatArray:
    """Degrees (n_rows,) of the parts."""
    codes = [one for text in sample.layout.get("missing", ()) if (one := number_in(text, ".")) is not None]
    columns = {part: sample.texts[k] for part, k in parts.items()}
    return position_of(name, columns, sample.layout.get("decimal", "."), MISSING, codes).degrees


def _joined(sample: Sample, first: int, others: Collection[int], degrees: FloatArray) -> Sample:
    nothing = np.full(len(degrees), np.nan)
    numbers = [degrees if k == first else nothing if k in others else one for k, one in enumerate(sample.numbers)]
    return replace(sample, numbers=numbers, written=sample.written | {first})
