"""Indices of manoeuvres by their keys: what people call them, and the order in which they are told."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from ..trial.index_trial import INDICES
from ..units import DEG


@dataclass(frozen=True)
class Known:
    """An index: its key with the unit, words, the unit people read, the factor to it from SI.

    endless  whether not to reach it is to lie above all that do
    """

    key: str
    words: str
    unit: str
    factor: float
    endless: bool


_UNITS = {
    "m": ("_m", "m", 1.0),
    "s": ("_s", "s", 1.0),
    "rad": ("_deg", "deg", 1.0 / DEG),
    "m/s": ("_m_per_s", "m/s", 1.0),
    "rad/s": ("_deg_per_s", "deg/s", 1.0 / DEG),
    "-": ("", "-", 1.0),
}


def _known(name: str, words: str, unit: str) -> Known:
    suffix, shown, factor = _UNITS[unit]
    endless = (unit in ("m", "s") and name != "lateral_deviation") or name.startswith("overshoot")
    return Known(name + suffix, words, shown, factor, endless)


_OTHERS = {
    "overshoot_3": {"overshoot_4": _known("overshoot_4", "4th overshoot", "rad")},
    "head_reach": {"lateral_deviation": _known("lateral_deviation", "lateral deviation", "m")},
}
"""Indices that no report states, behind those that they are told after."""

KNOWN: Mapping[str, Known] = {
    key: known
    for name, one in INDICES.items()
    for key, known in {name: _known(name, one.words, one.unit), **_OTHERS.get(name, {})}.items()
}
"""Indices that are shown, by the names of ``manoeuvres.on_lanes``, in the order in which they are."""

BY_KEY: Mapping[str, Known] = {one.key: one for one in KNOWN.values()}


def in_order(keys: Iterable[str]) -> list[str]:
    """Keys of indices in the order of the table; those that are not in it come last, as they are."""
    places = {key: place for place, key in enumerate(BY_KEY)}
    return sorted(keys, key=lambda key: places.get(key, len(places)))
