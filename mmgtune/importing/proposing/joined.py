"""Columns that hold a part of a latitude or longitude each: degrees, minutes, seconds and hemisphere."""

from __future__ import annotations

import itertools
import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ..cells.degrees import of_ddmm
from ..cells.headers import unit_in
from ..cells.numerals import number_in
from ..cells.position_pair import MOST, pair_in
from ..cells.position_parts import HEMISPHERES, letters_in, position_of
from ..formats.table import MISSING
from .finder import Finder
from .sampling import Sample
from .words import DATE, TIME

FEW = 30
"""Cells of a column that are looked at first: where none is a position, hardly any is."""

_NAMES = {"minutes": re.compile(r"min(ute)?s?\b|minut|'|′"), "seconds": re.compile(r"sec(ond)?s?\b|sek|\"|″|''")}
_UNITS = {"minutes": ("min",), "seconds": ("s",)}


def join_positions(find: Finder) -> None:
    """Put together latitudes and longitudes that stand in several columns; the first of them stands for all."""
    _divide_pairs(find)
    _read_ddmm(find)
    for name in HEMISPHERES:
        parts = _parts(find, name)
        if len(parts) < 2:
            continue
        found = [_together(sample, name, parts, parts[""] in find.ddmm) for sample in find.samples]
        degrees = [np.isfinite(sample.numbers[parts[""]]) for sample in find.samples]
        if sum(np.isfinite(one).sum() for one in found) < 0.9 * sum(one.sum() for one in degrees):
            continue
        first, *others = parts.values()
        find.samples = [_joined(one, first, others, values) for one, values in zip(find.samples, found, strict=True)]
        find.first = find.samples[0]
        find.parts[first] = {part: k for part, k in parts.items() if part}
        find.used.update(others)


def _divide_pairs(find: Finder) -> None:
    """Take columns whose cells hold a latitude and a longitude each for two, where no other columns are called so."""
    if set(HEMISPHERES) & set(find.said):
        return
    for k in range(len(find.said)):
        columns = [one.texts[k] for one in find.samples]
        if any(str(one.dtype) != "string" for one in columns) or find.said[k] in (TIME, DATE):
            continue
        if not any(np.isfinite(pair_in(_few(one))["latitude"]).any() for one in columns):
            continue
        halves = [list(pair_in(one).values()) for one in columns]
        told = sum(int(np.isfinite(latitude).sum()) for latitude, _ in halves)
        if told < 10 or told < 0.9 * sum(int(one.notna().sum()) for one in columns):
            continue
        find.samples = [one.divided(k, pair) for one, pair in zip(find.samples, halves, strict=True)]
        find.first = find.samples[0]
        find.said[k] = "latitude"
        find.said.append("longitude")
        find.units_said.append("")
        return


def _few(texts: Any) -> Any:
    """Some of the cells of a pandas column that hold something, from all over it."""
    known = texts.dropna()
    return known.iloc[:: max(1, len(known) // FEW)]


def _read_ddmm(find: Finder) -> None:
    """Turn latitudes and longitudes that hold degrees and minutes in one number, as NMEA 0183 has them, into degrees.

    One of the two beyond its largest angle shows it of both.
    """
    named = {name: [k for k, word in enumerate(find.said) if word == name] for name in HEMISPHERES}
    for pair in itertools.product(*named.values()):
        can, must = [], []
        for name, k in zip(named, pair, strict=True):
            values = np.concatenate([one.numbers[k] for one in find.samples])
            known = values[np.isfinite(values)]
            can.append(len(known) > 0 and bool(np.all(np.abs(of_ddmm(known)) <= MOST[name])))
            must.append(bool(np.max(np.abs(known), initial=0.0) > MOST[name]))
        if _are_exchanged(find, pair):
            lat, lon = (find.shown(k) for k in pair)
            find.notes.append(f"{lat} is beyond 90 deg, and {lon} is not: they are taken for each other, exchanged")
            find.said[pair[0]], find.said[pair[1]] = find.said[pair[1]], find.said[pair[0]]
            return
        if all(can) and any(must):
            find.samples = [_in_degrees(one, pair) for one in find.samples]
            find.first = find.samples[0]
            find.ddmm.update(pair)
            return


def _are_exchanged(find: Finder, pair: Sequence[int]) -> bool:
    """Whether what is called a latitude is the longitude in degrees, and the other way round."""
    lat, lon = (np.concatenate([np.abs(one.numbers[k]) for one in find.samples]) for k in pair)
    known = np.isfinite(lat) & np.isfinite(lon)
    return (
        bool(known.any())
        and MOST["latitude"] < lat[known].min() <= lat[known].max() <= MOST["longitude"]
        and bool(lon[known].max() <= MOST["latitude"])
    )


def _in_degrees(sample: Sample, columns: Collection[int]) -> Sample:
    numbers = [of_ddmm(one) if k in columns else one for k, one in enumerate(sample.numbers)]
    return replace(sample, numbers=numbers, written=sample.written | {*columns})


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


def _together(sample: Sample, name: str, parts: dict[str, int], ddmm: bool) -> FloatArray:
    """Degrees (n_rows,) of the parts."""
    codes = [one for text in sample.layout.get("missing", ()) if (one := number_in(text, ".")) is not None]
    columns = {part: sample.texts[k] for part, k in parts.items()}
    return position_of(name, columns, sample.layout.get("decimal", "."), MISSING, codes, ddmm).degrees


def _joined(sample: Sample, first: int, others: Collection[int], degrees: FloatArray) -> Sample:
    nothing = np.full(len(degrees), np.nan)
    numbers = [degrees if k == first else nothing if k in others else one for k, one in enumerate(sample.numbers)]
    return replace(sample, numbers=numbers, written=sample.written | {first})
